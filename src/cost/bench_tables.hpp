#pragma once
#include <string>
#include <string_view>

#include "bernal/cost/bench.hpp"
#include "cost/bench_rooms.hpp"

namespace bernal::cost {

using BenchFiles = std::vector<BenchFile>;  ///< the Markdown first; empty where the monitor stopped it

// The tables of their own, one file each.
BenchFiles methods(const BenchOptions&);
BenchFiles methods_of(std::span<const SizeClass>, const BenchOptions&);
BenchFiles effects(const BenchOptions&);
/// Every decision about walls and pairs in every arithmetic: arithmetic.md, .csv and .svg.
BenchFiles bench_arithmetic(const BenchOptions&);

/// The table of the scenes of those names, in the order of the list.
BenchFiles bench_scenes(std::span<const std::string_view> names, const BenchOptions&);
/// What they are called.
std::span<const Bench> scenes_to_bench();

}  // namespace bernal::cost
