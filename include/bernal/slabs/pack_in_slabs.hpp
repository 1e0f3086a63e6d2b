#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "bernal/core/monitor.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"

namespace bernal {

/// Whether a scene's engine leaves its spheres to be freed of overlap slab by slab: `[engine] slabs`.
bool is_in_slabs(const Scene& scene);

/// Throws Error{bad_scene} where the box of a plan whose scene `is_in_slabs` is too narrow for so many. Cost:
/// that of drawing its spheres.
void check_slabs(const Plan& plan);

struct SlabOptions {
  std::optional<std::uint64_t> seed = {};  ///< the scene's own if absent
  int threads = 0;                         ///< 0: as many as the machine has
  Monitor monitor = {};
  std::filesystem::path engine_folder = {};  ///< see `RunOptions`, but not empty
};

/// A packing that stands in files, and that nobody holds.
struct PackedInSlabs {
  Packing packing;  ///< without its spheres
  std::uint64_t spheres = 0;
  double packing_fraction = 0;
  WrittenPacking written = {};
  std::string not_measured = {};  ///< why there are no figures of its structure: a sentence
};

/// Runs and writes a plan whose scene `is_in_slabs`: draws the spheres one after the other into the engine's
/// input, sorts what the engine leaves into slabs on the disk, beside the result, lets each of them push its
/// overlaps apart while its neighbours rest, again and again while the box grows, and certifies the file that
/// it has written slab by slab. No more than some slabs are ever in memory.
///
/// Writes spheres.npy, slab after slab along the longest axis, scene.toml and report.json, all or none. One
/// seed gives one packing for any number of threads, as far as the engine does; another number of slabs gives
/// another one. Throws EngineError where the engine fails, Error{bad_scene} where the box is too narrow for
/// so many slabs, Error{cannot_write}, and Cancelled once the monitor says stop: then nothing is written but
/// what the engine keeps.
///
/// On the disk: 64 bytes a sphere, and some 180 in the engine's files; so much has to be free.
PackedInSlabs pack_in_slabs(const Plan& plan, const std::filesystem::path& folder,
                            const SlabOptions& options);

/// The certificate of a result that stands in such slabs, from its files, held no more of than then.
Certificate certify_in_slabs(const Scene& scene, const std::filesystem::path& spheres,
                             CertifyOptions options);

}  // namespace bernal
