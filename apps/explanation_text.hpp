#pragma once
#include <string>
#include <string_view>

struct Explanation;

/// The text in lines of at most `width` characters (not bytes), broken at blanks; a longer word has a line of
/// its own. The first line begins in `column`, the others behind `indent` blanks.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width = 100,
                    std::size_t column = 0);

/// The end of the help of a command, as a terminal shows it.
std::string explanation_as_text(const Explanation&);
