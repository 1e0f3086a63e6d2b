#include "bernal/map/map.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/predict/mixtures.hpp"
#include "core/parallel.hpp"
#include "files/input_file.hpp"
#include "files/output_file.hpp"
#include "files/staged_folder.hpp"
#include "map/contours.hpp"
#include "report/drawing.hpp"

namespace bernal {
namespace {

using namespace drawing;

constexpr std::size_t most_points_drawn = 200;  ///< along each axis
constexpr int least_points = 2, most_points = 20'000;

void require_valid(const MapOptions& o) {
  const auto refuse = [](const char* what) { throw Error(ErrorCode::bad_argument, what); };
  if (!(o.least_ratio > 0 && o.most_ratio > o.least_ratio && o.most_ratio / o.least_ratio < 1e6))
    refuse("a map needs ratios that are positive, ascend and differ less than a millionfold");
  if (o.points < least_points || o.points > most_points)
    refuse("a map has from 2 to 20,000 points along each axis");
}

/// Every so many-th point of an axis, and the last.
struct Drawn {
  explicit Drawn(std::size_t points)
      : last(points - 1), every((points + most_points_drawn - 1) / most_points_drawn) {}
  bool operator()(std::size_t k) const { return k == last || k % every == 0; }

  std::size_t last, every;
};

std::vector<double> drawn_of(const std::vector<double>& points) {
  std::vector<double> chosen;
  const Drawn is_drawn(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    if (is_drawn(k)) chosen.push_back(points[k]);
  return chosen;
}

/// Evenly from the first to the last, or evenly in the logarithm. Precondition: at least two points.
std::vector<double> spread(double from, double to, int points, bool logarithmic) {
  std::vector<double> values;
  for (int k = 0; k < points; ++k) {
    const double share = static_cast<double>(k) / (points - 1);
    values.push_back(logarithmic ? from * std::pow(to / from, share) : from + (to - from) * share);
  }
  values.back() = to;
  return values;
}

std::string drawing_of(const MapOptions& o, const Field& coarse, const WrittenMap& densest) {
  const auto [least, most] = std::ranges::minmax(coarse.values);
  Plot plot({88, 100, 648, 660}, {0, 1, "share w of b in the volume"},
            {o.least_ratio, o.most_ratio, "R: mean diameter d43 of b over that of a", Scale::logarithmic});
  plot.axes();
  add_contours(plot, coarse, most - least > 0.12 ? 0.01 : most - least > 0.02 ? 0.002 : 0.0002);
  add_disc(plot, plot.x(densest.share), plot.y(densest.ratio));
  add_disc(plot, 347, 60);
  add_text(plot, 372, 64, "start",
           fmt::format("densest: φ {:.4f} at w {:.3f}, R {:.3g}", densest.phi, densest.share, densest.ratio));
  return svg_document(690, 720,
                      fmt::format("Two lognormal populations, σa = {:g}, σb = {:g}", o.sigma_a, o.sigma_b),
                      std::move(plot).finish());
}

constexpr std::string_view head_of_map = "ratio,share,phi\n";

/// An earlier map is replaced, and nothing else.
void require_own(const std::filesystem::path& folder) {
  const std::filesystem::path csv = folder / "map.csv", svg = folder / "map.svg";
  std::error_code unknown;
  if (!std::filesystem::exists(csv, unknown) && !std::filesystem::exists(svg, unknown)) return;
  std::string head(head_of_map.size(), ' ');
  InputFile(csv).read(head.data(), std::ssize(head));
  if (head != head_of_map)
    throw Error(ErrorCode::cannot_write,
                "holds a map.csv or map.svg that is none of a map; take another folder", {folder.string()});
}

}  // namespace

WrittenMap write_map(const MapOptions& o, const std::filesystem::path& folder) try {
  require_valid(o);
  require_own(folder);
  const std::vector<double> shares = spread(0, 1, o.points, false),
                            ratios = spread(o.least_ratio, o.most_ratio, o.points, true);
  const Drawn is_drawn(shares.size());
  Field coarse{drawn_of(shares), drawn_of(ratios), {}};
  WrittenMap densest;
  StagedFolder staged(folder);
  OutputFile csv(staged.add("map.csv"));
  csv.append(head_of_map);
  const auto tell = [&](std::size_t i, const std::vector<Prediction>& row) {
    std::string lines;
    for (std::size_t j = 0; j < shares.size(); ++j) {
      const Prediction& p = row[j];
      lines += fmt::format("{:.6g},{:.6g},{:.6f}\n", ratios[i], shares[j], p.phi);
      if (is_drawn(i) && is_drawn(j)) coarse.values.push_back(p.phi);
      densest.error = std::max(densest.error, p.error);
      if (p.phi <= densest.phi) continue;
      densest.phi = p.phi;
      densest.ratio = ratios[i];
      densest.share = shares[j];
    }
    csv.append(lines);
  };

  // About half a second's worth on a few cores.
  const std::size_t rows_at_once =
      std::max<std::size_t>(4, 16'000'000 / shares.size() / static_cast<std::size_t>(o.rods));
  const Interruptible listening(o.monitor);
  for (std::size_t from = 0; from < ratios.size(); from += rows_at_once) {
    o.monitor.report(
        {"map", static_cast<double>(from) / static_cast<double>(ratios.size()), "of the ratios"});
    std::vector<std::vector<Prediction>> rows(std::min(rows_at_once, ratios.size() - from));
    parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
      rows[i] = predict_shares({o.sigma_a, o.sigma_b, ratios[from + i]}, shares, o.rods);
    });
    for (std::size_t i = 0; i < rows.size(); ++i) tell(from + i, rows[i]);
  }
  csv.close();
  staged.write("map.svg", drawing_of(o, coarse, densest));
  densest.files = staged.publish();
  return densest;
} catch (const Cancelled&) {
  return {};
}

}  // namespace bernal
