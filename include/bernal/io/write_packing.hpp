#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/run/packing.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

struct WrittenPacking {
  std::vector<std::filesystem::path> files;  ///< final paths, in the order of the contract
  Certificate certificate;                   ///< of spheres.csv as it was written and read back
};

/// Writes spheres.csv, spheres.vtp, scene.toml, report.json, report.html and, in two and three dimensions,
/// packing.svg into `folder`, which is made if it does not exist.
///
/// Everything is written whole under temporary names, spheres.csv is read back and certified against the
/// packing's container, and only then are the files renamed: a failure throws Error{cannot_write} and leaves
/// earlier output untouched. Once the monitor says stop, measurements that may be absent are left out.
WrittenPacking write_packing(const Packing& packing, const std::filesystem::path& folder,
                             const Monitor& monitor = {});

/// Throws Error{cannot_write} now rather than after a long run, if `folder` can be neither used nor made.
/// Leaves nothing behind.
void check_writable(const std::filesystem::path& folder);

/// What a certificate's statement adds about the walls, where they are not simply the file's surface: " The
/// walls are …", or nothing.
std::string certified_walls(const Scene& scene);

}  // namespace bernal
