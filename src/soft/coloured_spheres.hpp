#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>

#include "soft/coloured_cells.hpp"
#include "soft/device_spheres.hpp"

namespace bernal {

/// Spheres that are swept cell by cell, all cells of a colour at the same time.
///
/// A `Device` has a name() and memory, Array<T>, with size(), data() and resize_anew(n), which loses the
/// content. to(array, values) and from(array, count) copy; set(array, k, value) and at(array, k) access one
/// entry; fill_zero(array, n) clears. each(n, function) calls the function for 0 to n - 1 at the same time.
/// sort(keys, values, n, bits) is stable and uses the lowest bits of the keys. sums_before(array, n) replaces
/// each entry by the sum of those before it, entry n by that of all. wait() returns when all is done. Calls
/// follow each other.
///
/// With more spheres than `window`, slabs of pairs of layers, each with about `window` spheres, are swept one
/// after the other in all colours. So a cache of some tens of megabytes reads the spheres from memory once a
/// sweep, and not once a colour. Bytes a sphere and sweep are then 32 to read and write its place, 16 a unit
/// of its list, and 5 for the beginnings of its cell and its list.
template <class Device>
class ColouredSpheres final : public DeviceSpheres {
 public:
  static constexpr std::size_t usual_window = 4'000'000;

  explicit ColouredSpheres(std::size_t window = usual_window) : window_(window) {}

  std::string name() const override { return device_.name(); }

  void put(const std::vector<SoftSphere>& spheres) override {
    count_ = static_cast<std::uint32_t>(spheres.size());
    by_number_.resize_anew(count_);
    device_.to(by_number_, spheres);
    is_sorted_ = false;
  }
  std::vector<SoftSphere> get() const override {
    if (is_sorted_) give_back(spheres_);
    return device_.from(by_number_, count_);
  }
  std::vector<SoftSphere> built_at() const override {
    give_back(built_at_);
    return device_.from(by_number_, count_);
  }

  void build(const std::array<double, 3>& edges, float largest, float skin) override {
    if (is_sorted_) give_back(spheres_);
    cut(edges, largest, skin);
    sort();
    find_neighbors(scale_of(edges), skin);
  }

  void build_of(const std::vector<SoftSphere>& then, const std::array<double, 3>& edges, float largest,
                float skin) override {
    const std::vector<SoftSphere> now = get();
    put(then);
    build(edges, largest, skin);
    device_.to(by_number_, now);
    device_.each(count_, TakeAgain{by_number_.data(), number_of_.data(), spheres_.data()});
  }

  void sweep(const std::array<float, 3>& scale, float omega) override { sweep_all<false>(scale, omega); }
  float sweep_to_overlap(const std::array<float, 3>& scale, float omega) override {
    worst_.resize_anew(1);
    device_.fill_zero(worst_, 1);
    sweep_all<true>(scale, omega);
    return device_.at(worst_, 0);
  }

  std::vector<float> squares_moved(const std::array<float, 3>& scale, std::uint32_t part) const override {
    const std::uint32_t parts = (count_ + part - 1) / part;
    squares_.resize_anew(parts);
    device_.fill_zero(squares_, parts);
    device_.each(
        count_,
        FindMoves{spheres_.data(), built_at_.data(), {scale[0], scale[1], scale[2]}, part, squares_.data()});
    return device_.from(squares_, parts);
  }

  void wait() const override { device_.wait(); }

  double bytes_a_sweep() const override {
    const double units = device_.at(first_unit_, count_);
    return 2 * sizeof(SoftSphere) + sizeof(NeighborUnit) * units / count_ +
           sizeof(std::uint32_t) * (1 + static_cast<double>(cells_.size()) / count_);
  }

 private:
  template <class T>
  using Array = typename Device::template Array<T>;

  void cut(const std::array<double, 3>& edges, float largest, float skin) {
    constexpr double rounding = 1e-5;
    const double reach = 2 * (1 + rounding) * (static_cast<double>(largest) + static_cast<double>(skin));
    double finer = 1;  // cells of which most are empty cost time, too
    const double most = 2.0 * count_ + 1000;
    const auto along = [&](std::size_t k) {
      return std::max<std::uint32_t>(
          fewest_cells, 2 * static_cast<std::uint32_t>(std::min(edges[k] / (2 * reach * finer), 1e4)));
    };
    for (;; finer *= 1.1) {
      for (std::size_t k = 0; k < 3; ++k) cells_.across[k] = along(k);
      const double all = static_cast<double>(cells_.across[0]) * cells_.across[1] * cells_.across[2];
      if (all <= most) break;
    }
  }

  void sort() {
    cell_of_.resize_anew(count_);
    number_of_.resize_anew(count_);
    spheres_.resize_anew(count_ + 1);
    built_at_.resize_anew(count_);
    start_.resize_anew(cells_.size() + 1);
    device_.each(count_, FindCells{by_number_.data(), cells_, cell_of_.data(), number_of_.data()});
    device_.sort(cell_of_, number_of_, count_, std::bit_width(cells_.size()));
    device_.set(spheres_, count_, no_sphere);
    device_.each(count_, TakeOrder{by_number_.data(), cell_of_.data(), number_of_.data(), count_,
                                   cells_.size(), spheres_.data(), built_at_.data(), start_.data()});
    is_sorted_ = true;
  }

  void find_neighbors(const std::array<float, 3>& scale, float skin) {
    first_unit_.resize_anew(count_ + 1);
    FindNeighbors find{spheres_.data(), cells_, start_.data(),      {scale[0], scale[1], scale[2]},
                       2 * skin,        count_, first_unit_.data(), nullptr};
    device_.each(count_, find);
    device_.sums_before(first_unit_, count_);
    const std::size_t units = device_.at(first_unit_, count_);
    if (units_.size() < units) units_.resize_anew(units + units / 16);
    find.units = units_.data();
    device_.each(count_, find);
  }

  template <bool measure>
  void sweep_all(const std::array<float, 3>& scale, float omega) {
    const std::uint32_t pairs = cells_.across[2] / 2, of_pair = cells_.of_a_colour_in_two_layers();
    const auto windows = static_cast<std::uint32_t>(std::max<std::size_t>(1, count_ / window_));
    const std::uint32_t step = (pairs + windows - 1) / windows;
    SweepColour<measure> task{.spheres = spheres_.data(),
                              .cells = cells_,
                              .start = start_.data(),
                              .first_unit = first_unit_.data(),
                              .units = units_.data(),
                              .omega = omega,
                              .worst = worst_.data()};
    for (std::size_t k = 0; k < 3; ++k) {
      task.scale[k] = scale[k];
      task.inverse[k] = 1 / scale[k];
    }
    for (task.first_pair = 0; task.first_pair < pairs; task.first_pair += step)
      for (task.colour = 0; task.colour < ColouredCells::colours; ++task.colour)
        device_.each(task.threads * of_pair * std::min(step, pairs - task.first_pair), task);
  }

  void give_back(const Array<SoftSphere>& in_order) const {
    device_.each(count_, GiveBack{in_order.data(), number_of_.data(), by_number_.data()});
  }

  mutable Device device_;
  std::size_t window_;
  std::uint32_t count_ = 0;
  bool is_sorted_ = false;
  ColouredCells cells_{};
  mutable Array<SoftSphere> by_number_;
  Array<SoftSphere> spheres_, built_at_;
  Array<std::uint32_t> cell_of_, number_of_, start_, first_unit_;
  Array<NeighborUnit> units_;
  Array<float> worst_;
  mutable Array<float> squares_;
};

}  // namespace bernal
