#include "cad/true_surface.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cad/diagnose/counted.hpp"
#include "geometry/deviation_bounds.hpp"
#include "geometry/surface_kinds.hpp"

namespace bernal::cad {
namespace {

using Face = TrueSurface::Face;

/// How what the reader says of the same begins.
constexpr std::string_view measured_note = "tessellated with a deflection";

/// "6 × plane (40 % of the area), …".
std::string shares_of_kinds(const TrueSurface& surface) {
  std::vector<std::string> words;
  for (const SurfaceKind& kind : kinds_of(surface))
    words.push_back(fmt::format("{} × {} ({:.3g} % of the area)", kind.faces, kind.name, 100 * kind.share));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string without_bound(const TrueSurface& surface) {
  constexpr std::size_t most = 6;
  std::vector<std::string> words;
  for (const Face& face : surface.faces)
    if (!face.without_bound.empty())
      words.push_back(fmt::format("face {} ({}): {}", face.number, face.kind, face.without_bound));
  const std::size_t more = words.size() - std::min(most, words.size());
  words.resize(words.size() - more);
  return fmt::format("{}{}", fmt::join(words, "; "), more > 0 ? fmt::format("; and {} more", more) : "");
}

}  // namespace

void attach(TrueSurface&& surface, std::string_view unit, ImportedMesh& imported) {
  MeshReport& report = imported.report;
  if (!report.usable() || surface.empty()) return;
  if (!restrict_to(surface, imported.mesh)) {
    report.without_surface = "the walls are no longer those of the file";
  } else {
    report.notes.push_back("faces: " + shares_of_kinds(surface));
    report.without_surface = without_bound(surface);
  }
  if (!report.without_surface.empty()) {
    report.notes.push_back("how far the surface of the file is from the triangles is not proven: " +
                           report.without_surface);
    return;
  }
  set_deviation_bounds(surface);
  // What is measured says less.
  std::erase_if(report.notes, [](const std::string& note) { return note.starts_with(measured_note); });
  const Face& worst = surface.worst_face();
  report.notes.push_back(fmt::format(
      "tessellated with a deflection of {:.3g}{}; proven: the surface of the file lies within {:.3g}{} of "
      "the "
      "triangles, farthest in face {} ({}) at {:.4g}, {:.4g}, {:.4g}; its edges are known to {:.2g}{}",
      report.deflection, unit, worst.apart, unit, worst.number, worst.kind, worst.worst[0], worst.worst[1],
      worst.worst[2], surface.largest(&Face::tolerance), unit));
  imported.mesh.surface = std::make_shared<const TrueSurface>(std::move(surface));
}

void require_true_surface(const MeshFile& options, const ImportedMesh& imported) {
  if (!options.true_surface || imported.mesh.surface || !imported.report.usable()) return;
  std::vector<std::string> keys;
  const auto add = [&](bool there, const char* key) {
    if (there) keys.emplace_back(key);
  };
  add(!options.repair.empty(), "repair");
  add(options.weld.has_value(), "weld");
  add(!options.obstacles.empty(), "obstacles");
  add(!options.cap.empty(), "cap");
  add(options.fill_level.has_value(), "fill_level");
  add(options.interior != std::variant<Interior, Vector<3>>(Interior::solid), "interior");
  throw OptionError("true_surface",
                    keys.empty()
                        ? fmt::format("nothing can be proven of this file: {}; take the key out, or "
                                      "replace that in CAD",
                                      imported.report.without_surface)
                        : fmt::format("is of the file as it stands, but {} changes its walls: take one "
                                      "of the two out, and make the change in CAD",
                                      fmt::join(keys, ", ")));
}

}  // namespace bernal::cad
