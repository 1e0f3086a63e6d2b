#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "jam/few_spheres.hpp"

namespace bernal {
namespace {

/// Of the search, how much each of the spheres is worth that nobody has asked for by number: so much, and of
/// more than sixteen that times sixteen over their number, 0.2 s at most.
constexpr double effort_of_one_more = 0.125, with_full_effort = 16;
/// In largest roundings of a coordinate: gaps that no rounding closes, of spheres that nobody moves any more.
constexpr double gap_in_roundings = 1e3;

class FewInBed {
 public:
  FewInBed(SpheresInBed& in_bed, Reporter& report)
      : in_bed_(in_bed), report_(report), gap_(gap_in_roundings * in_bed.bed().container().resolution()) {}

  StageEnd run(StageEnd end) {
    const Target& target = in_bed_.task.target;
    const std::size_t wanted = in_bed_.supply->wanted(), there = in_bed_.bed().size();
    if (!target.is_open() && there < wanted && place(wanted, 1)) return StageEnd::converged;
    bool all_tried = false;
    for (std::size_t count = there + 1; count <= wanted && !cancelled_ && !all_tried; ++count) {
      if (!are_few(count, in_bed_.bed().container())) return end;
      if (!target.is_open() && count == wanted) break;
      all_tried = !place(count, effort_for(count));
    }
    if (cancelled_) return StageEnd::cancelled;
    if (target.is_open() && all_tried)
      report_.account = fmt::format("of {} no arrangement was found", grouped(in_bed_.bed().size() + 1));
    return target.is_open() && all_tried ? StageEnd::full : end;
  }

 private:
  /// So many of the sequence in place of what stands there, if there is a way. Returns whether they stand.
  bool place(std::size_t count, double effort) {
    const Bed& bed = in_bed_.bed();
    if (!are_few(count, bed.container())) return false;
    Spheres<3> spheres = in_bed_.drawn(count).spheres;
    spheres.resize(count);
    const double share = volume_of(spheres) / bed.container().volume();
    if (share > densest_known(bed.dimension())) return false;
    const double enough = 1 + gap_ / std::ranges::min(spheres.r);
    const FewPacked packed = pack_few(spheres.r, bed.container(), bed.places(),
                                      {.enough = enough,
                                       .effort = effort,
                                       .seed = report_.seed,
                                       .monitor = report_.monitor,
                                       .tell = [&](double done, double size) {
                                         const double there =
                                             std::pow(std::min(size, 1.0), bed.dimension()) * share;
                                         report_.milestone("few", count, there, 0, done, false);
                                       }});
    report_.effects["relaxation"].calls += packed.minima;
    cancelled_ = packed.cancelled;
    if (packed.size < enough) return false;
    for (std::size_t i = 0; i < count; ++i) spheres.set_center(i, packed.centers[i]);
    return stand(spheres);
  }

  /// In place of all that is in the bed, if they fit by the gap, which may be less than the bed's skin.
  bool stand(const Spheres<3>& spheres) {
    const Container& container = in_bed_.bed().container();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Vector<3> place = spheres.center(i);
      std::optional<EffectTimer> exact_timer;
      if (container.arithmetic() == WallArithmetic::exact)
        exact_timer.emplace(report_.effects[exact_walls_effect]);
      if (!container.contains(place, spheres.r[i] + gap_)) return false;
      for (std::size_t j = 0; j < i; ++j)
        if (!((place - spheres.center(j)).norm() >= spheres.r[i] + spheres.r[j] + gap_)) return false;
    }
    in_bed_.put_back({spheres, std::vector<bool>(spheres.size(), true)});
    return true;
  }

  static double effort_for(std::size_t count) {
    return effort_of_one_more * std::min(1.0, with_full_effort / static_cast<double>(count));
  }

  /// Of the volume: equal spheres fill no more. Mixtures that would are not searched for.
  static double densest_known(int dimension) { return dimension == 2 ? 0.9069 : 0.7405; }

  SpheresInBed& in_bed_;
  Reporter& report_;
  const double gap_;
  bool cancelled_ = false;
};

}  // namespace

StageEnd place_few(StageEnd end, SpheresInBed& in_bed, Reporter& report) {
  if (end == StageEnd::cancelled || !are_few(in_bed.bed().size() + 1, in_bed.bed().container())) return end;
  const NotResumable search(report);
  const EffectTimer timer(report.effects["relaxation"]);
  return FewInBed(in_bed, report).run(end);
}

}  // namespace bernal
