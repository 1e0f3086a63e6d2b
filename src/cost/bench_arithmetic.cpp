#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "core/parallel.hpp"
#include "cost/arithmetic.hpp"
#include "cost/bench_tables.hpp"
#include "figures/drawing.hpp"

namespace bernal::cost {
namespace {

constexpr std::int64_t usual_decisions = 1'000'000;
constexpr std::uint64_t least_decisions = 40, largest_mesh = 1'000'000;

/// Shares of all decisions, in parts of their sum: of an analytic container, and of meshes of 10^2, 10^3, …
/// triangles. What is dear is asked less often.
struct Share {
  PricedRow (*price)(const PricedContainer&, std::uint64_t, const Monitor&);
  double analytic;
  std::vector<double> meshes;
};
const std::vector<Share>& shares() {
  static const std::vector<Share> all = {{price_places, 8, {1, 1, 0.5, 0.25, 0.1}},
                                         {price_centres, 5, {1, 1, 1, 1, 1}},
                                         {price_distances, 1, {0.1, 0.1, 0.05, 0.03, 0.02}},
                                         {price_ways, 1.5, {0.2, 0.2, 0.1, 0.05, 0.03}},
                                         {price_certificate, 2, {1, 1, 1, 1, 1}}};
  return all;
}
constexpr double share_of_pairs = 8;

double share_of(const Share& share, const std::vector<PricedContainer>& containers, std::size_t k) {
  const std::size_t analytic = 3;
  return containers[k].is_mesh() ? share.meshes[std::min(k - analytic, share.meshes.size() - 1)]
                                 : share.analytic;
}

std::vector<PricedRow> priced_rows(const BenchOptions& options) {
  options.monitor.report({"arithmetic", 0, "containers"});
  const std::vector<PricedContainer> containers = containers_to_price(largest_mesh);
  double sum = share_of_pairs;
  for (const Share& share : shares())
    for (std::size_t k = 0; k < containers.size(); ++k) sum += share_of(share, containers, k);
  const auto wanted = static_cast<double>(options.decisions > 0 ? options.decisions : usual_decisions);
  const auto count = [&](double share) {
    return std::max(least_decisions, static_cast<std::uint64_t>(wanted * share / sum));
  };

  std::vector<PricedRow> rows;
  const auto steps = static_cast<double>(shares().size() * containers.size() + 1);
  const auto report = [&] {
    if (options.monitor.stop()) throw Cancelled();
    const std::string said =
        rows.empty() ? std::string() : fmt::format("{}, {}", rows.back().decision, rows.back().container);
    options.monitor.report({"arithmetic", static_cast<double>(rows.size()) / steps, said});
  };
  rows.push_back(price_pairs(count(share_of_pairs), options.monitor));
  for (const Share& share : shares())
    for (std::size_t k = 0; k < containers.size(); ++k) {
      report();
      rows.push_back(share.price(containers[k], count(share_of(share, containers, k)), options.monitor));
    }
  return rows;
}

std::string in_ulps(const std::optional<double>& length, double ulp) {
  return length ? fmt::format("{:.3g}", *length / ulp) : "";
}

std::string csv_of(const std::vector<PricedRow>& rows) {
  std::string csv =
      "decision,container,triangles,arithmetic,decisions,ns,exact_share,differ_from_exact,worst_error_ulp,"
      "bound_ulp,worst_error,ulp\n";
  for (const PricedRow& row : rows)
    for (std::size_t level = 0; level < level_count; ++level) {
      if (!row.level[level]) continue;
      const Priced& p = *row.level[level];
      csv += fmt::format("\"{}\",{},{},{},{},{:.1f},{:.6f},{},{},{},{},{}\n", row.decision, row.container,
                         row.triangles, name_of_level(level), p.decisions, p.nanoseconds, p.exact_share,
                         p.differ, in_ulps(p.worst_error, row.ulp), in_ulps(p.bound, row.ulp),
                         p.worst_error ? fmt::format("{:.3g}", *p.worst_error) : "", row.ulp);
    }
  return csv;
}

/// "error ≤ bound" in ulps.
std::string error_text(const Priced& p, double ulp) {
  if (!p.worst_error) return "";
  if (!p.bound) return in_ulps(p.worst_error, ulp);
  return fmt::format("{} ≤ {}", in_ulps(p.worst_error, ulp), in_ulps(p.bound, ulp));
}

struct Totals {
  std::uint64_t decisions = 0, filtered_differ = 0, plain_differ = 0;
  bool within_bounds = true;
};

Totals totals_of(const std::vector<PricedRow>& rows) {
  Totals totals;
  for (const PricedRow& row : rows) {
    if (row.level[1]) totals.decisions += row.level[1]->decisions;
    if (row.level[1]) totals.filtered_differ += row.level[1]->differ;
    if (row.level[0]) totals.plain_differ += row.level[0]->differ;
    for (const auto& level : row.level)
      if (level && level->worst_error && level->bound)
        totals.within_bounds &= *level->worst_error <= *level->bound;
  }
  return totals;
}

std::string page_of(const std::vector<PricedRow>& rows) {
  const Totals totals = totals_of(rows);
  std::string page = fmt::format(
      "# The arithmetic, priced\n\n"
      "Every decision about walls and pairs in `double`, `filtered` and `exact`, the three words of `walls` "
      "in "
      "`[accuracy]`: processor time each in nanoseconds, all three put to the same queries in turn. A "
      "quarter "
      "of the queries lies anywhere near a wall, a quarter within 1e-12 of a tie, a quarter within two "
      "doubles of it, and a quarter exactly at it, as far as there are such doubles. Written by `bernal "
      "bench "
      "arithmetic -o DIR`, which takes `--decisions`.\n\n"
      "**{} decisions: `filtered` differs from `exact` in {}, `double` in {}; every error is {}.**\n\n",
      grouped(totals.decisions), grouped(totals.filtered_differ), grouped(totals.plain_differ),
      totals.within_bounds ? "within its bound" : "NOT within its bound");
  page +=
      "![Nanoseconds a decision](arithmetic.svg)\n\n"
      "- *exact*: the share of the filtered decisions that needed exact arithmetic.\n"
      "- *differ*: decisions unlike those of `exact`. Of distances, doubles that are not the same; of move "
      "limits, whether the whole way is free, and of `filtered` also any that is longer than `exact`.\n"
      "- *error*, in units of the last place of the container's largest coordinate, and the bound derived "
      "for "
      "it (src/domain/free_path.hpp). Of yes and no: the deepest gap or overlap that was judged wrongly. Of "
      "a "
      "distance: its difference from the exact one. Of a move limit in `double`: how far the ball at its end "
      "is from contact, or has been beyond it; in `filtered`: how much shorter the way is than the exact "
      "one. "
      "Of pairs: in units of the sum of their radii.\n"
      "- A certificate has no level `double`. A mesh decides on which side a point is exactly at every "
      "level.\n";
  std::string decision;
  for (const PricedRow& row : rows) {
    if (row.decision != decision) {
      decision = row.decision;
      page += fmt::format(
          "\n## {}{}\n\n| container | triangles | decisions | double | filtered | exact | exact needed | "
          "differ, double | differ, filtered | error of double | error of filtered |\n"
          "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
          static_cast<char>(std::toupper(decision[0])), decision.substr(1));
    }
    const auto nanoseconds = [&](std::size_t level) {
      if (!row.level[level]) return std::string("–");
      const double ns = row.level[level]->nanoseconds;
      return ns < 100 ? fmt::format("{:.3g}", ns) : grouped(static_cast<std::uint64_t>(std::llround(ns)));
    };
    const Priced& filtered = *row.level[1];
    page +=
        fmt::format("| {} | {} | {} | {} | {} | {} | {:.3g} % | {} | {} | {} | {} |\n",
                    row.container.empty() ? "–" : row.container,
                    row.triangles > 0 ? grouped(row.triangles) : "–", grouped(filtered.decisions),
                    nanoseconds(0), nanoseconds(1), nanoseconds(2), 100 * filtered.exact_share,
                    row.level[0] ? grouped(row.level[0]->differ) : "–", grouped(filtered.differ),
                    row.level[0] ? error_text(*row.level[0], row.ulp) : "–", error_text(filtered, row.ulp));
  }
  return page;
}

constexpr std::string_view line_of_level[] = {"line four", "line two", "line one"};
constexpr std::string_view ink_of_level[] = {"#b3561d", "#2f8ba3", "#1d2733"};

/// One small plot a decision: nanoseconds over the containers, up to 10 to an even `power`.
std::string panel(const std::vector<const PricedRow*>& rows, const PlotArea& area, int power) {
  const double last = std::max<double>(1, static_cast<double>(rows.size()) - 1);
  Plot plot(area, {-0.3, last + 0.3}, {1, std::pow(10, power), {}, Scale::logarithmic});
  figures::add_text(plot, area.left, area.top - 10, "start", rows.front()->decision);
  for (int k = 0; k <= power; k += 2) {
    constexpr std::string_view words[] = {"1 ns", "100 ns", "10 µs", "1 ms", "0.1 s", "10 s"};
    const double y = plot.y(std::pow(10, k));
    plot.add("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", area.left, y, area.right);
    plot.add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", area.left - 6, y + 4,
             words[static_cast<std::size_t>(k / 2)]);
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::string& name = rows[k]->container;
    const std::string shown = name.empty()                  ? "spheres"
                              : name.starts_with("mesh 1e") ? "10^" + name.substr(7)
                                                            : name;
    plot.add(
        "<text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"end\" transform=\"rotate(-40 {0:.1f} "
        "{1:.1f})\">{2}</text>",
        plot.x(static_cast<double>(k)) + 4, area.bottom + 14, shown);
  }
  for (std::size_t level = 0; level < level_count; ++level) {
    std::vector<double> xs, ys;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (!rows[k]->level[level]) continue;
      xs.push_back(static_cast<double>(k));
      ys.push_back(std::max(1.0, rows[k]->level[level]->nanoseconds));
      plot.add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>", plot.x(xs.back()),
               plot.y(ys.back()), ink_of_level[level]);
    }
    if (xs.size() > 1) plot.line(xs, ys, line_of_level[level]);
  }
  plot.add("<path class=\"axis\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", area.left, area.bottom, area.right);
  return std::move(plot).finish();
}

std::string picture_of(const std::vector<PricedRow>& rows) {
  constexpr double width = 1060, left = 78, across = 340, down = 310, panel_width = 250, panel_height = 210,
                   top = 104;
  std::vector<std::vector<const PricedRow*>> decisions;
  double slowest = 100;
  for (const PricedRow& row : rows) {
    for (const auto& level : row.level)
      if (level) slowest = std::max(slowest, level->nanoseconds);
    if (decisions.empty() || decisions.back().front()->decision != row.decision) decisions.emplace_back();
    decisions.back().push_back(&row);
  }
  const int power = 2 * static_cast<int>(std::ceil(std::log10(slowest) / 2));
  std::string body;
  Plot legend({0, 0, 1, 1}, {}, {});
  for (std::size_t level = 0; level < level_count; ++level)
    figures::legend_line(legend, left + 150 * static_cast<double>(level), 58, line_of_level[level],
                         name_of_level(level));
  figures::add_text(legend, left + 480, 58, "start", "over the container; 10^2 to 10^6: triangles of a mesh");
  body += std::move(legend).finish();
  for (std::size_t k = 0; k < decisions.size(); ++k) {
    const double x = left + across * static_cast<double>(k % 3), y = top + down * static_cast<double>(k / 3);
    body += panel(decisions[k], {x, y, x + panel_width, y + panel_height}, power);
  }
  const double height = top + down * std::ceil(static_cast<double>(decisions.size()) / 3);
  return figures::svg_document(width, height, "Processor time a decision", body);
}

}  // namespace

BenchFiles bench_arithmetic(const BenchOptions& options) {
  const std::vector<PricedRow> rows = priced_rows(options);
  return {{"arithmetic.md", page_of(rows)},
          {"arithmetic.csv", csv_of(rows)},
          {"arithmetic.svg", picture_of(rows)}};
}

}  // namespace bernal::cost
