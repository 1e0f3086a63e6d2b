#pragma once
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "bernal/domain/domain.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/scene/layer_amounts.hpp"

// JSON common to reports and measurements, for this room's writers.

using Json = nlohmann::ordered_json;  // writes NaN and infinity as null

template <class T>
struct nlohmann::adl_serializer<std::optional<T>> {
  static void to_json(Json& json, const std::optional<T>& value) { json = value ? Json(*value) : Json(); }
};

/// Writes members of a struct under their own names. (nlohmann's macros do not support ordered_json.)
#define BERNAL_KEYS(Type, ...)                                               \
  static void to_json(Json& nlohmann_json_j, const Type& nlohmann_json_t) {  \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__)) \
  }

namespace bernal {

/// The key `box` with edges, walled axes and volume, for a periodic box or one of other than three
/// dimensions; else `container` with kind, volume and bounds, and the periods if there are any, 0 along open
/// axes.
Json::object_t::value_type domain_json(const Domain&);

/// How far the surface of a CAD file is proven to be from its triangles at most, where, and of what it
/// consists.
Json surface_json(const TrueSurface&);

/// For report.json: contacts, then the figures of all measurements; `bernal measure` returns the tables.
Json measured_figures(const Measurements&);

/// `layers` and `materials`, empty where the scene names no layers.
Json layers_json(const LayerAmounts&);

/// Indented by two spaces a level. Invalid UTF-8, which names may contain, is replaced.
std::string text_of(const Json&);

}  // namespace bernal
