#include "bernal/result/certify_levels.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"

namespace bernal {
namespace {

constexpr double unit_to = 1e-12;  // of the squared norm of a quaternion

std::string text_of(double length, Unit unit) { return fmt::format("{} {}", length, name_of(unit)); }

bool is_unit(const std::array<double, 4>& q) {
  double squared = 0;
  for (const double c : q) squared += c * c;
  return std::abs(squared - 1) <= unit_to;
}

/// Where some of the spheres that could hold a packing hold none, of how many that is.
std::string words_of(const Certificate::Level& level, std::size_t of_class) {
  if (of_class == 0) return fmt::format("inside {}: there are no such spheres", level.name);
  if (level.filled == 0)
    return fmt::format("inside {}: none of {} {} holds a packing", level.name, grouped(of_class),
                       of_class == 1 ? "sphere" : "spheres");
  const std::string filled = level.filled == of_class
                                 ? grouped(level.filled)
                                 : fmt::format("{} of {}", grouped(level.filled), grouped(of_class));
  return fmt::format("inside {}: {} in {} {}, each in its innermost layer, {} {}", level.name,
                     level.packings == 1 ? "one packing" : grouped(level.packings) + " packings", filled,
                     of_class == 1 ? "sphere" : "spheres", grouped(level.spheres),
                     level.spheres == 1 ? "sphere in all" : "spheres in all");
}

/// The proof for what lies inside the spheres of one class.
class Proof {
 public:
  Proof(const Packing& packing, const PackingsInside& inside, const SphereLayers& layers)
      : packing_(packing), inside_(inside), layers_(layers) {
    const std::vector<SphereClass> classes = classes_of(packing.scene);
    level_.name = inside.of_class < classes.size() ? classes[inside.of_class].name : "spheres";
    level_.packings = inside.templates.size();
    uses_.resize(inside.templates.size(), 0);
    of_class_ = packing.classes.empty()
                    ? packing.spheres.size()
                    : static_cast<std::size_t>(std::ranges::count(packing.classes, inside.of_class));
  }

  /// Of each filled sphere.
  void look_at_spheres() {
    const std::size_t n = inside_.spheres.size();
    if (inside_.which.size() != n || inside_.rotations.size() != n) {
      complain("the lists of filled spheres have different lengths");
      return;
    }
    level_.filled = n;
    for (std::size_t k = 0; k < n; ++k)
      if (const std::string fault = fault_of(k); !fault.empty())
        complain(fault);
      else
        ++uses_[inside_.which[k]];
  }

  /// Of each packing.
  void look_at_packings(const std::vector<Certificate>& certificates) {
    for (std::size_t t = 0; t < certificates.size(); ++t) {
      const Certificate& c = certificates[t];
      if (!c.certified && packing_fault_.empty())
        packing_fault_ = fmt::format("packing {} inside {}: {}", t + 1, level_.name, c.statement);
      level_.packed += c.spheres;
      level_.spheres += uses_[t] * c.spheres;
      level_.pairs_tested += c.pairs_tested;
      level_.walls_tested += c.walls_tested;
      level_.decided_double += c.decided_double;
      level_.decided_exact += c.decided_exact;
      level_.overlapping_pairs += c.overlapping_pairs;
      level_.protruding_spheres += c.protruding_spheres;
      for (const Certificate::Level& deeper : c.levels) add(deeper, uses_[t]);
    }
  }

  /// What is wrong, or nothing.
  std::string fault() const {
    if (!packing_fault_.empty()) return packing_fault_;
    if (level_.misplaced > 1)
      return fmt::format("{}, and {} more spheres", sphere_fault_, grouped(level_.misplaced - 1));
    return sphere_fault_;
  }
  /// "inside pebble: 10 packings in 29,400 spheres, …", and what lies inside of these.
  std::string in_words() const {
    std::string words = "; " + words_of(level_, of_class_);
    for (const Certificate::Level& level : deeper_) words += "; " + words_of(level, level.filled);
    return words;
  }
  void take_into(Certificate& c) {
    c.levels.push_back(level_);
    std::ranges::move(deeper_, std::back_inserter(c.levels));
  }

 private:
  void complain(const std::string& fault) {
    if (level_.misplaced++ == 0) sphere_fault_ = fault;
  }

  std::string fault_of(std::size_t k) const {
    const std::uint32_t i = inside_.spheres[k], t = inside_.which[k];
    if (k > 0 && i <= inside_.spheres[k - 1])
      return fmt::format("sphere {} is filled after sphere {}", i, inside_.spheres[k - 1]);
    if (i >= packing_.spheres.size()) return fmt::format("there is no sphere {} that could be filled", i);
    if (!packing_.classes.empty() && packing_.classes[i] != inside_.of_class)
      return fmt::format("sphere {} is filled, and is not of the class {}", i, level_.name);
    if (t >= inside_.templates.size())
      return fmt::format("sphere {} holds packing {}, which is not there", i, t + 1);
    if (!is_unit(inside_.rotations[k])) return fmt::format("sphere {} is turned by no unit quaternion", i);
    const Packing& packing = *inside_.templates[t];
    const auto* ball = std::get_if<Sphere>(&packing.domain);
    if (!ball || !ball->center.isZero(0))
      return fmt::format("packing {} inside {} lies in no ball about the origin", t + 1, level_.name);
    const std::span<const double> of = layers_.empty() ? std::span<const double>() : layers_.of(i);
    const double room = of.empty() ? packing_.spheres.r[i] : of.front();
    const Unit unit = packing_.scene.unit, unit_inside = packing.scene.unit;
    if (is_at_most(ball->radius, unit_inside, room, unit)) return {};
    return fmt::format("sphere {} has room for a ball of radius {}, and holds one of {}", i,
                       text_of(room, unit), text_of(ball->radius, unit_inside));
  }

  void add(const Certificate::Level& of, std::uint64_t times) {
    const std::string name = level_.name + " / " + of.name;
    auto found = std::ranges::find(deeper_, name, &Certificate::Level::name);
    if (found == deeper_.end()) found = deeper_.insert(found, Certificate::Level{.name = name});
    found->packings += of.packings;
    found->packed += of.packed;
    found->filled += times * of.filled;
    found->spheres += times * of.spheres;
    found->pairs_tested += of.pairs_tested;
    found->walls_tested += of.walls_tested;
    found->decided_double += of.decided_double;
    found->decided_exact += of.decided_exact;
    found->overlapping_pairs += of.overlapping_pairs;
    found->protruding_spheres += of.protruding_spheres;
    found->misplaced += of.misplaced;
  }

  const Packing& packing_;
  const PackingsInside& inside_;
  const SphereLayers& layers_;
  Certificate::Level level_;
  std::vector<Certificate::Level> deeper_;
  std::vector<std::uint64_t> uses_;  // of each packing
  std::size_t of_class_ = 0;         // spheres that could be filled
  std::string packing_fault_, sphere_fault_;
};

}  // namespace

Certificate with_levels(Certificate c, const Packing& packing,
                        const std::vector<std::vector<Certificate>>& of_insides) {
  if (packing.inside.empty()) return c;
  const SphereLayers layers = layers_of(packing);
  std::string faults, words;
  for (std::size_t k = 0; k < packing.inside.size(); ++k) {
    Proof proof(packing, packing.inside[k], layers);
    proof.look_at_spheres();
    proof.look_at_packings(of_insides[k]);
    if (const std::string fault = proof.fault(); !fault.empty())
      faults += (faults.empty() ? "" : "; ") + fault;
    words += proof.in_words();
    proof.take_into(c);
  }
  c.spheres_of_all_levels = c.spheres;
  for (const Certificate::Level& level : c.levels) c.spheres_of_all_levels += level.spheres;
  if (!faults.empty()) {
    c.statement = fmt::format("{}Not certified by levels: {}{}", c.certified ? "" : c.statement + " ", faults,
                              faults.ends_with('.') ? "" : ".");
    c.certified = false;
  } else if (c.certified && c.spheres_of_all_levels == c.spheres) {
    c.statement += fmt::format(" Nothing lies in them{}.", words);
  } else if (c.certified) {
    c.statement += fmt::format(
        " So are all levels{}. A rotation changes no distance: what is said of the spheres holds for all {}, "
        "which stand for "
        "themselves.",
        words, grouped(c.spheres_of_all_levels));
  }
  return c;
}

Certificate certify_levels(const Packing& packing, const CertifyOptions& options) {
  const auto of_scene = [&](const Scene& scene) {
    CertifyOptions own = options;
    own.allowed_overlap = scene.overlap;
    own.gap = scene.gap;
    own.wall_gap = scene.wall_gap;
    return own;
  };
  const Stopwatch watch;
  Certificate c = certify(packing.spheres, packing.domain, of_scene(packing.scene));
  std::vector<std::vector<Certificate>> of_insides;
  for (const PackingsInside& inside : packing.inside) {
    std::vector<Certificate>& of = of_insides.emplace_back();
    for (const auto& packed : inside.templates) {
      of.push_back(certify_levels(*packed, of_scene(packed->scene)));
      c.cancelled = c.cancelled || of.back().cancelled;
    }
  }
  c = with_levels(std::move(c), packing, of_insides);
  c.seconds = watch.seconds();
  return c;
}

}  // namespace bernal
