#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/cad/mesh_report.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/measure/rest.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/zones_in_place.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

/// The certificate as a JSON object, indented by two spaces a level: what `verify --json` prints, and
/// `certificate` in report.json. Its keys are the members of Certificate. `worst_pair` is null if there are
/// no two spheres or images, and holds one index twice for a sphere and its own image; `worst_wall` and
/// `min_wall_gap` are null if there are no walls or no spheres. `overlaps` and `protrusions` are present if a
/// list was requested and has entries. Numbers that are not finite become null. `settled` is present if a
/// `Rest` is given; its `list`, of spheres with centre and radius, if it has entries. `misplaced`, the
/// spheres that are not in the place of their zone, is present if `ZonesInPlace` is given.
std::string certificate_as_json(const Certificate&, const std::optional<ZonesInPlace>& = {},
                                const std::optional<Rest>& = {},
                                const Spheres<dynamic>& = Spheres<dynamic>(3));

/// Measurements as a JSON object: what `bernal measure --json` prints. Lengths are in the scene's unit; sizes
/// are radii. Absent measurements are null, as are p-values without meaning.
std::string measurements_as_json(const Packing&, const Measurements&);

/// A plan as a JSON object: what `bernal explain --json` prints. `stages` is TOML.
std::string plan_as_json(const Plan&);

/// A CAD file as a JSON object: what `bernal inspect --json` prints. `unit` is the unit assumed for its
/// lengths, "" if unknown; `chambers` are those for a given radius; `container_lines` are `lines_that_help`.
/// Unknown values are null.
std::string inspection_as_json(const std::filesystem::path& file, std::string_view unit, const MeshReport&,
                               const std::optional<Chambers>& chambers,
                               const std::vector<std::string>& container_lines);

/// All keys of a scene, see `scene_reference`, as a JSON object {"groups": [{name, selector, title, tables:
/// [{name, help, keys, choices}]}]}: what `bernal keys --json` prints. A key has name, help, type,
/// expectation, `default` as JSON or null, `min` and `max` (null if unlimited), `above_min`, `below_max`,
/// words, required, `is_diameter` and `acts`.
std::string scene_reference_as_json();

/// The same as a JSON Schema (2020-12) of a scene read as TOML: types, ranges, words, required and mutually
/// exclusive keys, help and defaults; unknown keys are refused. What `bernal keys --schema` prints.
/// Conditions on two values at once (min below max, as many shares as sizes, which stage works where) are not
/// in it; `read_scene` and `build` check them.
std::string scene_schema_as_json();

}  // namespace bernal
