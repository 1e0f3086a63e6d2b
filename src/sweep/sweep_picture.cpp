#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "report/drawing.hpp"
#include "scene/toml_text.hpp"
#include "sweep/results.hpp"
#include "viewer/palette.hpp"

namespace bernal {
namespace sweep {
namespace {

constexpr double drawing_width = 980, drawing_height = 600, legend_at = 740;
constexpr std::size_t most_series = 8;

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

struct Point {
  double x, y;
  std::string series;
  bool is_done;
};

/// Distinct values, numbers by their size and before words.
std::vector<std::string> distinct(const std::vector<std::string>& values) {
  std::vector<std::string> all(values);
  std::ranges::stable_sort(all, [](const std::string& a, const std::string& b) {
    const auto x = number_of(a), y = number_of(b);
    if (x && y) return *x < *y;
    return x.has_value() != y.has_value() ? x.has_value() : a < b;
  });
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

bool has_several_numbers(const std::vector<std::string>& values) {
  std::set<double> numbers;
  for (const std::string& value : values)
    if (const auto number = number_of(value)) numbers.insert(*number);
  return numbers.size() > 1;
}

std::string label_of(const std::string& column) {
  if (column == "phi") return "packing fraction";
  if (column == "coordination") return "mean number of contacts";
  if (column == "seconds") return "seconds of a run";
  if (column == "peak_memory_bytes") return "memory at the peak, bytes";
  return column;
}

/// An axis with some room at its ends; in the logarithm where numbers lie far apart.
Axis axis_of(const std::vector<double>& values, std::string_view label) {
  const auto [least, most] = std::ranges::minmax(values);
  constexpr double far_apart = 50;
  if (least > 0 && most / least >= far_apart) {
    const double room = std::pow(most / least, 0.04);
    return {least / room, most * room, label, Scale::logarithmic};
  }
  const double room = most > least ? 0.05 * (most - least) : std::max(1e-6, 0.05 * std::abs(most));
  return {least - room, most + room, label};
}

class Picture {
 public:
  Picture(std::vector<Point> points, const Plotted& columns, std::vector<std::string> series)
      : points_(std::move(points)), columns_(columns), series_(std::move(series)) {}

  std::string svg(const std::string& title) const {
    std::vector<double> xs, ys;
    for (const Point& p : points_) {
      xs.push_back(p.x);
      ys.push_back(p.y);
    }
    if (points_.empty()) xs = ys = {0, 1};
    const std::string x = label_of(columns_.x), y = label_of(columns_.y);
    const double right = series_.size() > 1 ? 700 : 940;
    Plot plot({78, 92, right, 530}, axis_of(xs, x), axis_of(ys, y));
    plot.axes();
    if (add_means(plot)) drawing::add_text(plot, right, 44, "end", "lines: means");
    for (const Point& p : points_) plot.add("{}", marker(p.series, p.is_done, plot.x(p.x), plot.y(p.y)));
    add_legend(plot);
    return drawing::svg_document(drawing_width, drawing_height, title, std::move(plot).finish());
  }

 private:
  std::size_t place_of(const std::string& series) const {
    return static_cast<std::size_t>(std::ranges::find(series_, series) - series_.begin());
  }
  std::string colour_of(const std::string& series) const {
    if (series_.size() <= most_series) return std::string(drawing::series_colour(place_of(series)));
    // So many that only their order can be seen; the lightest would not be seen on white.
    return size_colour(0.2 +
                       0.8 * static_cast<double>(place_of(series)) / static_cast<double>(series_.size() - 1))
        .text();
  }
  std::string marker(const std::string& series, bool is_done, double x, double y) const {
    const std::string colour = colour_of(series);
    const std::size_t shape = series_.size() <= most_series ? place_of(series) : 0;
    return is_done
               ? drawing::shape(shape, x, y, 4.2, fmt::format("fill=\"{}\" fill-opacity=\"0.75\"", colour))
               : drawing::shape(shape, x, y, 4.2,
                                fmt::format("fill=\"#ffffff\" stroke=\"{}\" stroke-width=\"1.4\"", colour));
  }

  /// Lines through the mean of the cells of a series at each place; whether there are any.
  bool add_means(Plot& plot) const {
    constexpr std::size_t most_places = 200;
    bool some = false;
    for (const std::string& series : series_) {
      std::map<double, std::pair<double, int>> sums;
      for (const Point& p : points_)
        if (p.series == series && p.is_done) {
          sums[p.x].first += p.y;
          ++sums[p.x].second;
        }
      if (sums.size() < 2 || sums.size() > most_places) continue;
      std::string path;
      for (const auto& [x, sum] : sums)
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', plot.x(x),
                            plot.y(sum.first / sum.second));
      some = true;
      plot.add("<path class=\"line\" style=\"stroke:{}\" d=\"{}\"/>", colour_of(series), path);
    }
    return some;
  }

  void add_legend(Plot& plot) const {
    double y = plot.area().top + 14;
    if (series_.size() > 1) {
      drawing::add_text(plot, legend_at, y, "start", columns_.colour);
      y += 24;
      const std::size_t step = (series_.size() - 1) / most_series + 1;
      for (std::size_t k = 0; k < series_.size(); k += step) {
        plot.add("{}", marker(series_[k], true, legend_at + 8, y - 4));
        drawing::add_text(plot, legend_at + 24, y, "start",
                          series_[k].empty() ? "–" : plain_text(series_[k], 32));
        y += 22;
      }
    }
    if (std::ranges::all_of(points_, &Point::is_done)) return;
    const bool beside = series_.size() > 1;
    const double x = beside ? legend_at + 8 : plot.area().right - 190, at = beside ? y - 4 : 62;
    plot.add("{}", drawing::shape(0, x, at, 4.2, "fill=\"#ffffff\" stroke=\"#5d6b7a\" stroke-width=\"1.4\""));
    drawing::add_text(plot, x + 16, at + 4, "start", "not what was asked for");
  }

  std::vector<Point> points_;
  const Plotted& columns_;
  std::vector<std::string> series_;
};

/// The names of `plot`, each of which is a column.
std::vector<std::string> named_columns(const Sweep& sweep, const std::string& plot) {
  std::vector<std::string_view> known = {"cell"};
  known.insert(known.end(), sweep.keys().begin(), sweep.keys().end());
  known.insert(known.end(), result_columns().begin(), result_columns().end());
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= plot.size();) {
    const std::size_t comma = std::min(plot.find(',', from), plot.size());
    names.push_back(plot.substr(from, comma - from));
    from = comma + 1;
    if (std::ranges::find(known, names.back()) == known.end())
      throw Error(ErrorCode::bad_argument,
                  fmt::format("results.csv has no column {} to plot{}", toml_string(names.back()),
                              remedy(names.back(), known)));
  }
  if (names.size() < 2 || names.size() > 3)
    throw Error(ErrorCode::bad_argument,
                "a plot is of two columns, or of three, the last of them as colour: "
                "x,y or x,y,colour");
  return names;
}

}  // namespace

Plotted plotted_columns(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& plot) {
  Plotted columns{.x = "cell", .y = "phi", .colour = {}};
  const bool is_chosen = !plot.empty();
  if (is_chosen) {
    const std::vector<std::string> names = named_columns(sweep, plot);
    columns = {names[0], names[1], names.size() == 3 ? names[2] : std::string()};
    if (!columns.colour.empty()) return columns;
  } else {
    for (const bool seeds : {true, false})  // what is found last is what is taken
      for (auto key = sweep.keys().rbegin(); key != sweep.keys().rend(); ++key)
        if ((*key == "seed") == seeds && has_several_numbers(column_of(sweep, rows, *key))) columns.x = *key;
  }
  for (const std::string& key : sweep.keys()) {
    if (key == columns.x || key == columns.y || key == "seed") continue;
    const std::size_t several = distinct(column_of(sweep, rows, key)).size();
    if (several < 2 || several > most_series) continue;
    columns.colour = key;
    break;
  }
  return columns;
}

}  // namespace sweep

std::string sweep_svg(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& plot) {
  const sweep::Plotted columns = sweep::plotted_columns(sweep, rows, plot);
  const std::vector<std::string> xs = sweep::column_of(sweep, rows, columns.x);
  const std::vector<std::string> ys = sweep::column_of(sweep, rows, columns.y);
  const std::vector<std::string> series = columns.colour.empty()
                                              ? std::vector<std::string>(rows.size())
                                              : sweep::column_of(sweep, rows, columns.colour);
  std::vector<sweep::Point> points;
  std::vector<std::string> drawn;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto x = sweep::number_of(xs[k]), y = sweep::number_of(ys[k]);
    if (!x || !y) continue;
    points.push_back({*x, *y, series[k], rows[k].result.is_done()});
    drawn.push_back(series[k]);
  }
  const std::string title =
      fmt::format("{}: {} of {} cells", plain_text(sweep.file().filename().string(), 80),
                  grouped(points.size()), grouped(rows.size()));
  return sweep::Picture(std::move(points), columns, sweep::distinct(drawn)).svg(title);
}

}  // namespace bernal
