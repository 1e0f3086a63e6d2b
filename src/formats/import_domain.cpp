#include "formats/import_domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/describe.hpp"
#include "scene/repetition.hpp"

namespace bernal {
namespace {

[[noreturn]] void refuse_words(const std::string& why) { throw Error(ErrorCode::bad_argument, why); }

/// "x, y": names of axes.
std::string axes_in_words(const std::vector<std::size_t>& axes, std::size_t dimension) {
  std::vector<std::string> names;
  for (const std::size_t k : axes)
    names.push_back(dimension <= 3 ? std::string(1, "xyz"[k]) : fmt::format("axis {}", k));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Ends of the axes from `--periodic`: "none", "xyz", "z".
std::vector<AxisEnd> ends_of_word(const std::string& word, std::size_t dimension) {
  std::vector<AxisEnd> ends(dimension, AxisEnd::wall);
  if (word == "none") return ends;
  for (const char letter : word) {
    const auto axis = static_cast<std::size_t>(letter - 'x');
    if (letter < 'x' || letter > 'z' || axis >= dimension)
      refuse_words(
          fmt::format("‹periodic› takes the axes that repeat themselves, such as xyz or xy, or none, "
                      "for {} dimensions",
                      dimension));
    if (ends[axis] == AxisEnd::period)
      refuse_words(
          fmt::format("‹periodic› names the axis {} twice; it takes each once, such as xyz or xy", letter));
    ends[axis] = AxisEnd::period;
  }
  return ends;
}

/// The least edge whose sum with the corner, as the box rounds it, reaches the upper bound.
double edge_between(double lower, double upper) {
  double edge = upper - lower;
  while (lower + edge < upper) edge = std::nextafter(edge, std::numeric_limits<double>::infinity());
  return edge;
}

/// Bounds of balls along an axis, rounded outwards.
void bounds_along(const Spheres<dynamic>& spheres, std::size_t axis, double& lower, double& upper) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  lower = infinity;
  upper = -infinity;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    lower = std::min(lower, spheres.x[axis][i] - spheres.r[i]);
    upper = std::max(upper, spheres.x[axis][i] + spheres.r[i]);
  }
  lower = std::nextafter(lower, -infinity);
  upper = std::nextafter(upper, infinity);
}

/// The box with all ends decided, and the reason in words.
FileBox box_of_import(const FileContents& contents, const ImportOptions& options, std::string& words) {
  const std::size_t dimension = contents.spheres.x.size();
  FileBox box;
  words = "as the file says";
  if (!options.box.empty()) {
    if (options.box.size() != dimension)
      refuse_words(fmt::format("‹box› needs an edge for each of {} dimensions, not {}", dimension,
                               options.box.size()));
    box = {std::vector<double>(dimension), options.box, std::vector<AxisEnd>(dimension, AxisEnd::period)};
    words = "as ‹box› says";
    if (contents.box && contents.box->tilt != Tilt{}) words += ", upright, where the file has a tilted one";
  } else if (contents.box) {
    box = *contents.box;
  } else {
    if (!options.periodic.empty())
      refuse_words("‹periodic› needs a box, and the file has none; give ‹box› too, such as ‹box=10,10,10›");
    if (dimension != 2 && dimension != 3)
      refuse_words(fmt::format("the file has no box; give its {} edges by ‹box›", dimension));
    box = {std::vector<double>(dimension), std::vector<double>(dimension),
           std::vector<AxisEnd>(dimension, AxisEnd::wrapped)};
    words = "the bounds of the spheres, as the file has no box; ‹box› or ‹container› says another";
  }
  box.lower.resize(dimension);
  box.upper.resize(dimension);
  box.ends.resize(dimension);
  if (!options.periodic.empty()) {
    box.ends = ends_of_word(options.periodic, dimension);
    words += ", its ends as ‹periodic› says";
  }
  std::vector<std::size_t> guessed, wrapped;
  for (std::size_t k = 0; k < dimension; ++k) {
    if (box.ends[k] == AxisEnd::unsaid) {
      box.ends[k] = AxisEnd::period;
      guessed.push_back(k);
    } else if (box.ends[k] == AxisEnd::wrapped) {
      box.ends[k] = AxisEnd::wall;
      wrapped.push_back(k);
      bounds_along(contents.spheres, k, box.lower[k], box.upper[k]);
    }
    if (!(box.upper[k] - box.lower[k] >= smallest_length && box.upper[k] - box.lower[k] <= farthest_place))
      throw Error(ErrorCode::bad_packing,
                  fmt::format("the box has no length along axis {}: from {} to {}; give ‹box›", k,
                              box.lower[k], box.upper[k]));
  }
  if (!guessed.empty())
    words += fmt::format("; it does not say how {} end{}, which then repeat{}: ‹periodic› says another",
                         axes_in_words(guessed, dimension), guessed.size() == 1 ? "s" : "",
                         guessed.size() == 1 ? "s itself" : " themselves");
  if (!wrapped.empty() && (contents.box || !options.box.empty()))
    words += fmt::format("; along {} the bounds of the spheres", axes_in_words(wrapped, dimension));
  return box;
}

std::string edges_in_words(const std::vector<double>& edges, Unit unit) {
  return fmt::format("{:.10g} {}", fmt::join(edges, " x "), name_of(unit));
}

/// Throws for a tilted box with an end at a wall, which would be skewed.
void refuse_skewed_walls(const FileBox& box, const Reading& reading) {
  if (box.tilt == Tilt{} || std::ranges::find(box.ends, AxisEnd::wall) == box.ends.end()) return;
  const bool is_of_discs = box.ends.size() == 3 && box.ends[2] == AxisEnd::wall && box.tilt[1] == 0 &&
                           box.tilt[2] == 0 && box.ends[0] == AxisEnd::period &&
                           box.ends[1] == AxisEnd::period;
  if (is_of_discs)
    reading.fail(
        "the box is tilted and ends along its third axis, as that of discs does: give ‹dimension=2› if these "
        "are discs, ‹periodic=xyz› if it repeats itself along that axis too; else, as no container with "
        "skewed walls is known, what the spheres lie in, by ‹box› or ‹container›");
  reading.fail(
      fmt::format("the box is tilted and does not repeat itself along every axis, and no container with "
                  "skewed walls is known; give ‹periodic={}› if it does, else what the spheres lie in, by "
                  "‹box› or ‹container›",
                  box.ends.size() == 2 ? "xy" : "xyz"));
}

/// The last two tilts are of the third axis. Precondition: the box has no walls.
void take_tilt(const FileBox& from, PeriodicBox& box) {
  if (box.dimension == 2 && (from.tilt[1] != 0 || from.tilt[2] != 0))
    refuse_words("the box of the file is tilted out of its plane; leave ‹dimension› out");
  box.tilt.assign(from.tilt.begin(), from.tilt.begin() + (box.dimension == 3 ? 3 : 1));
  schema::tilt_rule(box, {"the box of the file", {}});
}

ImportDomain domain_of_box(const FileBox& box, Unit unit, const std::string& why) {
  ImportDomain made;
  made.scene.unit = unit;
  const std::size_t dimension = box.lower.size();
  std::vector<double> edges;
  std::vector<int> walls;
  for (std::size_t k = 0; k < dimension; ++k) {
    const bool is_wall = box.ends[k] == AxisEnd::wall;
    if (is_wall) walls.push_back(static_cast<int>(k));
    edges.push_back(is_wall ? edge_between(box.lower[k], box.upper[k]) : box.upper[k] - box.lower[k]);
  }
  if (walls.size() == dimension && (dimension == 2 || dimension == 3)) {
    Box of{Vector<dynamic>::Zero(static_cast<int>(dimension)),
           Vector<dynamic>::Zero(static_cast<int>(dimension))};
    for (std::size_t k = 0; k < dimension; ++k) {
      of.corner[static_cast<int>(k)] = box.lower[k];
      of.size[static_cast<int>(k)] = edges[k];
    }
    made.scene.container = std::move(of);
    made.domain = packed_domain_of(made.scene);
  } else {
    made.scene.container =
        PeriodicBox{.dimension = static_cast<int>(dimension), .size = edges, .walls = walls};
    if (box.tilt != Tilt{}) take_tilt(box, std::get<PeriodicBox>(made.scene.container));
    made.domain = packed_domain_of(made.scene);
    if (std::ranges::any_of(box.lower, [](double x) { return x != 0; }))
      // 0 - x avoids -0, which would be printed.
      for (const double x : box.lower) made.shift.push_back(0 - x);
  }
  made.words = fmt::format("{}, {}{}, {}", name_of(made.domain), edges_in_words(edges, unit),
                           tilt_in_words(made.domain), why);
  return made;
}

ImportDomain domain_of_scene(FileContents& contents, Unit unit, const Scene& scene, const std::string& why) {
  if (scene.dimension() != contents.spheres.dimension())
    throw Error(ErrorCode::bad_packing,
                fmt::format("the spheres have {} dimensions, but the container of the scene has {}; "
                            "‹dimension=2› takes spheres of one plane for discs",
                            contents.spheres.dimension(), scene.dimension()),
                {scene.file.string()});
  ImportDomain made;
  made.scene.unit = scene.unit;
  made.scene.container = scene.container;
  made.scene.walls = scene.walls;
  const auto converted = unit_conversion(unit, scene.unit);
  Mapping{[&](double x, int) { return converted(x); }, converted}.map(contents.spheres);
  if (!scene.container.meshes().empty()) {
    std::string notes, caution;  // the smallest radius determines the tessellation of curved parts
    made.scene.sizes = Constant{std::ranges::min(contents.spheres.r)};
    made.domain = domain_of(made.scene, notes, caution);
    made.scene.sizes = Constant{0};
  } else {
    made.domain = packed_domain_of(scene);
  }
  made.words = fmt::format("{}, {}", name_of(made.domain), why);
  return made;
}

}  // namespace

Unit unit_of_import(const FileContents& contents, const Reading& reading) {
  const std::optional<Unit>& asked = reading.options.unit;
  if (contents.unit && asked && *contents.unit != *asked)
    throw Error(ErrorCode::bad_argument,
                fmt::format("says itself that it is in {}; leave ‹unit› out", name_of(*contents.unit)),
                {reading.file.string()});
  if (contents.unit) return *contents.unit;
  if (asked) return *asked;
  if (reading.options.container) return reading.options.container->unit;
  throw Error(ErrorCode::bad_packing, "does not say the unit of its lengths; give it, such as ‹unit=mm›",
              {reading.file.string()});
}

ImportDomain domain_of_import(FileContents& contents, Unit unit, const Reading& reading) {
  const ImportOptions& options = reading.options;
  if (options.container) {
    if (!options.periodic.empty() || !options.box.empty())
      refuse_words("‹container› says what the spheres lie in; leave ‹box› and ‹periodic› out");
    const std::filesystem::path& scene = options.container->file;
    return domain_of_scene(contents, unit, *options.container,
                           "the container of " + (scene.empty() ? "a scene" : scene.string()));
  }
  if (contents.container && options.periodic.empty() && options.box.empty()) {
    const Scene container = *contents.container;
    return domain_of_scene(contents, unit, container, "as the file says");
  }
  std::string why;
  const FileBox box = box_of_import(contents, options, why);
  refuse_skewed_walls(box, reading);
  return domain_of_box(box, unit, why);
}

}  // namespace bernal
