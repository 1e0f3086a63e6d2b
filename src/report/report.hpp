#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/layer_amounts.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

/// The data of a report, read by the writers of JSON and HTML.
struct Report {
  const Packing& packing;
  const Certificate& certificate;
  const Measurements& measured;
  const SizeDistribution* asked;  ///< of radii; null if it cannot be reconstructed
  std::string hash;
  std::map<std::string, std::string> files = {};  ///< of the result, see `Manifest`
  std::vector<std::string> made_from = {};        ///< source files, relative to the result's folder
  std::string cell = {};                          ///< see WriteOptions
  LayerAmounts layers = {};                       ///< what there is of each that the scene names
};

/// The same for a packing that is not measured: one that is not in memory, of which `packing` has no spheres,
/// or one inside of spheres.
struct StreamedReport {
  const Packing& packing;
  std::uint64_t spheres;
  double packing_fraction;
  const Certificate& certificate;
  std::string not_measured;  ///< one sentence: what was not measured, and why
  std::string hash;
  std::map<std::string, std::string> files = {};
  std::vector<std::string> made_from = {};
  LayerAmounts layers = {};  ///< none of one that is not in memory
};

/// The digests of a result's files in report.json; empty if the text is not bernal's.
std::map<std::string, std::string> manifest_in(const std::string& report);

/// The sources of a result in report.json; empty if the text is not bernal's.
std::vector<std::string> sources_in(const std::string& report);

/// report.json: the keys of the file format, in a fixed order, with lengths in the scene's unit. Numbers that
/// are not finite become null. The set of keys does not depend on the packing, except for either `container`
/// or `box`, see `domain_json`; `min_wall_gap` is null if there are no walls or no spheres.
std::string json_of(const Report& report);
/// The same without measured keys, and with `not_measured`.
std::string json_of(const StreamedReport& report);

/// SVG, and the result of `view_data`; empty if absent.
struct Pictures {
  std::string_view packing, section, view = {};
};

/// report.html: one page without external resources, and without scripts unless there is a view; `scene` is
/// TOML.
std::string html_of(const Report& report, const Pictures& pictures, std::string_view scene);

}  // namespace bernal
