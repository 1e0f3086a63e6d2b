#include "soft/settle_as_dense.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "soft/bed_density.hpp"

namespace bernal {
namespace {

/// What is near enough to the aim, and what more is said to be missed.
constexpr double near_aim = 0.004, missed_by = 0.005;
constexpr int most_attempts = 8, most_in_vain = 3;
/// Spheres begin to fall at porosities in between.
constexpr double least_start = 0, most_start = 0.8;
/// Tapped once, beds are within this of what more taps reach.
constexpr double more_taps_gain = 0.02;
/// Where less than this share of what they begin looser remains, they settle as dense however they begin.
constexpr double no_looser = 0.3;
/// Floor and surface make the whole of a bed so much looser than its core, times its height in diameters.
constexpr double looser_by_ends = 0.15;
/// With friction they begin to fall so much looser than they are to lie.
constexpr double above_aim = 0.02;
constexpr double exact_angle = 0.25;  // degrees
/// Where no law holds, vibration is tried at so much more than settling leaves: what relaxation reaches.
constexpr double denser_below_laws = 1.04;
/// What `Task::close_packing` is of equal spheres.
constexpr double close_packing_of_equal = 0.6435;

/// In mean diameters: of a lower bed next to nothing is far from floor and top.
constexpr double least_height = 4;

/// In mean diameters, of a bed with a level top.
double height_of(const SpheresInBed& in_bed, const Heights& heights, std::size_t count, double porosity) {
  const double level = heights.holding(in_bed.volume_of_drawn(count) / (1 - porosity));
  return (level - heights.ground()) / mean_diameter(in_bed, count);
}

/// The bed before a stage, from which each attempt begins.
class BedBefore {
 public:
  explicit BedBefore(SpheresInBed& in_bed)
      : in_bed_(in_bed), bed_(in_bed.bed()), start_(in_bed.crowded_start), placed_(in_bed.drawn(0).placed) {}
  void put_back() const {
    in_bed_.replace_bed(std::make_unique<Bed>(bed_));
    in_bed_.crowded_start = start_;
    in_bed_.supply->set_placed(placed_);
  }

 private:
  SpheresInBed& in_bed_;
  const Bed bed_;
  const Spheres<3> start_;
  const std::vector<bool> placed_;
};

class Attempts {
 public:
  Attempts(SpheresInBed& in_bed, Reporter& report, const DensityAim& aim, const Heights& heights,
           const BedTop& top, const std::function<StageEnd(Laying&)>& lay)
      : in_bed_(in_bed),
        report_(report),
        aim_(aim),
        heights_(heights),
        top_(top),
        lay_(lay),
        before_(in_bed) {}

  /// `height`: about that of the bed, in mean diameters.
  StageEnd run(bool vibrated, double height) {
    double start = aim_.porosity + (aim_.of_core ? looser_by_ends / height : 0);
    int taps = vibrated ? usual_taps : 0;
    int tapped_in_vain = 0;
    double too_tight = least_start;
    double slope = 1, start_before = 0, error_before = 0;
    for (int k = 0; k < most_attempts; ++k) {
      Laying laying{1 - start, taps};
      if (!tapped_.empty()) laying.first_tap = next_tap;
      if (!tapped_.empty() && tapped_in_vain == 0) laying.taps = usual_taps / 2;
      const double error = attempt(laying);
      if (end_ == StageEnd::cancelled) break;
      if (std::abs(error) <= near_aim) break;
      if (start_before > 0 && start != start_before)
        slope = std::clamp((error - error_before) / (start - start_before), 0.0, 1.0);
      start_before = start;
      error_before = error;
      if (error > 0 && !laying.finds_room) {
        if (taps > 0 && error > more_taps_gain) {
          too_tight = start;
          start = 0.5 * (start + aim_.porosity + error);
        } else if (taps > 0 && ++tapped_in_vain > most_in_vain) {
          break;
        }
        taps = usual_taps;
      } else if (error < 0 && taps == 0 && slope < no_looser) {
        hold_by_friction();
        break;
      } else {
        const double next = start - error / (taps > 0 ? 1 : std::max(slope, no_looser));
        start = std::clamp(next, 0.5 * (too_tight + start), most_start);
        if (start - too_tight < near_aim) break;
      }
    }
    if (best_) best_->put_back();
    return end_ == StageEnd::cancelled ? end_ : end_of_best_;
  }

 private:
  /// Returns by how much more porous than the aim the bed is then.
  double attempt(Laying& laying) {
    if (tried_) before_.put_back();
    tried_ = true;
    if (!tapped_.empty()) in_bed_.crowded_start = tapped_;
    laying.is_aimed = true;
    end_ = lay_(laying);
    if (laying.taps > 0) tapped_ = in_bed_.crowded_start;
    if (end_ == StageEnd::cancelled && best_) return least_error_;
    const auto reached = porosity_of(in_bed_.bed(), heights_, top_);
    const double error =  // of a few spheres on a floor there is none
        reached ? (aim_.of_core ? reached->core : reached->whole) - aim_.porosity : 0;
    if (!best_ || std::abs(error) < least_error_) {
      least_error_ = std::abs(error);
      best_.emplace(in_bed_);
      end_of_best_ = end_;
      report_.missed = why_missed(error, laying);
    }
    return error;
  }

  std::string why_missed(double error, const Laying& laying) const {
    // What fills its container cannot rise to be looser.
    if (std::abs(error) <= missed_by ||
        (error < 0 && in_bed_.task.target.is_open() && !in_bed_.task.target.bed.gives_height()))
      return "";
    return fmt::format("a porosity of {:.3f}{} is the aim, and {:.3f} is reached: {}", aim_.porosity,
                       aim_.of_core ? " far from floor and top" : "", aim_.porosity + error,
                       error < 0             ? "they fall until they rest, and then that is left"
                       : laying.friction > 0 ? "no attempt came nearer"
                                             : "they find no room in less than that");
  }

  double attempt(double start, double angle) {
    Laying laying{.packing_fraction = 1 - start, .friction = angle};
    return attempt(laying);
  }

  /// The least angle at which the bed is as porous as it is to be, by bisection.
  void hold_by_friction() {
    double low = 0, high = BedTarget::most_friction;
    double start = std::min(aim_.porosity + above_aim, most_start);
    for (int k = 0; k < most_attempts && attempt(start, high) < 0 && start < most_start; ++k)
      start = std::min(start + above_aim, most_start);
    while (high - low > exact_angle && least_error_ > near_aim && end_ != StageEnd::cancelled) {
      const double middle = 0.5 * (low + high);
      (attempt(start, middle) < 0 ? low : high) = middle;
    }
  }

  SpheresInBed& in_bed_;

  Reporter& report_;
  const DensityAim& aim_;
  const Heights& heights_;
  const BedTop& top_;
  const std::function<StageEnd(Laying&)>& lay_;
  const BedBefore before_;
  bool tried_ = false;
  Spheres<3> tapped_;  // as the taps of the attempt before left them
  double least_error_ = 0;
  std::optional<BedBefore> best_;
  StageEnd end_ = StageEnd::full, end_of_best_ = StageEnd::full;
};

/// Of the part of the container that it will fill, at most.
Across across_of_bed(const SpheresInBed& in_bed, const Heights& heights, const BedTop& top,
                     std::size_t count) {
  const std::shared_ptr<const Container>& whole = in_bed.task.container;
  const double volume = in_bed.volume_of_drawn(count) / (1 - porosity_loose(least_across));
  if (volume >= whole->volume()) return across_of(*whole, -top.up(), mean_diameter(in_bed, count));
  return across_of(*cut_by_planes(whole, top.planes(heights.holding(volume)), volume), -top.up(),
                   mean_diameter(in_bed, count));
}

void tell_density(const SpheresInBed& in_bed, Reporter& report, const BedTarget& target,
                  const std::optional<DensityAim>& aim, const std::string& why_none, const Across& across,
                  const Heights& heights, const BedTop& top) {
  const auto porosity = porosity_of(in_bed.bed(), heights, top);
  if (!porosity) return;  // of a few spheres on a floor there is none
  if (in_bed.supply->drawn(0) < in_bed.supply->radius(0)) return;  // nor of spheres with their coats
  report.bed_porosity = porosity->whole;
  report.account = fmt::format("the bed has a porosity of {:.3f}", porosity->whole);
  if (target.density) report.account += fmt::format(", far from floor and top {:.3f}", porosity->core);
  if (target.density == BedTarget::Density::poured && across.is_column && across.diameters > 1.5 &&
      across.diameters < 50)  // of which the law is
    report.account +=
        fmt::format(" (of poured beds {:.3f} by Benyahia and O'Neill's law, {:.3g} diameters across)",
                    porosity_poured(across.diameters), across.diameters);
  if (!why_none.empty()) report.account += "; " + why_none;
  if (aim && aim->of_core)
    report.account += fmt::format("; the aim there is {:.3f}, give or take {:g} ({})", aim->porosity,
                                  scatter_of_beds, aim->words);
}

}  // namespace

StageEnd settle_as_dense(SpheresInBed& in_bed, Reporter& report, const BedTarget& target,
                         const Heights& heights, const BedTop& top, double poured,
                         const std::function<StageEnd(Laying&)>& lay) {
  const std::size_t count = in_bed.target_count();
  const bool equal = in_bed.supply->smallest() == in_bed.supply->largest();
  const Across across = target.density ? across_of_bed(in_bed, heights, top, count) : Across{};
  auto [aim, why_none] =
      aim_of(target, across, equal ? 1 : in_bed.task.close_packing / close_packing_of_equal);
  const double height = aim ? height_of(in_bed, heights, count, aim->porosity) : 0;
  if (aim && aim->of_core && height < least_height) {
    aim.reset();
    why_none = fmt::format("it is lower than {:g} diameters, and no law is of such beds", least_height);
  }
  const bool vibrated = target.density == BedTarget::Density::vibrated;
  Laying once{vibrated ? denser_below_laws * poured : poured, vibrated ? usual_taps : 0};
  const StageEnd end =
      aim ? Attempts(in_bed, report, *aim, heights, top, lay).run(vibrated, height) : lay(once);
  if (end != StageEnd::cancelled) tell_density(in_bed, report, target, aim, why_none, across, heights, top);
  return end;
}

}  // namespace bernal
