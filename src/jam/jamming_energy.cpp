#include "jam/jamming_energy.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include <Eigen/Cholesky>

#include "bernal/core/boundary.hpp"
#include "core/every_dimension.hpp"
#include "jam/spatial_order.hpp"

namespace bernal {
namespace {

/// Of the pair lists, in smallest radii: pairs are found anew when spheres have moved that far.
constexpr double skin = 0.3;
/// Where the smoothed force is cut off: gap in units of the smoothing, and as a ratio at most.
constexpr double cutoff = 30;
constexpr double widest = 0.1;
/// Of a sphere's block of the preconditioner: what is added in all directions, in stiffnesses of a contact
/// with a sphere of its size.
constexpr double least_stiffness = 1;
/// Between walls: how far a sphere moves at most at a time, in its radii. Its centre is farther from them.
constexpr double longest_move = 0.5;
/// How much the box shrinks at most at a time; and, between walls, in all: nothing would be left of it else.
constexpr double most_shrinkage = 0.5, smallest_scale = 0.5;

/// s^(D - 2)
template <int D>
double stiffness_of(double s) {
  if constexpr (D == 1) return 1 / s;
  double k = 1;
  for (int i = 2; i < D; ++i) k *= s;
  return k;
}

/// The smoothed overlap x, x (x - o) = t²; t > 0.
double smoothed(double overlap, double t) {
  const double root = std::sqrt(overlap * overlap + 4 * t * t);
  return overlap > 0 ? 0.5 * (overlap + root) : 2 * t * t / (root - overlap);
}

/// The components of sphere i in a vector of all.
template <int D>
Eigen::Map<Vector<D>> part(Eigen::VectorXd& v, std::size_t i) {
  return Eigen::Map<Vector<D>>(v.data() + D * i);
}
template <int D>
Eigen::Map<const Vector<D>> part(const Eigen::VectorXd& v, std::size_t i) {
  return Eigen::Map<const Vector<D>>(v.data() + D * i);
}

/// Inverts a symmetric positive definite matrix of n rows in place, 1 <= n <= 8, by its Cholesky factors. It
/// knows n only when it runs: Eigen's factorisation for a size known beforehand takes the compiler seconds
/// for each size, and gives the same numbers.
void invert_positive_definite(double* matrix, int n) {
  if (n == 1) {  // Eigen would multiply by the reciprocal of the root
    const double root = std::sqrt(*matrix);
    *matrix = 1 / root / root;
    return;
  }
  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 8, 8>;
  Eigen::Map<Block> block(matrix, n, n);
  block = block.llt().solve(Block::Identity(n, n)).eval();
}

}  // namespace

template <int D>
JammingEnergy<D>::JammingEnergy(const Spheres<D>& spheres, const Vector<D>& edges,
                                std::shared_ptr<const Enclosure<D>> enclosure)
    : order_(spatial_order(spheres, edges)), enclosure_(std::move(enclosure)) {
  state_.centers.resize(static_cast<Eigen::Index>(D * spheres.size()));
  state_.edges = edges;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    radius_.push_back(spheres.r[order_[i]]);
    part<D>(state_.centers, i) = spheres.center(order_[i]);
    load_per_overlap_ += D * std::pow(2 * radius_[i], D);
  }
  least_radius_ = std::ranges::min(radius_);
  largest_radius_ = std::ranges::max(radius_);
}

template <int D>
void JammingEnergy<D>::set_level(double overlap, double smoothing) {
  load_ = overlap * load_per_overlap_;
  smoothing_ = smoothing;
  if (!held_) find_pairs();
  evaluate();
}

/// Ratio of gap to s up to which two spheres feel each other.
template <int D>
double JammingEnergy<D>::width() const {
  return std::min(cutoff * smoothing_, widest);
}

/// Whether every pair that feels each other is among the pairs: what was d apart when they were found is at
/// least scale · d - 2 · way apart now.
template <int D>
bool JammingEnergy<D>::pairs_are_complete() const {
  if (held_) return true;
  const double scale = state_.edges[0] / at_finding_.edges[0];
  double squared = 0;
  for (std::size_t i = 0; i < size(); ++i)
    squared = std::max(squared,
                       (part<D>(state_.centers, i) - scale * part<D>(at_finding_.centers, i)).squaredNorm());
  const double slack = scale * (1 + width_at_finding_) - (1 + width());
  const double s = 2 * (slack < 0 ? largest_radius_ : least_radius_);
  return 2 * std::sqrt(squared) <= scale * skin * least_radius_ + slack * s;
}

template <int D>
void JammingEnergy<D>::find_pairs() {
  width_at_finding_ = width();
  at_finding_ = state_;
  pairs_.find(state_.centers.data(), radius_, state_.edges, width_at_finding_, skin * least_radius_);
  if (enclosure_) find_walls();
}

template <int D>
void JammingEnergy<D>::find_walls() {
  const auto found = std::make_shared<NearWalls<D>>();
  for (std::size_t i = 0; i < size(); ++i)
    found->add_near(*enclosure_, part<D>(state_.centers, i) / state_.scale,
                    ((1 + width_at_finding_) * radius_[i] + skin * least_radius_) / state_.scale);
  near_walls_ = found;
}

template <int D>
void JammingEnergy<D>::hold(const std::vector<char>& bears) {
  pairs_.keep_if([&](const typename PeriodicPairs<D>::Pair& pair) {
    const double s = radius_[pair.first] + radius_[pair.second];
    return bears[pair.first] && bears[pair.second] && away_of(pair).squaredNorm() < s * s;
  });
  if (enclosure_) hold_walls(bears);
  held_ = true;
  evaluate();
}

template <int D>
void JammingEnergy<D>::hold_walls(const std::vector<char>& bears) {
  const auto held = std::make_shared<NearWalls<D>>();
  for (std::size_t i = 0; i < size(); ++i) {
    const auto near = near_walls_->of(i);
    held->add_touching(near.first(bears[i] ? near.size() : 0), part<D>(state_.centers, i) / state_.scale,
                       radius_[i] / state_.scale, enclosure_->same_place());
  }
  near_walls_ = held;
}

template <int D>
void JammingEnergy<D>::let_go(std::size_t contact) {
  const std::size_t pairs = pairs_.pairs().size();
  if (contact < pairs) {
    pairs_.erase(contact);
    return evaluate();
  }
  const auto fewer = std::make_shared<NearWalls<D>>(*near_walls_);
  fewer->erase(contact - pairs);
  near_walls_ = fewer;
  evaluate();
}

/// From the second to the first.
template <int D>
Vector<D> JammingEnergy<D>::away_of(const typename PeriodicPairs<D>::Pair& pair) const {
  return part<D>(state_.centers, pair.first) - part<D>(state_.centers, pair.second) -
         pairs_.images()[pair.image].cwiseProduct(state_.edges);
}

template <int D>
void JammingEnergy<D>::evaluate() {
  now_.contacts.clear();
  now_.bends.clear();
  now_.gradient.setZero(unknowns());
  now_.energy = now_.elastic = now_.largest_overlap = 0;
  const double reach = 1 + width();
  for (const auto& pair : pairs_.pairs()) {
    if (is_fixed(pair.first) && is_fixed(pair.second)) continue;
    const Vector<D> away = away_of(pair);
    const double most = reach * (radius_[pair.first] + radius_[pair.second]);
    if (held_ || away.squaredNorm() < most * most) meet(pair.first, pair.second, away);
  }
  if (enclosure_) meet_walls();
  double virial = 0;
  for (const Contact& c : now_.contacts) {
    const double force = c.tension * c.distance;
    part<D>(now_.gradient, c.first) -= force * c.normal;
    if (c.is_pair()) part<D>(now_.gradient, c.second) += force * c.normal;
    virial += force * c.distance;
  }
  now_.gradient[unknowns() - 1] = load_ - virial;
  still(now_.gradient);
}

/// Leaves of a motion or a gradient what is not fixed.
template <int D>
void JammingEnergy<D>::still(Eigen::VectorXd& v) const {
  if (fixed_.empty()) return;
  for (std::size_t i = 0; i < size(); ++i)
    if (fixed_[i]) part<D>(v, i).setZero();
  v[unknowns() - 1] = 0;
}

template <int D>
void JammingEnergy<D>::meet(std::uint32_t first, std::uint32_t second, const Vector<D>& away) {
  const double s = radius_[first] + radius_[second], d = away.norm();
  if (!(d > 0)) return;  // coincident centres push in no direction
  const double overlap = s - d;
  const Spring spring = press(s, overlap, stiffness_of<D>(s));
  now_.contacts.push_back({away / d, spring.stiffness, spring.force / d, d, first, second});
}

/// A spring of that stiffness where nothing is smoothed. Adds it to the energies.
template <int D>
typename JammingEnergy<D>::Spring JammingEnergy<D>::press(double s, double overlap, double k) {
  const double t = smoothing_ * s;
  double x = overlap, stiffness = k;
  if (t > 0) {
    const double range = width() * s, most = smoothed(overlap, t), least = smoothed(-range, t);
    x = most - least;
    stiffness = k * most * most / (most * most + t * t);
    now_.energy += k * (0.5 * (most * most - least * least) + t * t * std::log(most / least) -
                        least * (overlap + range));
  } else {
    now_.energy += 0.5 * k * x * x;
  }
  now_.elastic += 0.5 * k * x * x;
  now_.largest_overlap = std::max(now_.largest_overlap, overlap / s);
  return {k * x, stiffness};
}

template <int D>
void JammingEnergy<D>::meet_walls() {
  const double reach = 1 + width();
  for (std::uint32_t i = 0; i < size(); ++i) {
    const auto walls = near_walls_->of(i);
    if (walls.empty() || is_fixed(i)) continue;
    const std::size_t first = now_.contacts.size();
    const Vector<D> p = part<D>(state_.centers, i) / state_.scale;
    const double moved = (p - part<D>(at_finding_.centers, i) / at_finding_.scale).norm();
    for (const NearPiece<D>& near : walls)
      if (held_ || state_.scale * (near.distance - moved) < reach * radius_[i]) meet_wall(i, p, near, first);
  }
}

/// `first`: the first contact of the sphere with walls.
template <int D>
void JammingEnergy<D>::meet_wall(std::uint32_t i, const Vector<D>& p, const NearPiece<D>& near,
                                 std::size_t first) {
  const WallView<D> view = view_of<D>(near.piece, p);
  const double s = radius_[i], d = state_.scale * view.distance;
  if (!(d > 0) || (!held_ && !(d < (1 + width()) * s))) return;
  const Spring spring = press(s, s - d, 2 * near.weight * stiffness_of<D>(2 * s));
  for (std::size_t c = first; c < now_.contacts.size() && !held_; ++c) {
    Contact& other = now_.contacts[c];
    const Vector<D> apart = other.distance * other.normal - d * view.normal;
    if (apart.norm() > state_.scale * enclosure_->same_place()) continue;
    other.stiffness += spring.stiffness;
    other.tension += spring.force / d;
    return;
  }
  now_.contacts.push_back({view.normal, spring.stiffness, spring.force / d, d, i, wall});
  now_.bends.push_back(bend_of<D>(near.piece, p, view));
}

template <int D>
void JammingEnergy<D>::hessian_times(const Eigen::VectorXd& v, Eigen::VectorXd& out) const {
  out.setZero();
  const double* in = v.data();
  double* result = out.data();
  const double dilation = v[unknowns() - 1];
  double sum = 0;
  const std::size_t pairs = now_.contacts.size() - now_.bends.size();
  for (const Contact& c : std::span(now_.contacts).first(pairs)) {
    const double* a = in + D * std::size_t{c.first};
    const double* b = in + D * std::size_t{c.second};
    Vector<D> w;
    double along = 0;
    for (int k = 0; k < D; ++k) {
      w[k] = a[k] - b[k];
      along += c.normal[k] * w[k];
    }
    const double spring = c.stiffness * (along + dilation * c.distance);
    sum += spring * c.distance;
    const double normal_part = spring + c.tension * along;
    double* to_a = result + D * std::size_t{c.first};
    double* to_b = result + D * std::size_t{c.second};
    for (int k = 0; k < D; ++k) {
      const double h = normal_part * c.normal[k] - c.tension * w[k];
      to_a[k] += h;
      to_b[k] -= h;
    }
  }
  for (std::size_t k = 0; k < now_.bends.size(); ++k) {
    const Contact& c = now_.contacts[pairs + k];
    const Vector<D> w = part<D>(v, c.first);
    const double spring = c.stiffness * (c.normal.dot(w) + dilation * c.distance);
    sum += spring * c.distance;
    part<D>(out, c.first) += spring * c.normal - c.tension * (now_.bends[k] * w);
  }
  out[unknowns() - 1] = sum - load_ * dilation;
  still(out);
}

template <int D>
void JammingEnergy<D>::factor_preconditioner() {
  inverse_blocks_.resize(size());
  for (std::size_t i = 0; i < size(); ++i) {
    inverse_blocks_[i].setZero();
    inverse_blocks_[i].diagonal().setConstant(least_stiffness * stiffness_of<D>(2 * radius_[i]));
  }
  double dilation = 1e-3 * load_per_overlap_;
  for (const Contact& c : now_.contacts) {
    dilation += c.stiffness * c.distance * c.distance;
    if (c.first == c.second) continue;
    for (int k = 0; k < D; ++k)
      for (int l = 0; l < D; ++l) {
        const double stiffness = c.stiffness * c.normal[l] * c.normal[k];
        inverse_blocks_[c.first](l, k) += stiffness;
        if (c.is_pair()) inverse_blocks_[c.second](l, k) += stiffness;
      }
  }
  for (Block& block : inverse_blocks_) invert_positive_definite(block.data(), D);
  inverse_dilation_ = 1 / dilation;
}

template <int D>
void JammingEnergy<D>::precondition(const Eigen::VectorXd& v, Eigen::VectorXd& out) const {
  for (std::size_t i = 0; i < size(); ++i) part<D>(out, i).noalias() = inverse_blocks_[i] * part<D>(v, i);
  out[unknowns() - 1] = inverse_dilation_ * v[unknowns() - 1];
}

template <int D>
double JammingEnergy<D>::move(const Eigen::VectorXd& motion) {
  state_before_ = state_;
  std::swap(before_, now_);
  const double e = motion[unknowns() - 1];
  state_.centers = (1 + e) * (state_.centers + motion.head(unknowns() - 1));
  state_.edges *= 1 + e;
  state_.scale *= 1 + e;
  if (!(e > -most_shrinkage) || (enclosure_ && (state_.scale < smallest_scale || moves_too_far(motion))))
    return std::numeric_limits<double>::infinity();
  if (!pairs_are_complete()) find_pairs();
  evaluate();
  return now_.energy - before_.energy + load_ * std::log1p(e);
}

template <int D>
bool JammingEnergy<D>::moves_too_far(const Eigen::VectorXd& motion) const {
  for (std::size_t i = 0; i < size(); ++i)
    if (!(part<D>(motion, i).norm() < longest_move * radius_[i])) return true;
  return false;
}

template <int D>
void JammingEnergy<D>::take_back() {
  std::swap(state_, state_before_);
  std::swap(now_, before_);
}

template <int D>
void JammingEnergy<D>::archive(Archive& a) {
  a(order_, radius_, load_per_overlap_, load_, smoothing_, state_, now_, pairs_, at_finding_,
    width_at_finding_, held_, fixed_);
  if (!enclosure_) return;
  const auto walls = std::make_shared<NearWalls<D>>();
  if (near_walls_) *walls = *near_walls_;
  a(*walls);
  near_walls_ = walls;
}

template <int D>
void JammingEnergy<D>::write(Spheres<D>& spheres) const {
  const Boundary<D> box{state_.edges};
  for (std::size_t i = 0; i < size(); ++i)
    spheres.set_center(order_[i], box.wrap(part<D>(state_.centers, i)));
}

template <int D>
void JammingEnergy<D>::write_to_scale(Spheres<D>& spheres) const {
  for (std::size_t i = 0; i < size(); ++i)
    spheres.set_center(order_[i], part<D>(state_.centers, i) / state_.scale);
}

#define BERNAL_INSTANTIATE(D) template class JammingEnergy<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
