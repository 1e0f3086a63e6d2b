#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

/// Everything the reports tell about a packing; made once, read by the writers of JSON and HTML.
struct Report {
  const Packing& packing;
  const Certificate& certificate;
  const Measurements& measured;
  const SizeDistribution* asked;  ///< of radii; null where it cannot be made again
  std::string hash;
  std::map<std::string, std::string> files = {};  ///< of the result, see `Manifest`
  std::vector<std::string> made_from = {};        ///< files that were read, relative to the result's folder
  std::string cell = {};                          ///< see WriteOptions
};

/// The same of a packing whose spheres nobody holds; `packing` has none of them.
struct StreamedReport {
  const Packing& packing;
  std::uint64_t spheres;
  double packing_fraction;
  const Certificate& certificate;
  std::string not_measured;  ///< what is not, and why: a sentence
  std::string hash;
  std::map<std::string, std::string> files = {};
  std::vector<std::string> made_from = {};
};

/// What report.json says of the files of its result; empty where the text is none of bernal's.
std::map<std::string, std::string> manifest_in(const std::string& report);

/// What it says of what the result was made from; the same.
std::vector<std::string> sources_in(const std::string& report);

/// report.json: the keys of the file format, in a fixed order, lengths in the scene's unit. Numbers that are
/// not finite become null. Which keys there are does not depend on the packing, except that there is either
/// `container` or `box`, see `domain_json`; `min_wall_gap` is null where no sphere is near a wall.
std::string json_of(const Report& report);
/// The keys of that, but for those that are measured, and `not_measured`.
std::string json_of(const StreamedReport& report);

/// SVG, and what `view_data` makes; empty where there is none.
struct Pictures {
  std::string_view packing, section, view = {};
};

/// report.html: one page without outside files, and without scripts where there is no view; `scene` is the
/// scene as TOML.
std::string html_of(const Report& report, const Pictures& pictures, std::string_view scene);

}  // namespace bernal
