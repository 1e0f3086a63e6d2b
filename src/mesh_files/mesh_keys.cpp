#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "mesh_files/mesh_file.hpp"

namespace bernal {
namespace {

[[noreturn]] void refuse_value(const MeshKey& key, std::string_view given) {
  std::string takes = fmt::format("{}", fmt::join(key.words, ", "));
  if (key.words.empty())
    takes = fmt::format("a {} from {} to {}",
                        std::holds_alternative<int MeshFileOptions::*>(key.to) ? "whole number" : "number",
                        key.least, key.most);
  throw Error(ErrorCode::bad_argument,
              fmt::format("‹{}› takes {}, not {}", key.name, takes, plain_text(given)));
}

/// Takes the value of a key for the member that it stands for.
struct Taken {
  const MeshKey& key;
  const std::string& text;
  MeshFileOptions& options;

  template <class Number>
  void operator()(Number MeshFileOptions::*member) const {
    const char* end = text.data() + text.size();
    const auto [stop, problem] = std::from_chars(text.data(), end, options.*member);
    if (problem != std::errc() || stop != end) refuse_value(key, text);
  }
  void operator()(std::string MeshFileOptions::*member) const {
    if (text.empty())
      throw Error(ErrorCode::bad_argument, fmt::format("‹{}› is empty; leave it out", key.name));
    options.*member = text;
  }
  void operator()(bool MeshFileOptions::*member) const { options.*member = place() == 1; }
  void operator()(ContactTreatment MeshFileOptions::*member) const {
    constexpr ContactTreatment treatments[] = {ContactTreatment::bridge, ContactTreatment::gap,
                                               ContactTreatment::shrink, ContactTreatment::cap,
                                               ContactTreatment::fillet};
    options.*member = treatments[place()];
  }
  std::size_t place() const {
    const auto found = std::ranges::find(key.words, text);
    if (found == key.words.end()) refuse_value(key, text);
    return static_cast<std::size_t>(found - key.words.begin());
  }
};

}  // namespace

const std::vector<MeshKey>& mesh_keys() {
  using Of = MeshFileOptions;
  static const std::vector<MeshKey> all = {
      {.name = "contact",
       .what = "What is done where spheres touch or nearly do; bridge if absent",
       .placeholder = "WORD",
       .to = &Of::contact,
       .words = {"bridge", "gap", "shrink", "cap", "fillet"}},
      {"gap", "Contacts nearer than this, in radii; 0.01 if absent", "SHARE", &Of::gap, 1e-3, 0.5},
      {"bridge_radius", "Of bridges, and of waists of fillets, in radii of the smaller sphere; 0.2 if absent",
       "SHARE", &Of::bridge_radius, 0.05, 0.7},
      {"bridge_angle",
       "Instead: the least angle at centres of spheres between the axis of a bridge and where it begins",
       "DEGREES", &Of::bridge_angle, 3, 40},
      {"mesh_size", "Edges on spheres, in radii; 0.3 if absent", "SHARE", &Of::sphere_edge, 0.02, 0.9},
      {"neck_size", "Edges where bridges begin, in radii; 0.15 if absent", "SHARE", &Of::neck_edge, 0.01,
       0.9},
      {"gap_size", "Edges where surfaces are near each other, in widths of the gap; 4 if absent", "WIDTHS",
       &Of::gap_edge, 0.5, 50},
      {"layer_size", "Edges on spheres with thin layers, in thicknesses of these; 6 if absent", "WIDTHS",
       &Of::layer_edge, 0.5, 50},
      {.name = "facets",
       .what =
           "What facets keep of spheres: corners lie on them, or volume is held, by corners that stand off "
           "them a little; corners if absent",
       .placeholder = "WORD",
       .to = &Of::hold_volumes,
       .words = {"corners", "volume"}},
      {"prisms", "Layers of prisms in the fluid on spheres and walls where there is room; none if absent",
       "N", &Of::prisms, 0, 20},
      {"prism_height", "Of all layers of prisms together, in radii; 0.1 if absent", "SHARE",
       &Of::prism_height, 0.005, 0.4},
      {"prism_growth", "Height of a layer of prisms over that of the one below; 1.2 if absent", "RATIO",
       &Of::prism_growth, 1, 3},
      {.name = "regions",
       .what = "What is meshed: the fluid, or the spheres too; fluid if absent",
       .placeholder = "WORD",
       .to = &Of::solids,
       .words = {"fluid", "all"}},
      {"cut",
       "The part that is meshed, in the scene's unit: \"x = 1..4, y = 1..4, z = 0..5\", other planes that "
       "close a convex part, or a file, part.stl; its faces cut spheres. In boxes, periodic ones too, "
       "cylinders and spheres, with contact gap or shrink",
       "PART", &Of::cut},
      {"patches",
       "Flat walls that are patches of their own, by the planes that they lie in, for inlets and outlets: "
       "\"inlet: z = 0, outlet: z = 4 cm\"; in the scene's unit where none is given",
       "NAMES", &Of::patches},
      {"unit", "Of lengths in the files: m, mm, …; the scene's if absent, and always m for snappy", "UNIT",
       &Of::unit},
      {"order", "2: elements with middles of edges, on the true spheres; 1 if absent", "N", &Of::order, 1, 2},
  };
  return all;
}

void require_in_range(const MeshKey& key, const MeshFileOptions& options) {
  const auto require = [&](auto value) {
    if (!(value >= key.least && value <= key.most)) refuse_value(key, fmt::format("{}", value));
  };
  if (const auto* number = std::get_if<double MeshFileOptions::*>(&key.to); number != nullptr) {
    static const MeshFileOptions defaults;  // some of which stand for what is absent
    if (options.**number != defaults.**number) require(options.**number);
  }
  if (const auto* whole = std::get_if<int MeshFileOptions::*>(&key.to)) require(options.**whole);
}

MeshFileOptions mesh_options_of(std::string_view format, const std::map<std::string, std::string>& words) {
  MeshFileOptions options{.format = std::string(format)};
  for (const auto& [name, text] : words) {
    const auto key = std::ranges::find(mesh_keys(), name, &MeshKey::name);
    if (key == mesh_keys().end()) {
      std::vector<std::string_view> names;
      for (const MeshKey& known : mesh_keys()) names.emplace_back(known.name);
      throw Error(ErrorCode::bad_argument,
                  fmt::format("meshes have no \"{}\"{}", plain_text(name), remedy(name, names)));
    }
    std::visit(Taken{*key, text, options}, key->to);
    require_in_range(*key, options);
  }
  if (words.contains("bridge_radius") && words.contains("bridge_angle"))
    throw Error(ErrorCode::bad_argument, "bridges take ‹bridge_radius› or ‹bridge_angle›, not both");
  for (const char* key : {"prism_height", "prism_growth"})
    if (words.contains(key) && options.prisms == 0)
      throw Error(ErrorCode::bad_argument, fmt::format("‹{}› is of ‹prisms›, of which there are none", key));
  return options;
}

}  // namespace bernal
