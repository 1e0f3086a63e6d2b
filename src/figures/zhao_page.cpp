#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "figures/zhao.hpp"

namespace bernal::figures {
namespace {

constexpr double within_print = 0.005;

std::string difference(double own, double printed) { return fmt::format("{:+.4f}", own - printed); }

/// Over the numbers of spheres that the published loop took.
std::string period_table(const ZhaoResults& results) {
  std::vector<std::string> head = {"spheres", "adaptive, 17 lg² N"};
  for (const int period : fixed_periods) head.push_back(fmt::format("T = {}", period));
  head.emplace_back("fast loop, adaptive");
  std::vector<int> counts = results.counts({.period = fixed_periods[0]});
  for (const int n : results.counts({.method = RelaxMethod::fast})) counts.push_back(n);
  std::ranges::sort(counts);
  counts.erase(std::ranges::unique(counts).begin(), counts.end());
  std::vector<std::vector<std::string>> lines;
  for (const int n : counts) {
    std::vector<std::string> row = {std::to_string(n)};
    const auto add = [&](ZhaoRun run) {
      run.spheres = n;
      const auto found = results.of(run);
      row.push_back(found.empty() ? "" : phi_of(found).text(4));
    };
    add({});
    for (const int period : fixed_periods) add({.period = period});
    add({.method = RelaxMethod::fast});
    lines.push_back(row);
  }
  return markdown_table(head, lines);
}

std::string period_section(const ZhaoResults& results) {
  std::string text =
      R"(## Figure 5: fixed and adaptive period

![figure 5](zhao2007_fig5.svg)

Packing fractions of equal spheres, mean ± standard deviation of one packing where there are several seeds:

)" + period_table(results) +
      R"(
The curves of their figure 5 are not in the text, nor are its fixed periods; what the text says is that
with a fixed period the packing fraction falls as N rises, most where the period is short, and that it
hardly changes with the adaptive one.)";
  const ZhaoRun adaptive{}, few_sweeps{.period = fixed_periods[0]}, more_sweeps{.period = fixed_periods[1]};
  const auto of = [&](ZhaoRun run, int spheres) {
    run.spheres = spheres;
    return results.of(run);
  };
  std::vector<int> counts = results.counts(adaptive);
  std::erase_if(counts, [&](int n) { return of(few_sweeps, n).empty() || of(more_sweeps, n).empty(); });
  if (counts.size() > 1) {
    const int few = counts[counts.size() > 2 ? counts.size() - 3 : 0], many = counts.back();
    const auto change = [&](const ZhaoRun& run) {
      return phi_of(of(run, many)).mean - phi_of(of(run, few)).mean;
    };
    text += fmt::format(
        R"( Here, from {} to {} spheres: {:+.4f} with the adaptive period, {:+.4f} with T = {} and {:+.4f} with T = {}.)",
        few, many, change(adaptive), change(more_sweeps), more_sweeps.period, change(few_sweeps),
        few_sweeps.period);
  }
  return text + "\n\n";
}

struct TimeLaw {
  PowerLaw law;
  int least = 0, most = 0;
  double seconds = 0;  ///< of the most
};

TimeLaw time_law(const ZhaoResults& results, const ZhaoRun& runs) {
  constexpr int few = 300;  // below, what does not grow with N counts
  std::vector<double> xs, ys;
  for (const int n : results.counts(runs)) {
    ZhaoRun run = runs;
    run.spheres = n;
    if (n < few) continue;
    xs.push_back(n);
    ys.push_back(seconds_of(results.of(run)).mean);
  }
  if (xs.size() < 2) return {};
  return {fitted_power(xs, ys), static_cast<int>(xs.front()), static_cast<int>(xs.back()), ys.back()};
}

std::string time_section(const ZhaoResults& results) {
  std::vector<std::vector<std::string>> lines;
  const auto add = [&](std::string name, const ZhaoRun& runs) {
    const TimeLaw time = time_law(results, runs);
    if (time.most == 0) return;
    lines.push_back({std::move(name), fmt::format("{} to {}", time.least, time.most),
                     fmt::format("{:.2f} ± {:.2f}", time.law.exponent, time.law.error),
                     fmt::format("{:.3g}", time.seconds)});
  };
  add("published loop, φ0 = 0.86 (close)", {});
  add("published loop, φ0 = 0.75 (their loose)", {.phi0 = 0.75});
  add("published loop, T = 100", {.period = 100});
  add("fast loop, φ0 = 0.86", {.method = RelaxMethod::fast});
  std::string text = "## Figure 8: time against the number of spheres\n\n![figure 8](zhao2007_fig8.svg)\n\n";
  if (!lines.empty())
    text += markdown_table({"equal spheres", "N", "exponent of N", "seconds at the most"}, lines) + "\n";
  text +=
      R"(Printed: about O(N), and 217 s for 10,000 spheres in close packing on an AMD Athlon 3200+ (2.0 GHz). With
the adaptive period the number of sweeps grows as lg² N, so that O(N lg² N) is to be expected, an exponent
of 1.2 or so over these numbers: a sweep is O(N), the whole is not quite. The fast loop keeps the period
that 10,000 spheres have beyond them.

)";
  const auto loose = results.counts({.phi0 = 0.75});
  if (!loose.empty()) {
    ZhaoRun run{.phi0 = 0.75, .spheres = loose.back()}, close{.spheres = loose.back()};
    text += fmt::format(
        R"(φ0 = 0.75, which the paper takes for random loose packing, gives {:.4f} with {} spheres; 0.86 gives
{:.4f}. That is close packing by either: loose ones need a smaller φ0.

)",
        phi_of(results.of(run)).mean, run.spheres, phi_of(results.of(close)).mean);
  }
  return text;
}

std::string picture_section() {
  std::string text = "## Figures 9 to 12: the packings and their middle planes\n\n";
  for (const ZhaoSizes& of : zhao_sizes())
    if (of.figure > 0) text += fmt::format("![figure {0}](zhao2007_fig{0}.svg)\n", of.figure);
  return text + "\nBy the fast loop; colours are sizes, from light and small to dark and large.\n\n";
}

/// The gap ratio to which neighbours have to be counted for that coordination, between those counted.
std::optional<double> gap_for(const std::vector<double>& coordination, double wanted) {
  for (std::size_t k = 1; k < coordination.size(); ++k) {
    if (!(coordination[k - 1] <= wanted && wanted <= coordination[k])) continue;
    const double share = (wanted - coordination[k - 1]) / (coordination[k] - coordination[k - 1]);
    return counted_gaps[k - 1] * std::pow(counted_gaps[k] / counted_gaps[k - 1], share);
  }
  return {};
}

std::string table_2_rows(const ZhaoResults& results) {
  std::vector<std::vector<std::string>> lines;
  for (std::size_t k = 0; k < zhao_sizes().size(); ++k) {
    const ZhaoSizes& of = zhao_sizes()[k];
    for (const RelaxMethod method : {RelaxMethod::reference, RelaxMethod::fast}) {
      for (const int n : results.counts({.sizes = k, .method = method})) {
        const bool of_table = std::ranges::binary_search(results.counts({.sizes = 1, .method = method}), n) ||
                              (method == RelaxMethod::reference && n == results.counts({}).back());
        if (!of_table) continue;
        const auto packings = results.of({.sizes = k, .method = method, .spheres = n});
        const double phi = phi_of(packings).mean;
        lines.push_back({std::string(of.name), method == RelaxMethod::fast ? "fast" : "published",
                         std::to_string(n), std::to_string(packings.size()), phi_of(packings).text(4),
                         of.phi ? fmt::format("{:.3f}", *of.phi) : "", of.phi ? difference(phi, *of.phi) : "",
                         coordination_of(packings).text(2),
                         of.coordination ? fmt::format("{:.2f}", *of.coordination) : "",
                         seconds_of(packings).text(1)});
      }
    }
  }
  return markdown_table({"sizes", "loop", "N", "seeds", "packing fraction", "printed", "difference",
                         "coordination", "printed", "seconds"},
                        lines);
}

std::string about_equal_spheres(const ZhaoResults& results) {
  const ZhaoSizes& equal = zhao_sizes().front();
  const int most = results.counts({}).back();
  const auto book = results.of({.spheres = most});
  const double phi = phi_of(book).mean, off = phi - *equal.phi;
  std::string text =
      fmt::format("Equal spheres, {} by the published loop: {:.4f}, {} of the printed {:.3f}", most, phi,
                  std::abs(off) <= within_print ? "within 0.005" : "not within 0.005", *equal.phi);
  if (std::abs(off) > within_print)
    text += most < 10'000 ? fmt::format(": so few as {} spheres pack looser by some thousandths", most) : "";
  text +=
      R"(. Here packings are grown until nothing overlaps at all, as the paper's are not: that costs up to three
times the overlap ratio of 2e-4 at which the loop stops, 0.0004.)";
  const auto& z = book.front()->coordination;
  text += fmt::format(
      R"( The coordination depends on how near a neighbour must be: this packing has {:.2f} at a gap ratio of 5e-4,
{:.2f} at 0.002 (the paper's) and {:.2f} at 0.01.)",
      z[3], z[usual_gap], z.back());
  const int fast_most = results.counts({.sizes = 1, .method = RelaxMethod::fast}).back();
  const auto fast = results.of({.method = RelaxMethod::fast, .spheres = fast_most});
  text += fmt::format(
      R"( The fast loop, whose spheres come nearer to rest between two growths, reaches {:.4f} and then has {:.2f}:
a denser packing has more neighbours. The printed pair, {:.3f} with {:.2f}, has fewer than either)",
      phi_of(fast).mean, coordination_of(fast).mean, *equal.phi, *equal.coordination);
  if (coordination_of(fast).mean > *equal.coordination && coordination_of(book).mean > *equal.coordination) {
    text += ": neither loop gives both";
    if (const auto gap = gap_for(fast.front()->coordination, *equal.coordination))
      text += fmt::format(
          "; the fast loop's packing has {:.2f} where neighbours are counted up to a gap ratio of {:.1g}",
          *equal.coordination, *gap);
  } else {
    text = text.substr(0, text.rfind(" The printed pair")) +
           " So few spheres scatter too much to be held against the printed pair";
  }
  return text + ".\n\n";
}

std::string about_lognormal_spheres(const ZhaoResults& results) {
  const double printed = *zhao_sizes()[2].phi;
  const int n = results.counts({.sizes = as_printed}).back();
  const double stated = phi_of(results.of({.sizes = 2, .spheres = n})).mean,
               drawn = phi_of(results.of({.sizes = as_printed, .spheres = n})).mean;
  return fmt::format(
      R"(Lognormal sizes: with sigma 0.3 the published loop gives {:.4f} for {} spheres, {:+.4f} from print; with
the sigma of 0.212 that the printed formula draws it gives {:.4f}. The missing factor explains {:.4f} of
the difference; {:+.4f} is left, which nothing here explains.

)",
      stated, n, stated - printed, drawn, stated - drawn, drawn - printed);
}

std::string about_arbitrary_spheres(const ZhaoResults& results) {
  constexpr std::size_t row = 3;
  const int n = results.counts({.sizes = row, .method = RelaxMethod::fast}).back();
  const auto fast = results.of({.sizes = row, .method = RelaxMethod::fast, .spheres = n});
  return fmt::format(
      R"(Arbitrary sizes: their data are not in the text, and the sizes here were chosen so that they pack about as
densely. So only the coordination says something: {:.2f} against the printed {:.2f}; it depends on how
many small spheres lie loose between large ones, and theirs had other sizes.
)",
      coordination_of(fast).mean, *zhao_sizes()[row].coordination);
}

}  // namespace

std::string zhao_page(const ZhaoResults& results, const DrawnSizes& drawn, double seconds) {
  return fmt::format(
             R"(# Zhao, Li & Liu (2007), done again

Zhao Liang, Li Shuixiang, Liu Yuewu: *Numerical simulation of sphere packing with arbitrary diameter
distribution*. Chinese Journal of Computational Physics (2007, in Chinese). Written by `bernal reproduce
zhao2007` in {:.0f} s on: {}. Seconds in the tables are the processor's, of one thread a packing; all
packings are certified free of overlap. `zhao2007.csv` has every one of them.

*Published loop*: the paper's, literally. *Fast loop*: the default of `relax`, the same idea on neighbour
lists with over-relaxed steps; in a box of some ten spheres of many sizes it is the published one.

)",
             seconds, processor_name()) +
         drawn.page + "\n" + period_section(results) + time_section(results) + picture_section() +
         R"(## Table 2: packing fraction and coordination

Mean ± standard deviation of one packing. Printed are single numbers for 10,000 spheres.

)" + table_2_rows(results) +
         "\n" + about_equal_spheres(results) + about_lognormal_spheres(results) +
         about_arbitrary_spheres(results);
}

}  // namespace bernal::figures
