#pragma once
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "bernal/domain/domain.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

using Json = nlohmann::ordered_json;  // writes NaN and infinity as null

/// Names may hold any bytes; a report that is not valid UTF-8 would be worse than a replaced character.
std::string text_of(const Json&);

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

/// What stands under `certificate` of report.json.
Json certificate_json(const Certificate&);

/// `coordination`, `contacts`, `rattlers` and what goes with them.
Json contacts_json(const Contacts&);

/// Spheres, crystalline ones and their share: of all, near the wall and in the core; null where there is no
/// such order or region.
Json crystalline_json(const std::optional<BondOrder>&);

/// The chambers with what is in them, and what cannot be covered.
Json chambers_json(const std::optional<Chambers>&);

/// The figures of a wall profile, without its layers.
Json walls_json(const WallProfile&);

/// How the sizes differ from the drawn sequence, or null.
Json drawn_json(const SizeComparison&);

/// The key `box` with edges, axes that have walls and volume of a box that repeats itself or has not three
/// dimensions; or `container` with kind, volume and bounds, and the periods of one that repeats itself, 0
/// along open axes.
Json::object_t::value_type domain_json(const Domain&);

}  // namespace bernal
