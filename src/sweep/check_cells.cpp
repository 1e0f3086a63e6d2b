#include "sweep/check_cells.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/read_scene.hpp"

namespace bernal::sweep {
namespace {

/// Chooses the cells that are built: every value of every key is in one of them. Seeds change no plan, and a
/// CAD file, which may take long to read, is read once.
class BuiltCells {
 public:
  explicit BuiltCells(const std::vector<std::string>& keys) : keys_(keys) {}

  bool takes(const Cell& cell) {
    bool is_new = std::exchange(is_first_, false);
    for (std::size_t k = 0; k < keys_.size(); ++k)
      if (keys_[k] != "seed") is_new |= values_.emplace(k, cell.values[k]).second;
    if (!is_new || cell.scene.container.meshes().empty()) return is_new;
    Scene alone;
    alone.container = cell.scene.container;
    return containers_.insert(scene_as_toml(alone)).second;
  }

 private:
  const std::vector<std::string>& keys_;
  std::set<std::pair<std::size_t, std::string>> values_;
  std::set<std::string> containers_;
  bool is_first_ = true;
};

}  // namespace

CheckedCells check_cells(const Sweep& sweep, std::size_t first, std::size_t last, bool built,
                         const Monitor& monitor) {
  CheckedCells checked;
  std::map<std::string, std::size_t> known;
  BuiltCells built_cells(sweep.keys());
  last = std::min(last, sweep.size());
  for (std::size_t number = first; number <= last; ++number) {
    if (monitor.stop()) throw Cancelled();
    monitor.report(
        {"check", static_cast<double>(number - first) / static_cast<double>(last - first + 1), {}});
    Cell cell = sweep.cell(number);
    const auto [other, is_new] = known.emplace(cell.hash, number);
    if (!is_new)
      throw Error(
          ErrorCode::bad_scene,
          fmt::format("cells {} and {} are the same scene, whatever the sweep writes over it; leave out "
                      "one of them",
                      other->second, number),
          {sweep.file().string()});
    if (built && built_cells.takes(cell)) {
      const Plan plan = build(cell.scene);
      checked.most_memory = std::max(checked.most_memory, plan.expected_memory_bytes);
      checked.most_seconds = std::max(checked.most_seconds, plan.expected_seconds);
    }
    checked.rows.push_back({number, std::move(cell.values), std::move(cell.hash), {}});
  }
  return checked;
}

}  // namespace bernal::sweep
