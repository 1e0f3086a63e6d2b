#pragma once
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace bernal {

/// Text made safe inside HTML elements and quoted attributes.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    constexpr std::string_view unsafe = "&<>\"", names[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
    const std::size_t k = unsafe.find(c);
    out += k == unsafe.npos ? std::string_view(&c, 1) : names[k];
  }
  return out;
}

/// Text that grows; `add` formats, `raw` does not.
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

}  // namespace bernal
