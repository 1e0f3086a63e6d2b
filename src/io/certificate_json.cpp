#include "bernal/io/certificate_json.hpp"

#include "io/json.hpp"

namespace bernal {

Json certificate_json(const Certificate& c) {
  Json json = {{"certified", c.certified},
               {"statement", c.statement},
               {"allowed_overlap", c.allowed_overlap},
               {"cancelled", c.cancelled},
               {"spheres", c.spheres},
               {"pairs_tested", c.pairs_tested},
               {"walls_tested", c.walls_tested},
               {"centers_tested", c.centers_tested},
               {"decided_double", c.decided_double},
               {"decided_exact", c.decided_exact},
               {"overlapping_pairs", c.overlapping_pairs},
               {"protruding_spheres", c.protruding_spheres},
               {"worst_pair", or_null(c.worst_pair)},
               {"max_overlap", c.max_overlap},
               {"worst_wall", or_null(c.worst_wall)},
               {"min_wall_gap", c.worst_wall ? Json(c.min_wall_gap) : Json()}};
  for (const auto& [pair, ratio] : c.overlaps) json["overlaps"].push_back({{"pair", pair}, {"ratio", ratio}});
  for (const auto& [sphere, gap] : c.protrusions)
    json["protrusions"].push_back({{"sphere", sphere}, {"gap", gap}});
  json["seconds"] = c.seconds;
  return json;
}

std::string certificate_as_json(const Certificate& c) { return text_of(certificate_json(c)); }

}  // namespace bernal
