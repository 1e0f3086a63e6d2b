#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "engine/engine_plan.hpp"
#include "engine/run_engine.hpp"
#include "run/engine_box.hpp"
#include "run/stages.hpp"
#include "run/start.hpp"
#include "work/clear_place.hpp"

namespace bernal {
namespace {

/// A periodic box grows so far above the packing fraction that is asked for.
constexpr double above_asked = 1.03;
/// More than what is likely to fit is not put between walls.
constexpr double most_of_attainable = 1.1;

/// The folder that an engine works in, and that goes with this object where nobody wants it.
class FolderOfEngine {
 public:
  explicit FolderOfEngine(const std::filesystem::path& wanted) : path_(wanted), passes_(wanted.empty()) {
    if (!passes_) return;
    std::string name = (std::filesystem::temp_directory_path() / "bernal-engine-XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw Error(ErrorCode::cannot_write, "no folder can be made for the engine: is TMPDIR full?",
                  {std::filesystem::temp_directory_path().string()});
    path_ = name;
  }
  ~FolderOfEngine() {
    std::error_code gone;
    if (passes_) std::filesystem::remove_all(path_, gone);
  }
  FolderOfEngine(const FolderOfEngine&) = delete;
  FolderOfEngine& operator=(const FolderOfEngine&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// What has gone wrong there is to be seen.
  void stays() { passes_ = false; }

 private:
  std::filesystem::path path_;
  bool passes_;
};

engine::Places run_in_folder(const Plan& plan, const std::filesystem::path& folder,
                             const engine::EngineTask& task, const std::vector<double>& radii,
                             const Work& work) {
  FolderOfEngine at(folder);
  try {
    return engine::run_engine(*plan.scene.engine, task, radii, at.path(), work.monitor);
  } catch (const Error&) {
    std::error_code gone;
    const bool is_empty = std::filesystem::is_empty(at.path(), gone);
    if (!is_empty && !gone) at.stays();
    throw;
  }
}

double unit_of(const std::vector<double>& radii) {
  double sum = 0;
  for (const double r : radii) sum += r;
  return unit_of_engine(sum / static_cast<double>(radii.size()));
}

std::string name_of_engine(const Plan& plan) {
  return std::holds_alternative<Lammps>(*plan.scene.engine) ? "lammps" : "liggghts";
}

void take_engine_in_box(const Plan& plan, const std::filesystem::path& folder, Work& work) {
  const std::vector<double>& radii = work.spheres.r;
  const double volume = work.volume_of_spheres(), unit = unit_of(radii);
  std::optional<double> most;
  if (work.target_edges) most = above_asked * volume / work.target_edges->prod();
  const Vector<3> proportions = work.edges;
  const EngineBox scale = engine_box(proportions, volume, std::ranges::max(radii), work.attainable, most);
  const Vector<3> edges = proportions * (scale.first / unit);
  Random random = work.random(Stream::insert);
  Spheres<3> spheres;
  spheres.reserve(radii.size());
  for (const double r : radii)
    spheres.push_back(uniform_point<3>(random, {Vector<3>::Zero(), edges}), r / unit);
  const std::vector<double> told_radii = spheres.r;
  const engine::EngineTask task{.spheres = engine::told(std::move(spheres)),
                                .domain = Box{Vector<3>::Zero().eval(), edges, {true, true, true}},
                                .growth = scale.last / scale.first,
                                .steps = plan.scene.engine->process().steps};

  const engine::Places places = run_in_folder(plan, folder, task, told_radii, work);
  const Vector<3> box = places.box.size(), end = proportions * scale.last;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double factor = end[k] / box[k];
    for (std::size_t i = 0; i < radii.size(); ++i) {
      double x = (places.spheres.x[axis][i] - places.box.lower[k]) * factor;
      x -= end[k] * std::floor(x / end[k]);
      work.spheres.x[axis][i] = x < end[k] ? x : 0;
    }
  }
  work.edges = end;
  work.begun = radii.size();
  work.placed = work.may_overlap = true;
  work.milestone(name_of_engine(plan), 1, 0);
}

/// From the packer's coordinates to the engine's: a cylinder that is oblique is turned upright.
struct Turn {
  Vector<3> base = Vector<3>::Zero();
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  Domain domain = {};

  explicit Turn(const Domain& of) : domain(of) {
    auto* cylinder = std::get_if<Cylinder>(&domain);
    if (!cylinder || cylinder->coordinate_axis() >= 0) return;
    base = cylinder->base;
    turned = Eigen::Quaterniond::FromTwoVectors(cylinder->axis, Vector<3>::UnitZ()).toRotationMatrix();
    cylinder->base = Vector<3>::Zero();
    cylinder->axis = Vector<3>::UnitZ();
  }
  Vector<3> there(const Vector<3>& p) const { return turned * (p - base); }
  Vector<3> back(const Vector<3>& p) const { return base + turned.transpose() * p; }
};

void take_engine_in_bed(const Plan& plan, const std::filesystem::path& folder, Work& work) {
  work.stand_in_bed();
  const Container& container = work.bed().container();
  const std::size_t count = std::max<std::size_t>(
      1, std::min(work.target_count(), work.count_filling(most_of_attainable * work.attainable)));
  const std::vector<double>& all = work.supply->radii();
  const std::vector<double> radii(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  const double unit = unit_of(radii);
  const Turn turn(work.domain);
  Random random = work.random(Stream::insert);
  const auto place_for = [&](double r) {
    return clear_place(r, container, work.bed().places(), random, work.monitor);
  };
  Spheres<3> begin;
  begin.reserve(count);
  for (const double r : radii) begin.push_back(turn.there(place_for(r)) / unit, r / unit);
  const std::vector<double> told_radii = begin.r;
  const engine::EngineTask task{.spheres = engine::told(std::move(begin)),
                                .domain = to_local(turn.domain, Frame{.scale = unit}),
                                .steps = plan.scene.engine->process().steps};

  const engine::Places places = run_in_folder(plan, folder, task, told_radii, work);
  Spheres<3> spheres;
  spheres.reserve(count);
  std::size_t put_back = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Vector<3> c = container.boundary().wrap(turn.back(unit * places.spheres.center(i)));
    if (!container.contains(c, 0)) {
      c = place_for(radii[i]);
      ++put_back;
    }
    spheres.push_back(c, radii[i]);
  }
  work.begun = count;
  work.crowded_start = std::move(spheres);
  if (put_back > 0)
    work.account = fmt::format("{} had left the container in {}, and {} put back",
                               put_back == 1 ? "1 sphere" : grouped(put_back) + " spheres",
                               name_of_engine(plan), put_back == 1 ? "was" : "were");
  work.crowd_milestone(name_of_engine(plan), count, volume_of(work.crowded_start), 0, 1);
}

}  // namespace

void take_engine(const Plan& plan, const std::filesystem::path& folder, Work& work) {
  const EffectTimer timer(work.effects[engine::engine_effect]);
  if (table_of(plan.scene.stages.front()).traits.stands_in_bed(plan.scene))
    take_engine_in_bed(plan, folder, work);
  else
    take_engine_in_box(plan, folder, work);
}

}  // namespace bernal
