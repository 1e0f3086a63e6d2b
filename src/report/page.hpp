#pragma once
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "report/report.hpp"

namespace bernal {

/// Text under construction; `add` formats, `raw` does not.
class Page {
 public:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    text_ += fmt::format(format, std::forward<Args>(args)...);
  }
  void raw(std::string_view text) { text_ += text; }

  void card(std::string_view value, std::string_view name, std::string_view what,
            std::string_view style = "") {
    add("<div class=\"card\"><span class=\"dim\">{}</span><b class=\"{}\">{}</b><small>{}</small></div>\n",
        name, style, value, what);
  }
  /// One row of a table of name, value and explanation.
  void row(std::string_view name, std::string_view value, std::string_view what) {
    add("<tr><td>{}</td><td class=\"n\">{}</td><td class=\"dim\">{}</td></tr>\n", name, value, what);
  }
  std::string finish() && { return std::move(text_); }

 private:
  std::string text_;
};

// Sections of report.html.
void write_sizes(Page&, const Report&);
void write_contacts(Page&, const Report&);
void write_chambers(Page&, const Report&);
void write_bed(Page&, const Report&);
void write_walls(Page&, const Report&);
void write_structure(Page&, const Report&);

/// ", of the bed below 24.1 mm", if walls and pores are measured there.
std::string below_level(const Report&);

/// "every sphere rests".
std::string short_rest_text(const Rest&);

}  // namespace bernal
