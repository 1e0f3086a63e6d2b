// What accuracy costs: the front against brute force, the knobs of scenes, and whole measurements of small
// ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "bernal/cost/cost.hpp"
#include "bernal/hard/grow.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/settle/shake.hpp"
#include "bernal/soft/relax.hpp"
#include "cost/cost_row.hpp"
#include "cost/faceted.hpp"
#include "cost/front.hpp"
#include "cost/knobs.hpp"
#include "cost/rounds.hpp"
#include "support/folder.hpp"
#include "support/outdated_trials.hpp"

namespace bernal::cost_test {
namespace {

using namespace cost;

/// Every offer that no other one dominates: costs no more and is worth no less, and one of them is strict.
std::set<std::pair<double, double>> brute_front(const std::vector<Offer>& offers) {
  std::set<std::pair<double, double>> front;
  for (const Offer& a : offers) {
    const auto beats_a = [&](const Offer& b) {
      return b.cost <= a.cost && b.worth >= a.worth && (b.cost < a.cost || b.worth > a.worth);
    };
    if (std::ranges::none_of(offers, beats_a)) front.emplace(a.cost, a.worth);
  }
  return front;
}

TEST(Front, IsWhatBruteForceFinds) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    std::vector<Offer> offers(random() % 20);
    for (Offer& o : offers) o = {static_cast<double>(random() % 12), static_cast<double>(random() % 12)};
    std::set<std::pair<double, double>> found;
    for (const std::size_t k : front_of(offers)) found.emplace(offers[k].cost, offers[k].worth);
    EXPECT_EQ(found, brute_front(offers));
    for (const Offer& o : offers) {
      double most = -1;
      for (const Offer& other : offers)
        if (other.cost <= o.cost) most = std::max(most, other.worth);
      EXPECT_EQ(worth_for(offers, o.cost), most);
    }
  }
}

TEST(Front, TakesNoStepThatIsSmallerThanCanBeTold) {
  const std::vector<Offer> offers = {{1, 0.50}, {2, 0.5005}, {3, 0.502}, {4, 0.5029}};
  EXPECT_EQ(front_of(offers, 0.001), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(front_of(offers), (std::vector<std::size_t>{0, 1, 2, 3}));
}

// A closed surface whose normals point outward encloses a positive volume; inside the curved one, it is less,
// and comes as near as its faces are many.
TEST(Faceted, ContainersLieInsideTheCurvedOnesAndComeNear) {
  const Domain curved[] = {Cylinder{.base = {1, 2, 3}, .axis = {1, 1, 0}, .radius = 2, .height = 5},
                           Sphere{.center = {-1, 0, 4}, .radius = 3}};
  for (const Domain& domain : curved) {
    double last = 0;
    for (const int faces : {12, 30, 100, 1000}) {
      const Faceted made = *faceted(domain, faces);
      const double share = volume_of(made.mesh) / volume_of(domain);
      EXPECT_GT(share, last);
      EXPECT_LT(share, 1);
      last = share;
      // What is missing is a shell no thicker than the deviation.
      EXPECT_LT(1 - share, made.deviation * area_of(domain) / volume_of(domain));
      EXPECT_EQ(2 * made.mesh.vertices.size() - 4, made.mesh.triangles.size())
          << "Euler: no handles, no holes";
    }
    EXPECT_GT(last, 0.98);
  }
  EXPECT_FALSE(faceted(Box{}, 12));
  EXPECT_FALSE(faceted(Cylinder{.periodic = true}, 12));
}

Scene equal_spheres(SceneContainer container, std::optional<std::int64_t> count, Stage stage, double r = 1) {
  Scene scene;
  scene.unit = Unit::mm;
  scene.container = std::move(container);
  scene.sizes = Constant{r};
  scene.target.count = count;
  scene.stages = {std::move(stage)};
  complete(scene);
  return scene;
}

std::vector<std::string> names_of_knobs(const Scene& scene, const testing::Folder& folder) {
  std::vector<std::string> names;
  TrialRecord record;
  for (const Knob& knob : knobs_of(subject_of(scene), folder.path(), record)) names.push_back(knob.name);
  return names;
}

TEST(Knobs, AreThoseOfTheScenesOwnProtocolAndDomain) {
  const testing::Folder folder;
  using Names = std::vector<std::string>;
  EXPECT_EQ(names_of_knobs(equal_spheres(PeriodicBox{}, 100, Relax{}), folder),
            (Names{"alpha", "beta", "stop", "polish", "overlap"}));
  EXPECT_EQ(names_of_knobs(equal_spheres(PeriodicBox{}, 100, Grow{}), folder),
            (Names{"rate", "pressure", "polish"}));
  EXPECT_EQ(names_of_knobs(equal_spheres(Sphere{.radius = 6}, {}, Relax{}), folder),
            (Names{"patience", "polish", "walls", "faces", "packing_fraction"}));
  EXPECT_EQ(names_of_knobs(equal_spheres(Box{.size = Vector<3>(9, 9, 9)}, 50, Relax{}), folder),
            (Names{"patience", "polish", "walls"}));
}

// Every step gives a scene that can be read back, and the own one changes nothing.
TEST(Knobs, TurnAScenesValues) {
  const testing::Folder folder;
  const Subject subject = subject_of(equal_spheres(Sphere{.radius = 6}, {}, Relax{.patience = 7}));
  TrialRecord record;
  for (Knob& knob : knobs_of(subject, folder.path(), record)) {
    SCOPED_TRACE(knob.name);
    ASSERT_EQ(knob.order.size(), knob.steps.size());
    std::set<std::string> texts;
    for (std::size_t k = 0; k < knob.steps.size(); ++k) {
      Setting setting{"", subject.scene};
      knob.steps[k].turn(setting);
      complete(setting.scene);
      const std::string text = scene_as_toml(setting.scene);
      EXPECT_EQ(text == scene_as_toml(subject.scene), k == knob.own);
      EXPECT_TRUE(texts.insert(text).second);
      EXPECT_EQ(scene_as_toml(parse_scene(text, "step.toml")), text);
    }
    if (knob.name == "patience") {
      EXPECT_EQ(knob.steps[knob.own].text, "7");
      const auto between = knob.insert_between(knob.own, knob.order[knob.place_of(knob.own) + 1]);
      ASSERT_TRUE(between);
      EXPECT_EQ(knob.steps[*between].text, "9") << "the whole number nearest to the root of 7 times 12";
    }
  }
}

TEST(Knobs, OfAStageThatComesTwiceAreCountedAmongThatStage) {
  const testing::Folder folder;
  Scene scene = equal_spheres(Box{.size = Vector<3>(9, 9, 9)}, 50, Insert{});
  scene.stages = {Insert{}, Shake{}, Refill{}, Shake{}};
  const auto names = names_of_knobs(scene, folder);
  EXPECT_EQ(std::ranges::count(names, "shake rounds (1)") + std::ranges::count(names, "rounds (1)"), 1);
  EXPECT_EQ(std::ranges::count(names, "shake rounds (2)") + std::ranges::count(names, "rounds (2)"), 1);
  for (const std::string& name : names) EXPECT_EQ(name.find("(3)"), name.npos) << name;
}

// A ratio to which contacts are closed: 0 stands for not at all, and so is the least accurate; of a largest
// overlap it is the most accurate.
TEST(Knobs, PutTheScenesOwnValueWhereItsAccuracyIs) {
  const testing::Folder folder;
  using Texts = std::vector<std::string>;
  const auto ladder = [&](const Scene& scene, std::string_view name) {
    Texts texts;
    TrialRecord record;
    for (const Knob& knob : knobs_of(subject_of(scene), folder.path(), record))
      if (knob.name == name)
        for (const std::size_t step : knob.order) texts.push_back(knob.steps[step].text);
    return texts;
  };
  const auto polished = [](double to) { return equal_spheres(PeriodicBox{}, 60, Relax{.polish = to}); };
  EXPECT_EQ(ladder(polished(1e-8), "polish"), (Texts{"0", "1e-06", "1e-08", "1e-10"}));
  EXPECT_EQ(ladder(polished(1e-3), "polish"), (Texts{"0", "0.001", "1e-06", "1e-10"}));
  EXPECT_EQ(ladder(polished(1e-12), "polish"), (Texts{"0", "1e-06", "1e-10", "1e-12"}));
  Scene scene = equal_spheres(PeriodicBox{}, 60, Relax{});
  scene.overlap = 1e-8;
  EXPECT_EQ(ladder(scene, "overlap"), (Texts{"0.001", "0.0001", "1e-06", "1e-08", "0"}));
  EXPECT_EQ(ladder(equal_spheres(PeriodicBox{}, 60, Relax{.period = 100}), "period"),
            (Texts{"10", "20", "50", "100", "150", "500", "2000"}));
}

CostRow row_with(std::vector<double> phi_of_seed, double seconds = 1) {
  CostRow row;
  row.runs = static_cast<int>(phi_of_seed.size());
  row.phi_of_seed = std::move(phi_of_seed);
  row.seconds = seconds;
  return row;
}

// Runs with the same seed are compared: what every seed loses is a loss, however much seeds differ.
TEST(Difference, IsThatOfTheSameSeeds) {
  const CostRow own = row_with({0.60, 0.62, 0.64});
  const Difference loss = difference_of(row_with({0.598, 0.617, 0.638}), own);
  EXPECT_NEAR(loss.mean, -0.007 / 3, 1e-12);
  EXPECT_NEAR(*loss.error, 0.001 / 3, 1e-12) << "of -0.002, -0.003, -0.002";
  EXPECT_NEAR(loss.least, -0.003, 1e-12);
  EXPECT_NEAR(loss.most, -0.002, 1e-12);
  EXPECT_FALSE(is_no_loss(row_with({0.598, 0.617, 0.638}), own));
  EXPECT_TRUE(is_no_loss(row_with({0.5991, 0.6191, 0.6391}), own)) << "less than matters";
  EXPECT_TRUE(is_no_loss(row_with({0.59, 0.625, 0.64}), own)) << "some seeds gain";
  EXPECT_FALSE(is_no_loss(row_with({0.55, 0.64, 0.65}), own)) << "0.0067, whatever the seeds do";
  EXPECT_FALSE(difference_of(row_with({0.6}), row_with({0.61})).error) << "of one seed nothing is known";
  EXPECT_FALSE(is_no_loss(row_with({0.598}), row_with({0.6})));
}

CostReport measured(const Scene& scene, const testing::Folder& folder, double seconds, int seeds = 2) {
  return measure_cost(scene, folder.path(),
                      {.seconds = seconds, .seeds = seeds, .threads = 1, .most_settings = 30});
}

TEST(Cost, FindsAFrontAndARecommendationThatGivesWhatItSays) {
  const testing::Folder folder;
  const Scene scene = equal_spheres(PeriodicBox{}, 30, Relax{});
  const CostReport report = measured(scene, folder, 120, 1);
  const CostRow& chosen = report.rows[report.recommended];
  std::size_t on_front = 0;
  double densest = 0;
  for (const CostRow& row : report.rows) {
    on_front += row.pareto;
    if (!row.slower) densest = std::max(densest, row.phi);
    for (const CostRow& other : report.rows) {
      if (row.pareto && other.pareto && other.seconds < row.seconds) {
        EXPECT_LT(other.phi, row.phi);
      }
    }
  }
  EXPECT_GE(on_front, 3u);
  EXPECT_EQ(report.rows[report.own].setting, "as it is");
  EXPECT_LE(chosen.seconds, report.rows[report.own].seconds * 20);
  const Scene advised = read_scene(folder / "recommended.toml");
  const Packing packing = run(build(advised), {{}, 1, {}});
  EXPECT_EQ(hash_of(packing.spheres), chosen.hash);
  EXPECT_NEAR(packing.packing_fraction(), chosen.own_phi, 1e-12);
  for (const char* file : {"cost.csv", "cost.md", "cost.svg", "cost.html", "trials.csv"})
    EXPECT_GT(std::filesystem::file_size(folder / file), 500u) << file;
  EXPECT_NE(testing::text_of(folder / "cost.md").find(report.recommendation), std::string::npos);
}

// The seconds decide which way the search goes, so the second call may know others than it asks for; but
// what it has asked for once it does not run again.
TEST(Cost, RunsNothingTwice) {
  const testing::Folder folder;
  const Scene scene = equal_spheres(PeriodicBox{}, 40, Relax{});
  const CostReport first = measured(scene, folder, 120, 1);
  TrialRecord record(folder / "trials.csv");
  EXPECT_EQ(record.size(), first.runs_made);
  const CostReport second = measured(scene, folder, 120, 1);
  EXPECT_GT(second.runs_kept, 0u);
  EXPECT_EQ(TrialRecord(folder / "trials.csv").size(), record.size() + second.runs_made);
  EXPECT_EQ(second.rows[second.own].seconds, first.rows[first.own].seconds);
  EXPECT_EQ(second.outdated, "");
}

TEST(Cost, SaysWhichRunsAreOfOtherPackings) {
  const testing::Folder folder;
  const Scene scene = equal_spheres(PeriodicBox{}, 40, Relax{});
  measured(scene, folder, 0.5, 1);
  const int runs = testing::let_trials_be_of(7, folder / "trials.csv", 1);
  ASSERT_GT(runs, 0) << testing::text_of(folder / "trials.csv");
  const CostReport again = measured(scene, folder, 0.5, 1);
  EXPECT_EQ(again.runs_kept, 0u);
  EXPECT_TRUE(again.outdated.starts_with(fmt::format("{} run", runs))) << again.outdated;
  EXPECT_NE(again.outdated.find("of packings 7, and this is bernal " + text_of(this_program())),
            std::string::npos)
      << again.outdated;
}

TEST(Cost, SaysWhatBuysNothing) {
  const testing::Folder folder;
  const CostReport report =
      measured(equal_spheres(Box{.size = Vector<3>(9, 9, 9)}, 20, Relax{}), folder, 120, 1);
  // So few spheres have room at random places, whatever the patience.
  const auto said = [&](std::string_view knob, std::string_view what) {
    return std::ranges::any_of(report.verdicts, [&](const std::string& verdict) {
      return verdict.starts_with(knob) && verdict.find(what) != verdict.npos;
    });
  };
  EXPECT_TRUE(said("patience", "without effect on this scene"));
}

TEST(Cost, StopsWhenItIsTold) {
  const testing::Folder folder;
  int asked = 0;
  const Monitor stop{{}, [&] { return ++asked > 400; }};
  const CostReport report = measure_cost(equal_spheres(PeriodicBox{}, 60, Relax{}), folder.path(),
                                         {.seconds = 60, .seeds = 1, .threads = 1, .monitor = stop});
  EXPECT_TRUE(report.cancelled);
  EXPECT_EQ(std::filesystem::exists(folder / "cost.md"), !report.rows.empty());
  const Monitor at_once{{}, [] { return true; }};
  const testing::Folder other;
  EXPECT_TRUE(measure_cost(equal_spheres(PeriodicBox{}, 60, Relax{}), other.path(),
                           {.seconds = 60, .threads = 1, .monitor = at_once})
                  .rows.empty());
  EXPECT_FALSE(std::filesystem::exists(other / "cost.md"));
}

// Polished in a container all radii have grown: that is no density of the spheres that are asked for.
TEST(Cost, ComparesPackingFractionsAtTheSizesThatAreAskedFor) {
  const testing::Folder folder;
  const Scene scene = equal_spheres(Box{.size = Vector<3>(8, 8, 8)}, 58, Relax{});
  const CostReport report =
      measure_cost(scene, folder.path(), {.seconds = 30, .seeds = 1, .threads = 1, .most_settings = 4});
  const CostRow& own = report.rows[report.own];
  std::size_t polished = 0;
  for (const CostRow& row : report.rows) {
    if (row.size_scale == 1 || row.slower) continue;
    ++polished;
    EXPECT_GT(row.packed_phi, own.packed_phi);
    EXPECT_NEAR(row.phi, own.phi, 1e-9) << row.setting << ": as many spheres of the same sizes";
  }
  EXPECT_GT(polished, 0u);
  EXPECT_EQ(report.rows[report.recommended].size_scale, 1);
}

TEST(Cost, CountsTheSameSpheresAsOneSetting) {
  const testing::Folder folder;
  const CostReport report =
      measured(equal_spheres(Box{.size = Vector<3>(9, 9, 9)}, 20, Relax{}), folder, 60, 1);
  const CostRow& own = report.rows[report.own];
  EXPECT_FALSE(own.is_repeat);
  std::size_t repeats = 0;
  for (const CostRow& row : report.rows) {
    if (&row == &own || row.hash != own.hash) continue;
    ++repeats;
    EXPECT_TRUE(row.is_repeat) << row.setting;
    EXPECT_FALSE(row.pareto || row.pareto_contacts) << row.setting;
  }
  EXPECT_GT(repeats, 0u) << "patience has nothing to do here";
  EXPECT_NE(report.rows[report.recommended].hash == own.hash, report.recommended != report.own);
}

TEST(Cost, SaysWhatOneSeedDoesNotTellAndWhyItEnded) {
  const testing::Folder folder;
  const CostReport report = measure_cost(equal_spheres(PeriodicBox{}, 30, Relax{}), folder.path(),
                                         {.seconds = 60, .seeds = 1, .threads = 1, .most_settings = 3});
  EXPECT_FALSE(report.complete);
  EXPECT_TRUE(report.ending.starts_with("the most settings were tried")) << report.ending;
  const std::string page = testing::text_of(folder / "cost.md");
  EXPECT_NE(page.find("with one seed nothing is known of how seeds differ"), page.npos);
  EXPECT_EQ(page.find("two seeds"), page.npos);
  for (const CostRow& row : report.rows) EXPECT_FALSE(row.phi_change_error);
}

// Where overlap is allowed, `bernal pack` states more than what counts here: both are said.
TEST(Cost, StatesWhatPackStates) {
  const testing::Folder folder;
  Scene scene = equal_spheres(PeriodicBox{}, 60, Relax{.alpha = 3, .stop = 0.01});
  scene.overlap = 0.01;
  const CostReport report =
      measure_cost(scene, folder.path(), {.seconds = 60, .seeds = 1, .threads = 1, .most_settings = 1});
  const CostRow& own = report.rows[report.own];
  ASSERT_GT(own.max_overlap, 0);
  const double stated = run(build(scene), {{}, 1, {}}).packing_fraction();
  EXPECT_NEAR(own.packed_phi, stated, 1e-12);
  EXPECT_NEAR(own.own_phi, stated * std::pow(1 - own.max_overlap, 3), 1e-12);
  const CostRow& chosen = report.rows[report.recommended];
  const std::string page = testing::text_of(folder / "cost.md");
  EXPECT_NE(page.find(fmt::format("gives packing fraction {:.6f}", chosen.packed_phi)), page.npos);
  EXPECT_NE(page.find(fmt::format("{:.6f}", chosen.own_phi)), page.npos);
}

// Where a scene ends at a limit, that is what stands between it and what it asks for.
TEST(Cost, PutsOffALimitThatTheSceneEndsAt) {
  const testing::Folder folder;
  const Scene scene = equal_spheres(Box{.size = Vector<3>(12, 12, 12)}, 218, Relax{.sweeps = 10});
  const CostReport report =
      measure_cost(scene, folder.path(), {.seconds = 20, .seeds = 1, .threads = 1, .most_settings = 4});
  ASSERT_EQ(report.rows[report.own].outcome, Outcome::hit_limit) << report.rows[report.own].reason;
  EXPECT_TRUE(std::ranges::any_of(report.rows, [](const CostRow& row) {
    return row.changed == std::vector<std::string>{"sweeps"} && row.outcome == Outcome::converged;
  }));
  EXPECT_EQ(report.rows[report.recommended].outcome, Outcome::converged) << report.recommendation;
}

TEST(Cost, SaysThatASceneDoesNotReachWhatItAsksFor) {
  const testing::Folder folder;
  Scene scene = equal_spheres(Box{.size = Vector<3>(6, 6, 6)}, 200, Insert{});
  const CostReport report = measured(scene, folder, 20, 1);
  ASSERT_NE(report.rows[report.own].outcome, Outcome::converged);
  EXPECT_NE(report.recommendation.find("does not reach what the scene asks for"), std::string::npos);
  EXPECT_TRUE(testing::text_of(folder / "recommended.toml").starts_with("# It does not reach"));
  EXPECT_NE(testing::text_of(folder / "cost.html").find("does not reach what is asked for</span>"),
            std::string::npos);
  read_scene(folder / "recommended.toml");
}

TEST(Cost, RefusesATimeInWhichNothingEnds) {
  const testing::Folder folder;
  EXPECT_THROW(measured(equal_spheres(PeriodicBox{}, 20000, Relax{.alpha = 1000}), folder, 0.2), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "cost.md"));
}

}  // namespace
}  // namespace bernal::cost_test
