#include "formats/raw_numbers.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace bernal {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void append_as(std::string_view bytes, bool is_swapped, std::vector<double>& to) {
  to.reserve(to.size() + bytes.size() / sizeof(T));
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    char own[sizeof(T)];
    std::memcpy(own, bytes.data() + at, sizeof(T));
    if (is_swapped) std::reverse(own, own + sizeof(T));
    T value;
    std::memcpy(&value, own, sizeof(T));
    to.push_back(static_cast<double>(value));
  }
}

template <class Byte, class Short, class Word, class Long>
void append_whole(std::string_view bytes, RawNumber how, std::vector<double>& to) {
  switch (how.bytes) {
    case 1:
      return append_as<Byte>(bytes, false, to);
    case 2:
      return append_as<Short>(bytes, how.is_swapped, to);
    case 4:
      return append_as<Word>(bytes, how.is_swapped, to);
    default:
      return append_as<Long>(bytes, how.is_swapped, to);
  }
}

}  // namespace

void append_raw_numbers(std::string_view bytes, RawNumber how, std::vector<double>& to) {
  if (how.kind == 'i')
    return append_whole<std::int8_t, std::int16_t, std::int32_t, std::int64_t>(bytes, how, to);
  if (how.kind == 'u')
    return append_whole<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>(bytes, how, to);
  return how.bytes == 8 ? append_as<double>(bytes, how.is_swapped, to)
                        : append_as<float>(bytes, how.is_swapped, to);
}

}  // namespace bernal
