#include "bernal/cad/read_mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "cad/diagnose/counted.hpp"
#include "cad/diagnose/defects.hpp"
#include "cad/diagnose/diagnose_mesh.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "cad/exact_corners.hpp"
#include "cad/open_ends.hpp"
#include "cad/read/make_triangles.hpp"
#include "cad/read/read_soup.hpp"
#include "cad/repair/close_seams.hpp"
#include "cad/repair/hollows.hpp"
#include "cad/repair/interior.hpp"
#include "cad/repair/obstacles.hpp"
#include "cad/repair/repairs.hpp"
#include "cad/true_surface.hpp"
#include "geometry/changes.hpp"
#include "geometry/deviation_bounds.hpp"
#include "geometry/measures.hpp"
#include "geometry/topology.hpp"

namespace bernal {
namespace {

using cad::FileFacts;

/// A true surface is tessellated to within this share of the smallest sphere's radius.
constexpr double deflection_over_radius = 0.02;
/// And where spheres are to lie inside of it: what is proven of its distance is somewhat more.
constexpr double fine_deflection_over_radius = 8e-4;

/// Ratio of the file's unit to the requested one.
Ratio ratio_of(const MeshFile& options, const FileFacts& facts, std::optional<Unit> wanted) {
  const auto& of_file = facts.unit;
  const std::optional<Unit> own = of_file ? unit_of_metres(of_file->metres) : std::nullopt;
  if (of_file && options.unit && !options.ignore_unit_of_file && own != options.unit)
    throw OptionError("unit",
                      fmt::format("the file says that its lengths are in {}, and the scene that they are "
                                  "in {}; leave \"unit\" out, or, if the file is wrong, add "
                                  "ignore_unit_of_file = true",
                                  of_file->name, name_of(*options.unit)));
  if (!wanted) return {};
  if (options.unit) return conversion_ratio(*options.unit, *wanted);
  if (!of_file) return {};
  if (own) return conversion_ratio(*own, *wanted);
  return {of_file->metres / metres_per(*wanted)};
}

/// A text as a number from 1 on; 0 if it is none.
std::size_t number_in(const std::string& text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

/// Marks the parts that the options choose.
std::vector<bool> chosen_parts(const MeshFile& options, const std::vector<std::string>& names) {
  std::vector<bool> chosen(names.size(), false);
  for (const std::string& wanted : options.solids) {
    bool found = false;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == wanted) found = chosen[i] = true;
    if (const std::size_t number = number_in(wanted); !found && number >= 1 && number <= names.size())
      found = chosen[number - 1] = true;
    if (found) continue;
    constexpr std::size_t most = 12;
    std::vector<std::string> known;
    const bool has_names = std::ranges::any_of(names, [](const std::string& name) { return !name.empty(); });
    for (std::size_t i = 0; has_names && i < std::min(names.size(), most); ++i)
      known.push_back(names[i].empty() ? fmt::format("{} (without a name)", i + 1)
                                       : fmt::format("\"{}\"", names[i]));
    throw OptionError("solids",
                      fmt::format("the file has no solid \"{}\"; it has {}{}{}", wanted,
                                  cad::counted(names.size(), "solid", "solids"),
                                  known.empty() ? fmt::format(", by number from 1 to {}", names.size())
                                                : fmt::format(": {}", fmt::join(known, ", ")),
                                  !known.empty() && names.size() > most ? ", ..." : ""));
  }
  return chosen;
}

/// Keeps the chosen parts, if the file names parts.
void keep_chosen(cad::PolygonSoup& soup, const MeshFile& options) {
  std::vector<std::string> names;
  for (const cad::Solid& solid : soup.solids) names.push_back(solid.name);
  cad::keep_solids(soup, chosen_parts(options, names));
}

/// The same for a file without named parts: its connected pieces, in the order of their first faces.
void keep_pieces(Mesh& mesh, const MeshFile& options) {
  const MeshTopology topology = topology_of(mesh);
  const std::vector<bool> chosen = chosen_parts(options, std::vector<std::string>(topology.components));
  std::vector<bool> kept(mesh.triangles.size());
  for (std::size_t t = 0; t < kept.size(); ++t) kept[t] = chosen[topology.component[t]];
  keep_only(mesh, kept);
}

/// Rotates the upward axis to z, without mirroring, by the same convention as Collada.
Vector<3> turned_up(const Vector<3>& v, Up up) {
  if (up == Up::x) return {-v[1], -v[2], v[0]};
  return up == Up::y ? Vector<3>(v[0], -v[2], v[1]) : v;
}

/// Closes seams, unless that improves nothing.
void close_seams_of(cad::Triangles& triangles, double tolerance, std::vector<std::string>& done) {
  const MeshTopology before = topology_of(triangles.mesh);
  if (before.closed() && cad::count_degenerate(triangles.mesh) == 0) return;
  Mesh tried = triangles.mesh;
  const cad::Seams seams = cad::close_seams(tried, tolerance);
  if (!seams.any() || tried.triangles.empty()) return;
  const MeshTopology after = topology_of(tried);
  if (after.open_edges + after.non_manifold_edges > before.open_edges + before.non_manifold_edges) return;
  triangles.mesh = std::move(tried);
  for (std::string& words : seams.in_words()) done.push_back(std::move(words));
}

std::vector<cad::CutPlane> planes_of(const MeshFile& options) {
  std::vector<cad::CutPlane> planes;
  try {
    for (const std::string& text : options.cap) planes.push_back(cad::plane_in(text));
  } catch (const Error& error) {
    throw OptionError("cap", error.what());
  }
  if (options.fill_level) planes.push_back(cad::plane_in(fmt::format("z < {}", *options.fill_level)));
  return planes;
}

/// The key that decides on the interior, for errors.
std::string_view interior_option(const MeshFile& options) {
  if (!options.cap.empty()) return "cap";
  return options.fill_level ? "fill_level" : "interior";
}

void take_interior(Mesh& mesh, const MeshFile& options, double tolerance, std::vector<std::string>& done,
                   std::vector<std::string>& cautions) {
  try {
    cad::ChosenInterior chosen =
        cad::choose_interior(mesh, {planes_of(options), options.interior}, tolerance);
    mesh = std::move(chosen.mesh);
    for (std::string& note : chosen.notes) done.push_back(std::move(note));
    for (std::string& caution : chosen.cautions) cautions.push_back(std::move(caution));
  } catch (const OptionError&) {
    throw;
  } catch (const Error& error) {
    throw OptionError(interior_option(options), error.what());
  }
}

/// The remedy for the first problem in the report, if no line was found that helps.
std::string_view remedy(const MeshReport& report, const MeshFile& options) {
  if (report.open_edges > 0 && std::ranges::count(options.periodic, true) > 1)
    return "ends of a surface that repeats itself along several axes share rims, which no flat lid closes; "
           "give one period as a closed solid, with its ends";
  if (report.open_edges > 0 && options.repeats())
    return "the openings that \"periodic\" means lie flat in its two end planes, and these do not; close "
           "them in CAD, or cut the part straight across the axis";
  if (report.open_edges > 0) return "the surface has a hole or is a shell; close it in CAD";
  if (report.non_manifold_edges > 0)
    return "walls branch; unite touching bodies and delete inner faces in CAD";
  if (report.degenerate_faces > 0) return "export it again with a finer tolerance or collapse those faces";
  if (report.self_intersections > 0) return "the wall passes through itself; unite the bodies in CAD";
  return "export a closed solid";
}

/// Reads an obstacle; its unit is its own if stated, else that of the container's file.
Mesh read_obstacle(const std::filesystem::path& file, const MeshFile& options, const ImportFor& purpose) {
  MeshFile obstacle{.file = file,
                    .unit = options.unit,
                    .ignore_unit_of_file = options.ignore_unit_of_file,
                    .up = options.up,
                    .weld = options.weld,
                    .deflection = options.deflection,
                    .surfaces = options.surfaces};
  const auto read = [&] {
    ImportedMesh imported = read_mesh(obstacle, purpose);
    if (!imported.report.usable())
      throw OptionError("obstacles", fmt::format("{} cannot be an obstacle: {}", file.string(),
                                                 fmt::join(imported.report.problems, ", ")));
    return std::move(imported.mesh);
  };
  try {
    return read();
  } catch (const OptionError& error) {
    if (error.option != "unit") throw;
    obstacle.unit.reset();
    return read();
  }
}

/// Subtracts the obstacles from the container; returns their meshes.
std::vector<Mesh> take_out_obstacles(Mesh& mesh, const MeshFile& options, const ImportFor& purpose,
                                     std::vector<std::string>& done) {
  std::vector<Mesh> taken_out;
  if (options.obstacles.empty()) return taken_out;
  cad::Triangles container{.mesh = mesh};
  if (!cad::diagnose_mesh(container).usable()) return taken_out;  // the report says so
  mesh = std::move(container.mesh);                               // turned outward
  std::vector<std::filesystem::path> seen;
  for (const std::filesystem::path& file : options.obstacles) {
    if (std::ranges::find(seen, file) != seen.end())
      throw OptionError("obstacles", fmt::format("{} is listed twice", file.string()));
    seen.push_back(file);
    const Mesh& obstacle = taken_out.emplace_back(read_obstacle(file, options, purpose));
    cad::take_out(mesh, obstacle, file.string());
    done.push_back(fmt::format("took out {}, {} faces", file.filename().string(), obstacle.triangles.size()));
  }
  return taken_out;
}

/// Adds a caution if the part is the wall of a vessel.
void caution_about_shell(const Mesh& mesh, double tolerance, MeshReport& report) {
  constexpr std::uint64_t most_faces = 500'000, most_pieces = 100;
  if (report.faces > most_faces || report.components > most_pieces) return;
  const std::optional<cad::Hollow> hollow = cad::hollow_of_shell(mesh, tolerance);
  if (!hollow) return;
  report.hollow_volume = hollow->volume;
  report.cautions.push_back(fmt::format(
      "the part is a shell with {}: it encloses its wall, and its hollow is {:.2g} times as large; "
      "if that is meant, write interior = \"cavity\" in [container]",
      hollow->lids.size() == 1 ? "an opening" : cad::counted(hollow->lids.size(), "", "openings"),
      hollow->volume / report.volume));
}

ImportedMesh import(const MeshFile& options, const ImportFor& purpose) {
  if (options.deflection && !cad::opencascade_reads(options.file))
    throw OptionError("deflection",
                      fmt::format("applies to the surfaces of STEP, IGES and BREP, but {} holds triangles; "
                                  "take the key out",
                                  options.file.filename().string()));
  if (options.true_surface && options.repeats())
    throw OptionError("periodic", "is for triangles, and \"true_surface\" is not; take one of the two out");
  if (!options.obstacles.empty() && options.repeats())
    throw OptionError("obstacles",
                      "are for a container that ends, and \"periodic\" repeats this one; take one of the two "
                      "out, or cut the obstacles out of the part in CAD");
  if (options.true_surface && !cad::opencascade_reads(options.file))
    throw OptionError(
        "true_surface",
        fmt::format("is for STEP, IGES and BREP, but {} holds triangles, on which the certificate "
                    "decides anyway; take the key out",
                    options.file.filename().string()));
  const double deflection = options.deflection.value_or(
      (options.true_surface ? fine_deflection_over_radius : deflection_over_radius) *
      purpose.smallest_radius);
  const std::optional<Unit> assumed = options.unit ? options.unit : purpose.unit;
  const double metres = purpose.unit ? metres_per(*purpose.unit) : 0;
  std::optional<cad::SpheresInside> inside;
  if (options.true_surface) inside = {purpose.smallest_radius * metres};
  const PolygonSurface* const given = options.surface_called(options.file);
  cad::ReadAttempt read =
      given ? cad::read_surface(*given, options.file)
            : cad::read_soup(options.file, deflection * metres, assumed ? metres_per(*assumed) : 0, inside);
  const Ratio ratio = ratio_of(options, read.facts, purpose.unit);
  const double factor = ratio.nearest();

  ImportedMesh result;
  std::vector<std::string> done;
  // The only part of a file is the whole.
  const auto& parts = read.soup.solids;
  const bool is_whole = parts.size() == 1 && options.solids == std::vector{parts.front().name};
  const bool by_piece = parts.size() < 2 && !is_whole;
  for (const cad::Solid& solid : parts)
    if (parts.size() > 1 || !(solid.name.empty() || solid.name.starts_with('<')))
      result.report.solids.push_back(solid.name);
  if (!options.solids.empty() && !by_piece) keep_chosen(read.soup, options);
  cad::Triangles triangles = cad::make_triangles(read.soup);
  read.soup = {};
  Mesh& mesh = triangles.mesh;
  const double rounding = factor * cad::rounding_of_coordinates(mesh);
  move_vertices(mesh, [&](const Vector<3>& v) { return turned_up(v, options.up); });
  const std::vector<Vector<3>> as_written = factor != 1 ? mesh.vertices : std::vector<Vector<3>>();
  if (factor != 1) move_vertices(mesh, [&](const Vector<3>& v) -> Vector<3> { return factor * v; });
  close_seams_of(triangles, options.weld.value_or(rounding), done);
  if (!options.solids.empty() && by_piece) keep_pieces(mesh, options);
  const double apart =  // that corners of ends which match may be
      options.weld.value_or(std::max(rounding, cad::match_over_diagonal * bounds_of(mesh).diagonal()));
  if (options.repeats()) cad::close_ends(mesh, options.periodic, apart);
  if (options.largest_hole && std::ranges::find(options.repair, Repair::holes) == options.repair.end())
    throw OptionError("largest_hole", "needs repair = [\"holes\"] beside it, which closes them");
  cad::Repairs repairs(options, purpose, mesh, done);
  repairs.before_planes();
  take_interior(mesh, options, options.weld.value_or(rounding), done, repairs.cautions);
  repairs.after_planes();
  const std::vector<Mesh> taken_out = take_out_obstacles(mesh, options, purpose, done);

  MeshReport report = cad::diagnose_mesh(triangles);
  report.is_repaired = repairs.any;
  report.cautions = std::move(repairs.cautions);
  if (report.usable() && !cad::has_planes(options) && options.obstacles.empty() &&
      options.interior == std::variant<Interior, Vector<3>>(Interior::solid) && !options.repeats())
    caution_about_shell(mesh, options.weld.value_or(rounding), report);
  report.reader = std::move(read.reader);
  if (read.facts.unit) {
    report.unit = read.facts.written_in ? read.facts.written_in->name : read.facts.unit->name;
    report.metres = read.facts.unit->metres;
    report.stated_metres = read.facts.written_in ? read.facts.written_in->metres : report.metres;
  }
  if (read.facts.deflection) report.deflection = factor * *read.facts.deflection;
  report.up = read.facts.up;
  report.notes = std::move(read.facts.notes);
  report.solids = std::move(result.report.solids);
  if (!report.usable()) report.defects = cad::defects_of(mesh);
  if (report.usable() && options.repeats()) done.push_back(cad::open_ends(mesh, options.periodic, apart));
  report.repairs.insert(report.repairs.begin(), done.begin(), done.end());
  result.report = std::move(report);
  result.mesh = std::move(mesh);
  if (options.true_surface) {
    move_linearly(
        read.surface, [&](const Vector<3>& v) -> Vector<3> { return factor * turned_up(v, options.up); },
        factor);
    const std::string unit = purpose.unit      ? fmt::format(" {}", name_of(*purpose.unit))
                             : read.facts.unit ? " mm"
                                               : "";
    cad::attach(std::move(read.surface), unit, result);
  }
  if ((factor != 1 || !taken_out.empty()) && !options.repeats())
    cad::state_exactly(result.mesh, as_written, ratio, taken_out);
  return result;
}

}  // namespace

ImportedMesh read_mesh(const MeshFile& options, const ImportFor& purpose) {
  try {
    return import(options, purpose);
  } catch (const OptionError&) {
    throw;
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(error.code(), error.what(), {options.file.string()});
  }
}

bool has_true_surface(const std::filesystem::path& file) { return cad::opencascade_reads(file); }

Unit unit_of_mesh_file(const std::filesystem::path& file) {
  const MeshReport report = read_mesh(MeshFile{file}).report;
  if (const auto unit = unit_of_metres(report.stated_metres)) return *unit;
  const Vector<3> size = report.bounds.size();
  throw Error(
      ErrorCode::bad_argument,
      report.unit.empty()
          ? fmt::format(
                "the file does not say its unit; it is {:.4g} × {:.4g} × {:.4g} units large: give the "
                "unit of these and of all lengths, such as ‹unit=mm›",
                size.x(), size.y(), size.z())
          : fmt::format("the file is in {}, in which no scene can be: give the unit of all lengths, "
                        "such as ‹unit=m›",
                        report.unit),
      {file.string()});
}

ImportedMesh read_container_mesh(const MeshFile& options, const ImportFor& purpose) {
  ImportedMesh result = read_mesh(options, purpose);
  cad::require_true_surface(options, result);
  if (result.report.usable()) return result;
  std::vector<std::string> lines = lines_that_help(options, purpose, result, Effort::quick);
  for (std::string& line : lines)
    if (const std::size_t end = line.find('\n'); end != std::string::npos) line.replace(end, 1, " with ");
  const std::string help =
      lines.empty() ? fmt::format("{}; bernal inspect tries a wrap", remedy(result.report, options))
                    : fmt::format("in [container], {} helps", fmt::join(lines, ", or "));
  const std::string tried =
      options.repair.empty() ? "" : fmt::format("{}; ", fmt::join(result.report.repairs, "; "));
  throw Error(
      ErrorCode::bad_mesh,
      fmt::format("cannot be a container: {} ({}{})", fmt::join(result.report.problems, ", "), tried, help),
      {options.file.string()});
}

}  // namespace bernal
