#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <system_error>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/text.hpp"
#include "bernal/plan/plan.hpp"
#include "engine/engine_plan.hpp"
#include "engine/run_engine.hpp"
#include "plan/start.hpp"
#include "run/engine_box.hpp"
#include "settle/insert.hpp"
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
                             const Monitor& monitor) {
  FolderOfEngine at(folder);
  try {
    return engine::run_engine(*plan.scene.engine, task, radii, at.path(), monitor);
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

void take_engine_in_box(const Plan& plan, const std::filesystem::path& folder, SpheresInBox& in_box,
                        Reporter& report) {
  const std::vector<double>& radii = in_box.spheres.r;
  const double volume = in_box.volume_of_spheres(), unit = unit_of(radii);
  std::optional<double> most;
  if (in_box.task.target_edges) most = above_asked * volume / in_box.task.target_edges->prod();
  const Vector<3> proportions = in_box.edges;
  const EngineBox scale =
      engine_box(proportions, volume, std::ranges::max(radii), in_box.task.attainable, most);
  const Vector<3> edges = proportions * (scale.first / unit);
  Random random = report.random(Stream::insert);
  Spheres<3> spheres;
  spheres.reserve(radii.size());
  for (const double r : radii)
    spheres.push_back(uniform_point<3>(random, {Vector<3>::Zero(), edges}), r / unit);
  const std::vector<double> told_radii = spheres.r;
  const engine::EngineTask task{.spheres = engine::told(std::move(spheres)),
                                .domain = Box{Vector<3>::Zero().eval(), edges, {true, true, true}},
                                .growth = scale.last / scale.first,
                                .steps = plan.scene.engine->process().steps};

  const engine::Places places = run_in_folder(plan, folder, task, told_radii, report.monitor);
  const Vector<3> box = places.box.size(), end = proportions * scale.last;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double factor = end[k] / box[k];
    for (std::size_t i = 0; i < radii.size(); ++i) {
      double x = (places.spheres.x[axis][i] - places.box.lower[k]) * factor;
      x -= end[k] * std::floor(x / end[k]);
      in_box.spheres.x[axis][i] = x < end[k] ? x : 0;
    }
  }
  in_box.edges = end;
  in_box.begun = radii.size();
  in_box.placed = in_box.may_overlap = true;
  report.milestone(name_of_engine(plan), in_box, 0, 1);
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

/// Room in the air for what is poured: so much of it, at most, is spheres.
constexpr double most_in_air = 0.2;

/// The container, and where it can be, with a shaft on it, for spheres that are to fall into it.
Domain with_shaft(const Domain& domain, const Vector<3>& down, double volume_in_air) {
  const double more = volume_in_air / volume_of(domain);
  if (more <= 1) return domain;
  Domain higher = domain;
  if (auto* box = std::get_if<Box>(&higher)) {
    for (int k = 0; k < 3; ++k)
      if (std::abs(down[k]) >= 1) {
        const double added = (more - 1) * box->size[k];
        if (down[k] > 0) box->corner[k] -= added;
        box->size[k] += added;
      }
  } else if (auto* cylinder = std::get_if<Cylinder>(&higher)) {
    const double along = down.dot(cylinder->axis.normalized());
    if (std::abs(along) >= 1 - 1e-12) {
      const double added = (more - 1) * cylinder->height;
      if (along > 0) cylinder->base -= added * cylinder->axis.normalized();
      cylinder->height += added;
    }
  }
  return higher;
}

/// Those spheres in the air, each with room around it. Throws where there is none for them.
Spheres<3> in_air(const Domain& domain, const std::vector<double>& radii, const Plan& plan,
                  const SpheresInBed& in_bed, Reporter& report) {
  std::vector<std::uint32_t> tags(radii.size());
  std::iota(tags.begin(), tags.end(), 0u);
  Task task = in_bed.task;
  task.target = {.count = static_cast<std::int64_t>(radii.size())};
  task.domain = domain;
  task.exact_place = {};  // that is of the scene's container
  task.container = make_container(domain, WallArithmetic::plain, in_bed.task.container->resolution());
  SpheresInBed own(task, std::make_shared<Supply>(in_bed.supply->of(tags)), report.effects);
  Reporter of_own = report.alone();
  insert(until_full, own, of_own);
  report.streams_used = of_own.streams_used;
  if (own.bed().size() < radii.size())
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("of {} spheres that are to be poured {} have room in the air before they fall: ask "
                    "for fewer, or make the container higher",
                    grouped(radii.size()), grouped(own.bed().size())),
        plan.scene.target.where);
  Spheres<3> spheres;
  spheres.resize(radii.size());
  spheres.r = radii;
  for (Bed::Id i = 0; i < own.bed().size(); ++i) spheres.set_center(own.bed().tag(i), own.bed()[i].center);
  return spheres;
}

/// What `Pouring` says, of spheres in this container.
engine::Pouring pouring_of(const Liggghts& engine, const Vector<3>& down, const Domain& shaft,
                           const std::vector<double>& radii) {
  const double height = down.cwiseAbs().dot(bounds_of(shaft).size());
  double volume = 0, mean = 0;
  for (const double r : radii) {
    volume += ball_volume(3, r);
    mean += r / static_cast<double>(radii.size());
  }
  constexpr double settled = 0.58;
  const double layers = volume / settled / volume_of(shaft) * height / (2 * mean);
  return {.down = down,
          .friction = engine.friction,
          .restitution = engine.restitution,
          .layers = std::max(3.0, layers),
          .fall = height / (2 * mean)};
}

void require_below_brim(const Container& container, const Spheres<3>& spheres, const Plan& plan) {
  std::size_t above = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) above += !container.contains(spheres.center(i), 0);
  if (above > 0)
    throw Error(ErrorCode::bad_scene,
                fmt::format("{} of {} spheres that were poured lie outside the container: ask for fewer, or "
                            "make it higher",
                            grouped(above), grouped(spheres.size())),
                plan.scene.target.where);
}

void take_engine_in_bed(const Plan& plan, const std::filesystem::path& folder, SpheresInBed& in_bed,
                        Reporter& report) {
  const Task& task = in_bed.task;
  const Container& container = in_bed.bed().container();
  const std::size_t count = std::max<std::size_t>(
      1, std::min(in_bed.target_count(), in_bed.count_filling(most_of_attainable * task.attainable)));
  const std::vector<double>& all = in_bed.supply->radii();
  const std::vector<double> radii(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  const double unit = unit_of(radii);
  const Turn turn(task.domain);
  Random random = report.random(Stream::insert);
  const auto place_for = [&](double r) {
    return clear_place(r, container, in_bed.bed().places(), random, report.monitor);
  };
  const auto* liggghts = std::get_if<Liggghts>(&*plan.scene.engine);
  const bool pours = liggghts && liggghts->pour;
  Spheres<3> begin;
  begin.reserve(count);
  std::optional<engine::Pouring> pouring;
  Domain around = turn.domain;
  if (pours) {
    const Vector<3> down = down_in(plan.scene);
    around = with_shaft(turn.domain, down, in_bed.volume_of_drawn(count) / most_in_air);
    pouring = pouring_of(*liggghts, down, around, radii);
    begin = in_air(around, radii, plan, in_bed, report);
    for (std::size_t i = 0; i < count; ++i) begin.set_center(i, begin.center(i) / unit);
    for (double& r : begin.r) r /= unit;
  } else {
    for (const double r : radii) begin.push_back(turn.there(place_for(r)) / unit, r / unit);
  }
  const std::vector<double> told_radii = begin.r;
  const engine::TaskSpheres spheres_told = engine::told(std::move(begin));
  const engine::EngineTask engine_task{
      .spheres = spheres_told,
      .domain = to_local(around, Frame{.scale = unit}),
      .steps = pouring ? 3 * pouring->steps_of_fall(spheres_told) : plan.scene.engine->process().steps,
      .pouring = pouring};

  const engine::Places places = run_in_folder(plan, folder, engine_task, told_radii, report.monitor);
  Spheres<3> spheres;
  spheres.reserve(count);
  std::size_t put_back = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Vector<3> c = container.boundary().wrap(turn.back(unit * places.spheres.center(i)));
    if (!pours && !container.contains(c, 0)) {
      c = place_for(radii[i]);
      ++put_back;
    }
    spheres.push_back(c, radii[i]);
  }
  if (pours) require_below_brim(container, spheres, plan);
  in_bed.begun = count;
  in_bed.crowded_start = std::move(spheres);
  if (pours)
    report.account = fmt::format("poured by LIGGGHTS with a friction of {} and a restitution of {}",
                                 liggghts->friction, liggghts->restitution);
  if (put_back > 0)
    report.account = fmt::format("{} had left the container in {}, and {} put back",
                                 put_back == 1 ? "1 sphere" : grouped(put_back) + " spheres",
                                 name_of_engine(plan), put_back == 1 ? "was" : "were");
  report.milestone(name_of_engine(plan), count, volume_of(in_bed.crowded_start) / container.volume(), 0, 1);
}

}  // namespace

void take_engine(const Plan& plan, const std::filesystem::path& folder, SpheresOfRun& spheres,
                 Reporter& report) {
  const EffectTimer timer(report.effects[engine::engine_effect]);
  if (auto* in_bed = std::get_if<SpheresInBed>(&spheres))
    take_engine_in_bed(plan, folder, *in_bed, report);
  else
    take_engine_in_box(plan, folder, std::get<SpheresInBox>(spheres), report);
}

}  // namespace bernal
