#pragma once
#include <string_view>
#include <vector>

namespace bernal {

/// How a number lies in a file: floating point 'f' of 4 or 8 bytes, whole with a sign 'i' or without 'u' of
/// 1, 2, 4 or 8; least byte first, or swapped.
struct RawNumber {
  char kind = 'f';
  int bytes = 8;
  bool is_swapped = false;

  bool is_known() const {
    const bool is_long = bytes == 4 || bytes == 8;
    return kind == 'f' ? is_long : (kind == 'i' || kind == 'u') && (is_long || bytes == 1 || bytes == 2);
  }
};

/// The number that begins there. Precondition: a known kind, as many bytes as it has.
double raw_number(const char* bytes, RawNumber how);
/// Appends the numbers whose bytes these are; a part of one at the end is left out.
void append_raw_numbers(std::string_view bytes, RawNumber how, std::vector<double>& to);

}  // namespace bernal
