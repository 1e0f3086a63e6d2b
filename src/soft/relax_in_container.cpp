#include "soft/relax.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "jam/few_spheres.hpp"
#include "jam/polish.hpp"
#include "settle/insert.hpp"
#include "soft/crowd.hpp"
#include "soft/shrink_in_container.hpp"
#include "soft/start_in_container.hpp"
#include "work/snug_places.hpp"

namespace bernal {
namespace {

/// Of patience, from one time that spheres are taken out to the next.
constexpr double less_patience = 0.7;
/// Where there are too many spheres for stirring to be of use it is done once.
constexpr double hopeless_patience = 1;
/// What is pushed in at a time, first and at last.
constexpr double pushed_in = 0.004, least_pushed_in = 2e-4;
constexpr int most_hand_overs = 20;
/// As many as fit are found by letting spheres shrink where they are at least so many, in a third of the
/// time. Fewer are stirred and pushed in.
constexpr std::size_t many_to_fill = 20000;
/// Where at least this share of the spheres is within three of its radii of a wall, pushing in more finds up
/// to two in a hundred; elsewhere it finds nothing after they have shrunk.
constexpr double share_near_walls = 0.7;
/// Fewer spheres take no time that would be worth saving, and next to all of them are near walls, where each
/// one more counts.
constexpr std::size_t many_to_hurry = 1000;
/// After sizes are exchanged: as `taken_out`, and exchanges each time.
constexpr double taken_out_dealing = 0.3;
constexpr int exchanges_to_settle = 50;

/// Of the radii: a skin up to this is lost in the margin.
constexpr double thin_skin = 1e-7;

class Relaxation {
 public:
  Relaxation(SpheresInBed& in_bed, Reporter& report, const Relax& options, bool pours)
      : in_bed_(in_bed),
        report_(report),
        options_(options),
        random_(report.random(Stream::relax)),
        skin_(in_bed.bed().skin() > thin_skin * in_bed.supply->smallest() ? in_bed.bed().skin() : 0),
        exchanges_(options.exchange &&
                   SizeExchange(in_bed.supply->radii(), in_bed.bed().dimension()).is_of_use()),
        snug_(SnugPlaces(in_bed, report).all_touch()),
        wide_(!pours && in_bed.bed().dimension() == 3 && is_for_wide_sizes(in_bed.task.fill_task, options)),
        crowd_(ContainerGround(in_bed.bed().container(), in_bed.bed().places(), snug_, wide_, first_margin()),
               spheres_to_start_from(in_bed, options, skin_, random_, report.monitor)),
        target_count_(std::max(crowd_.size(), in_bed.target_count())),
        shrinks_(!pours && !snug_ && in_bed.bed().dimension() == 3 && in_bed.begun == 0 &&
                 in_bed.crowded_start.empty() &&
                 (wide_ || (in_bed.task.target.fill && crowd_.size() >= many_to_fill))) {}

  StageEnd run() {
    enum class Step { shrink, free, push_in, exchange, push_in_more, finish } step = Step::shrink;
    bool free = false, limited = false;
    StageEnd end = StageEnd::full;
    BedKeepsake ordinary;  // what stands without an exchange
    const Resumable part(report_, "relaxation", [&](Archive& a) {
      a(step, free, limited, share_out_, patience_, random_, over_, is_full_, sweeps_of_exchange_, has_dealt_,
        end, ordinary);
    });
    if (step == Step::shrink) {
      free = shrinks_ && pack_shrinking();
      if (!cancelled_) step = Step::free;
    }
    if (step == Step::free) {
      free = free || free_by_dropping();
      limited = over_;  // what is added after that is as much as there is time for
      if (!cancelled_) step = Step::push_in;
    }
    if (step == Step::push_in) {
      if (free && !over_ && !is_packed_full()) push_in();
      const bool has_time = !limited && !cancelled_ && !is_out_of_time();
      const bool exchanges_sizes = free && has_time && exchanges_ && crowd_.size() < target_count_;
      end = stand(free, limited);
      if (exchanges_sizes && end == StageEnd::full) {
        end = insert_what_else_fits(in_bed_, report_, end);
        ordinary = BedKeepsake(in_bed_);
        over_ = cancelled_;
      }
      step = exchanges_sizes && end == StageEnd::full ? Step::exchange : Step::finish;
    }
    if (step == Step::exchange) {
      exchange();
      step = Step::push_in_more;
    }
    if (step == Step::push_in_more) {
      if (has_dealt_ && !over_) push_in();
      end = keep_denser(ordinary);
    }
    if (cancelled_ && step < Step::push_in) put_in_bed();
    report_.effects["neighbour lists"] += crowd_.lists_built();
    report_.effects["relaxation"].calls += static_cast<std::uint64_t>(crowd_.sweeps());
    return cancelled_ ? StageEnd::cancelled : end;
  }

 private:
  /// Wide, unless spheres are few or are to be as dense as they can.
  double first_margin() const {
    const bool densest = in_bed_.task.target.fill || options_.exchange || snug_ ||
                         in_bed_.target_count() < many_to_hurry ||
                         in_bed_.target_count() > in_bed_.count_filling(in_bed_.task.attainable);
    return densest ? 0 : ContainerGround::wide_margin;
  }

  /// Returns whether as many as fit are free of overlap.
  bool pack_shrinking() {
    const auto tell = [this](const Spheres<3>& spheres, double largest, double done) {
      report_.milestone("relax", spheres.size(), packing_fraction_of(spheres), largest, done);
    };
    const auto is_over = [this](double sweeps) { return is_over_after(sweeps); };
    FirstThatFit packed = bernal::pack_shrinking(in_bed_, crowd_.size(), target_count_, skin_, random_,
                                                 report_, options_, is_over, tell);
    const bool limited = packed.end == StageEnd::hit_limit;
    cancelled_ = packed.end == StageEnd::cancelled;
    over_ = cancelled_ || (limited && !packed.is_free);
    is_full_ = packed.is_free && (packed.is_full || limited);
    crowd_.restore(std::move(packed.spheres));
    return packed.is_free && !cancelled_;
  }

  /// Puts them into the bed.
  StageEnd stand(bool free, bool limited) {
    // Single precision saw them free of overlap in motion; a few more sweeps bring all of them there.
    bool all_there = put_in_bed();
    for (int k = 0; !all_there && free && !cancelled_ && k < most_hand_overs; ++k) {
      cancelled_ = crowd_.settle(report_.monitor, [this] { tell(); }) == StageEnd::cancelled;
      all_there = put_in_bed();
    }
    if (cancelled_) return StageEnd::cancelled;
    if (!all_there || crowd_.size() < target_count_) place_snugly();
    if (in_bed_.bed().size() >= target_count_) return StageEnd::converged;
    return limited ? StageEnd::hit_limit : StageEnd::full;
  }

  /// What an exchange of sizes came to, unless more stands without it.
  StageEnd keep_denser(const BedKeepsake& ordinary) {
    const auto is_denser = [&] { return in_bed_.bed().packing_fraction() > ordinary.packing_fraction(); };
    if (has_dealt_) {
      StageEnd end = stand(true, false);
      if (!is_denser()) end = insert_what_else_fits(in_bed_, report_, end);
      if (is_denser()) return end;
    }
    report_.account = cancelled_ ? "the exchange of sizes was not finished, and left no trace"
                                 : "an exchange of sizes has made no room";
    in_bed_.put_back(ordinary.spheres());
    return StageEnd::full;
  }

  bool put_in_bed() {
    Spheres<3> spheres = crowd_.spheres();
    for (std::uint32_t i = 0; i < spheres.size(); ++i) spheres.r[i] = in_bed_.supply->radius(i);
    if (snug_) SnugPlaces(in_bed_, report_).move_to_touch(spheres);
    return in_bed_.put_in_bed(spheres);
  }

  /// Settles and stirs. Returns whether the spheres came free of overlap.
  bool relax(double patience) {
    const auto is_over = [this] { return is_over_after(crowd_.sweeps() - sweeps_of_exchange_); };
    const StageEnd end = crowd_.relax({.patience = patience,
                                       .hopeless_patience = hopeless_patience,
                                       .failures_a_burst = std::numeric_limits<int>::max(),
                                       .milestone = [this] { tell(); },
                                       .is_over = is_over,
                                       .checkpoints = report_.checkpoints},
                                      report_.monitor, random_);
    cancelled_ = end == StageEnd::cancelled;
    over_ = over_ || cancelled_ || end == StageEnd::hit_limit;
    return end == StageEnd::converged;
  }

  /// Whether they have shrunk to what fits, and no more is likely to be pushed in.
  bool is_packed_full() const {
    if (!is_full_ || crowd_.size() < many_to_fill) return false;
    const Spheres<3>& spheres = crowd_.spheres();
    std::size_t near = 0;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const double reach = 3 * spheres.r[i];
      near += in_bed_.bed().container().clearance_within(spheres.center(i), reach) < reach;
    }
    return static_cast<double>(near) < share_near_walls * static_cast<double>(spheres.size());
  }

  bool is_over_after(double sweeps) const { return sweeps > options_.sweeps || is_out_of_time(); }
  bool is_out_of_time() const { return options_.seconds > 0 && seconds() > options_.seconds; }

  /// How many of the sequence, up to the target, this share of those that are there is.
  std::size_t count_of_more(double share) const {
    const std::size_t n = crowd_.size();
    return std::min(target_count_ - n, static_cast<std::size_t>(std::ceil(share * static_cast<double>(n))));
  }

  /// The next of the sequence, in holes. Returns false, with nothing changed, if there are not so many.
  bool add(std::size_t count) {
    const auto next = std::span(in_bed_.supply->radii()).subspan(crowd_.size(), count);
    std::vector<double> radii(next.begin(), next.end());
    for (double& r : radii) r += skin_;
    return crowd_.add(radii, random_);
  }

  /// More and more of the sequence, until even a few find no room.
  void push_in() {
    double share = pushed_in;
    std::size_t more = 0;
    Spheres<3> before;
    const Resumable part(report_, "push in", [&](Archive& a) { a(share, more, before); });
    for (bool goes_on = part.resumed(); share >= least_pushed_in && !over_;) {
      if (!std::exchange(goes_on, false)) {
        before = crowd_.spheres();
        more = count_of_more(share);
        if (more == 0 || !add(more)) return;
        if (!has_dealt_) crowd_.burst();
      }
      if (has_dealt_ ? settle_by_exchange() : relax(options_.patience)) continue;
      crowd_.restore(before);
      if (more == 1) return;
      share /= 2;
    }
  }

  /// Relaxes and stirs, and takes out what does not come free. Returns whether the others are.
  bool free_by_dropping() {
    for (;;) {
      const bool free = relax(patience_);
      if (free || cancelled_ || crowd_.size() <= 1) return free;
      const double count = share_out_ * crowd_.mean_squeeze() * static_cast<double>(crowd_.size());
      crowd_.drop_last(count, random_);
      share_out_ *= taken_out_faster;
      patience_ = over_ ? 0 : less_patience * patience_;
    }
  }

  /// Spheres that are free of overlap exchange their sizes, and more of the sequence come in as that makes
  /// room, or not: see `keep_denser`.
  void exchange() {
    const EffectTimer timer(report_.effects["exchange"]);
    Spheres<3> ordinary = crowd_.spheres();
    double sweeps_before = crowd_.sweeps();
    bool crowding = true;
    const Resumable part(report_, "exchange", [&](Archive& a) { a(ordinary, sweeps_before, crowding); });
    if (crowding) crowd_by_exchange();
    crowding = false;
    bool free = settle_by_exchange();
    while (!free && !over_ && crowd_.size() > ordinary.size()) {
      crowd_.drop_last_dealing(taken_out_dealing * crowd_.mean_squeeze() *
                               static_cast<double>(crowd_.size()));
      free = settle_by_exchange();
    }
    sweeps_of_exchange_ += crowd_.sweeps() - sweeps_before;
    has_dealt_ = free && crowd_.size() > ordinary.size();
    if (has_dealt_)
      report_.account =
          fmt::format("an exchange of sizes has made room for {:.1f} % more",
                      100 * (in_bed_.volume_of(crowd_.spheres()) / in_bed_.volume_of(ordinary) - 1));
  }

  /// Up to a little more than there is room for, unless all are there before.
  void crowd_by_exchange() {
    int k = 0;
    const Resumable part(report_, "crowding", [&](Archive& a) { a(k, crowd_); });
    SizeExchange sizes(crowd_.spheres().r, in_bed_.bed().dimension());
    const auto is_done = [&] {
      return crowd_.is_free() && !sizes.is_widened() && crowd_.size() == target_count_;
    };
    for (; k < exchanges && !is_done(); ++k) {
      if (exchange_is_over()) return;
      const double done = static_cast<double>(k) / exchanges;
      const double energy = crowd_.exchange(sizes, done);
      if (energy < crowding && crowd_.size() < target_count_) {
        if (!add(count_of_more(compression - 1))) return;
        sizes = SizeExchange(crowd_.spheres().r, in_bed_.bed().dimension());
      }
      if (k % exchanges_a_milestone == 0) tell("exchange", done);
    }
  }

  /// Returns whether the spheres came free of overlap. Nothing is stirred: that would undo what exchange has
  /// done.
  bool settle_by_exchange() {
    int k = 0;
    const Resumable part(report_, "settling", [&](Archive& a) { a(k, crowd_); });
    SizeExchange sizes(crowd_.spheres().r, in_bed_.bed().dimension());
    for (; k < exchanges_to_settle && !crowd_.is_free(); ++k) {
      if (exchange_is_over()) return false;
      crowd_.exchange(sizes, 1);
    }
    const StageEnd end = crowd_.settle(report_.monitor, [this] { tell(); });
    cancelled_ = end == StageEnd::cancelled;
    over_ = over_ || cancelled_;
    return end == StageEnd::converged;
  }

  bool exchange_is_over() {
    cancelled_ = report_.stop();
    over_ = over_ || cancelled_ || is_out_of_time();
    return over_;
  }

  /// Those that the walls leave less room than the margin, which never come free of overlap.
  void place_snugly() {
    SnugPlaces(in_bed_, report_)
        .complete(in_bed_.volume_of_drawn(target_count_) / in_bed_.task.container->volume());
  }

  void tell() { tell("relax", crowd_.done()); }
  void tell(std::string_view stage, double done) {
    report_.milestone(stage, crowd_.size(), packing_fraction_of(crowd_.spheres()), crowd_.largest_overlap(),
                      done);
  }
  double packing_fraction_of(const Spheres<3>& spheres) const {
    return in_bed_.volume_of(spheres) / in_bed_.task.container->volume();
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  SpheresInBed& in_bed_;

  Reporter& report_;
  const Relax options_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Random random_;
  const double skin_;     // that the radii are relaxed with, where it is not thin: far from the origin
  const bool exchanges_;  // sizes, which is of use
  const bool snug_;       // between the walls
  const bool wide_;       // sizes
  CrowdInContainer crowd_;
  const std::size_t target_count_;
  const bool shrinks_;  // to begin with, see `pack_shrinking`
  double sweeps_of_exchange_ = 0;
  bool has_dealt_ = false;                                       // an exchange of sizes has made room
  double share_out_ = taken_out, patience_ = options_.patience;  // of the next that are taken out
  bool is_full_ = false;                                         // hardly more fit, as is known
  bool over_ = false;  // there is no more time, or no more patience of the user
  bool cancelled_ = false;
};

/// Whether what is asked for is so little that spheres need not push each other.
bool is_dilute(const SpheresInBed& in_bed) {
  const Task& task = in_bed.task;
  return !task.target.is_open() && in_bed.volume_of_drawn(in_bed.supply->wanted()) <=
                                       dilute * task.attainable * task.container->volume();
}

StageEnd relaxed_in_container(const Relax& options, SpheresInBed& in_bed, Reporter& report, bool pours,
                              bool searches) {
  enum class Step { begin, insert, relax, finish } step = Step::begin;
  StageEnd end = StageEnd::converged;
  const Resumable part(report, "relax in container", [&](Archive& a) { a(step, end); });
  const auto relaxed = [&] {
    if (step == Step::begin) {
      // What fits only touching the walls would be pushed off its place; the others come around it.
      if (SnugPlaces(in_bed, report).only_some_touch()) return insert_largest_first(in_bed, report);
      const bool all_stand = in_bed.begun > 0 && !in_bed.task.target.is_open() && in_bed.supply->exhausted();
      if (all_stand) return StageEnd::converged;
      step = is_dilute(in_bed) && in_bed.crowded_start.empty() ? Step::insert : Step::relax;
    }
    if (step == Step::insert) {
      const StageEnd inserted = insert(until_full, in_bed, report);
      if (inserted != StageEnd::full) return inserted;
      step = Step::relax;
    }
    const auto relax = [&] {
      const EffectTimer timer(report.effects["relaxation"]);
      return Relaxation(in_bed, report, options, pours).run();
    };
    const StageEnd full = insert_what_else_fits(in_bed, report, relax());
    return searches ? place_few(full, in_bed, report, !pours) : full;
  };
  if (step != Step::finish) end = relaxed();
  step = Step::finish;
  return finish_in_bed(end, options.polish, in_bed, report);
}

}  // namespace

StageEnd relax_in_container(const Relax& options, SpheresInBed& in_bed, Reporter& report) {
  return relaxed_in_container(options, in_bed, report, false, true);
}

StageEnd relax_to_pour(const Relax& options, SpheresInBed& in_bed, Reporter& report, bool rises) {
  return relaxed_in_container(options, in_bed, report, true, !rises);
}

}  // namespace bernal
