#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "bernal/domain/container.hpp"
#include "bernal/scene/packing.hpp"
#include "core/event_clock.hpp"
#include "core/made.hpp"

namespace bernal {

/// The walls of a run: passes every question on and counts it, so that all who ask are counted in one place.
///
/// The first 64 questions are timed and one in 64 of the others, see `EventClock`; questions of several
/// threads at once count for the time of each. Cost: 3 ns a question beside that of the container.
class CountedContainer final : public Container {
 public:
  explicit CountedContainer(std::shared_ptr<const Container> container)
      : Container(container->arithmetic(), container->resolution(), container->boundary(),
                  container->dimension(), container->inset()),
        container_(std::move(container)) {}

  std::string_view kind() const override { return container_->kind(); }
  Bounds<3> bounds() const override { return container_->bounds(); }
  double volume() const override { return container_->volume(); }
  double clearance(const Vector<3>& p) const override {
    return counted([&] { return container_->clearance(p); });
  }
  double clearance_within(const Vector<3>& p, double reach) const override {
    return counted([&] { return container_->clearance_within(p, reach); });
  }
  bool contains(const Vector<3>& c, double r) const override {
    return counted([&] { return container_->contains(c, r); });
  }
  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    counted([&] { container_->facets_near(c, reach, out); });
  }
  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction,
                       double limit) const override {
    return counted([&] { return container_->first_contact(c, r, direction, limit); });
  }
  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    return counted([&] { return container_->free_path(c, r, direction, limit); });
  }
  bool few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const override {
    return counted([&] { return container_->few_facets_near(c, reach, most, out); });
  }
  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const override {
    counted([&] { container_->contacts(c, r, out); });
  }

  /// All questions so far.
  Effect asked() const {
    return {"walls", calls_, 1e-9 * EventClock::seconds_of(calls_, of_first_, timed_, nanoseconds_)};
  }

 private:
  template <class Ask>
  std::invoke_result_t<Ask> counted(const Ask& ask) const {
    const std::uint64_t n = calls_.fetch_add(1, std::memory_order_relaxed);
    if (!EventClock::is_timed(n)) return ask();
    const Timed timed{*this, n < EventClock::first, EventClock::Clock::now()};
    return ask();
  }
  struct Timed {
    const CountedContainer& of;
    bool is_first;
    EventClock::Clock::time_point start;
    ~Timed() {
      const double nanoseconds = 1e9 * EventClock::seconds_since(start);
      if (is_first) {
        of.of_first_.fetch_add(nanoseconds, std::memory_order_relaxed);
      } else {
        of.timed_.fetch_add(1, std::memory_order_relaxed);
        of.nanoseconds_.fetch_add(nanoseconds, std::memory_order_relaxed);
      }
    }
  };

  const std::shared_ptr<const Container> container_;
  const Made made_{"walls"};
  mutable std::atomic<std::uint64_t> calls_ = 0, timed_ = 0;
  mutable std::atomic<double> of_first_ = 0, nanoseconds_ = 0;
};

}  // namespace bernal
