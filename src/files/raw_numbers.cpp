#include "files/raw_numbers.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace bernal {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
double value_of(const char* bytes, bool is_swapped) {
  char own[sizeof(T)];
  std::memcpy(own, bytes, sizeof own);
  if (is_swapped) std::reverse(own, own + sizeof own);
  return static_cast<double>(std::bit_cast<T>(own));
}

}  // namespace

double raw_number(const char* bytes, RawNumber how) {
  const auto whole = [&]<class Signed, class Unsigned>(Signed, Unsigned) {
    return how.kind == 'i' ? value_of<Signed>(bytes, how.is_swapped)
                           : value_of<Unsigned>(bytes, how.is_swapped);
  };
  if (how.kind == 'f')
    return how.bytes == 8 ? value_of<double>(bytes, how.is_swapped)
                          : value_of<float>(bytes, how.is_swapped);
  switch (how.bytes) {
    case 1:
      return whole(std::int8_t{}, std::uint8_t{});
    case 2:
      return whole(std::int16_t{}, std::uint16_t{});
    case 4:
      return whole(std::int32_t{}, std::uint32_t{});
    default:
      return whole(std::int64_t{}, std::uint64_t{});
  }
}

void append_raw_numbers(std::string_view bytes, RawNumber how, std::vector<double>& to) {
  const auto width = static_cast<std::size_t>(how.bytes);
  to.reserve(to.size() + bytes.size() / width);
  for (std::size_t at = 0; at + width <= bytes.size(); at += width)
    to.push_back(raw_number(bytes.data() + at, how));
}

}  // namespace bernal
