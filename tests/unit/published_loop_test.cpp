#include "soft/published_loop.hpp"
#include "bernal/run/run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "bernal/core/dimension.hpp"
#include "bernal/measure/measure.hpp"
#include "soft/relax.hpp"
#include "support/plans.hpp"
#include "support/sorted_cells.hpp"

// The published loop packs the same to the bit whatever keeps the spheres, and as one that looks at all
// pairs.
namespace bernal {
namespace published_loop_test {

enum class Sizes { equal, uniform, one_to_a_hundred };

struct Case {
  int count;
  double phi;  ///< at the start, unless a sphere would overlap itself
  Sizes sizes;
  bool settle = false;
  double stretch = 1;  ///< of the first edge
};

double radius(Sizes sizes, Random& random) {
  const double u = random.uniform();
  return sizes == Sizes::equal ? 1 : sizes == Sizes::uniform ? 0.5 + 0.5 * u : u < 0.1 ? 1 : 0.01;
}

template <int D>
std::pair<Spheres<D>, Vector<D>> start_of(const Case& of, std::uint64_t seed = 1) {
  Random random(seed, 0);
  Spheres<D> spheres;
  std::vector<double> radii = {1};  // one of the largest
  while (radii.size() < static_cast<std::size_t>(of.count)) radii.push_back(radius(of.sizes, random));
  double volume = 0;
  for (const double r : radii) volume += ball_volume(D, r);
  Vector<D> edges = Vector<D>::Constant(std::pow(volume / of.phi / of.stretch, 1.0 / D));
  edges[0] *= of.stretch;
  edges *= std::max(1.0, 2.001 / edges.minCoeff());
  for (const double r : radii) {
    Vector<D> c;
    for (int k = 0; k < D; ++k) c[k] = edges[k] * random.uniform();
    spheres.push_back(c, r);
  }
  return {spheres, edges};
}

const Case cases[] = {
    {1, 0.8, Sizes::equal},
    {2, 0.8, Sizes::equal, true},
    {7, 0.8, Sizes::uniform},  // a box of fewer than three cells across
    {30, 0.8, Sizes::uniform, true},
    {60, 0.8, Sizes::uniform, false, 12},
    {250, 0.86, Sizes::equal},
    {250, 0.3, Sizes::uniform, true},
    {250, 0.8, Sizes::one_to_a_hundred, true},
};

template <int D, template <int> class Cells>
std::vector<double> sweeps_of(const Case& of, int sweeps) {
  const auto [spheres, edges] = start_of<D>(of);
  PublishedLoop<D, Cells> loop(spheres, edges, of.settle, Random(2, 0));
  std::vector<double> all;  // that may differ
  for (int k = 1; k <= sweeps; ++k) {
    all.push_back(loop.sweep());
    if (k % 7 == 0) loop.grow(1 + all.back() / 30);
  }
  Spheres<D> after = spheres;
  loop.write_to(after);
  for (int k = 0; k < D; ++k) {
    all.push_back(loop.edges()[k]);
    all.insert(all.end(), after.x[k].begin(), after.x[k].end());
  }
  return all;
}

/// Calls f with 1 to 5 dimensions and every case.
template <class F>
void for_each_case(F f) {
  const auto in_dimension = [&](auto dimension) {
    for (const Case& of : cases) {
      SCOPED_TRACE(::testing::Message() << dimension << " dimensions, " << of.count << " spheres");
      f(dimension, of);
    }
  };
  [&]<int... D>(std::integer_sequence<int, D...>) { (in_dimension(std::integral_constant<int, D>{}), ...); }
  (std::integer_sequence<int, 1, 2, 3, 4, 5>{});
}

TEST(PublishedLoop, IsTheSameToTheBitOnListsAndOnSortedArrays) {
  for_each_case([](auto dimension, const Case& of) {
    constexpr int D = decltype(dimension)::value;
    EXPECT_EQ((sweeps_of<D, LinkedCells>(of, 40)), (sweeps_of<D, SortedCells>(of, 40)));
  });
}

/// Moves every sphere once a sweep, by up to a tenth of the box or hardly at all, lets the box grow between
/// sweeps, and asks each time for what is near.
template <int D, template <int> class Cells>
void expect_to_find_what_is_near(const Case& of) {
  const auto [spheres, edges] = start_of<D>(of, 7);
  const double most = std::ranges::max(spheres.r);
  Cells<D> cells({edges}, spheres, std::ranges::min(spheres.r), most);
  Random random(3, 0);
  for (const double step : {0.1, 1e-3, 0.01, 1e-6, 1e-6}) {
    cells.begin_sweep();
    for (std::uint32_t number = 0; number < cells.size(); ++number) {
      const Vector<D> c = cells[cells.slot_of(number)].center;
      std::vector<int> visits(cells.size(), 0);
      const double reach = random.uniform(0, 2) * most;
      cells.for_each_near(c, reach, [&](std::uint32_t slot) { ++visits[slot]; });
      for (std::uint32_t slot = 0; slot < cells.size(); ++slot) {
        const double gap = cells.box().minimum_image(cells[slot].center - c).norm() - cells[slot].r;
        ASSERT_LE(visits[slot], 1);
        if (gap < reach) {
          ASSERT_EQ(visits[slot], 1) << "at a gap of " << gap << " within " << reach;
        }
      }
      const double longest = step * cells.box().edges.minCoeff();
      cells.move(cells.slot_of(number), c + random.uniform(0, longest) * uniform_direction<D>(random));
    }
    cells.grow(cells.box().edges * 1.01);
  }
}

TEST(PublishedLoop, FindsAllThatIsNearOnce) {
  for_each_case([](auto dimension, const Case& of) {
    constexpr int D = decltype(dimension)::value;
    expect_to_find_what_is_near<D, LinkedCells>(of);
    expect_to_find_what_is_near<D, SortedCells>(of);
  });
}

// Of 2,000 spheres the cells around one hold some fifty.
TEST(PublishedLoop, LooksAtWhatIsNearAlone) {
  const auto [start, edges] = start_of<3>({2000, 0.7, Sizes::equal});
  const auto tested = [](auto loop) {
    for (int sweep = 0; sweep < 3; ++sweep) loop.sweep();
    return static_cast<double>(loop.pairs_tested()) / 3 / 2000;
  };
  const double linked = tested(PublishedLoop<3, LinkedCells>(start, edges, false, Random(2, 0)));
  EXPECT_GT(linked, 20);
  EXPECT_LT(linked, 80);
  // Spheres move by up to a radius in the first sweep: that much farther, the arrays are searched.
  const double sorted = tested(PublishedLoop<3, SortedCells>(start, edges, false, Random(2, 0)));
  EXPECT_GE(sorted, linked);
  EXPECT_LT(sorted, 5 * linked);
}

/// What a scene is packed to, and how it ends; cancelled after so many questions whether to stop.
std::string packed(const std::string& method, int questions) {
  int asked = 0;
  RunOptions options;
  options.threads = 1;
  options.monitor.cancelled = [&] { return ++asked > questions; };
  const Packing packing = run(
      testing::plan_of("[container]\nkind = \"periodic\"\n[spheres]\ncount = 150\nradius = { distribution = "
                       "\"lognormal\", median = 1.0, sigma = 0.4 }\n[[stage]]\ndo = \"relax\"\nalpha = "
                       "1.0\nmethod = \"" +
                       method + "\"\n"),
      options);
  return hash_of(packing.spheres) + " " + std::string(name_of(packing.outcome)) + " " +
         std::to_string(packing.packing_fraction());
}

TEST(PublishedLoop, PacksASceneTheSameCancelledOrNot) {
  for (const int questions : {0, 1, 25, 1000000}) {
    const std::string linked = packed("reference", questions);
    EXPECT_EQ(packed("reference", questions), linked);
    // With so few sweeps it ends 0.086 below random close packing of these sizes.
    EXPECT_NE(linked.find(questions < 1000 ? " cancelled " : " loose "), std::string::npos) << linked;
  }
}

TEST(PublishedLoop, IsSaidByThePlanWithWhatItRunsOn) {
  const auto relaxation = [](const std::string& method) -> std::string {
    const Plan plan = testing::plan_of(
        "[container]\nkind = \"periodic\"\n[spheres]\ncount = 9\nradius = 1.0\n[[stage]]\ndo = "
        "\"relax\"\nmethod = \"" +
        method + "\"\n");
    std::string said;
    for (const PlanItem& item : plan.items) said += item.name + ": " + item.what + "\n";
    return said;
  };
  EXPECT_NE(relaxation("fast").find("neighbour lists: "), std::string::npos);
  EXPECT_EQ(relaxation("reference").find("neighbour lists: "), std::string::npos);
  EXPECT_NE(relaxation("reference").find("linked lists"), std::string::npos);
}

}  // namespace published_loop_test
}  // namespace bernal
