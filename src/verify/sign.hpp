#pragma once
#include <cstdint>

namespace bernal::verify {

/// The sign of a number as an arithmetic knows it. Exact arithmetic never returns `unknown`.
enum class Sign : std::int8_t { negative = -1, zero = 0, positive = 1, unknown = 2 };

constexpr Sign operator-(Sign s) { return s == Sign::unknown ? s : static_cast<Sign>(-static_cast<int>(s)); }

/// Kleene's three-valued logic: a conjunction with a certain `no` is `no` whatever its other operand is, so a
/// predicate can be certain although some of its comparisons are not.
enum class Truth : std::int8_t { no = -1, unknown = 0, yes = 1 };

constexpr Truth operator!(Truth a) { return static_cast<Truth>(-static_cast<int>(a)); }
constexpr Truth operator&(Truth a, Truth b) { return a < b ? a : b; }
constexpr Truth operator|(Truth a, Truth b) { return a < b ? b : a; }

constexpr Truth truth(bool certain) { return certain ? Truth::yes : Truth::no; }

constexpr Truth is_negative(Sign s) {
  return s == Sign::unknown ? Truth::unknown : truth(s == Sign::negative);
}
constexpr Truth is_positive(Sign s) { return is_negative(-s); }

/// a >= b and a > b for any arithmetic.
template <class Number>
Truth at_least(const Number& a, const Number& b) {
  return !is_negative((a - b).sign());
}
template <class Number>
Truth more_than(const Number& a, const Number& b) {
  return is_positive((a - b).sign());
}

}  // namespace bernal::verify
