#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/plan/layer_shares.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/predict/predict.hpp"
#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"
#include "design.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct LayerCall {
  std::filesystem::path scene;
  std::string name;
  double fraction = 0;
  int rods = 16000;
  bool json = false;
};

struct LayerAnswer {
  double share = 0;   ///< of the layers or the material of that name, of the spheres
  double needed = 0;  ///< packing fraction of the spheres
  Prediction prediction = {};
};

/// Layers of that name, or all of that material.
double share_of(const std::vector<LayerShare>& layers, const LayerCall& call) {
  double share = 0;
  std::vector<std::string> names;
  for (const LayerShare& layer : layers) {
    if (layer.name == call.name || layer.material == call.name) share += layer.share;
    if (std::ranges::find(names, layer.name) == names.end()) names.push_back(layer.name);
  }
  if (layers.empty())
    throw Error(ErrorCode::bad_scene,
                "the spheres have no layers: name them in [spheres], layers = [{ name = \"core\", … }]",
                {call.scene.string()});
  if (share == 0)
    throw Error(ErrorCode::bad_argument,
                fmt::format("--layer: no layer is called {} or made of that; the layers are {}",
                            plain_text(call.name, 100), fmt::join(names, ", ")));
  return share;
}

LayerAnswer find(const LayerCall& call) {
  if (!(call.fraction > 0 && call.fraction < 1))
    throw Error(ErrorCode::bad_argument,
                fmt::format("--fraction: a packing fraction lies between 0 and 1, not at {}", call.fraction));
  const Scene scene = read_scene(call.scene);
  if (scene.dimension() != 3)
    throw Error(ErrorCode::bad_scene, "layers are of spheres in three dimensions",
                scene.container.locations.whole);
  LayerAnswer answer{.share = share_of(layer_shares(scene), call)};
  answer.needed = call.fraction / answer.share;
  answer.prediction = predict_packing_fraction(*radii_of(scene), call.rods);
  return answer;
}

int layer(const LayerCall& call) {
  const LayerAnswer answer = find(call);
  const bool reachable = answer.needed <= answer.prediction.phi;
  const double most = answer.share * answer.prediction.phi;
  if (call.json) {
    const nlohmann::ordered_json json = {
        {"layer", call.name},
        {"fraction", call.fraction},
        {"share", answer.share},
        {"phi", reachable ? nlohmann::ordered_json(answer.needed) : nlohmann::ordered_json()},
        {"largest_fraction", most},
        {"predicted_phi", answer.prediction.phi},
        {"error", answer.prediction.error},
        {"found", reachable}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("layer             {:.6f} of the spheres is {}\n", answer.share, plain_text(call.name, 100));
    fmt::print("most              {:.6f}, where the spheres pack as densely as is predicted, {:.6f}\n", most,
               answer.prediction.phi);
    print_error(answer.prediction);
    if (reachable)
      fmt::print("\nTo paste under [spheres] of the scene:\npacking_fraction = {}\n", number(answer.needed));
  }
  if (reachable) return exit_code::done;
  say(stderr,
      "bernal: {} cannot fill {} of a packing: the spheres would have to fill {:.6f}, and random ones fill "
      "{:.6f}, with which it fills {:.6f}\n",
      plain_text(call.name, 100), call.fraction, answer.needed, answer.prediction.phi, most);
  return exit_code::not_reached;
}

}  // namespace

Command layer_command() {
  const auto call = std::make_shared<LayerCall>();
  return {
      "layer",
      "How densely spheres with layers must pack, so that a layer fills a given fraction",
      {file(required({"SCENE", &call->scene, "The scene that names the layers, a TOML file"}), {".toml"}),
       required({"--layer", &call->name, "The name of a layer, or a material, of which all counts", "NAME"}),
       required({"--fraction", &call->fraction, "That it is to fill, of the whole volume", "P"}),
       rods_option(call->rods, 100, 10'000'000), json_option(call->json)},
      {.text = "A packing fraction of fuel, of cores or of an interphase, which is that of the spheres "
               "times the layer's share of them, a mean over their sizes and over drawn thicknesses.",
       .lists = {},
       .examples = {{"bernal design layer triso.toml --layer kernel --fraction 0.02",
                     "packing_fraction = …, for the scene"}},
       .exit_codes = {{"0", "done"},
                      {"2", "bad input"},
                      {"3", "random packings are not that dense, and what the layer fills at most"}}},
      [call] { return layer(*call); }};
}
