#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <new>
#include <set>
#include <string>

#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "core/made.hpp"
#include "hard/calendar.hpp"
#include "plan/stages.hpp"
#include "support/plans.hpp"
#include "support/scenes.hpp"
#include "work/counted_container.hpp"
#include "work/effect_log.hpp"

// Only what a scene calls for is made, allocates and runs. This executable counts every allocation of the
// process for the effect that is in progress in its thread.

namespace {

/// Without allocations of its own: names of effects are few and short.
struct Ledger {
  static constexpr std::size_t most = 64;
  std::array<std::array<char, 32>, most> names{};
  std::array<std::uint64_t, most> allocations{};
  std::size_t count = 0;
  bool open = false;

  void add(const char* effect) {
    std::size_t k = 0;
    while (k < count && std::string_view(names[k].data()) != effect) ++k;
    if (k == most) std::abort();
    if (k == count) {
      ++count;
      for (std::size_t c = 0; effect[c] != 0 && c + 1 < names[k].size(); ++c) names[k][c] = effect[c];
    }
    ++allocations[k];
  }
};
thread_local Ledger ledger;

void* allocate(std::size_t size, std::size_t alignment) {
  if (ledger.open && bernal::effect_in_progress) ledger.add(bernal::effect_in_progress);
  void* const memory = alignment > alignof(std::max_align_t)
                           ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                           : std::malloc(size > 0 ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size, 1); }
void* operator new[](std::size_t size) { return allocate(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // malloc and free are a pair
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace bernal {
namespace effects_test {

using Counts = std::map<std::string, std::uint64_t>;

/// What happened on the way from a scene to its packing, by effect.
struct Account {
  Plan plan;
  Packing packing;
  Counts made, allocated;
};

Account account_of(const Scene& scene) {
  const Counts before = made_so_far();
  ledger = {};
  ledger.open = true;
  Account account{.plan = build(scene), .packing = Packing(), .made = {}, .allocated = {}};
  RunOptions options;
  options.threads = 1;  // allocations of other threads would have no effect in progress
  account.packing = run(account.plan, options);
  ledger.open = false;
  for (const auto& [effect, count] : made_so_far()) {
    const auto then = before.find(effect);
    if (const std::uint64_t fresh = count - (then == before.end() ? 0 : then->second); fresh > 0)
      account.made[effect] = fresh;
  }
  for (std::size_t k = 0; k < ledger.count; ++k)
    account.allocated[ledger.names[k].data()] = ledger.allocations[k];
  return account;
}

/// The example scenes, and what runs where a scene names no stages, in every kind of domain.
std::vector<std::pair<std::string, Scene>> scenes() {
  std::vector<std::pair<std::string, Scene>> all;
  for (const auto& file : testing::example_scenes())
    all.emplace_back(file.stem().string(), testing::small(read_scene(file)));
  const std::string spheres = "[spheres]\ncount = 150\nradius = 0.05\n";
  for (const auto& [name, container] : std::vector<std::pair<std::string, std::string>>{
           {"box", "kind = \"box\"\nsize = [1.0, 1.0, 1.0]\n"},
           {"cylinder", "kind = \"cylinder\"\nradius = 0.5\nheight = 1.0\n"},
           {"sphere", "kind = \"sphere\"\nradius = 0.5\n"},
           {"periodic cylinder", "kind = \"cylinder\"\nradius = 0.5\nheight = 1.0\nperiodic = true\n"},
           {"periodic box", "kind = \"periodic\"\n"},
           {"periodic box of given size", "kind = \"periodic\"\nedge = 0.6\n"},
           {"periodic plane", "kind = \"periodic\"\ndimension = 2\n"},
           {"box between two walls", "kind = \"periodic\"\nsize = [1.0, 1.0, 1.0]\nwalls = [2]\n"}})
    all.emplace_back(name, parse_scene("[container]\n" + container + spheres, "test.toml"));
  all.emplace_back("dense box", parse_scene("[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n[spheres]\n"
                                            "packing_fraction = 0.45\nradius = 0.07\n",
                                            "test.toml"));
  const auto add_periodic = [&](const std::string& name, const std::string& stage) {
    all.emplace_back(name, parse_scene("[container]\nkind = \"periodic\"\n" + spheres + stage, "test.toml"));
  };
  add_periodic("published loop", "[[stage]]\ndo = \"relax\"\nmethod = \"reference\"\nstop = 0.01\n");
  all.emplace_back("four in a periodic box",
                   parse_scene("[container]\nkind = \"periodic\"\n[spheres]\ncount = 4\nradius = 0.05\n"
                               "[[stage]]\ndo = \"relax\"\n",
                               "test.toml"));
  for (const std::string bed :
       {"bed = \"poured\"", "bed = \"vibrated\"", "bed = \"loose\"", "porosity = 0.45"})
    all.emplace_back("settled, " + bed.substr(bed.find(' ') + 3, 4),
                     parse_scene("[container]\nkind = \"cylinder\"\nradius = 0.4\nheight = 2.0\n" + spheres +
                                     bed + "\n[[stage]]\ndo = \"settle\"\n",
                                 "test.toml"));
  add_periodic("polished", "[[stage]]\ndo = \"relax\"\npolish = 1e-6\n");
  for (const std::string container : {"kind = \"periodic\"", "kind = \"box\"\nsize = [1.0, 1.0, 1.0]"})
    all.emplace_back(
        "cells in " + container.substr(8, 3),
        parse_scene("[container]\n" + container +
                        "\n[spheres]\ncount = 60\ncells = { volume = { distribution = "
                        "\"uniform\", min = 1.0, max = 3.0, basis = \"number\" }, rounds = 1 }\n",
                    "test.toml"));
  const std::string box = "[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n";
  const std::string exact = box + spheres + "[accuracy]\nwalls = \"exact\"\n";
  for (const std::string stages : {"insert", "relax", "grow"})
    all.emplace_back("exact walls of " + stages,
                     parse_scene(exact + "[[stage]]\ndo = \"" + stages + "\"\n", "test.toml"));
  all.emplace_back("exact walls of compress",
                   parse_scene(exact + "[[stage]]\ndo = \"insert\"\npacking_fraction = 0.05\n"
                                       "[[stage]]\ndo = \"compress\"\nmax_iterations = 4\n",
                               "test.toml"));
  return all;
}

std::set<std::string> names_of(const Plan& plan) {
  std::set<std::string> names;
  for (const PlanItem& item : plan.items) names.insert(item.name);
  return names;
}

class EffectsOf : public ::testing::TestWithParam<std::pair<std::string, Scene>> {};

TEST_P(EffectsOf, TheSceneAreAllThatIsMadeThatAllocatesAndThatRuns) {
  const Account account = account_of(GetParam().second);
  const std::set<std::string> planned = names_of(account.plan);
  Counts calls;
  for (const Effect& effect : account.packing.effects) {
    calls[effect.name] = effect.calls;
    EXPECT_GT(effect.calls, 0u) << effect.name;
    EXPECT_GT(effect.seconds, 0) << effect.name;
  }
  for (const std::string& absent : account.plan.absent) {
    EXPECT_EQ(account.made.count(absent), 0u) << absent << " is made";
    EXPECT_EQ(account.allocated.count(absent), 0u) << absent << " allocates";
    EXPECT_EQ(calls.count(absent), 0u) << absent << " runs";
  }
  for (const Counts* counts : std::initializer_list<const Counts*>{&account.made, &account.allocated, &calls})
    for (const auto& [effect, count] : *counts)
      // The balls that packings lie in end where layers do.
      EXPECT_TRUE(planned.contains(effect == "layers" ? "inside" : effect))
          << effect << " is not planned, " << count << " times";
  for (const PlanItem& item : account.plan.items)
    if (!item.if_needed && item.name != "fly") {  // which says how a box is filled
      EXPECT_EQ(calls.count(item.name), 1u) << item.name << " is planned and does not run";
    }
}

TEST_P(EffectsOf, ThePlanAndThoseThatAreAbsentAreAllThatThereAre) {
  const Plan plan = build(GetParam().second);
  std::set<std::string> all = {"start", "walls", "exact walls", "cells", "inside"};
  for (const StageEntry* stage : stage_entries())
    all.insert(stage->may_bring.begin(), stage->may_bring.end());
  std::set<std::string> told = names_of(plan);
  told.erase("fly");
  for (const std::string& name : plan.absent) EXPECT_TRUE(told.insert(name).second) << name;
  EXPECT_EQ(told, all);
}

TEST_P(EffectsOf, ThePlanHavePricesThatAddUp) {
  const Plan plan = build(GetParam().second);
  double seconds = 0, bytes = 0;
  const bool one_stage =
      plan.scene.stages.size() == 1;  // of more, those of one are gone when the next begins
  for (const PlanItem& item : plan.items) {
    EXPECT_GE(item.seconds, 0) << item.name;
    EXPECT_GE(item.bytes, 0) << item.name;
    if (!item.part) seconds += item.seconds;
    bytes = one_stage ? bytes + item.bytes : std::max(bytes, item.bytes);
  }
  EXPECT_GT(plan.expected_seconds, 0);
  EXPECT_DOUBLE_EQ(plan.expected_seconds, seconds);
  EXPECT_GT(plan.expected_memory_bytes, bytes);
}

std::string test_name(const ::testing::TestParamInfo<std::pair<std::string, Scene>>& tested) {
  std::string name = tested.param.first;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, EffectsOf, ::testing::ValuesIn(scenes()), test_name);

// That the instruments above see what they are for.
TEST(Made, CountsWhatIsMadeAndCopiedButNotWhatMoves) {
  const auto count = [] {
    const Counts all = made_so_far();
    const auto found = all.find("nothing that any stage brings");
    return found == all.end() ? 0 : found->second;
  };
  const std::uint64_t before = count();
  Made made("nothing that any stage brings");
  EXPECT_EQ(count(), before + 1);
  const Made copy = made;
  EXPECT_EQ(count(), before + 2);
  const Made moved = std::move(made);
  EXPECT_EQ(count(), before + 2);
}

TEST(Made, CountsACalendarAsOneOfCollisions) {
  const std::uint64_t before = made_so_far()["collisions"];
  const Calendar calendar;
  EXPECT_EQ(made_so_far()["collisions"], before + 1);
}

TEST(EffectTimer, NamesWhatAllocationsAreMadeFor) {
  EffectLog log;
  Effect &growth = log["growth"], &collisions = log["collisions"];
  const auto allocate_so_often = [](int often) {
    for (; often > 0; --often) ::operator delete(::operator new(80));
  };
  ledger = {};
  ledger.open = true;
  {
    const EffectTimer outer(growth);
    allocate_so_often(1);
    {
      const EffectTimer inner(collisions);
      allocate_so_often(3);
    }
    allocate_so_often(1);
  }
  allocate_so_often(1);
  ledger.open = false;
  Counts allocated;
  for (std::size_t k = 0; k < ledger.count; ++k) allocated[ledger.names[k].data()] = ledger.allocations[k];
  EXPECT_EQ(allocated["growth"], 2u);
  EXPECT_EQ(allocated["collisions"], 3u);
  EXPECT_EQ(allocated.size(), 2u);
}

/// Answers every question in a way of its own.
class Answering final : public Container {
 public:
  Answering() : Container(WallArithmetic::exact, 1e-12, {.edges = Vector<3>(3, 4, 5)}) {}
  std::string_view kind() const override { return "answering"; }
  Bounds<3> bounds() const override { return {Vector<3>::Zero(), Vector<3>(3, 4, 5)}; }
  double volume() const override { return 60; }
  double clearance(const Vector<3>& p) const override { return p[0]; }
  double clearance_within(const Vector<3>& p, double reach) const override { return p[0] + reach; }
  bool contains(const Vector<3>&, double r) const override { return r == 2; }
  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction,
                       double limit) const override {
    return c[0] + 2 * r + 3 * direction[0] + 4 * limit;
  }
  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    return c[0] + 3 * r + 5 * direction[0] + 7 * limit;
  }
  void facets_near(const Vector<3>&, double reach, std::vector<NearFacet>& out) const override {
    out.assign(1, NearFacet{reach, {}});
  }
  bool few_facets_near(const Vector<3>&, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const override {
    out.assign(most, NearFacet{reach, {}});
    return most == 2;
  }
  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const override {
    out.assign(1, {c, r});
  }
};

TEST(CountedContainer, PassesEveryQuestionOnAndCountsIt) {
  const Answering asked;
  const CountedContainer counted(std::make_shared<Answering>());
  EXPECT_EQ(counted.arithmetic(), asked.arithmetic());
  EXPECT_EQ(counted.resolution(), asked.resolution());
  EXPECT_EQ(counted.boundary().edges, asked.boundary().edges);
  EXPECT_EQ(counted.kind(), asked.kind());
  EXPECT_EQ(counted.bounds().upper, asked.bounds().upper);
  EXPECT_EQ(counted.volume(), asked.volume());
  EXPECT_EQ(counted.asked().calls, 0u) << "what is known needs no question";

  const Vector<3> c(0.5, 0, 0), u(1, 0, 0);
  EXPECT_EQ(counted.clearance(c), asked.clearance(c));
  EXPECT_EQ(counted.clearance_within(c, 9), asked.clearance_within(c, 9));
  EXPECT_TRUE(counted.contains(c, 2));
  EXPECT_FALSE(counted.contains(c, 3));
  EXPECT_EQ(counted.first_contact(c, 1, u, 2), asked.first_contact(c, 1, u, 2));
  EXPECT_EQ(counted.free_path(c, 1, u, 2), asked.free_path(c, 1, u, 2));
  EXPECT_EQ(counted.asked().calls, 6u);

  std::vector<NearFacet> facets;
  counted.facets_near(c, 0.25, facets);
  ASSERT_EQ(facets.size(), 1u);
  EXPECT_EQ(facets[0].distance, 0.25);
  EXPECT_TRUE(counted.few_facets_near(c, 0.125, 2, facets));
  ASSERT_EQ(facets.size(), 2u);
  EXPECT_FALSE(counted.few_facets_near(c, 0.125, 3, facets));
  std::vector<WallContact> contacts;
  counted.contacts(c, 0.75, contacts);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].distance, 0.75);
  EXPECT_EQ(counted.asked().calls, 10u);
  EXPECT_GT(counted.asked().seconds, 0);
}

// A cost model knows what makes a run long.
TEST(Prices, RiseWithWhatIsAskedFor) {
  const auto seconds = [](const std::string& spheres, const std::string& stage) {
    return testing::plan_of("[container]\nkind = \"periodic\"\n[spheres]\nradius = 1.0\ncount = " + spheres +
                            "\n" + stage)
        .expected_seconds;
  };
  const std::string relax = "[[stage]]\ndo = \"relax\"\n", grow = "[[stage]]\ndo = \"grow\"\n";
  EXPECT_GT(seconds("20000", relax), 1.5 * seconds("10000", relax));
  EXPECT_GT(seconds("10000", relax), 3 * seconds("10000", relax + "alpha = 2\n"));
  EXPECT_GT(seconds("1000", relax + "method = \"reference\"\n"), 3 * seconds("1000", relax));
  EXPECT_GT(seconds("1000", relax + "polish = 1e-8\n"), 3 * seconds("1000", relax));
  EXPECT_GT(seconds("2000", grow), 1.5 * seconds("1000", grow));
  EXPECT_GT(seconds("1000", grow + "rate = 0.001\n"), 3 * seconds("1000", grow));
}

}  // namespace effects_test
}  // namespace bernal
