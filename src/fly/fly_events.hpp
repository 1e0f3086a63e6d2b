#pragma once
#include <cstdint>
#include <queue>
#include <vector>

#include "bernal/fly/fly.hpp"
#include "core/archive.hpp"
#include "fly/flying_spheres.hpp"
#include "work/reporter.hpp"

namespace bernal {

/// Collision filling beyond the patent's ceiling: all spheres fly from collision to collision, the earliest
/// first, each moved only when something happens to it (Alder & Wainwright 1959), and a new centre that
/// overlaps is pushed out of what it overlaps a few times before it is given up.
///
/// Flight is cut into stretches of the time `dt`, at whose ends all spheres stand at one time and new ones
/// come. Within a stretch the collisions of all near pairs are in a queue; those whose spheres have collided
/// with others meanwhile are passed over. A stretch ends early where a sphere has flown as far as the list of
/// near pairs holds. Kinetic energy is conserved to rounding.
///
/// Cost: O(log N) a collision, O(N) a stretch. Precondition of both: every pair of spheres at contact or
/// beyond; so they stay.
template <int D>
class EventFlight {
 public:
  using Id = typename FlyingSpheres<D>::Id;

  EventFlight(FlyingSpheres<D>& spheres, const Fly& options, Random random);

  /// One batch of new spheres. Returns how many found a place.
  std::size_t insert();
  /// One stretch of flight.
  void fly();
  std::uint64_t collisions() const { return collisions_; }
  /// What they took, with foreseeing the next ones.
  double seconds_of_collisions() const { return times_.seconds(); }

  /// Its state between two stretches, but for the spheres.
  void archive(Archive& a) {
    a(times_, random_, near_, listed_, from_, time_, room_, hits_, end_, collisions_);
  }

 private:
  struct Event {
    double time;
    Id first, second;            // second: another sphere, or one of the below
    Id first_hits, second_hits;  // how often they had collided when this was foreseen
    bool operator>(const Event& other) const {
      if (time != other.time) return time > other.time;
      return first != other.first ? first > other.first : second > other.second;
    }
  };
  static constexpr Id leaves_list = 0xFFFFFFFF;
  static constexpr Id wall = 0xFFFFFF00;  // + axis

  void list_pairs();
  void list_new_pairs();
  /// Brings sphere i to the time t.
  void move_to(Id i, double t);
  /// When i and j touch, seen from the time at which both are now; infinite if they do not. `way` is from j
  /// to i then, to the image that i meets.
  double time_to_meet(Id i, Id j, Vector<D>& way) const;
  double time_to_meet(const Vector<D>& d, const Vector<D>& w, double contact) const;
  void foresee_pair(Id i, Id j);
  void foresee_alone(Id i);
  void foresee(Id i);
  bool is_stale(const Event& event) const;
  void collide(const Event& event);

  const Made made_{"collisions"};
  EventClock times_;
  FlyingSpheres<D>& spheres_;
  std::size_t batch_;
  double dt_;
  Random random_;
  bool small_;
  std::vector<std::vector<Id>> near_;
  std::size_t listed_ = 0;                   // of the pairs
  typename FlyingSpheres<D>::Columns from_;  // where the spheres were when pairs were listed
  std::vector<double> time_, room_;          // of each sphere; how far it may fly
  std::vector<Id> hits_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  double end_ = 0;  // of this stretch, which starts at 0
  std::uint64_t collisions_ = 0;
};

/// Fills the box `Task::target_edges` that way. As `fill_by_relaxation` otherwise.
StageEnd fly_by_events(SpheresInBox& in_box, Reporter& report, const Fly& options);

}  // namespace bernal
