#include "fly/fly.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "fly/fill_by_classes.hpp"
#include "fly/fly_events.hpp"
#include "fly/fly_patent.hpp"

namespace bernal {
namespace {

/// Of random close packing, what event-driven flight reaches with 2,000 equal spheres in about a second, by
/// dimension: measured.
constexpr double share_of_flight[] = {0.75, 0.80, 0.71, 0.59, 0.47, 0.43, 0.41, 0.38};
/// Of that between walls: they cost a layer of spheres, in eight dimensions half of the box. On the safe
/// side, as relaxation is fast at such targets too.
constexpr double share_between_walls = 0.5;
/// Where radii differ more than this, small spheres have room between the large ones: those come first.
constexpr double wide_sizes = 4;

constexpr std::pair<std::string_view, FillMethod> methods[] = {{"patent", FillMethod::patent},
                                                               {"flight", FillMethod::flight},
                                                               {"classes", FillMethod::classes},
                                                               {"relaxation", FillMethod::relaxation}};

/// Takes out the spheres that overlap their own image or do not fit between two walls.
std::size_t drop_too_wide(Work& work) {
  Spheres<dynamic> fitting(work.dimension());
  fitting.reserve(work.spheres.size());
  const double skin = 1 + 1e-9;  // more than the margin that flying spheres keep from walls
  for (std::size_t i = 0; i < work.spheres.size(); ++i) {
    bool fits = true;
    for (int k = 0; k < work.dimension(); ++k)
      fits = fits && 2 * work.spheres.r[i] * (work.has_wall(k) ? skin : 1) <= (*work.target_edges)[k];
    if (fits) fitting.push_back(work.spheres.center(i), work.spheres.r[i]);
  }
  const std::size_t dropped = work.spheres.size() - fitting.size();
  if (dropped > 0) work.spheres = std::move(fitting);
  return dropped;
}

StageEnd fill(Work& work, FillMethod method, const FlyOptions& options) {
  switch (method) {
    case FillMethod::patent:
    case FillMethod::flight: {
      const EffectTimer timer(work.effects["flight"]);
      return method == FillMethod::patent ? fly_by_patent(work, options) : fly_by_events(work, options);
    }
    case FillMethod::classes:
      return fill_by_classes(work, {.sweeps = options.sweeps});
    case FillMethod::relaxation:
      break;
  }
  return fill_by_relaxation(work, {.sweeps = options.sweeps});
}

bool flies(FillMethod method) { return method == FillMethod::patent || method == FillMethod::flight; }

}  // namespace

std::string_view name_of(FillMethod method) {
  return std::ranges::find(methods, method, &std::pair<std::string_view, FillMethod>::second)->first;
}

FillChoice choose_filling(std::string_view method, const FillTask& task) {
  if (method != "auto") {
    const auto* named = std::ranges::find(methods, method, &std::pair<std::string_view, FillMethod>::first);
    if (named == std::end(methods))
      throw Error(ErrorCode::bad_argument, fmt::format("no such way of filling a box: \"{}\"", method));
    if (task.has_walls && named->second == FillMethod::classes)
      throw Error(ErrorCode::bad_argument,
                  "\"classes\" does not know walls; with walls, the methods are \"auto\", \"flight\", "
                  "\"patent\" and \"relaxation\"");
    return {named->second, "as the scene asks for it"};
  }
  const double reached =
      share_of_flight[task.dimension - 1] * task.attainable * (task.has_walls ? share_between_walls : 1);
  const auto phi = task.packing_fraction;
  const char* between = task.has_walls ? " between walls surely" : "";
  if (task.size_ratio > wide_sizes && !task.has_walls)
    return {FillMethod::classes, fmt::format("as the largest sphere is {:.3g} times the smallest: small ones "
                                             "find room between the large",
                                             task.size_ratio)};
  if (phi <= reached)
    return {FillMethod::flight,
            fmt::format("as flight{} reaches {:.3f}, and {:.3f} is asked for", between, reached, phi)};
  return {FillMethod::relaxation,
          fmt::format("as {:.3f} is more than the {:.3f} that flight{} reaches", phi, reached, between)};
}

StageEnd fly(Work& work, const FillChoice& choice, const FlyOptions& options) {
  if (work.placed && work.edges == *work.target_edges) {
    work.account = "all had places in this box before";
    return StageEnd::converged;
  }
  const std::size_t wanted = work.spheres.size();
  const std::size_t too_wide = drop_too_wide(work);
  StageEnd end = StageEnd::converged;
  if (!work.spheres.empty()) {
    end = fill(work, choice.method, options);
  }
  work.edges = *work.target_edges;
  work.placed = true;
  work.needed_volume = work.edges.prod();

  work.account = fmt::format("by {}, {}", name_of(choice.method), choice.reason);
  if (too_wide > 0) {
    end = end == StageEnd::converged ? StageEnd::full : end;
    work.account += fmt::format("; {} wider than the box", grouped(too_wide));
  }
  const std::size_t missing = wanted - too_wide - work.spheres.size();
  if (missing > 0 && flies(choice.method) && end == StageEnd::full)
    work.account += fmt::format(
        "; no place was free among {} in a row",
        grouped(static_cast<std::uint64_t>(options.patience * static_cast<double>(wanted - too_wide))));
  return end;
}

}  // namespace bernal
