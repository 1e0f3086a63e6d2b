// Readers in a child process: what they read comes back whole, and what befalls them is told in a line.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "cad/read/caged_reader.hpp"
#include "cad/repair/caged_repair.hpp"
#include "core/parallel.hpp"

namespace bernal {
namespace cage_test {

using cad::ReadAttempt;

constexpr CageLimits narrow = {std::uint64_t{256} << 20U, 1};

std::string failure_of(const std::function<void()>& act) {
  return cad::read_in_cage("the reader", narrow,
                           [&] {
                             act();
                             return ReadAttempt();
                           })
      .failure;
}

TEST(Cage, HandsBackAllThatWasRead) {
  ReadAttempt read;
  read.soup.points = {{0, 1, 2}, {3, 4, 5}, {1e-300, -1e300, 0.1}};
  read.soup.polygons = {{0, 1, 2}, {2, 1, 0, 1}, {}};
  read.soup.solids = {{"one", 0}, {"", 1}};
  read.facts.unit = cad::FileFacts::Length{0.0254, "inch"};
  read.facts.up = 'y';
  read.facts.deviation = cad::SurfaceDeviation{0.5, 0.25};
  read.facts.deflection = 0.125;
  read.facts.notes = {"first", "", "third"};
  const ReadAttempt got = cad::read_in_cage("the reader", narrow, [&] { return read; });
  EXPECT_TRUE(got.ok()) << got.failure;
  EXPECT_EQ(got.soup.points, read.soup.points);
  EXPECT_EQ(got.soup.polygons, read.soup.polygons);
  ASSERT_EQ(got.soup.solids.size(), 2u);
  EXPECT_EQ(got.soup.solids[0].name, "one");
  EXPECT_EQ(got.soup.solids[1].first, 1u);
  ASSERT_TRUE(got.facts.unit && got.facts.deviation && got.facts.deflection);
  EXPECT_EQ(got.facts.unit->metres, 0.0254);
  EXPECT_EQ(got.facts.unit->name, "inch");
  EXPECT_FALSE(got.facts.written_in);
  EXPECT_EQ(got.facts.up, 'y');
  EXPECT_EQ(got.facts.deviation->inside, 0.25);
  EXPECT_EQ(*got.facts.deflection, 0.125);
  EXPECT_EQ(got.facts.notes, read.facts.notes);
}

TEST(Cage, SaysWhatBefellTheReader) {
  EXPECT_EQ(failure_of([] { throw std::runtime_error("line 3: no number"); }), "line 3: no number");
  EXPECT_EQ(failure_of([] { throw std::length_error("basic_string::_M_create"); }),
            "basic_string::_M_create");
  EXPECT_EQ(failure_of([] { throw 7; }), "an exception without a message");
  EXPECT_EQ(failure_of([] { throw std::bad_alloc(); }),
            "the reader wants more than 0.25 GiB of memory for it");
  EXPECT_EQ(failure_of([] { std::abort(); }), "the reader crashes on it (Aborted)");
  EXPECT_EQ(failure_of([] { std::raise(SIGSEGV); }), "the reader crashes on it (Segmentation fault)");
  EXPECT_EQ(failure_of([] { std::raise(SIGKILL); }), "the reader was killed over it");
  EXPECT_NE(failure_of([] { _exit(0); }), "");
}

TEST(Cage, TellsAnExceptionAsItself) {
  std::uint64_t made = 0;
  const auto befell = [&](const std::function<void()>& work) {
    return run_in_cage("the writer", narrow, work, [&](Archive& a) { a(made); });
  };
  EXPECT_EQ(befell([&] { made = 7; }), "");
  EXPECT_EQ(made, 7u);
  EXPECT_EQ(befell([] { throw std::out_of_range("no such\nface"); }), "no such face");
  const std::string long_one = befell([] { throw std::runtime_error(std::string(100'000, 'x')); });
  EXPECT_EQ(long_one.substr(0, 200), std::string(200, 'x'));
  EXPECT_LE(long_one.size(), 1000u);
  EXPECT_EQ(befell([] { throw std::bad_alloc(); }), "the writer wants more than 0.25 GiB of memory for it");
}

TEST(Cage, SaysWhatBefellARepair) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const auto said_of = [&](const std::function<void()>& act) {
    const cad::RepairedMesh repaired = cad::repair_in_cage(mesh, 1, [&] {
      act();
      return cad::RepairedMesh{{}, "mended"};
    });
    EXPECT_EQ(repaired.mesh.triangles.size(), repaired.done == "mended" ? 0u : 1u);
    return repaired.done;
  };
  EXPECT_EQ(said_of([] {}), "mended");
  EXPECT_EQ(said_of([] { throw std::runtime_error("precondition violation!\nLine: 7"); }),
            "not repaired: precondition violation! Line: 7");
  EXPECT_EQ(said_of([] { throw std::bad_alloc(); }),
            "not repaired: CGAL wants more than 4 GiB of memory for it");
  EXPECT_EQ(said_of([] { std::abort(); }), "not repaired: CGAL crashes on it (Aborted)");
}

TEST(Cage, EndsAReaderThatLoops) {
  EXPECT_EQ(failure_of([] {
              for (std::atomic<int> k = 0;;) ++k;
            }),
            "the reader takes longer than 1 s over it");
}

TEST(Cage, EndsAReaderThatTakesAllMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take terabytes of addresses, so that no limit is set";
#endif
  EXPECT_EQ(failure_of([] {
              // Not written to: where pages are dear, time would run out first.
              std::vector<std::unique_ptr<char[]>> all;
              for (;;) all.push_back(std::make_unique_for_overwrite<char[]>(std::size_t{1} << 24U));
            }),
            "the reader wants more than 0.25 GiB of memory for it");
  EXPECT_EQ(failure_of([] { std::vector<char>(std::size_t{1} << 40U); }),
            "the reader wants more than 0.25 GiB of memory for it");
}

TEST(Cage, IsDeaf) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(failure_of([] {
              std::fputs("assimp: something is wrong\n", stderr);
              std::fflush(stderr);
            }),
            "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Cage, OpensWhenTheUserWantsToStop) {
  const auto start = std::chrono::steady_clock::now();
  Monitor monitor;
  monitor.cancelled = [&] {
    return std::chrono::steady_clock::now() - start > std::chrono::milliseconds(100);
  };
  const Interruptible interruptible(monitor);
  EXPECT_THROW(failure_of([] { sleep(60); }), Cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace cage_test
}  // namespace bernal
