#include "jam/few_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "jam/close_few.hpp"
#include "jam/few_energy.hpp"
#include "jam/lattice_places.hpp"
#include "jam/quasi_newton.hpp"
#include "jam/symmetric_places.hpp"
#include "work/room.hpp"

namespace bernal {
namespace {

/// Overlap ratios: at the start, at which minima are compared, and of those that are looked at closely.
constexpr double rough = 0.05, compared = 3e-3, closely = 3e-4;
/// Of the tightest, how much looser a minimum may seem at these two and turn out to be tighter; and what is
/// as tight as the tightest is the same again.
constexpr double unsure = 3e-3, hardly_unsure = 3e-5, same_again = 1e-9;
/// The search ends after so many minima a sphere, or so many multiplications.
constexpr double minima_a_sphere = 60, most_work = 6.5e9;
/// What a value of the energy, a solution of its equations and a look at a piece of wall cost, in these: N²
/// and (D N)³ times, and as it stands.
constexpr double work_a_value = 4, work_a_solution = 1.0 / 6, work_a_look = 100, spheres_of_overhead = 4;
/// Of the search, what begins anew without hops; so many of the tightest of these hop then, each of another
/// minimum: tighter by this at least.
constexpr double share_without_hops = 0.35, another = 1e-6;
constexpr std::size_t kept_starts = 6;
/// Hops in a row that find nothing tighter, until it starts anew; and, of the tightest, from where on a start
/// is worth hops.
constexpr int most_idle_hops = 20;
constexpr double worth_hops = 0.98;
/// How often another group of symmetries is tried until the container has it.
constexpr int most_groups = 20;
/// Of what is asked for: what has less after this share of the search does not come to it.
constexpr double hopeless = 0.95, share_to_hope = 0.25;
constexpr int most_draws = 10'000;
/// Of the proportions of the radii.
constexpr int bits = 44;
/// Of the random numbers of relaxation, beyond those of any stage.
constexpr std::uint64_t own_stream = std::uint64_t{1} << 40;

class FewSearch {
 public:
  FewSearch(const std::vector<double>& radii, const Container& container, const Places& places,
            const FewWish& wish)
      : energy_(container, radii),
        places_(places),
        wish_(wish),
        random_(wish.seed, stream(Stream::relax, own_stream)),
        of_one_size_(std::ranges::all_of(radii, [&](double r) { return r == radii.front(); })) {}

  FewPacked run() {
    if (energy_.size() == 1) {
      close(started(at({largest_room(energy_.container()).place}), false));
      return std::move(found_);
    }
    if (auto places = grid_places(energy_.container(), energy_.size()))
      close(started(among(std::move(*places), 0), false));
    std::vector<Start> tightest;
    while (!over() && done_now() < share_without_hops) {
      Start start = begin();
      if (tightest.empty() || start.size > tightest.front().size) close(start);
      keep(std::move(start), tightest);
    }
    for (Start& start : tightest)
      if (!over()) hop_from(start);
    while (!over())
      if (Start start = begin(); start.size >= worth_hops * best()) hop_from(start);
    return std::move(found_);
  }

 private:
  struct Start {
    Eigen::VectorXd point;
    double size;
  };

  /// Anew, symmetric every other time.
  Start begin() {
    const std::uint64_t kind = starts_++ % 4;
    return started(kind == 1 ? on_lattice() : kind == 3 ? at_random() : symmetric(), kind != 1);
  }

  Start started(Eigen::VectorXd point, bool from_afar) {
    const double size = relaxed(point, from_afar);
    return {std::move(point), size};
  }

  static void keep(Start start, std::vector<Start>& tightest) {
    const auto place = std::ranges::lower_bound(tightest, start.size, std::ranges::greater(), &Start::size);
    const auto is_same = [&](const Start& other) {
      return std::abs(other.size - start.size) < another * start.size;
    };
    if (std::ranges::any_of(tightest, is_same)) return;
    tightest.insert(place, std::move(start));
    if (tightest.size() > kept_starts) tightest.pop_back();
  }

  bool over() {
    if (found_.size >= wish_.enough || found_.cancelled) return true;
    if (wish_.monitor.stop()) return found_.cancelled = true;
    const double done = done_now();
    if (wish_.tell && found_.minima % 16 == 0) wish_.tell(std::min(done, 1.0), found_.size);
    const bool hopes = std::isinf(wish_.enough) || best() >= hopeless * wish_.enough;
    return done >= (hopes ? 1 : share_to_hope);
  }

  double done_now() const {
    const auto n = static_cast<double>(energy_.size());
    const double value = work_a_value * (n + spheres_of_overhead) * (n + spheres_of_overhead),
                 solution = work_a_solution * std::pow(static_cast<double>(energy_.unknowns()), 3);
    const double work = value * static_cast<double>(newton_.evaluations()) +
                        solution * static_cast<double>(solved_) +
                        work_a_look * static_cast<double>(energy_.looks_at_pieces());
    return std::max(work / most_work, static_cast<double>(found_.minima) / (minima_a_sphere * n)) /
           wish_.effort;
  }

  double best() const { return std::max(found_.size, waiting_.size); }

  /// In the container, or after many draws near it.
  Vector<3> place() {
    Vector<3> p = places_.draw(random_);
    for (int k = 0; k < most_draws && !(energy_.container().clearance(p) > 0); ++k) p = places_.draw(random_);
    return p;
  }

  Eigen::VectorXd at(const std::vector<Vector<3>>& places) const {
    Eigen::VectorXd point(energy_.unknowns());
    for (std::size_t i = 0; i < energy_.size(); ++i) energy_.set_center(point, i, places[i]);
    energy_.set_size(point, energy_.expected_size());
    return point;
  }

  Eigen::VectorXd at_random() {
    std::vector<Vector<3>> places(energy_.size());
    for (Vector<3>& p : places) p = place();
    return at(places);
  }

  Eigen::VectorXd on_lattice() {
    constexpr double jitter = 1e-3;
    const double r = energy_.expected_size() * mean_radius();
    auto sites = lattice_places(energy_.container(), energy_.size(), r, random_);
    return sites ? among(std::move(*sites), jitter * r) : at_random();
  }

  Eigen::VectorXd symmetric() {
    const double r = energy_.expected_size() * mean_radius();
    for (int k = 0; k < most_groups && of_one_size_; ++k)
      if (auto all = symmetric_places(energy_.container(), places_, energy_.size(), r, random_))
        return at(*all);
    return at_random();
  }

  /// Spheres of several sizes take these places as chance has it.
  Eigen::VectorXd among(std::vector<Vector<3>> places, double jitter) {
    if (!of_one_size_) shuffle(places);
    for (Vector<3>& p : places) p += jitter * random_way();
    return at(places);
  }

  double mean_radius() const {
    double sum = 0;
    for (std::size_t i = 0; i < energy_.size(); ++i) sum += energy_.radius(i);
    return sum / static_cast<double>(energy_.size());
  }

  /// In the cube of edge 2 about the origin.
  Vector<3> random_way() {
    Vector<3> way;
    for (double& x : way) x = random_.uniform(-1, 1);
    return way;
  }

  template <class T>
  void shuffle(std::vector<T>& values) {
    for (std::size_t i = 0; i + 1 < values.size(); ++i)
      std::swap(values[i], values[i + random_() % (values.size() - i)]);
  }

  void minimise(Eigen::VectorXd& point, double overlap, double improvement, double balance, int evaluations) {
    energy_.set_overlap(overlap);
    const double s = energy_.expected_size();
    newton_.minimise(
        point,
        [this](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) { return energy_.value(at, gradient); },
        {.longest_move = 0.5 * s * mean_radius(),
         .gradient = balance * overlap * s,
         .improvement = improvement,
         .evaluations = evaluations});
  }

  /// How tight the minimum near it is.
  double relaxed(Eigen::VectorXd& point, bool from_afar) {
    ++found_.minima;
    if (from_afar) minimise(point, rough, 1e-5, 0, 300);
    minimise(point, compared, 3e-8, 0.02, 600);
    return size_without_load(point);
  }

  double size_without_load(const Eigen::VectorXd& point) {
    Eigen::VectorXd gradient(point.size());
    energy_.value(point, gradient);
    return energy_.size_without_load(point);
  }

  /// Keeps it if it is the tightest since the last that was closed. Closing takes as long as some hops: it
  /// waits until nothing tighter is found near.
  void look_at(Eigen::VectorXd point, double size) {
    if (size < (1 - unsure) * best()) return;
    minimise(point, closely, 1e-10, 0.01, 600);
    size = size_without_load(point);
    if (size <= waiting_.size || size < (1 - hardly_unsure) * found_.size) return;
    if (std::abs(size - seemed_) < same_again * size) return;
    waiting_ = {std::move(point), size};
  }

  void close(const Start& start) {
    look_at(start.point, start.size);
    close_waiting();
  }

  void close_waiting() {
    if (!(waiting_.size > 0)) return;
    Eigen::VectorXd& point = waiting_.point;
    const double seemed = std::exchange(waiting_.size, 0);
    solved_ += close_few(energy_, point, 0.1 * closely);
    const double closed = energy_.size_of(point);
    if (!(closed > found_.size)) return;
    seemed_ = seemed;
    found_.size = closed;
    found_.centers.resize(energy_.size());
    for (std::size_t i = 0; i < energy_.size(); ++i) found_.centers[i] = energy_.center(point, i);
  }

  void hop_from(Start& from) {
    auto& [point, size] = from;
    look_at(point, size);
    for (int idle = 0; idle < most_idle_hops && !over();) {
      Eigen::VectorXd other = point;
      disturb(other);
      const double size_there = relaxed(other, false);
      idle = size_there > (1 + 1e-7) * size ? 0 : idle + 1;
      if (!(size_there > size)) continue;
      point = std::move(other);
      size = size_there;
      look_at(point, size);
    }
    close_waiting();
  }

  void disturb(Eigen::VectorXd& point) {
    constexpr double shakes_all = 0.35, shakes_some = 0.6, exchanges = 0.15;
    if (!of_one_size_ && random_.uniform() < exchanges) return exchange(point);
    const double kind = random_.uniform();
    if (kind < shakes_all) {
      const double way = (random_.uniform() < 0.5 ? 0.4 : 0.8) * random_.uniform(0.3, 1);
      shake(point, place(), std::numeric_limits<double>::infinity(), way);
    } else if (kind < shakes_some) {
      const Vector<3> middle = place();
      shake(point, middle, random_.uniform(2, 5) * energy_.size_of(point) * mean_radius(), 0.9);
    } else {
      constexpr double two = 0.3, one_more = 0.1;
      const int count = 1 + (random_.uniform() < two) + (random_.uniform() < one_more);
      for (int k = 0; k < count; ++k) put_into_hole(point, some_sphere(point));
    }
  }

  /// Those nearer than that, by so many of their radii at most.
  void shake(Eigen::VectorXd& point, const Vector<3>& middle, double reach, double way) {
    const double s = energy_.size_of(point);
    for (std::size_t i = 0; i < energy_.size(); ++i) {
      const Vector<3> at = energy_.center(point, i);
      if ((at - middle).norm() < reach)
        energy_.set_center(point, i, at + way * s * energy_.radius(i) * random_way());
    }
  }

  void exchange(Eigen::VectorXd& point) {
    const std::size_t i = random_() % energy_.size(), j = random_() % energy_.size();
    const Vector<3> at = energy_.center(point, i);
    energy_.set_center(point, i, energy_.center(point, j));
    energy_.set_center(point, j, at);
  }

  /// Any, or one of the most or of the least squeezed.
  std::size_t some_sphere(const Eigen::VectorXd& point) {
    constexpr double by_squeeze = 0.6, least_squeezed = 0.3, spread = 0.08;
    if (random_.uniform() >= by_squeeze) return random_() % energy_.size();
    const std::vector<double> squeeze = energy_.squeeze(point);
    const bool least = random_.uniform() < least_squeezed;
    std::vector<std::size_t> order(squeeze.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return least ? squeeze[i] : -squeeze[i]; });
    const double rank = -std::log(1 - random_.uniform()) * spread * static_cast<double>(order.size());
    return order[std::min(order.size() - 1, static_cast<std::size_t>(rank))];
  }

  /// The roomiest of some random places.
  void put_into_hole(Eigen::VectorXd& point, std::size_t i) {
    const int probes = 3 + static_cast<int>(100 * random_.uniform());
    const double s = energy_.size_of(point);
    Vector<3> roomiest = energy_.center(point, i);
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < probes; ++k) {
      const Vector<3> at = place();
      double room = energy_.container().clearance(at);
      for (std::size_t j = 0; j < energy_.size() && room > most; ++j)
        if (j != i) room = std::min(room, (at - energy_.center(point, j)).norm() - s * energy_.radius(j));
      if (!(room > most)) continue;
      most = room;
      roomiest = at;
    }
    energy_.set_center(point, i, roomiest);
  }

  FewEnergy energy_;
  const Places& places_;
  const FewWish& wish_;
  Random random_;
  const bool of_one_size_;
  QuasiNewton newton_;
  std::uint64_t starts_ = 0, solved_ = 0;
  Start waiting_ = {{}, 0};  // to be closed
  double seemed_ = 0;        // how tight the tightest seemed before it was closed
  FewPacked found_;
};

}  // namespace

bool are_few(std::size_t count, const Container& container) {
  return count >= 1 && count <= most_few && !container.boundary().repeats();
}

double gap_of_few(const Container& container) {
  constexpr double roundings = 32;
  return roundings * container.resolution();
}

double seconds_of_few(double count) {
  constexpr double of_five = 0.03, power = 2.4, most = 4;
  return std::min(most, of_five * std::pow(count / 5, power));
}

double effort_of_one_more(double count) {
  constexpr double effort = 0.125, of_count = 40;
  return effort * std::min(1.0, of_count / count);
}

/// By proportions that are rounded, so that sizes that are all multiplied by one factor go the same way.
FewPacked pack_few(const std::vector<double>& radii, const Container& container, const Places& places,
                   const FewWish& wish) {
  const double largest = std::ranges::max(radii);
  std::vector<double> proportions;
  for (const double r : radii)
    proportions.push_back(std::ldexp(std::round(std::ldexp(r / largest, bits)), -bits));
  FewWish in_proportion = wish;
  in_proportion.enough *= largest;
  if (wish.tell) in_proportion.tell = [&](double done, double size) { wish.tell(done, size / largest); };
  FewPacked packed = FewSearch(proportions, container, places, in_proportion).run();
  packed.size /= largest;
  return packed;
}

}  // namespace bernal
