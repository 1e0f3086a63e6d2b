#pragma once
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "bernal/domain/domain.hpp"
#include "bernal/measure/contacts.hpp"

namespace bernal {

using Json = nlohmann::ordered_json;  // writes NaN and infinity as null

/// Names may hold any bytes; a report that is not valid UTF-8 would be worse than a replaced character.
inline std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

/// `coordination`, `contacts`, `rattlers` and what goes with them.
Json contacts_json(const Contacts&);

/// The key `box` with the edges of a periodic box, or `container` with kind, volume and bounds.
Json::object_t::value_type domain_json(const Domain&);

}  // namespace bernal
