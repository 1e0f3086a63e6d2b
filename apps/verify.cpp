#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bed_text.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/measure/rest.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/json.hpp"
#include "bernal/report/zones_in_place.hpp"
#include "bernal/result/certify_levels.hpp"
#include "bernal/result/layers_table.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/slabs/pack_in_slabs.hpp"
#include "bernal/verify/certificate.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "results.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct VerifyCall {
  std::filesystem::path target;
  std::filesystem::path scene;
  std::string list;
  bool settled = false;
  double tolerance = Rest::closed;  ///< of what touches, for `settled`
  int threads = 0;
  bool json = false;
};

/// How many overlaps `--list`, `--list=all` and `--list=N` ask for.
std::size_t listed(const std::string& text) {
  if (text.empty()) return 0;
  if (text == "all") return CertifyOptions::all;
  std::size_t most = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, most);
  if (error != std::errc{} || stop != end || most == 0)
    throw Error(ErrorCode::bad_argument, "--list takes no value, or how many are wanted: --list=20");
  return most;
}

bool is_folder(const std::filesystem::path& target) {
  std::error_code unknown;
  return std::filesystem::is_directory(target, unknown);
}

Scene scene_of(const VerifyCall& call) {
  if (!call.scene.empty()) return read_scene(call.scene);
  if (is_folder(call.target)) return scene_of_result(call.target);
  std::error_code unknown;
  if (!std::filesystem::exists(call.target, unknown))
    throw Error(ErrorCode::bad_argument, "no such file or folder", {call.target.string()});
  throw Error(ErrorCode::bad_argument,
              "one file does not say what it was packed into; give --scene SCENE.toml too",
              {call.target.string()});
}

/// A least distance in words, where only small distances are known.
std::string least_text(const std::optional<double>& distance) {
  return distance ? fmt::format("{:.9g}", *distance) : "more than twice that";
}

void print(const Certificate& c, const std::optional<ZonesInPlace>& zones, const VerifyCall& call,
           const Domain& domain, std::string_view unit) {
  say(stdout, "certified  {}\n", c.certified ? "yes" : "NO");
  say(stdout, "spheres    {}, in {}\n", grouped(c.spheres), unit);
  say(stdout, "pairs      {} near, {} overlapping", grouped(c.pairs_tested), grouped(c.overlapping_pairs));
  if (c.allowed_overlap > 0) say(stdout, " by more than {:g}", c.allowed_overlap);
  if (c.worst_pair) say(stdout, "; worst: {}, overlap ratio {:.3g}", worst_pair_text(c), c.max_overlap);
  if (has_walls(domain))
    say(stdout, "\nwalls      {} {}, {} spheres protruding", grouped(c.walls_tested),
        walls_tested_are_near(domain) ? "near" : "decided, near or far", grouped(c.protruding_spheres));
  if (c.worst_wall)
    say(stdout, "; worst: sphere {}, gap {:.3g} of its radius", *c.worst_wall, c.min_wall_gap);
  if (c.gap + c.wall_gap > 0) {
    say(stdout, "\ngaps       {:g} between spheres", c.gap);
    if (c.gap > 0) say(stdout, ", least {}", least_text(c.least_distance));
    if (has_walls(domain)) say(stdout, "; {:g} from walls", c.wall_gap);
    if (has_walls(domain) && c.wall_gap > 0) say(stdout, ", least {}", least_text(c.least_wall_distance));
    say(stdout, "; ratios are those of spheres with half the gap around them");
  }
  say(stdout, "\ndecided    {} in double with a proven bound, {} in exact arithmetic, in {:.3f} s\n",
      grouped(c.decided_double), grouped(c.decided_exact), c.seconds);
  for (const Certificate::Level& level : c.levels)
    say(stdout, "inside     {}: {} pairs near, {} overlapping, {} walls, {} protruding, {} misplaced\n",
        level.name, grouped(level.pairs_tested), grouped(level.overlapping_pairs),
        grouped(level.walls_tested), grouped(level.protruding_spheres), grouped(level.misplaced));
  if (zones)
    say(stdout, "zones      {} spheres not in the place of theirs\n", grouped(zones->misplaced.size()));
  const std::size_t most = zones ? std::min(zones->misplaced.size(), listed(call.list)) : 0;
  for (std::size_t k = 0; k < most; ++k) say(stdout, "misplaced  {}\n", zones->misplaced[k]);
  for (const auto& [pair, ratio] : c.overlaps)
    say(stdout, "overlap    {}, ratio {:.3g}\n", pair_text(pair), ratio);
  for (const auto& [sphere, gap] : c.protrusions)
    say(stdout, "protrudes  {}, gap {:.3g} of its radius\n", sphere, gap);
  say(stdout, "{}\n", c.statement);
}

/// Which spheres rest, for `--settled`.
Rest rest_of(const VerifyCall& call, const Scene& scene, const Spheres<dynamic>& spheres,
             const Domain& domain, bool streamed) {
  if (streamed)
    throw Error(ErrorCode::bad_argument, "--settled needs the whole packing, and this one is in slabs");
  Rest rest = measure_rest(spheres, domain, down_in(scene),
                           {.gap = scene.gap,
                            .wall_gap = scene.wall_gap,
                            .tolerance = call.tolerance,
                            .friction = scene.target.bed.friction(),
                            .list = !call.list.empty()});
  if (const std::size_t most = listed(call.list); rest.list.size() > most) rest.list.resize(most);
  return rest;
}

void print(const Rest& rest, const VerifyCall& call, const Spheres<dynamic>& spheres, std::string_view unit) {
  const std::string to =
      call.tolerance > Rest::closed ? fmt::format(", to {:g} of a radius", call.tolerance) : "";
  say(stdout, "settled    {}{}\n", rest_text(rest, unit), to);
  for (const auto& [sphere, slope, fall] : rest.list) {
    const auto i = static_cast<std::size_t>(sphere);
    say(stdout, "unsettled  {} at {:.6g}, radius {:.6g}: {}\n", sphere, fmt::join(spheres.center(i), ", "),
        spheres.r[i],
        fall > 0 ? fmt::format("hangs, could fall {:.3g} {}", fall, unit)
                 : fmt::format("is not held, a way down of slope {:.3g} is open", slope));
  }
  if (!rest.list.empty() && rest.list.size() < rest.unsettled)
    say(stdout, "           and {} more\n", grouped(rest.unsettled - rest.list.size()));
}

/// Whether a result is certified slab by slab, since it may be larger than memory.
bool is_streamed(const VerifyCall& call, const Scene& scene) {
  return is_folder(call.target) && is_in_slabs(scene) && spheres_of_result(call.target).extension() == ".npy";
}

/// What the tables of layers say that stand beside a result's own scene.
std::optional<LayersTable> layers_table_of(const VerifyCall& call, const Packing& packing) {
  if (!is_folder(call.target) || !call.scene.empty()) return {};
  return layers_table_of(packing, call.target);
}

int verify(const VerifyCall& call) {
  const Scene scene = scene_of(call);
  say_if_unpublished(call.target);
  const bool streamed = is_streamed(call, scene);
  const bool by_levels = is_folder(call.target) && !scene.inside.empty();
  Packing packing;
  if (by_levels) {
    packing = read_packing(call.target);
  } else {
    packing.scene = scene;
    packing.seed = scene.seed;
    if (!streamed)
      packing.spheres = is_folder(call.target)  // before another result replaces both
                            ? read_spheres_of(scene, call.target, &packing.classes)
                            : read_columns_of(scene, call.target);
    packing.domain = packed_domain_of(scene);
  }
  const Spheres<dynamic>& spheres = packing.spheres;
  const Domain& domain = packing.domain;
  speak_of(scene.dimension());

  ProgressBar bar(call.json, true);
  const CertifyOptions options{.allowed_overlap = scene.overlap,
                               .gap = scene.gap,
                               .wall_gap = scene.wall_gap,
                               .list = listed(call.list),
                               .threads = call.threads,
                               .monitor = bar.monitor()};
  Certificate certificate = streamed    ? certify_in_slabs(scene, spheres_of_result(call.target), options)
                            : by_levels ? certify_levels(packing, options)
                                        : certify(spheres, domain, options);
  certificate.statement += certified_walls(scene, domain);
  const auto zones = zones_in_place(scene, domain, spheres, packing.classes, {.threads = call.threads});
  if (zones) add_to(certificate, *zones);
  if (const auto table = streamed ? std::nullopt : layers_table_of(call, packing))
    add_to(certificate, *table);
  std::optional<Rest> rest;
  if (call.settled) rest = rest_of(call, scene, spheres, domain, streamed);
  bar.clear();
  if (call.json) {
    say(stdout, "{}", certificate_as_json(certificate, zones, rest, spheres));
  } else {
    print(certificate, zones, call, domain, name_of(scene.unit));
    if (rest) print(*rest, call, spheres, name_of(scene.unit));
  }
  return certificate.certified && (!rest || rest->unsettled == 0) ? exit_code::done : exit_code::no;
}

}  // namespace

Command verify_command() {
  const auto call = std::make_shared<VerifyCall>();
  return {
      "verify",
      "Certify files from scratch: no overlap, nothing outside",
      {file(required(
                {"DIR", &call->target,
                 "What bernal pack wrote, or one file: CSV whose header names x, y, z and r or d, or .npy",
                 "DIR|FILE.csv"}),
            {".csv", ".npy"}),
       file({"--scene", &call->scene, "The scene that names the container, if not DIR/scene.toml",
             "SCENE.toml"},
            {".toml"}),
       {"--list{all}", &call->list,
        "Name every overlapping pair and protruding sphere, and with --settled every sphere that does not "
        "rest; --list=N: the N worst of each"},
       {"--settled", &call->settled, "Say too whether every sphere rests, or hangs or could roll down"},
       within(needs({"--gap", &call->tolerance,
                     "For --settled: spheres touch below this gap, in radii, and ways down that are no "
                     "steeper count as level; 1e-6 if absent, more for coordinates that were rounded",
                     "RATIO"},
                    "--settled"),
              Rest::closed, 0.1),
       threads_option(call->threads, "the answer"),
       json_option(call->json)},
      {.text =
           "Every near pair and every near wall is decided: in double arithmetic where a proven error bound "
           "allows, else exactly.",
       .examples = {{"bernal verify out", "what bernal pack wrote"},
                    {"bernal verify out --settled", "and whether the bed stands by itself"},
                    {"bernal verify bed.csv --scene scene.toml --settled --gap 1e-3 --list=20",
                     "of others, with three decimals: which spheres do not rest"},
                    {"bernal verify bed.csv --scene scene.toml --list", "other spheres, and what is wrong"}},
       .exit_codes = {{"0", "certified"},
                      {"1", "not certified, in another zone, not at rest, or layers.csv says otherwise"},
                      {"2", "bad input"}}},
      [call] { return verify(*call); }};
}
