#include "settle/steepest_way.hpp"

#include <algorithm>

#include <Eigen/QR>

namespace bernal {
namespace {

/// What a way along a contact may lead into it by rounding; how far it has to lead away from one that bends.
constexpr double into = 1e-12, away = 1e-6;
constexpr int most_rounds = 64;

/// The contacts that push, and how much.
class Pushes {
 public:
  explicit Pushes(const Vector<3>& down) : down_(down) {}

  int count() const { return count_; }
  std::size_t contact(int k) const { return contacts_[static_cast<std::size_t>(k)]; }
  bool has(std::size_t contact) const {
    return std::find(contacts_.begin(), contacts_.begin() + count_, contact) != contacts_.begin() + count_;
  }
  Vector<3> way() const { return down_ + normals_.leftCols(count_) * pushes_.head(count_); }

  /// Precondition: fewer than three push.
  void add(std::size_t contact, const Vector<3>& normal) {
    contacts_[static_cast<std::size_t>(count_)] = contact;
    normals_.col(count_) = normal;
    pushes_[count_++] = 0;
    while (count_ > 0) {
      const Few wanted = normals_.leftCols(count_).colPivHouseholderQr().solve(-down_);
      const auto [first, share] = first_to_end(wanted);
      pushes_.head(count_) += share * (wanted - pushes_.head(count_));
      if (first == count_) return;
      remove(first);
    }
  }

 private:
  using Few = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;

  /// Which of the pushes becomes 0 first on the way to those wanted, and after which share of it.
  std::pair<int, double> first_to_end(const Few& wanted) const {
    int first = count_;
    double share = 1;
    for (int k = 0; k < count_; ++k) {
      if (wanted[k] > 0) continue;
      const double until = pushes_[k] > 0 ? pushes_[k] / (pushes_[k] - wanted[k]) : 0;
      if (first < count_ && until >= share) continue;
      first = k;
      share = until;
    }
    return {first, share};
  }

  void remove(int k) {
    for (--count_; k < count_; ++k) {
      contacts_[static_cast<std::size_t>(k)] = contacts_[static_cast<std::size_t>(k) + 1];
      normals_.col(k) = Vector<3>(normals_.col(k + 1));
      pushes_[k] = pushes_[k + 1];
    }
  }

  Vector<3> down_;
  std::array<std::size_t, 3> contacts_{};
  Eigen::Matrix3d normals_ = Eigen::Matrix3d::Zero();
  Vector<3> pushes_ = Vector<3>::Zero();
  int count_ = 0;
};

}  // namespace

SteepestWay steepest_way(const Vector<3>& down, std::span<const Vector<3>> normals, std::size_t bent) {
  Pushes pushes(down);
  SteepestWay found{.way = down};
  for (int round = 0; round < most_rounds; ++round) {
    double worst = -into;
    std::size_t next = SteepestWay::none;
    for (std::size_t c = 0; c < normals.size(); ++c) {
      const double along = normals[c].dot(found.way) - (c == bent ? away * found.way.norm() : 0);
      if (along >= worst || pushes.has(c)) continue;
      worst = along;
      next = c;
    }
    if (next == SteepestWay::none) break;
    if (pushes.count() == 3) {  // three hold it, up to rounding
      found.way = Vector<3>::Zero();
      break;
    }
    pushes.add(next, normals[next]);
    found.way = pushes.way();
  }
  found.count = pushes.count();
  for (int k = 0; k < found.count; ++k) found.held_by[static_cast<std::size_t>(k)] = pushes.contact(k);
  if (found.count == 3) found.way = Vector<3>::Zero();
  return found;
}

}  // namespace bernal
