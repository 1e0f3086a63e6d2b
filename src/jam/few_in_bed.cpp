#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "jam/few_spheres.hpp"
#include "settle/insert.hpp"

namespace bernal {
namespace {

class FewInBed {
 public:
  FewInBed(SpheresInBed& in_bed, Reporter& report)
      : in_bed_(in_bed), report_(report), gap_(gap_of_few(in_bed.bed().container())) {}

  StageEnd run(StageEnd end, bool may_be_lattice) {
    const Target& target = in_bed_.task.target;
    const std::size_t wanted = in_bed_.supply->wanted();
    if (may_be_lattice && in_bed_.bed().size() < wanted && of_one_size()) lay_out();
    const std::size_t there = in_bed_.bed().size();
    if (!target.is_open() && (there == wanted || place(wanted, 1))) return StageEnd::converged;
    bool all_tried = false;
    for (std::size_t count = there + 1; count <= wanted && !cancelled_ && !all_tried; ++count) {
      if (!are_few(count, in_bed_.bed().container())) return end;
      if (!target.is_open() && count == wanted) break;
      all_tried = !place(count, effort_of_one_more(static_cast<double>(count)));
    }
    if (cancelled_) return StageEnd::cancelled;
    if (target.is_open() && all_tried)
      report_.account =
          fmt::format("of {0} no arrangement was found in a short search; count = {0} searches longer",
                      in_bed_.bed().size() + 1);
    return target.is_open() && all_tried ? StageEnd::full : end;
  }

 private:
  bool of_one_size() const { return in_bed_.supply->smallest() == in_bed_.supply->largest(); }

  /// On a simple cubic lattice, if more find their places there than stand.
  void lay_out() {
    const BedKeepsake before(in_bed_);
    const std::size_t there = in_bed_.bed().size();
    in_bed_.put_back({});
    const Monitor nobody;  // it takes no time, and nothing may be lost meanwhile
    std::vector<Vector<3>> sites = crystal_sites({.layout = Layout::sc}, in_bed_, nobody);
    if (sites.size() > in_bed_.supply->wanted()) sites.resize(in_bed_.supply->wanted());
    in_bed_.put_back(sites.size() > there ? first_drawn(sites) : before.spheres());
  }

  FirstDrawn first_drawn(const std::vector<Vector<3>>& places) const {
    FirstDrawn drawn;
    drawn.extend(places.size(), *in_bed_.supply);
    for (std::size_t i = 0; i < places.size(); ++i) drawn.spheres.set_center(i, places[i]);
    drawn.placed.assign(places.size(), true);
    return drawn;
  }

  /// So many of the sequence in place of what stands there, if there is a way. Returns whether they stand.
  bool place(std::size_t count, double effort) {
    const Bed& bed = in_bed_.bed();
    if (!are_few(count, bed.container())) return false;
    if (in_bed_.task.few_places.size() == count) return stand(first_drawn(in_bed_.task.few_places));
    Spheres<3> spheres = in_bed_.drawn(count).spheres;
    spheres.resize(count);
    const double volume = in_bed_.volume_of(spheres);
    if (volume > most_volume()) return false;
    const double share = volume / bed.container().volume();
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
    return packed.size >= enough && stand(first_drawn(packed.centers));
  }

  /// In place of all that is in the bed, if they fit by the gap, which may be less than the bed's skin.
  bool stand(const FirstDrawn& few) {
    const Container& container = in_bed_.bed().container();
    const Spheres<3>& spheres = few.spheres;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Vector<3> place = spheres.center(i);
      std::optional<EffectTimer> exact_timer;
      if (container.arithmetic() == WallArithmetic::exact)
        exact_timer.emplace(report_.effects[exact_walls_effect]);
      if (!container.contains(place, spheres.r[i] + gap_)) return false;
      for (std::size_t j = 0; j < i; ++j)
        if (!((place - spheres.center(j)).norm() >= spheres.r[i] + spheres.r[j] + gap_)) return false;
    }
    in_bed_.put_back(few);
    return true;
  }

  /// More does not fit: boxes, put side by side, fill space, and no arrangement of spheres of one size fills
  /// more than this of it (Thue 1892, Hales 2005). Other containers may be as round as what is in them.
  double most_volume() const {
    using std::numbers::pi;
    const auto* box = std::get_if<Box>(&in_bed_.task.domain);
    if (!box || !of_one_size()) return in_bed_.bed().container().volume();
    return box->size.prod() * pi / std::sqrt(in_bed_.bed().dimension() == 2 ? 12.0 : 18.0);
  }

  SpheresInBed& in_bed_;
  Reporter& report_;
  const double gap_;
  bool cancelled_ = false;
};

}  // namespace

StageEnd place_few(StageEnd end, SpheresInBed& in_bed, Reporter& report, bool may_be_lattice) {
  if (end == StageEnd::cancelled || !are_few(in_bed.bed().size() + 1, in_bed.bed().container())) return end;
  const NotResumable search(report);
  const EffectTimer timer(report.effects["relaxation"]);
  return FewInBed(in_bed, report).run(end, may_be_lattice);
}

}  // namespace bernal
