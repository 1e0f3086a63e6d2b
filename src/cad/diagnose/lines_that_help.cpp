#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/text.hpp"
#include "cad/diagnose/defects.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/caged_repair.hpp"
#include "cad/repair/close_seams.hpp"
#include "cad/repair/wrap.hpp"

namespace bernal {
namespace {

/// A line of a scene and its effect.
struct Line {
  std::string text;
  std::function<void(MeshFile&)> say;
};

/// The least width of an opening, as a share of the part's diagonal, and its largest depth, as a share of its
/// width. Smaller ones are holes; a plane closes a hole only if it is flat.
constexpr double narrowest_opening = 0.2, deepest_opening = 0.25;

struct Openings {
  std::vector<std::string> planes;  ///< planes that close all openings
  bool wide = false;                ///< at least one is wide, so no hole
};

/// The number with the fewest digits equal to `value` within the rounding, or slightly moved towards the
/// middle of the part, where there is wall to cut.
std::string rounded(double value, double towards, double within) {
  if (std::abs(value) <= within) return "0";
  for (int digits = 1; digits < 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    const double shift = std::strtod(text.c_str(), nullptr) - value;
    if (std::abs(shift) <= within || (shift * towards > 0 && std::abs(shift) <= 1e-4 * std::abs(towards)))
      return fmt::format("{}", std::strtod(text.c_str(), nullptr));  // "10", not "1e+01"
  }
  return fmt::format("{}", value);
}

/// The direction in which the points extend least: an axis if that is as good.
Vector<3> flattest(const std::vector<Vector<3>>& points, const Bounds<3>& bounds, double deepest) {
  int axis = 0;
  if (bounds.size().minCoeff(&axis) <= deepest) return Vector<3>::Unit(axis);
  Vector<3> mean = Vector<3>::Zero();
  for (const Vector<3>& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Vector<3>& p : points) moments += (p - mean) * (p - mean).transpose();
  Vector<3> across = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  int longest = 0;
  across.cwiseAbs().maxCoeff(&longest);
  across /= across[longest];
  constexpr double digits = 1e4;  // a readable number of digits
  return (digits * across).array().round().matrix() / digits;
}

/// "z", "x + 0.5 z"
std::string sum_of_coordinates(const Vector<3>& multiples) {
  std::string text;
  for (int k = 0; k < 3; ++k) {
    if (multiples[k] == 0) continue;
    const double size = std::abs(multiples[k]);
    text += text.empty() ? (multiples[k] < 0 ? "-" : "") : multiples[k] < 0 ? " - " : " + ";
    text += size == 1 ? std::string(1, "xyz"[k]) : fmt::format("{} {}", size, "xyz"[k]);
  }
  return text;
}

/// The plane through a rim, and how far the rim reaches beyond it.
struct RimPlane {
  Vector<3> outward;
  double level, ragged;

  double beyond(const Vector<3>& p) const { return outward.dot(p) - level; }
};

/// Whether the plane cuts off more than its own opening: another opening, or more of the part than a brim.
bool cuts_off_more(const RimPlane& plane, const cad::OpenRim& own, const std::vector<cad::OpenRim>& rims,
                   const Mesh& mesh, double brim, double rounding) {
  const auto is_beyond = [&](double by) {
    return [&plane, by](const Vector<3>& p) { return plane.beyond(p) > by; };
  };
  for (const cad::OpenRim& other : rims)
    if (&other != &own && std::ranges::any_of(other.ends, is_beyond(plane.ragged + rounding))) return true;
  return std::ranges::any_of(mesh.vertices, is_beyond(brim + rounding));
}

/// A rim as flat as an opening's (or a hole's, if it is no wider), and the plane that closes it.
struct Closing {
  RimPlane plane;
  std::string text;  ///< "z = 1.1"
  bool wide;
};
std::optional<Closing> closing_of(const cad::OpenRim& rim, const Bounds<3>& part, double rounding) {
  const bool wide = rim.bounds.diagonal() >= narrowest_opening * part.diagonal();
  const double deepest = wide ? deepest_opening * rim.bounds.size().maxCoeff() : rounding;
  const Vector<3> across = flattest(rim.ends, rim.bounds, deepest);
  double lowest = across.dot(rim.ends.front()), highest = lowest;
  for (const Vector<3>& p : rim.ends) {
    lowest = std::min(lowest, across.dot(p));
    highest = std::max(highest, across.dot(p));
  }
  if (highest - lowest > deepest) return {};
  const double middle = across.dot(part.center()), length = across.norm();
  const bool is_above = lowest + highest > 2 * middle;
  const double level = is_above ? lowest : highest;
  const RimPlane plane{(is_above ? 1 : -1) * across / length, (is_above ? level : -level) / length,
                       (highest - lowest) / length};
  return Closing{plane,
                 fmt::format("{} = {}", sum_of_coordinates(across), rounded(level, middle - level, rounding)),
                 wide};
}

Openings openings_of(const Mesh& mesh, const Bounds<3>& part) {
  constexpr std::size_t most_planes = 4;
  const double rounding = cad::rounding_of_coordinates(mesh);
  Openings found;
  const std::vector<cad::OpenRim> rims = cad::open_rims(mesh);
  for (const cad::OpenRim& rim : rims) {
    const std::optional<Closing> closing = closing_of(rim, part, rounding);
    const double brim = deepest_opening * rim.bounds.size().maxCoeff();
    if (!closing || cuts_off_more(closing->plane, rim, rims, mesh, brim, rounding)) continue;
    found.wide = found.wide || closing->wide;
    if (std::ranges::find(found.planes, closing->text) == found.planes.end())
      found.planes.push_back(closing->text);
  }
  return found.planes.size() > most_planes ? Openings{} : found;
}

/// Each solid of an assembly by itself, by its name, or its number where others have that name or it has
/// none.
std::vector<Line> lines_for_solids(const MeshFile& options, const MeshReport& report) {
  constexpr std::size_t most = 6;
  std::vector<Line> lines;
  const std::vector<std::string>& names = report.solids;
  if (names.size() < 2 || !options.solids.empty()) return lines;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
    const bool is_plain = !names[i].empty() && names[i] == plain_text(names[i]) &&
                          names[i].find_first_of("\"\\") == std::string::npos;
    const std::string called =
        is_plain && std::ranges::count(names, names[i]) == 1 ? names[i] : fmt::format("{}", i + 1);
    lines.push_back(
        {fmt::format("solids = [\"{}\"]", called), [called](MeshFile& m) { m.solids = {called}; }});
  }
  return lines;
}

/// What may be meant instead of the whole of a file that can be a container: the hollow of a vessel, one
/// solid of an assembly.
std::vector<Line> other_containers(const MeshFile& options, const MeshReport& report) {
  std::vector<Line> lines;
  if (report.hollow_volume > 0)
    lines.push_back({"interior = \"cavity\"", [](MeshFile& m) { m.interior = Interior::cavity; }});
  for (Line& line : lines_for_solids(options, report)) lines.push_back(std::move(line));
  return lines;
}

std::vector<Line> candidates(const MeshFile& options, const ImportedMesh& as_it_is) {
  const Mesh& mesh = as_it_is.mesh;
  const MeshReport& report = as_it_is.report;
  std::vector<Line> lines;
  if (report.open_edges > 0 && !options.weld) {
    const double widest = 1e-3 * report.bounds.diagonal();
    const double tolerance = cad::closing_tolerance(mesh, cad::rounding_of_coordinates(mesh), widest);
    if (tolerance > 0) {
      const std::string text = fmt::format("{:.1g}", 1.5 * tolerance);
      lines.push_back({fmt::format("weld = {}", text),
                       [w = std::strtod(text.c_str(), nullptr)](MeshFile& m) { m.weld = w; }});
    }
  }
  std::vector<Line> caps;
  bool caps_first = false;
  if (report.open_edges > 0 && options.cap.empty() && !options.fill_level)
    if (const auto& [planes, wide] = openings_of(mesh, report.bounds); !planes.empty()) {
      caps_first = wide;
      const std::string list = fmt::format("\"{}\"", fmt::join(planes, "\", \""));
      caps.push_back({planes.size() == 1 ? fmt::format("cap = {}", list) : fmt::format("cap = [{}]", list),
                      [all = planes](MeshFile& m) { m.cap = all; }});
    }
  std::vector<Line> repairs;
  const auto offer = [&](const std::vector<Repair>& repair) {
    std::vector<std::string_view> names;
    for (const Repair r : repair) names.push_back(name_of(r));
    repairs.push_back({fmt::format("repair = [\"{}\"]", fmt::join(names, "\", \"")),
                       [repair](MeshFile& m) { m.repair = repair; }});
  };
  if (options.repair.empty()) {
    if (report.open_edges > 0) offer({Repair::holes});
    if (report.self_intersections > 0) offer({Repair::self_intersections});
    if (report.open_edges > 0 && report.self_intersections > 0)
      offer({Repair::holes, Repair::self_intersections});
  }
  for (const auto* some : {caps_first ? &caps : &repairs, caps_first ? &repairs : &caps})
    lines.insert(lines.end(), some->begin(), some->end());
  // Touching parts: one of them, if the file separates them.
  if (report.open_edges == 0)
    for (Line& line : lines_for_solids(options, report)) lines.push_back(std::move(line));
  for (const Line& cap : caps)
    for (const Line& repair : repairs)
      lines.push_back({fmt::format("{}\n{}", cap.text, repair.text), [cap, repair](MeshFile& m) {
                         cap.say(m);
                         repair.say(m);
                       }});
  return lines;
}

/// Closes a rim so wide that it could be an open top, but that no plane closes.
std::vector<Line> lines_for_widest_hole(const MeshFile& options, const ImportedMesh& as_it_is) {
  const bool closes_holes = std::ranges::find(options.repair, Repair::holes) != options.repair.end();
  if (as_it_is.report.open_edges == 0 || options.largest_hole || !(options.repair.empty() || closes_holes))
    return {};
  const double widest = cad::open_rims(as_it_is.mesh).front().bounds.diagonal();
  const std::string number = fmt::format("{:.2g}", 1.06 * widest);  // two digits may be 5 % less
  const std::string text = "largest_hole = " + number;
  return {{closes_holes ? text : fmt::format("repair = [\"holes\"]\n{}", text),
           [closes_holes, largest = std::strtod(number.c_str(), nullptr)](MeshFile& m) {
             if (!closes_holes) m.repair = {Repair::holes};
             m.largest_hole = largest;
           }}};
}

/// Processor time of a repair that is offered, and the time after which no more lines are tried.
constexpr double seconds_to_try = 4, seconds_for_all = 8;

/// The line that wraps the surface, with remarks; empty if it has no inside to wrap. Tried as it would be
/// done, or coarsely if that takes long.
std::string wrap_that_helps(const Mesh& mesh, double smallest_radius, double diagonal) {
  constexpr double coarse = 0.05;
  for (const bool coarsely : {false, true}) {
    const cad::RepairedMesh tried = cad::repair_in_cage(mesh, seconds_to_try, [&] {
      return coarsely ? cad::wrap(mesh, coarse * diagonal) : cad::wrap_for_spheres(mesh, smallest_radius);
    });
    if (!tried.done.starts_with("wrapped from inside")) continue;
    std::string remark = coarsely ? "tried coarsely: gaps wider than its alpha have to be closed first" : "";
    if (const std::string left = cad::what_is_left(mesh, tried.mesh); !left.empty())
      remark += fmt::format("{}{}", remark.empty() ? "it loses a part: " : "; ", left);
    return "repair = [\"wrap\"]" + (remark.empty() ? remark : "  # " + remark);
  }
  return {};
}

}  // namespace

std::vector<std::string> lines_that_help(const MeshFile& options, const ImportFor& purpose,
                                         const ImportedMesh& as_it_is, Effort effort) {
  constexpr std::size_t most_faces = 500000, enough = 2;
  std::vector<std::string> lines;
  if (as_it_is.mesh.triangles.empty() || as_it_is.mesh.triangles.size() > most_faces) return lines;
  if (as_it_is.report.self_intersections >= cad::most_self_intersections(as_it_is.mesh)) return lines;
  const Stopwatch watch;
  ImportFor to_try = purpose;
  to_try.repair_seconds = std::min(to_try.repair_seconds, seconds_to_try);
  const auto helps = [&](const Line& line) {
    MeshFile tried = options;
    line.say(tried);
    try {
      return read_mesh(tried, to_try).report.usable();
    } catch (const Error&) {
      return false;
    }
  };
  const auto try_all = [&](const std::vector<Line>& some, std::size_t most) {
    for (const Line& line : some) {
      const auto is_part = [&](const std::string& shorter) {
        return line.text.find(shorter) != std::string::npos;
      };
      if (std::ranges::any_of(lines, is_part)) continue;  // a smaller change suffices
      if (watch.seconds() > seconds_for_all) break;
      if (helps(line)) lines.push_back(line.text);
      if (lines.size() == most) break;
    }
  };
  if (as_it_is.report.usable()) {
    const std::vector<Line> others = other_containers(options, as_it_is.report);
    try_all(others, others.size());
    return lines;
  }
  try_all(candidates(options, as_it_is), enough);
  if (lines.empty()) try_all(lines_for_widest_hole(options, as_it_is), enough);
  if (lines.empty() && effort == Effort::thorough && options.repair.empty())
    if (std::string line =
            wrap_that_helps(as_it_is.mesh, purpose.smallest_radius, as_it_is.report.bounds.diagonal());
        !line.empty())
      lines.push_back(std::move(line));
  return lines;
}

}  // namespace bernal
