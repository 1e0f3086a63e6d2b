#include <algorithm>
#include <cmath>
#include <map>

#include "cost/write_cost.hpp"
#include "report/drawing.hpp"
#include "viewer/html.hpp"

namespace bernal::cost {
namespace {

constexpr double drawing_width = 980, drawing_height = 600;
constexpr PlotArea area = {78, 92, 690, 530};
constexpr double legend_at = 716;

std::vector<const CostRow*> drawn_rows(const CostReport& report) {
  std::vector<const CostRow*> rows;
  for (const CostRow& row : report.rows)
    if (!row.slower && row.certified && row.seconds > 0) rows.push_back(&row);
  return rows;
}

/// Markers of the knobs, in the order in which they are met.
class Markers {
 public:
  explicit Markers(const CostReport& report) {
    for (const CostRow* row : drawn_rows(report)) {
      if (row->outcome != Outcome::converged) some_fall_short_ = true;
      if (row->changed.size() == 1) knobs_.try_emplace(row->changed.front(), knobs_.size());
      if (row->changed.size() > 1) some_change_several_ = true;
    }
  }
  std::string of(const CostRow& row, double x, double y) const {
    if (row.outcome != Outcome::converged) return short_of_it(x, y);
    if (row.changed.empty()) return own(x, y);
    return row.changed.size() == 1 ? of_knob(knobs_.at(row.changed.front()), x, y) : several(x, y);
  }
  void legend(Plot& plot, double y) const {
    const auto line = [&](const std::string& symbol, std::string_view text) {
      plot.add("{}", symbol);
      drawing::add_text(plot, legend_at + 22, y, "start", text);
      y += 22;
    };
    line(own(legend_at + 8, y - 4), "the scene as it is");
    std::map<std::size_t, std::string_view> in_order;
    for (const auto& [name, k] : knobs_) in_order[k] = name;
    for (const auto& [k, name] : in_order) line(of_knob(k, legend_at + 8, y - 4), name);
    if (some_change_several_) line(several(legend_at + 8, y - 4), "several keys changed");
    if (some_fall_short_) line(short_of_it(legend_at + 8, y - 4), "does not reach what is asked");
    line(fmt::format("<path class=\"line heavy\" d=\"M{} {}h16\"/>", legend_at, y - 4),
         "front, numbered as in the table");
    line(fmt::format("<circle class=\"chosen\" cx=\"{}\" cy=\"{}\" r=\"8\"/>", legend_at + 8, y - 4),
         "recommended");
  }

 private:
  static std::string own(double x, double y) {
    return fmt::format("<path d=\"M{:.1f} {:.1f}l7 7l-7 7l-7 -7z\" fill=\"#1d2733\"/>", x, y - 7);
  }
  static std::string several(double x, double y) {
    return drawing::shape(0, x, y, 3.2, "fill=\"#ffffff\" stroke=\"#5d6b7a\" stroke-width=\"1.3\"");
  }
  static std::string short_of_it(double x, double y) {
    return fmt::format("<path class=\"short\" d=\"M{:.1f} {:.1f}l7 7m0 -7l-7 7\"/>", x - 3.5, y - 3.5);
  }
  static std::string of_knob(std::size_t k, double x, double y) {
    return drawing::shape(k, x, y, 4.4, fmt::format("fill=\"{}\"", drawing::series_colour(k)));
  }

  std::map<std::string, std::size_t> knobs_;
  bool some_change_several_ = false, some_fall_short_ = false;
};

/// Numbers beside the points of the front, as many as have room.
void add_numbers(Plot& plot, const CostReport& report) {
  const std::vector<std::size_t> front = front_rows(report);
  double last_x = -1e9, last_y = -1e9;
  for (std::size_t n = 0; n < front.size(); ++n) {
    const CostRow& row = report.rows[front[n]];
    const double x = plot.x(row.seconds) - 7, y = plot.y(row.phi) - 8;
    if (std::abs(x - last_x) < 18 && std::abs(y - last_y) < 15) continue;
    drawing::add_text(plot, x, y, "end", fmt::format("{}", n + 1));
    last_x = x;
    last_y = y;
  }
}

}  // namespace

std::vector<std::size_t> front_rows(const CostReport& report) {
  std::vector<std::size_t> front;
  for (std::size_t k = 0; k < report.rows.size(); ++k)
    if (report.rows[k].pareto) front.push_back(k);
  return front;
}

std::string cost_svg(const CostReport& report, const CostHeading& heading) {
  const std::vector<const CostRow*> rows = drawn_rows(report);
  double from = 1e300, to = 0, low = 1, high = 0;
  for (const CostRow* row : rows) {
    from = std::min(from, row->seconds);
    to = std::max(to, row->seconds);
    low = std::min(low, row->phi - row->phi_scatter);
    high = std::max(high, row->phi + row->phi_scatter);
  }
  if (rows.empty()) from = 0.5, to = 2, low = 0, high = 1;
  const double room = std::max(1e-4, 0.06 * (high - low));
  Plot plot(area, {from / 1.15, to * 1.15, "processor seconds of a run, all threads", Scale::logarithmic},
            {low - room, high + room, "packing fraction, strict"});
  plot.axes();

  std::string stair;
  for (const std::size_t k : front_rows(report)) {
    const CostRow& row = report.rows[k];
    const double x = plot.x(row.seconds), y = plot.y(row.phi);
    stair += stair.empty() ? fmt::format("M{:.1f} {:.1f}", x, y) : fmt::format("H{:.1f}V{:.1f}", x, y);
  }
  if (!stair.empty()) plot.add("<path class=\"line heavy\" d=\"{}H{:.1f}\"/>", stair, area.right);
  const Markers markers(report);
  // Those that matter more on top of the others.
  for (const bool on_front : {false, true})
    for (const CostRow* row : rows) {
      if (row->pareto != on_front) continue;
      const double x = plot.x(row->seconds), y = plot.y(row->phi);
      if (row->phi_scatter > 0)
        plot.add("<path class=\"scatter\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", x,
                 plot.y(row->phi - row->phi_scatter), plot.y(row->phi + row->phi_scatter));
      plot.add("{}", markers.of(*row, x, y));
    }
  if (!rows.empty()) {
    const CostRow& chosen = report.rows[report.recommended];
    plot.add("<circle class=\"chosen\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"10\"/>", plot.x(chosen.seconds),
             plot.y(chosen.phi));
  }
  add_numbers(plot, report);
  markers.legend(plot, area.top + 14);
  const std::string style =
      "<style>.chosen{fill:none;stroke:#c0322b;stroke-width:2.2}.short{stroke:#5d6b7a;stroke-width:1.6}."
      "scatter{stroke:#9aa7b4;stroke-width:1}</"
      "style>";
  return drawing::svg_document(drawing_width, drawing_height,
                               fmt::format("What accuracy costs: {}, {}", heading.scene, heading.machine),
                               style + std::move(plot).finish());
}

}  // namespace bernal::cost
