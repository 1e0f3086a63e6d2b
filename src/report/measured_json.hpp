#pragma once
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "bernal/domain/domain.hpp"
#include "bernal/measure/measure.hpp"

// What reports and measurements have in common as JSON; for the files of this room that write it.

using Json = nlohmann::ordered_json;  // writes NaN and infinity as null

template <class T>
struct nlohmann::adl_serializer<std::optional<T>> {
  static void to_json(Json& json, const std::optional<T>& value) { json = value ? Json(*value) : Json(); }
};

/// Makes members of a struct keys of their own names. (Those of nlohmann know no ordered_json.)
#define BERNAL_KEYS(Type, ...)                                               \
  static void to_json(Json& nlohmann_json_j, const Type& nlohmann_json_t) {  \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__)) \
  }

namespace bernal {

/// The key `box` with edges, axes that have walls and volume of a box that repeats itself or has not three
/// dimensions; or `container` with kind, volume and bounds, and the periods of one that repeats itself, 0
/// along open axes.
Json::object_t::value_type domain_json(const Domain&);

/// Of report.json: contacts, then the figures of all that is measured; the tables are in the answer of
/// `bernal measure`.
Json measured_figures(const Measurements&);

/// Two spaces a level. Names may hold any bytes; a report that is not valid UTF-8 would be worse than a
/// replaced character.
std::string text_of(const Json&);

}  // namespace bernal
