#include "meshes/neck_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bernal {

using std::numbers::pi;

std::array<double, 2> NeckShape::turns() const {
  const auto turn = [&](double height, double rim) { return std::atan2(height - waist, spine() - rim); };
  return {turn(begin, rims[0]), turn(end, rims[1])};
}

NeckShape::Ring NeckShape::ring(double share) const {
  if (!is_fillet()) return {begin + share * (end - begin), radius};
  const auto [from, to] = turns();
  const double turn = from + share * (to - from);
  return {waist + tube * std::sin(turn), spine() - tube * std::cos(turn)};
}

double NeckShape::length() const {
  if (!is_fillet()) return end - begin;
  const auto [from, to] = turns();
  return tube * (to - from);
}

double NeckShape::volume() const {
  if (!is_fillet()) return pi * radius * radius * (end - begin);
  // The integral of π (s - t cos u)² t cos u du.
  const double s = spine(), t = tube;
  const auto up_to = [&](double u) {
    const double sine = std::sin(u);
    return pi * t *
           (s * s * sine - s * t * (u + sine * std::cos(u)) + t * t * (sine - sine * sine * sine / 3));
  };
  const auto [from, to] = turns();
  return up_to(to) - up_to(from);
}

NeckShape cylinder_between(const NeckEnds& ends, double radius) {
  const auto depth = [&](double r) { return std::sqrt(r * r - radius * radius); };
  NeckShape shape{.radius = radius, .rims = {radius, radius}};
  shape.begin = depth(ends.first);
  shape.end = ends.distance - (ends.second ? depth(*ends.second) : 0.0);
  return shape;
}

NeckShape fillet_between(const NeckEnds& ends, double radius) {
  const double r = ends.first, d = ends.distance, w = radius;
  NeckShape shape{.radius = w};
  if (ends.second) {
    // waist = a + b t, put into the first equation: b² t² - 2 p t + q = 0.
    const double other = *ends.second, gap = d - r - other;
    const double a = r + gap * (d - r + other) / (2 * d), b = (r - other) / d;
    const double p = r - w - a * b, q = (a - r) * (a + r) + w * w;
    shape.tube = q / (p + std::sqrt(p * p - b * b * q));
    shape.waist = a + b * shape.tube;
  } else {
    const double p = d + r - w, q = (d - r) * (d + r) + w * w;
    shape.tube = q / (p + std::sqrt(p * p - q));
    shape.waist = d - shape.tube;
  }
  const double s = shape.spine(), share = r / (r + shape.tube);
  shape.begin = share * shape.waist;
  shape.rims[0] = share * s;
  shape.end = d;
  shape.rims[1] = s;
  if (ends.second) {
    const double share_of_other = *ends.second / (*ends.second + shape.tube);
    shape.end -= share_of_other * (d - shape.waist);
    shape.rims[1] *= share_of_other;
  }
  return shape;
}

double radius_for_angle(const NeckEnds& ends, double degrees, bool is_fillet) {
  const double angle = degrees * pi / 180, d = ends.distance;
  double larger = ends.first, smaller = ends.second.value_or(larger);
  if (larger < smaller) std::swap(larger, smaller);
  double radius = larger * std::sin(angle);
  if (is_fillet) {
    const double c = std::cos(angle);
    const double tube = ends.second ? ((d - smaller) * (d + smaller) + larger * (larger - 2 * d * c)) /
                                          (2 * (smaller - larger + d * c))
                                    : (d - larger * c) / (1 + c);
    radius = (larger + tube) * std::sin(angle) - tube;
  }
  return std::clamp(radius, (is_fillet ? 0.1 : 0.05) * smaller, 0.7 * smaller);
}

double radius_for_rim(const NeckEnds& ends, std::size_t end, double rim, double radius) {
  const auto fits = [&](double w) { return fillet_between(ends, w).rims[end] <= rim; };
  if (fits(radius)) return radius;
  double from = 0, to = radius;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (from + to);
    (fits(middle) ? from : to) = middle;
  }
  return from;
}

}  // namespace bernal
