#include "scene/schema.hpp"

namespace bernal::schema {
namespace {

/// Keys of `compress`, which `shake` and `refill` pass on to the compression that they end with.
std::vector<Key> with_compression(std::vector<Key> keys) {
  const Key compression[] = {
      {.name = "direction",
       .type = Type::direction,
       .help = "where the spheres are pushed; its length is of no matter",
       .otherwise = std::vector<double>{0, 0, -1}},
      {.name = "tilt",
       .type = Type::number,
       .help = "how far a sphere's own direction leaves the common one; 0: not at all",
       .otherwise = 2.0,
       .range = {0, 100}},
      {.name = "tolerance",
       .type = Type::number,
       .help = "relative fall of the potential energy in an iteration that counts as none",
       .otherwise = 1e-2,
       .range = {0, 1, true, true}},
      {.name = "max_iterations",
       .type = Type::integer,
       .help = "after which it stops unconverged",
       .otherwise = 400,
       .range = {1, 1e9}},
      {.name = "buffer",
       .type = Type::number,
       .help = "room in a sphere's bounding box on each side, in mean radii",
       .otherwise = 0.5,
       .range = {0.01, 10}}};
  keys.insert(keys.end(), std::begin(compression), std::end(compression));
  return keys;
}

/// The paper's phi0, and in other than three dimensions what is as far above random close packing.
void complete_relax(Spec& spec, const Scene& scene) {
  constexpr double phi0[] = {1.34, 1.13, 0.86, 0.62, 0.42, 0.27, 0.16, 0.093};
  spec.parameters.try_emplace("phi0", Parameter{phi0[scene.dimension() - 1], {scene.file.string()}});
}

/// The papers' phi_init; in other than three dimensions as far below where random insertion ends.
void complete_grow(Spec& spec, const Scene& scene) {
  const int dimension = scene.dimension();
  if (dimension < 2 || dimension > 6)
    throw Error(ErrorCode::bad_scene, "\"grow\" works in two to six dimensions; use \"relax\"", spec.where);
  constexpr double phi_init[] = {0.28, 0.2, 0.135, 0.089, 0.057};
  spec.parameters.try_emplace("phi_init", Parameter{phi_init[dimension - 2], {scene.file.string()}});
}

/// `insert` and all that compression needs.
std::vector<Entry> compression_stages() {
  return {
      {.name = "insert",
       .help = "place spheres at random where they overlap nothing",
       .keys = {{.name = "attempts",
                 .type = Type::integer,
                 .help = "random places tried for one sphere before it has to wait",
                 .otherwise = 100,
                 .range = {1, 1e9}},
                {.name = "packing_fraction",
                 .type = Type::number,
                 .help = "where random insertion stops",
                 .otherwise = 0.30,
                 .range = {0, 1, true, true}}}},
      {.name = "compress",
       .help = "move every sphere along a direction until it touches",
       .keys = with_compression({})},
      {.name = "shake",
       .help = "move spheres across the direction, so that arches break, and compress again",
       .keys = with_compression(
           {{.name = "rounds", .type = Type::integer, .help = "how often", .otherwise = 2, .range = {1, 1e9}},
            {.name = "amplitude",
             .type = Type::number,
             .help = "longest way in one sweep, in mean radii",
             .otherwise = 2.0,
             .range = {0, 100, true}}})},
      {.name = "refill",
       .help = "insert into the free space, compress and shake, until the container is full",
       .keys =
           with_compression({{.name = "probes",
                              .type = Type::number,
                              .help = "random places to look at, for each sphere that would fill the volume",
                              .otherwise = 15.0,
                              .range = {0, 1e6, true}},
                             {.name = "max_rounds",
                              .type = Type::integer,
                              .help = "after which it stops unfilled",
                              .otherwise = 200,
                              .range = {1, 1e9}},
                             {.name = "patience",
                              .type = Type::number,
                              .help = "full when a round adds less than this share of the spheres' volume",
                              .otherwise = 3e-3,
                              .range = {0, 1}},
                             {.name = "shakes",
                              .type = Type::integer,
                              .help = "rounds of shaking after each refilling",
                              .otherwise = 1,
                              .range = {0, 1e9}},
                             {.name = "amplitude",
                              .type = Type::number,
                              .help = "longest way in one sweep of shaking, in mean radii",
                              .otherwise = 2.0,
                              .range = {0, 100, true}}})}};
}

Entry relax_in_container_entry() {
  return {.name = "relax",
          .help = "start with overlaps; push spheres apart and off the walls, and stir what is stuck",
          .keys = {{.name = "patience",
                    .type = Type::integer,
                    .help = "how often what is stuck is stirred before some spheres are taken out",
                    .otherwise = 12,
                    .range = {0, 1e6}},
                   {.name = "sweeps",
                    .type = Type::integer,
                    .help = "of all spheres, after which it stops",
                    .otherwise = 40000,
                    .range = {1, 1e9}},
                   {.name = "seconds",
                    .type = Type::number,
                    .help = "after which it stops, and then one seed need not give one packing; 0: any time",
                    .otherwise = 0.0,
                    .range = {0, 1e9}}}};
}

Entry relax_in_periodic_box_entry() {
  return {.name = "relax",
          .help = "start with overlaps in a small box; push spheres apart and let the box grow",
          .keys = {{.name = "alpha",
                    .type = Type::number,
                    .help = "sweeps between two growths of the box, in units of (log10 N)^2",
                    .otherwise = 17.0,
                    .range = {0, 1e6, true}},
                   {.name = "beta",
                    .type = Type::number,
                    .help = "the box grows by the largest overlap ratio divided by this",
                    .otherwise = 30.0,
                    .range = {0.01, 1e6}},
                   {.name = "phi0",
                    .type = Type::number,
                    .help = "packing fraction of the overlapping spheres at the start; if absent 0.86, "
                            "in other than three dimensions 1.34 of random close packing",
                    .optional = true,
                    .range = {0, 10, true}},
                   {.name = "stop",
                    .type = Type::number,
                    .help = "largest overlap ratio that counts as none; the box then grows by it",
                    .otherwise = 2e-4,
                    .range = {1e-12, 0.5}},
                   {.name = "polish",
                    .type = Type::number,
                    .help = "close the gaps and overlaps of all contacts to this ratio; 0: do not",
                    .otherwise = 0.0,
                    .range = {0, 0.5}},
                   {.name = "method",
                    .type = Type::word,
                    .help = "fast, or reference: the published loop as it stands, a hundred times slower",
                    .otherwise = "fast",
                    .words = {"fast", "reference"}},
                   {.name = "settle",
                    .type = Type::flag,
                    .help = "reference: what touches nothing moves to touch its nearest neighbour",
                    .otherwise = false}},
          .complete = complete_relax};
}

Key growth_rate() {
  return {.name = "rate",
          .type = Type::number,
          .help =
              "growth of the mean diameter by volume over the thermal speed where the packing forms; "
              "slower is denser; ten times that while the spheres are a fluid",
          .otherwise = 0.01,
          .range = {1e-6, 1}};
}

Key jamming_pressure() {
  return {.name = "pressure",
          .type = Type::number,
          .help = "compressibility factor P V / N k T at which the spheres count as jammed",
          .otherwise = 1e6,
          .range = {10, 1e13}};
}

Key masses_of_spheres() {
  return {.name = "masses",
          .type = Type::word,
          .help =
              "equal, as published; volume: as of one material, which packs denser where sizes differ "
              "several times, if the rate is low",
          .otherwise = "equal",
          .words = {"equal", "volume"}};
}

Entry grow_in_container_entry() {
  return {.name = "grow",
          .help = "hard spheres fly, collide and grow to their radii, in convex containers",
          .keys = {
              {.name = "delta",
               .type = Type::number,
               .help = "as published: growth of the radii, relative to those at the start, in the time "
                       "that a sphere of thermal speed takes for the cube root of the container's volume; if "
                       "absent see rate",
               .optional = true,
               .range = {0, 100, true}},
              {.name = "phi_init",
               .type = Type::number,
               .help = "packing fraction of the random insertion at the start, half of it where spheres "
                       "find no places",
               .otherwise = 0.2,
               .range = {0, 0.5, true}},
              growth_rate(),
              jamming_pressure(),
              masses_of_spheres()}};
}

Entry grow_in_periodic_box_entry() {
  return {.name = "grow",
          .help = "hard spheres fly, collide and grow until they jam; in 2 to 6 dimensions",
          .keys = {{.name = "delta",
                    .type = Type::number,
                    .help = "as published: growth of the radii, relative to those at the start, in the time "
                            "that a sphere of thermal speed takes across the box; if absent see rate",
                    .optional = true,
                    .range = {0, 100, true}},
                   {.name = "phi_init",
                    .type = Type::number,
                    .help = "packing fraction of the random insertion at the start; if absent 0.2, in other "
                            "than three dimensions half of what insertion reaches",
                    .optional = true,
                    .range = {0, 0.5, true}},
                   growth_rate(),
                   jamming_pressure(),
                   masses_of_spheres(),
                   {.name = "polish",
                    .type = Type::number,
                    .help = "close the gaps and overlaps of all contacts to this ratio; 0: do not",
                    .otherwise = 0.0,
                    .range = {0, 0.5}}},
          .complete = complete_grow};
}

Entry fly_entry() {
  return {
      .name = "fly",
      .help = "fill a box of given size with spheres of given radii that fly and collide",
      .keys = {{.name = "method",
                .type = Type::word,
                .help = "auto: by target and sizes; flight: from collision to collision; patent: in steps of "
                        "one collision; classes: large ones first, small ones between them; relaxation: "
                        "all at once, pushed apart",
                .otherwise = "auto",
                .words = {"auto", "flight", "patent", "classes", "relaxation"}},
               {.name = "packing_fraction",
                .type = Type::number,
                .help = "where [spheres] does not say it: the one to fill the box to",
                .optional = true,
                .range = {0, 1, true, true}},
               {.name = "batch",
                .type = Type::integer,
                .help = "flight, patent: new spheres tried between two steps; 0: half of all, for the "
                        "patent's procedure a tenth",
                .otherwise = 0,
                .range = {0, 1e9}},
               {.name = "dt",
                .type = Type::number,
                .help = "flight, patent: way between two batches in mean diameters; if absent 0.25, for the "
                        "patent's procedure 0.01",
                .optional = true,
                .range = {0, 1e6, true}},
               {.name = "patience",
                .type = Type::number,
                .help = "flight, patent: full when so many places in a row, for each sphere, were not free",
                .otherwise = 1000.0,
                .range = {0, 1e9, true}},
               {.name = "sweeps",
                .type = Type::integer,
                .help = "classes, relaxation: of all spheres, after which it stops",
                .otherwise = 20000,
                .range = {1, 1e9}}}};
}

}  // namespace

std::vector<Entry> stages(bool in_container) {
  std::vector<Entry> all = compression_stages();
  all.insert(in_container ? all.end() : all.begin(),
             in_container ? relax_in_container_entry() : relax_in_periodic_box_entry());
  all.push_back(in_container ? grow_in_container_entry() : grow_in_periodic_box_entry());
  if (!in_container) all.insert(all.begin() + 1, fly_entry());
  return all;
}

}  // namespace bernal::schema
