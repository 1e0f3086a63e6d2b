#include <algorithm>

#include "bernal/core/error.hpp"
#include "bernal/predict/mixtures.hpp"
#include "core/parallel.hpp"
#include "figures/contours.hpp"
#include "figures/drawing.hpp"
#include "figures/figure_files.hpp"

namespace bernal {
namespace {

using namespace figures;

constexpr std::size_t most_points_drawn = 200;  ///< along each axis
constexpr int least_points = 2, most_points = 20'000;

void require_valid(const MapOptions& o) {
  const auto refuse = [](const char* what) { throw Error(ErrorCode::bad_argument, what); };
  if (!(o.least_ratio > 0 && o.most_ratio > o.least_ratio && o.most_ratio / o.least_ratio < 1e6))
    refuse("a map needs ratios that are positive, ascend and differ less than a millionfold");
  if (o.points < least_points || o.points > most_points)
    refuse("a map has from 2 to 20,000 points along each axis");
}

/// Every so many-th point, and the last.
std::vector<std::size_t> drawn(std::size_t points) {
  const std::size_t every = (points + most_points_drawn - 1) / most_points_drawn;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k + 1 < points; k += every) chosen.push_back(k);
  chosen.push_back(points - 1);
  return chosen;
}

std::string drawing_of(const MapOptions& o, const Field& map, const WrittenMap& densest) {
  const auto columns = drawn(map.xs.size()), rows = drawn(map.ys.size());
  Field coarse;
  for (const std::size_t j : columns) coarse.xs.push_back(map.xs[j]);
  for (const std::size_t i : rows) {
    coarse.ys.push_back(map.ys[i]);
    for (const std::size_t j : columns) coarse.values.push_back(map.at(i, j));
  }
  const auto [least, most] = std::ranges::minmax(coarse.values);
  Plot plot({88, 100, 648, 660}, {0, 1, "share w of b in the volume"},
            {o.least_ratio, o.most_ratio, "R: mean diameter d43 of b over that of a", Scale::logarithmic});
  plot.axes();
  add_contours(plot, coarse, most - least > 0.12 ? 0.01 : most - least > 0.02 ? 0.002 : 0.0002);
  add_marker(plot, Marker::disc, densest.share, densest.ratio);
  legend_marker(
      plot, Marker::disc, 330, 64,
      fmt::format("densest: φ {:.4f} at w {:.3f}, R {:.3g}", densest.phi, densest.share, densest.ratio));
  return svg_document(690, 720,
                      fmt::format("Two lognormal populations, σa = {:g}, σb = {:g}", o.sigma_a, o.sigma_b),
                      std::move(plot).finish());
}

}  // namespace

WrittenMap write_map(const MapOptions& o, const std::filesystem::path& folder) {
  require_valid(o);
  Field map{spread(0, 1, o.points - 1), spread(o.least_ratio, o.most_ratio, o.points - 1, true), {}};
  std::vector<std::vector<Prediction>> rows(map.ys.size());
  // About half a second's worth on a few cores.
  const std::size_t rows_at_once =
      std::max<std::size_t>(4, 16'000'000 / map.xs.size() / static_cast<std::size_t>(o.rods));
  try {
    const Interruptible listening(o.monitor);
    for (std::size_t from = 0; from < rows.size(); from += rows_at_once) {
      o.monitor.report(
          {"map", static_cast<double>(from) / static_cast<double>(rows.size()), "of the ratios"});
      parallel_for(from, std::min(rows.size(), from + rows_at_once), [&](std::size_t i) {
        rows[i] = predict_shares({o.sigma_a, o.sigma_b, map.ys[i]}, map.xs, o.rods);
      });
    }
  } catch (const Cancelled&) {
    return {};
  }

  WrittenMap densest;
  std::string csv = "ratio,share,phi\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < map.xs.size(); ++j) {
      const Prediction& p = rows[i][j];
      map.values.push_back(p.phi);
      csv += fmt::format("{:.6g},{:.6g},{:.6f}\n", map.ys[i], map.xs[j], p.phi);
      densest.error = std::max(densest.error, p.error);
      if (p.phi <= densest.phi) continue;
      densest.phi = p.phi;
      densest.ratio = map.ys[i];
      densest.share = map.xs[j];
    }
  }
  densest.files = write_files({{"map.csv", csv}, {"map.svg", drawing_of(o, map, densest)}}, folder);
  return densest;
}

}  // namespace bernal
