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
#include "bernal/scene/packing.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

/// The certificate as one JSON object, two spaces a level: what `verify --json` prints and what stands under
/// `certificate` in report.json. Its keys are the members of Certificate. `worst_pair` is null where no two
/// spheres are near, twice the same index for a sphere and its own image; `worst_wall` and `min_wall_gap` are
/// null where no sphere is near a wall. `overlaps` and `protrusions` are there where a list was asked for and
/// has entries. Numbers that are not finite become null.
/// With `settled`, where whether the spheres rest was asked for; its `list`, of spheres with centre and
/// radius, is there where it has entries.
std::string certificate_as_json(const Certificate&, const std::optional<Rest>& = {},
                                const Spheres<dynamic>& = Spheres<dynamic>(3));

/// Measurements as one JSON object: what `bernal measure --json` prints. Lengths are in the scene's unit,
/// radii are radii. What there is not is null: `g_r` where there are walls, `chambers` and `walls` where
/// there are none, p-values that would mean nothing.
std::string measurements_as_json(const Packing&, const Measurements&);

/// A plan as one JSON object: what `bernal explain --json` prints. `stages` is TOML.
std::string plan_as_json(const Plan&);

/// What a CAD file is as one JSON object: what `bernal inspect --json` prints. `unit` is what its lengths are
/// taken for, "" where nobody said; `chambers` those for a radius, where one was given; `container_lines`
/// are `lines_that_help`. What is not known is null.
std::string inspection_as_json(const std::filesystem::path& file, std::string_view unit, const MeshReport&,
                               const std::optional<Chambers>& chambers,
                               const std::vector<std::string>& container_lines);

/// Everything that a scene may say, see `scene_reference`, as one JSON object {"groups": [{name, selector,
/// title, tables: [{name, help, keys, choices}]}]}: what `bernal keys --json` prints. A key has name, help,
/// type, expectation, `default` as JSON or null, `min` and `max` (null where there is no limit), `above_min`,
/// `below_max`, words, required, `is_diameter` and `acts`.
std::string scene_reference_as_json();

/// The same as a JSON Schema (2020-12) of a scene, read as TOML: types, ranges, words, what must be given and
/// what excludes each other, with help and defaults; keys that it does not name are refused. What `bernal
/// keys
/// --schema` prints and data/schemas/scene.schema.json holds. What depends on two values at a time (min below
/// max, as many shares as sizes, which stage works where) it does not say; `read_scene` and `build` do.
std::string scene_schema_as_json();

}  // namespace bernal
