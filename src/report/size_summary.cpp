#include "report/size_summary.hpp"

#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/sizes/percentiles.hpp"
#include "scene/size_kinds.hpp"
#include "sizes/volume_carriers.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_shares = 12;
constexpr double rounding_of_shares = 1e-9;

double factor_of(const Scene& scene) { return scene.sizes_are_diameters ? 2 : 1; }

std::vector<SizeSummary::Share> shares_of(const Scene& scene, const SizeDistribution& radii) {
  std::vector<SizeSummary::Share> shares;
  const std::vector<double> atoms = radii.atoms();
  if (atoms.size() < 2 || atoms.size() > most_shares) return shares;
  const auto* classes = std::get_if<Classes>(&scene.sizes);
  const int dimension = scene.dimension();
  double all = 0, mass = 0;
  for (const double r : atoms) {
    const double number = radii.cumulative(r) - radii.cumulative(std::nextafter(r, 0.0));
    SizeSummary::Share& share = shares.emplace_back(SizeSummary::Share{
        factor_of(scene) * r, {}, number, number * std::pow(r, dimension) / radii.moment(dimension), {}});
    all += number;
    const auto k = classes ? class_of(*classes, share.size / scene.scale) : std::nullopt;
    if (k && !classes->names.empty()) share.name = classes->names[*k];
    if (k && !classes->material_densities.empty())
      mass += *(share.mass = share.volume * classes->material_densities[*k]);
  }
  if (std::abs(all - 1) > rounding_of_shares) return {};  // others lie between them
  for (SizeSummary::Share& share : shares)
    if (share.mass) *share.mass /= mass;
  return shares;
}

}  // namespace

SizeSummary summary_of(const Scene& scene, const SizeDistribution& radii) {
  SizeSummary summary;
  if (radii.min() == radii.max()) return summary;
  summary.shares = shares_of(scene, radii);
  for (const double share : {0.1, 0.5, 0.9})
    summary.percentiles.push_back(
        {share, 2 * radii.quantile(share), 2 * radius_holding(radii, 1 - share, scene.dimension())});
  if (const auto* given = std::get_if<Percentiles>(&scene.sizes))
    for (const NamedPercentile& each : named_percentiles)
      if (const auto& size = given->*each.member)
        summary.fit.push_back(
            {each.name, each.share, scene.scale * *size, 2 * radius_below(radii, each.share, given->basis)});
  return summary;
}

std::string fit_in_words(const SizeSummary::Fit& fit) {
  const double percent = 0.1 * std::round(1000 * (fit.fitted / fit.given - 1)) + 0.0;  // no -0
  return fmt::format("{} {:.4g} ({:+.1f} %)", fit.name, fit.fitted, percent);
}

std::string basis_of_fit(const Scene& scene) {
  const auto* given = std::get_if<Percentiles>(&scene.sizes);
  if (!given) return {};
  return given->basis == Basis::number   ? "by number"
         : given->basis == Basis::volume ? "by volume"
                                         : "by mass";
}

std::string summary_in_words(const SizeSummary& summary, const Scene& scene) {
  std::string text;
  const auto out = std::back_inserter(text);
  const std::string_view volume = scene.dimension() == 2 ? "area" : "volume";
  std::string_view head = "sizes";
  const auto line = [&](const std::string& words) {
    fmt::format_to(out, "{:<9}  {}\n", std::exchange(head, ""), words);
  };
  if (!summary.percentiles.empty()) {
    std::vector<std::string> by_volume, by_number;
    for (const auto& [share, number, of_volume] : summary.percentiles) {
      by_volume.push_back(fmt::format("D{:.0f} {:.4g}", 100 * share, of_volume));
      by_number.push_back(fmt::format("{:.4g}", number));
    }
    line(fmt::format("{} {} by {}; {} by number", fmt::join(by_volume, ", "), name_of(scene.unit), volume,
                     fmt::join(by_number, ", ")));
  }
  if (!summary.shares.empty()) {
    const bool has_mass = summary.shares.front().mass.has_value();
    line(fmt::format("{:>10} {:>14} {:>14}{}", scene.sizes_are_diameters ? "diameter" : "radius",
                     "% by number", fmt::format("% by {}", volume), has_mass ? "      % by mass" : ""));
    for (const SizeSummary::Share& share : summary.shares)
      line(fmt::format("{:>10.6g} {:>14.4g} {:>14.4g}{}{}", share.size, 100 * share.number,
                       100 * share.volume,
                       has_mass ? fmt::format(" {:>14.4g}", 100 * share.mass.value_or(0)) : "",
                       share.name.empty() ? "" : "  " + share.name));
  }
  if (!summary.fit.empty()) {
    std::vector<std::string> all;
    for (const SizeSummary::Fit& fit : summary.fit) all.push_back(fit_in_words(fit));
    head = "law";
    line(fmt::format("{} {}, against what was given", fmt::join(all, ", "), basis_of_fit(scene)));
  }
  return text;
}

}  // namespace bernal
