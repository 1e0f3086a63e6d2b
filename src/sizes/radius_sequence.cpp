#include "bernal/sizes/radius_sequence.hpp"

namespace bernal {

double RadiusSequence::next() {
  if (!first_.empty()) {
    const double r = first_.front();
    first_ = first_.subspan(1);
    return r;
  }
  if (!even_) return sizes_.sample(random_);
  if (!classes_->empty()) return classes_->next(random_);
  constexpr std::uint64_t golden = 0x9E3779B97F4A7C15;  // 2^64 / φ, odd: no two of 2^64 numbers are equal
  const double u = static_cast<double>(next_ >> 11) * 0x1p-53;
  next_ += golden;
  return sizes_.radius_at(std::max(u, 0x1p-54));
}

}  // namespace bernal
