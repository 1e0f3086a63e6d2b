#include "settle/slide.hpp"

#include <array>

namespace bernal {
namespace {

/// A leg that keeps less than this of the wanted direction is not worth its length.
constexpr double least_progress = 1e-3;
/// A direction that rounding alone turns into a contact does not point into it.
constexpr double tangent_rounding = 1e-12;
/// Two contacts whose normals enclose a smaller angle (squared sine) hold like one.
constexpr double parallel = 1e-12;
/// An obstacle this near, in radii, counts as a contact: moving up to it first is not worth a leg.
constexpr double contact_gap = 1e-6;
/// More obstacles cannot oppose a sphere that touches them all, unless they are much smaller than it is;
/// beyond that number it is taken as held.
constexpr std::size_t most_contacts = 16;
constexpr int most_legs = 4;

using Normals = std::span<const Vector<3>>;

bool points_into_none(const Vector<3>& d, Normals normals) {
  for (const Vector<3>& n : normals) {
    if (d.dot(n) < -tangent_rounding) return false;
  }
  return true;
}

/// The feasible direction that keeps most of `wanted`: `wanted` itself, its projection onto the plane of one
/// contact, or onto the line of two. Its length is the share that it keeps; zero if the contacts hold it.
Vector<3> part_left_free(const Vector<3>& wanted, Normals normals) {
  if (points_into_none(wanted, normals)) return wanted;
  Vector<3> best = Vector<3>::Zero();
  double longest = least_progress * least_progress;
  const auto offer = [&](const Vector<3>& d) {
    const double squared = d.squaredNorm();
    if (squared <= longest || !points_into_none(d, normals)) return false;
    longest = squared;
    best = d;
    return true;
  };
  bool in_a_plane = false;
  for (const Vector<3>& n : normals) in_a_plane |= offer(wanted - wanted.dot(n) * n);
  if (in_a_plane) return best;
  for (std::size_t a = 1; a < normals.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Vector<3> line = normals[a].cross(normals[b]);
      const double squared = line.squaredNorm();
      if (squared > parallel) offer((wanted.dot(line) / squared) * line);
    }
  }
  return best;
}

}  // namespace

double slide(Mover& mover, Bed::Id i, const Vector<3>& direction, double limit) {
  mover.pick(i);
  std::array<Vector<3>, most_contacts> contacts;
  const Vector<3> start = mover.ball().center;
  std::size_t count = mover.contacts(direction, contact_gap * mover.ball().r + 2 * mover.skin(), contacts);
  for (int leg = 0; leg < most_legs && count < most_contacts; ++leg) {
    const Vector<3> part = part_left_free(direction, Normals(contacts.data(), count));
    const double share = part.norm();
    if (share < least_progress) break;
    const Vector<3> u = part / share;
    const FreePath path = mover.free_path(u, limit);
    mover.advance(u, path.length);
    limit -= path.length;
    if (!path.blocked() || limit <= 0) break;
    contacts[count++] = path.normal;
  }
  return (mover.ball().center - start).norm();
}

}  // namespace bernal
