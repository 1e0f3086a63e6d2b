#pragma once
#include <string>
#include <string_view>

struct Explanation;

/// Lines of at most `width` characters (not bytes), broken at blanks, each after the first behind `indent`
/// blanks; a word longer than that has a line of its own. `column` is where the first line begins.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width = 100,
                    std::size_t column = 0);

/// The end of the help of a command, as a terminal shows it.
std::string explanation_as_text(const Explanation&);
