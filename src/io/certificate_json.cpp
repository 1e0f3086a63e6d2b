#include "bernal/io/certificate_json.hpp"

#include <nlohmann/json.hpp>

namespace bernal {

std::string certificate_as_json(const Certificate& c) {
  using Json = nlohmann::ordered_json;  // writes NaN and infinity as null
  const Json json = {{"certified", c.certified},
                     {"statement", c.statement},
                     {"spheres", c.spheres},
                     {"pairs_tested", c.pairs_tested},
                     {"walls_tested", c.walls_tested},
                     {"centers_tested", c.centers_tested},
                     {"decided_double", c.decided_double},
                     {"decided_exact", c.decided_exact},
                     {"overlapping_pairs", c.overlapping_pairs},
                     {"protruding_spheres", c.protruding_spheres},
                     {"worst_pair", c.worst_pair ? Json(*c.worst_pair) : Json()},
                     {"max_overlap", c.max_overlap},
                     {"worst_wall", c.worst_wall ? Json(*c.worst_wall) : Json()},
                     {"min_wall_gap", c.worst_wall ? Json(c.min_wall_gap) : Json()},
                     {"seconds", c.seconds}};
  return json.dump(2);
}

}  // namespace bernal
