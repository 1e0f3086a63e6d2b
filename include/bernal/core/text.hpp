#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace bernal {

/// The candidate nearest to `name` in edit distance (a letter inserted, left out, replaced or swapped with
/// its neighbour counts one, case does not count), the first of equals; "" when none is near enough to be
/// meant: more than a third of the letters of the longer word differ.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);

/// What to tell who wrote that name: `; did you mean "diameter"?` or, where nothing is near,
/// `; known: "count", "radius"`.
std::string remedy(std::string_view name, std::span<const std::string_view> candidates);

bool is_utf8(std::string_view text);

/// Text that came out of a file, fit for a terminal and a page: valid UTF-8 in one line, without control
/// characters and marks that turn the direction of writing, which become blanks; a byte that is no UTF-8
/// becomes "?". Of more than `most` bytes the middle is left out.
std::string plain_text(std::string_view text, std::size_t most = 500);

/// The text with those characters and marks written as TOML and JSON do: \u202E.
std::string with_escaped_controls(std::string_view text);

/// Without white space at the ends.
std::string_view trimmed(std::string_view text);

/// What a front end calls an option, with its value where a message gives an example: "--unit mm" on a
/// command line, "unit='mm'" in Python. The value is empty where there is none.
using OptionInWords = std::function<std::string(std::string_view name, std::string_view value)>;

/// The message with every option that it names as the front end calls it.
///
/// Messages of the library (errors, notes, what runs tell, words of `import_formats`) name an option between
/// ‹ and ›, by the name of its member or parameter, with a value behind the first "=": "give it, such as
/// ‹unit=mm›". Where there is no name between such marks they stay as they are.
std::string with_options(std::string_view message, const OptionInWords& in_words);

/// Words for people of a packing of so many dimensions: in two its spheres are called discs. What is between
/// quotation marks or in brackets, such as a key, and names of files, such as spheres.csv, stay; a word that
/// stands in a column takes as much room as before.
std::string in_dimension(int dimension, std::string_view text);

/// 28312 as "28,312".
std::string grouped(std::uint64_t n);

}  // namespace bernal
