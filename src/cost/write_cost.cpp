#include "cost/write_cost.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/version.hpp"
#include "cost/verdict.hpp"
#include "report/report_style.hpp"
#include "viewer/html.hpp"

namespace bernal::cost {
namespace {

std::string cell(const std::optional<double>& value) { return value ? fmt::format("{:.6g}", *value) : ""; }
std::string_view yes(bool value) { return value ? "yes" : "no"; }
std::string in_csv_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

/// What the columns of the table are; the same in both pages.
constexpr std::string_view column_names[] = {"front",
                                             "setting",
                                             "packing fraction",
                                             "±",
                                             "seconds",
                                             "wall s",
                                             "overlap before the finish",
                                             "holds from gap",
                                             "contacts / isostatic",
                                             "wall error",
                                             "MB",
                                             "end"};

std::string end_of(const CostReport& report, const CostRow& row) {
  if (row.slower) return "cut off: slower";
  const std::string end = row.certified ? std::string(name_of(row.outcome)) : "not certified";
  const int seeds = report.rows[report.own].runs;
  return row.runs < seeds ? fmt::format("{}; {} of {} seeds", end, row.runs, seeds) : end;
}

/// With the factor of its sizes where they are not as asked.
std::string setting_of_row(const CostRow& row) {
  return row.slower || row.size_scale == 1 ? row.setting
                                           : fmt::format("{} (sizes × {:.6g})", row.setting, row.size_scale);
}

/// What `bernal pack recommended.toml` states, and what of it counts here.
std::string packed(const CostRow& row) {
  const std::string stated = fmt::format("{:.6f}", row.packed_phi);
  const std::string counted = fmt::format("{:.6f}", row.own_phi);
  if (stated == counted) return stated;
  return fmt::format("{} ({} as it counts here, strict and at the sizes asked for)", stated, counted);
}

/// Text as it is in Markdown, which knows HTML, too.
std::string in_markdown(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("\\`*[]|").find(c) != std::string_view::npos) out += '\\';
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string_view(&c, 1);
  }
  return out;
}

std::vector<std::string> cells_of_row(const CostReport& report, std::size_t k) {
  const CostRow& row = report.rows[k];
  const std::vector<std::size_t> front = front_rows(report);
  const auto place = std::ranges::find(front, k);
  std::string number = place == front.end() ? "" : fmt::format("{}", place - front.begin() + 1);
  if (row.pareto_contacts) number += number.empty() ? "c" : " c";
  if (row.slower)
    return {number, setting_of_row(row), "", "", fmt::format("> {:.3g}", row.seconds), "", "", "", "", "",
            "",     end_of(report, row)};
  return {number,
          setting_of_row(row),
          fmt::format("{:.4f}", row.phi),
          fmt::format("{:.4f}", row.phi_scatter),
          fmt::format("{:.3g}", row.seconds),
          fmt::format("{:.3g}", row.wall_seconds),
          row.early_overlap > 0 ? fmt::format("{:.1e}", row.early_overlap) : "",
          row.held_from ? fmt::format("{:g}", *row.held_from) : "",
          row.contact_ratio ? fmt::format("{:.3f}", *row.contact_ratio) : "",
          row.wall_error > 0 ? fmt::format("{:.2g}", row.wall_error) : "0",
          row.memory_bytes ? fmt::format("{:.0f}", std::ceil(1e-6 * *row.memory_bytes)) : "",
          end_of(report, row)};
}

/// Fronts, single keys and the scene as it is: the others are in cost.csv.
std::vector<std::size_t> rows_to_show(const CostReport& report) {
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const CostRow& row = report.rows[k];
    if (row.pareto || row.pareto_contacts || row.changed.size() < 2 || k == report.recommended)
      shown.push_back(k);
  }
  return shown;
}

/// How it was measured, and what the words mean, in sentences.
std::vector<std::string> explanations(const CostReport& report, const CostHeading& heading) {
  const std::size_t runs = report.runs_made + report.runs_kept;
  return {
      fmt::format(
          "{} settings, {} runs of {} seed{} each ({} of them in this call), {}, bernal {}. Seconds are "
          "those of the processor, of all threads together, without reading files; wall s beside them. "
          "Medians over the seeds; ± is half of what lies between the least and the greatest.{}",
          report.rows.size(), runs, heading.seeds, heading.seeds == 1 ? "" : "s", report.runs_made,
          heading.machine, text_of(this_program()), fmt::format(" The end: {}.", report.ending)),
      fmt::format(
          "Shown are the fronts and what changes one key; all {} settings are in cost.csv. Numbers "
          "mark the front: in the order of seconds each is denser than the one before it by more than "
          "{:.2g}{}. c marks the second front: contacts closed further than in the one before it. What "
          "gives the same spheres as another setting with fewer changes is on neither.",
          report.rows.size(), report.phi_step,
          report.rows[report.own].runs == 1
              ? "; with one seed nothing is known of how seeds differ"
              : fmt::format(", the standard error of what the median setting differs from the scene by, "
                            "with the same {} seeds",
                            report.rows[report.own].runs)),
      "The packing fraction is strict: of the spheres shrunk by the largest overlap that is left, at the "
      "sizes "
      "that are asked for (a row says by what factor all of them are larger), and of the "
      "volume of the scene's own container. Holds from gap: the smallest gap, in sums of two radii, at which "
      "contacts hold half of the spheres or more; contacts / isostatic counts them there. Wall error: how "
      "far "
      "the wall that was used may lie from the exact one, or a sphere sticks out of it, in mean radii."};
}

}  // namespace

std::string cost_csv(const CostReport& report) {
  std::string csv =
      "setting,phi,phi_scatter,seconds,seconds_scatter,largest_overlap,pareto,pareto_contacts,recommended,"
      "overlap_left,held_from,contacts_over_isostatic,coordination,wall_error,memory_bytes,spheres,wall_"
      "seconds,"
      "prepare_seconds,runs,outcome,slower,certified,hash,phi_first_seed,seconds_first_seed,size_scale,"
      "packed_phi_first_seed,phi_change,phi_change_error,same_as_another,phi_step,reason\n";
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const CostRow& r = report.rows[k];
    csv += fmt::format(
        "{},{:.8f},{:.8f},{:.6g},{:.6g},{:.6g},{},{},{},{:.6g},{},{},{:.6g},{:.6g},{},{},{:.6g},{:.6g},{},{},"
        "{},{},"
        "{},{:.8f},{:.6g},{:.10g},{:.8f},{:.8f},{},{},{:.3g},{}\n",
        in_csv_quotes(r.setting), r.phi, r.phi_scatter, r.seconds, r.seconds_scatter, r.early_overlap,
        yes(r.pareto), yes(r.pareto_contacts), yes(k == report.recommended), r.max_overlap, cell(r.held_from),
        cell(r.contact_ratio), r.coordination, r.wall_error, cell(r.memory_bytes), r.spheres, r.wall_seconds,
        r.prepare_seconds, r.runs, name_of(r.outcome), yes(r.slower), yes(r.certified), r.hash, r.own_phi,
        r.own_seconds, r.size_scale, r.packed_phi, r.phi_change, cell(r.phi_change_error), yes(r.is_repeat),
        report.phi_step, in_csv_quotes(plain_text(r.reason)));
  }
  return csv;
}

std::string cost_md(const CostReport& report, const CostHeading& heading) {
  std::string text = fmt::format("# What accuracy costs: {}\n\n**{}**\n\n![front](cost.svg)\n\n",
                                 in_markdown(heading.scene), in_markdown(report.recommendation));
  text += "## What each key buys for this scene\n\n";
  for (const std::string& verdict : report.verdicts) text += fmt::format("- {}\n", in_markdown(verdict));
  if (!report.refused.empty()) text += "\n## Refused\n\n";
  for (const std::string& refused : report.refused) text += fmt::format("- {}\n", in_markdown(refused));
  text += "\n## Measured\n\n";
  for (const std::string& sentence : explanations(report, heading)) text += sentence + "\n\n";
  const auto line = [&](const auto& cells) {
    for (const auto& c : cells) text += fmt::format("| {} ", c);
    text += "|\n";
  };
  line(column_names);
  text += "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n";
  for (const std::size_t k : rows_to_show(report)) {
    std::vector<std::string> cells = cells_of_row(report, k);
    if (k == report.recommended) cells[1] = fmt::format("**{}** (recommended)", cells[1]);
    line(cells);
  }
  text += fmt::format(
      "\n## The recommendation, to paste\n\nAlso in recommended.toml. `bernal pack recommended.toml` gives "
      "packing "
      "fraction {}, spheres of hash {}, in about {}.\n\n```toml\n{}```\n",
      packed(report.rows[report.recommended]), report.rows[report.recommended].hash,
      seconds_in_words(report.rows[report.recommended].wall_seconds), report.toml);
  return text;
}

std::string cost_html(const CostReport& report, const CostHeading& heading, std::string_view picture) {
  const CostRow &chosen = report.rows[report.recommended], &own = report.rows[report.own];
  Page page;
  page.add(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\">\n<title>What accuracy costs: {}</title>\n<style>",
      escaped(heading.scene));
  page.raw(report_style);
  page.add(
      "</style></head>\n<body><main>\n<h1>What accuracy costs: {}</h1>\n<span class=\"dim\">measured by "
      "bernal {}"
      "</span>\n<div class=\"cards\">\n",
      escaped(heading.scene), escaped(text_of(this_program())));
  page.card(fmt::format("{:.4f}", chosen.phi), "Recommended: packing fraction",
            fmt::format("{:.4f} as the scene is", own.phi));
  page.card(seconds_in_words(chosen.seconds), "Recommended: processor time",
            fmt::format("{} as the scene is", seconds_in_words(own.seconds)));
  page.card(fmt::format("{}", front_rows(report).size()), "Settings on the front",
            fmt::format("of {} that were measured", report.rows.size()));
  page.card(chosen.memory_bytes ? fmt::format("{:.0f} MB", std::ceil(1e-6 * *chosen.memory_bytes)) : "?",
            "Recommended: memory", "at the peak of the run");
  if (chosen.outcome != Outcome::converged)
    page.card(name_of(chosen.outcome), "Recommended: does not reach what is asked for",
              escaped(plain_text(chosen.reason)), "no");
  page.add("</div>\n<p class=\"statement\">{}</p>\n<div class=\"picture\">\n",
           escaped(report.recommendation));
  page.raw(picture);
  page.raw("</div>\n<h2>What each key buys for this scene</h2>\n<ul>\n");
  for (const std::string& verdict : report.verdicts) page.add("<li>{}</li>\n", escaped(verdict));
  if (!report.refused.empty()) page.raw("</ul>\n<h2>Refused</h2>\n<ul>\n");
  for (const std::string& refused : report.refused) page.add("<li>{}</li>\n", escaped(refused));
  page.raw("</ul>\n<h2>Measured</h2>\n");
  for (const std::string& sentence : explanations(report, heading))
    page.add("<p class=\"dim\">{}</p>\n", escaped(sentence));
  page.raw("<div class=\"wide\"><table>\n<tr>");
  for (const std::string_view name : column_names) page.add("<th>{}</th>", name);
  page.raw("</tr>\n");
  for (const std::size_t k : rows_to_show(report)) {
    const std::vector<std::string> cells = cells_of_row(report, k);
    page.raw("<tr>");
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const bool is_text = c == 1 || c + 1 == cells.size();
      page.add("<td{}>{}{}</td>", is_text ? "" : " class=\"n\"", escaped(cells[c]),
               c == 1 && k == report.recommended ? " <b class=\"yes\">recommended</b>" : "");
    }
    page.raw("</tr>\n");
  }
  page.add(
      "</table></div>\n<h2>The recommendation, to paste</h2>\n<p>Also in <code>recommended.toml</code>. "
      "<code>bernal pack recommended.toml</code> gives packing fraction {} and spheres of hash "
      "<code>{}</code>.</p>\n<pre>{}</pre>\n</main></body></html>\n",
      packed(chosen), chosen.hash, escaped(report.toml));
  return std::move(page).finish();
}

}  // namespace bernal::cost
