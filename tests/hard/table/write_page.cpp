#include <cstdio>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "hard/table/random_polyhedra.hpp"

// `hard_table PAGE.md [PART]` writes how every case ends, or those whose name has this part, and says on
// standard error which do not end as they must; exit code 1 if there are any.
namespace bernal::hard {
namespace {

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string ratio(const Certificate& certificate, double value, bool decided) {
  return decided && certificate.spheres > 0 ? fmt::format("{:.1e}", value) : "—";
}

std::string ending(const Case& c, const End& end) {
  if (!end.refusal.empty()) return "refused: " + end.refusal;
  std::string text = c.offered.empty() ? "" : fmt::format("`{}`: ", c.offered);
  for (char& letter : text)
    if (letter == '\n') letter = ' ';
  text += fmt::format("{} {}, {:.3f}", end.spheres, end.spheres == 1 ? "sphere" : "spheres",
                      end.packing_fraction);
  if (end.outcome != Outcome::converged) text += fmt::format("; {}: {}", name_of(end.outcome), end.reason);
  const std::string wrong = objection(c, end);
  return wrong.empty() ? text : "**" + wrong + "** " + text;
}

struct Page {
  std::string rows;
  std::size_t cases = 0, packed = 0, short_of = 0, refused = 0, wrong = 0, ends = 0;
  double seconds = 0;
};

void add(Page& page, const Case& row) {
  const Case c = with_offered_line(row);
  std::vector<End> ends;
  for (const WallArithmetic walls : levels_of(c)) ends.push_back(end_of(c, walls));
  const End& end = ends[ends.size() / 2];  // filtered
  ++page.cases;
  page.ends += ends.size();
  ++(!end.refusal.empty() ? page.refused : end.outcome == Outcome::converged ? page.packed : page.short_of);
  std::string times, others;
  for (const End& each : ends) {
    page.seconds += each.seconds;
    times += fmt::format("{}{:.2f}", times.empty() ? "" : " / ", each.seconds);
    if (ending(c, each) != ending(c, end))
      others += fmt::format("; {}: {}", name_of(each.walls), ending(c, each));
    const std::string wrong = objection(c, each);
    if (wrong.empty()) continue;
    ++page.wrong;
    fmt::print(stderr, "{} ({}): {}\n", c.name, name_of(each.walls), wrong);
  }
  page.rows += fmt::format(
      "| {} | {} | {} | {} | {} | {} |\n", c.name, cell(c.why), cell(ending(c, end) + others),
      ratio(end.certificate, end.certificate.max_overlap, end.certificate.worst_pair.has_value()),
      ratio(end.certificate, end.certificate.min_wall_gap, end.certificate.worst_wall.has_value()), times);
}

/// A row a family.
std::string polyhedra(Page& page, const std::string& part) {
  std::string rows;
  for (const Family& family : families_of_polyhedra()) {
    if (family.name.find(part) == std::string::npos) continue;
    std::size_t spheres = 0, packed = 0, short_of = 0;
    double largest_overlap = -1, smallest_gap = 1e300, seconds = 0;
    for (std::uint64_t seed = 0; seed < 125; ++seed) {
      const Case c = case_of(family, seed);
      fmt::print(stderr, "\r\033[K{}\r", c.name);
      const End end = end_of(c, static_cast<WallArithmetic>(seed / 5 % 3));
      const std::string wrong = objection(c, end);
      if (!wrong.empty()) fmt::print(stderr, "{}: {}\n", c.name, wrong), ++page.wrong;
      spheres += end.spheres;
      ++(end.outcome == Outcome::converged ? packed : short_of);
      if (end.certificate.worst_pair)
        largest_overlap = std::max(largest_overlap, end.certificate.max_overlap);
      if (end.certificate.worst_wall) smallest_gap = std::min(smallest_gap, end.certificate.min_wall_gap);
      seconds += end.seconds;
    }
    rows += fmt::format("| {} | {} | 125 | {} | {} | {} | {:.1e} | {:.1e} | {:.1f} |\n", family.name,
                        family.what, packed, short_of, spheres, largest_overlap, smallest_gap, seconds);
  }
  return rows;
}

}  // namespace
}  // namespace bernal::hard

int main(int count, char** arguments) {
  using namespace bernal::hard;
  if (count < 2) return fmt::print(stderr, "hard_table PAGE.md [PART]\n"), 2;
  const std::string part = count > 2 ? arguments[2] : "";
  Page page;
  std::string group;
  for (const Case& c : all_cases()) {
    if (c.name.find(part) == std::string::npos) continue;
    if (c.group != group) {
      group = c.group;
      page.rows += fmt::format(
          "\n## {}\n\n| case | why it is hard | how it ends | largest overlap | smallest gap to a wall | "
          "seconds |\n|---|---|---|--:|--:|--:|\n",
          group);
    }
    fmt::print(stderr, "\r\033[K{} {}\r", page.cases, c.name);
    add(page, c);
  }
  if (const std::string rows = polyhedra(page, part); !rows.empty())
    page.rows +=
        "\n## Random polyhedra\n\n500 seeds; thirty spheres each, by all protocols and at all levels of "
        "arithmetic in turn.\n\n"
        "| family | what | seeds | all placed | fewer, with the reason | spheres | largest overlap | "
        "smallest gap to a wall | seconds |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|--:|\n" +
        rows;
  std::FILE* file = std::fopen(arguments[1], "w");
  if (!file) return fmt::print(stderr, "cannot write {}: {}\n", arguments[1], std::strerror(errno)), 2;
  fmt::print(
      file,
      "# Hard cases\n\n"
      "Written by `tests/hard/table/write`. `ctest -R hard/` tests each row; `ctest --preset slow` tests "
      "also the rows that take long, at every level of arithmetic.\n\n"
      "{} cases. {} end with what was asked for, {} with less and the reason, {} are refused before "
      "anything is packed; "
      "{} end in any other way. A case with walls is packed at each level of arithmetic for walls "
      "(`double`, `filtered`, `exact`): {} runs in all, {:.0f} s on one thread. Every packing is "
      "certified in exact arithmetic, and checked again by a second program of two pages in plain "
      "double precision (`tests/support/plain_check.hpp`).\n\n"
      "The numbers after the count of spheres are packing fractions. *Largest overlap*: (ri + rj - d) "
      "/ (ri + rj) of the worst pair; if it is negative, the spheres are that far apart. *Smallest gap "
      "to a wall*: in radii. The signs of both are decided exactly. —: no two spheres are near each "
      "other, or no sphere is near a wall. *Seconds*: to read, build and run, at the three levels.\n{}",
      page.cases, page.packed, page.short_of, page.refused, page.wrong, page.ends, page.seconds, page.rows);
  std::fclose(file);
  return page.wrong > 0;
}
