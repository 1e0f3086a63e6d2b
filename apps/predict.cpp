#include "bernal/predict/predict.hpp"

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/map/check_prediction.hpp"
#include "bernal/plan/layer_shares.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"
#include "design.hpp"
#include "progress_bar.hpp"

using namespace bernal;

namespace {

struct PredictCall {
  std::vector<std::string> lognormals;
  std::string classes;
  std::filesystem::path scene;
  std::string format;  ///< of standard input
  int rods = 16000;
  std::optional<double> gap_factor;
  bool fit = false;
  std::optional<double> solids;
  double intrinsic = 2.5;
  bool json = false;
  bool check = false;
  CheckOptions packing;
  bool quiet = false;
};

struct PredictAnswer {
  Prediction prediction;
  double seconds = 0;
  std::optional<double> viscosity;
  std::vector<LayerShare> layers;
  std::optional<PredictionCheck> packed;
};

std::vector<Population> populations_of(const PredictCall& call) {
  if (!call.format.empty()) return read_populations(std::cin, call.format.front());
  std::vector<Population> populations;
  if (!call.classes.empty()) populations = parse_classes(call.classes, "--classes");
  for (const std::string& text : call.lognormals) {
    populations.push_back(parse_lognormal(text, "--lognormal"));
    if (populations.size() + call.lognormals.size() > 2 && text.find(',') == std::string::npos)
      throw Error(
          ErrorCode::bad_argument,
          fmt::format("--lognormal {}: in a mixture a population needs a size: D43,D32,VOLUME", text));
  }
  return populations;
}

/// A scene with the sizes: that of the file, or one with nothing else if flags or standard input give them.
Scene scene_of(const PredictCall& call) {
  Scene scene;
  if (call.scene.empty()) {
    const std::vector<Population> populations = populations_of(call);
    if (call.fit && populations.size() != 1)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("--fit is for one lognormal population, not for {}", populations.size()));
    scene.sizes = sizes_of(populations);
  } else {
    scene = read_scene(call.scene);
    if (scene.dimension() != 3)
      throw Error(ErrorCode::bad_scene, "the rod model is for three dimensions",
                  scene.container.locations.whole);
  }
  return scene;
}

/// The width of the only population, a lognormal one, which the fitted formulas need.
double width_of(const Scene& scene) {
  const auto* only = std::get_if<Lognormal>(&std::get<Mixture>(scene.sizes).of.front());
  return only ? *only->sigma : 0;
}

/// Packs spheres of these sizes, to check the prediction.
PredictionCheck check(const Scene& scene, PredictCall& call) {
  ProgressBar bar(call.quiet);
  call.packing.monitor = bar.monitor();
  call.packing.gap_factor = call.gap_factor.value_or(rod_gap_factor);
  return check_prediction(scene_to_check(scene.sizes, scene.sizes_are_diameters, call.packing), call.packing);
}

/// Throws unless the user gave the sizes in exactly one way.
void require_one_source(const PredictCall& call) {
  const int sources =
      (!call.lognormals.empty() || !call.classes.empty()) + !call.scene.empty() + !call.format.empty();
  if (sources != 1)
    throw Error(ErrorCode::bad_argument,
                "give the sizes in one way: by --lognormal and --classes, --scene or --stdin; see bernal "
                "predict --help");
  if (call.fit && !call.scene.empty())
    throw Error(ErrorCode::bad_argument, "--fit is for one lognormal population, not for a scene");
}

PredictAnswer answer_to(PredictCall& call) {
  require_one_source(call);
  const Scene scene = scene_of(call);
  PredictAnswer answer;
  const Stopwatch watch;
  if (call.fit)
    answer.prediction = {fitted_packing_fraction(width_of(scene)), 0, 3e-4};
  else
    answer.prediction =
        predict_packing_fraction(*radii_of(scene), call.rods, call.gap_factor.value_or(rod_gap_factor));
  answer.layers = layer_shares(scene);
  answer.seconds = watch.seconds();
  if (call.solids) answer.viscosity = relative_viscosity(*call.solids, answer.prediction.phi, call.intrinsic);
  if (call.check) answer.packed = check(scene, call);
  return answer;
}

void print(const PredictionCheck& packed, double predicted) {
  fmt::print("packed            {:.6f}, {} spheres in a periodic box{}, {:.3f} contacts each, in {:.1f} s\n",
             packed.phi, grouped(packed.spheres), packed.certified ? ", certified" : ", NOT certified",
             packed.coordination, packed.seconds);
  fmt::print("difference        {:+.4f}, packed less predicted; {:+.4f} is from having so many spheres\n",
             packed.phi - predicted, packed.predicted - predicted);
  if (packed.outcome != Outcome::converged)
    fmt::print("outcome           {}: not as dense as it would become\n", name_of(packed.outcome));
}

void print(const std::vector<LayerShare>& layers, double phi) {
  for (const auto& [of_class, name, material, share] : layers)
    fmt::print("layer             {:.6f} of the spheres, {:.6f} of the packing: {}{}\n", share, share * phi,
               plain_text(name, 100), of_class.empty() ? "" : " of " + plain_text(of_class, 100));
  for (const LayerShare& of : by_material(layers))
    fmt::print("material          {:.6f} of the spheres, {:.6f} of the packing: {}\n", of.share,
               of.share * phi, plain_text(of.material, 100));
}

void print(const PredictCall& call, const PredictAnswer& answer) {
  const Prediction& p = answer.prediction;
  fmt::print("packing fraction  {:.6f}, {} without walls\n", p.phi,
             call.gap_factor ? fmt::format("by rods that are apart by {:g} of the shorter,", *call.gap_factor)
                             : "random close packing");
  if (call.fit)
    fmt::print("error             {:.1g}, of the fit to the rod model\n", p.error);
  else
    print_error(p);
  if (answer.viscosity)
    fmt::print("viscosity         {:.6g} times that of the liquid, at a volume fraction of solids of {:g}\n",
               *answer.viscosity, *call.solids);
  print(answer.layers, p.phi);
  if (answer.packed) print(*answer.packed, p.phi);
}

/// The exit code: `no` if a packing is not certified, `not_reached` if it was stopped or stayed loose.
int status_of(const PredictAnswer& answer) {
  if (!answer.packed) return exit_code::done;
  if (!answer.packed->certified) return exit_code::no;
  return answer.packed->outcome == Outcome::converged ? exit_code::done : exit_code::not_reached;
}

nlohmann::ordered_json as_json(const PredictCall& call, const PredictAnswer& answer) {
  nlohmann::ordered_json json = {{"phi", answer.prediction.phi},
                                 {"rods", answer.prediction.rods},
                                 {"error", answer.prediction.error},
                                 {"method", call.fit ? "fit" : "rods"},
                                 {"seconds", answer.seconds}};
  if (call.gap_factor) json["gap_factor"] = *call.gap_factor;
  if (answer.viscosity) {
    json["solids"] = *call.solids;
    json["relative_viscosity"] = *answer.viscosity;
  }
  for (const auto& [of_class, name, material, share] : answer.layers)
    json["layers"].push_back(
        {{"class", of_class.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(of_class)},
         {"name", name},
         {"material", material},
         {"share", share},
         {"packing_fraction", share * answer.prediction.phi}});
  for (const LayerShare& of : by_material(answer.layers))
    json["materials"].push_back({{"material", of.material},
                                 {"share", of.share},
                                 {"packing_fraction", of.share * answer.prediction.phi}});
  if (answer.packed)
    json["packed"] = {{"phi", answer.packed->phi},
                      {"phi_predicted_for_these_spheres", answer.packed->predicted},
                      {"spheres", answer.packed->spheres},
                      {"certified", answer.packed->certified},
                      {"coordination", answer.packed->coordination},
                      {"outcome", name_of(answer.packed->outcome)},
                      {"seconds", answer.packed->seconds}};
  return json;
}

int predict(PredictCall& call) {
  const PredictAnswer answer = answer_to(call);
  if (call.json)
    fmt::print("{}\n", as_json(call, answer).dump(2));
  else
    print(call, answer);
  return status_of(answer);
}

Explanation predict_explanation() {
  return {
      .text =
          "The rod model (Farr and Groot 2009, Farr 2013) knows the sizes alone: smooth spheres, no walls, "
          "no "
          "friction, no segregation. It is up to 0.01 above simulations of lognormal spheres and their "
          "mixtures, and below the truth where sizes are very different: 0.8595 instead of 0.8729 at best "
          "for two sizes.",
      .lists =
          {{.title = "Sizes",
            .text = "in one of three ways.",
            .entries = {{"--lognormal, --classes",
                         "as often as needed: one mixture of all. Diameters and volumes are in any unit; "
                         "volumes are those of the spheres (or masses, of one material), not of the heap"},
                        {"--scene",
                         "the [spheres] of a scene, of any distribution; where they have layers, also what "
                         "each layer and each material takes up"},
                        {"--stdin", "a table, one population a line, '#' begins a comment"}}},
           {.title = "Lines of --stdin",
            .entries = {{"l", "d43 d32 volume: lognormal, volume- and surface-weighted mean diameter"},
                        {"w", "d43 sigma volume: lognormal, sigma that of ln(diameter)"},
                        {"d", "diameter volume: one diameter"}}}},
      .examples = {{"bernal predict --lognormal 0.5", "0.7073"},
                   {"bernal predict --classes 1:0.25,5:0.75",
                    "a quarter of the volume five times smaller: 0.783"},
                   {"bernal predict --lognormal 20,17,3 --classes 100:7 --json", "a mixture, for programs"},
                   {"bernal predict --stdin d < sieves.txt", "a table"},
                   {"bernal predict --lognormal 0.5 --solids 0.6",
                    "viscosity of a suspension (Krieger and Dougherty)"},
                   {"bernal predict --lognormal 0.3 --gap-factor 0.918",
                    "if equal spheres packed to 0.60: 0.63"},
                   {"bernal predict --lognormal 0.3 --check", "and is it true? some seconds"}},
      .exit_codes = {{"0", "done"},
                     {"1", "with --check: not certified"},
                     {"2", "bad input"},
                     {"3", "with --check: the packing was stopped or is loose"}}};
}

}  // namespace

Command predict_command() {
  const auto call = std::make_shared<PredictCall>();
  return {
      "predict",
      "Say how densely spheres of these sizes pack, without packing them",
      {repeated({"--lognormal,--sigma", &call->lognormals,
                 "A lognormal population: its width alone, or its mean diameters and its volume",
                 "SIGMA|D43,D32,VOLUME"}),
       {"--classes", &call->classes, "Populations of one diameter each", "D:V,D:V,…"},
       file({"--scene", &call->scene, "The sizes of a scene, a TOML file", "SCENE"}, {".toml"}),
       one_of({"--stdin", &call->format, "Populations from standard input, in this format", "FORMAT"},
              {"l", "d", "w"}),
       rods_option(call->rods, 2, 10'000'000),
       within({"--gap-factor", &call->gap_factor,
               "Gaps between rods, in shares of the shorter one; 0.7654 if absent, which gives equal spheres "
               "0.6435; 0.918 gives them 0.60",
               "F"},
              0.0, 100.0),
       excludes({"--fit", &call->fit, "Farr's formula for one lognormal population, sigma up to 3"},
                "--gap-factor"),
       {"--solids", &call->solids, "Also the viscosity of a suspension with this volume fraction of spheres",
        "PHI"},
       needs({"--intrinsic", &call->intrinsic, "Intrinsic viscosity; 2.5, that of spheres, if absent", "ETA"},
             "--solids"),
       json_option(call->json),
       {"--check", &call->check,
        "Also pack these sizes in a periodic box, certify that, and say both numbers"},
       needs(within({"--spheres", &call->packing.spheres,
                     "So many; 10,000 if absent, more for wide distributions", "N"},
                    1, 10'000'000),
             "--check"),
       offering(
           needs({"--stage",
                  [call = call.get()](const std::string& name) { call->packing.stage = stage_named(name); },
                  "What packs them, relax or grow; relax if absent", "NAME"},
                 "--check"),
           {"relax", "grow"}),
       needs(seed_option("Of that packing; 1 if absent",
                         [call = call.get()](std::uint64_t seed) { call->packing.seed = seed; }),
             "--check"),
       quiet_option(call->quiet, "Show no progress")},
      predict_explanation(),
      [call] { return predict(*call); }};
}
