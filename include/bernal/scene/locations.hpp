#pragma once
#include <map>
#include <string>
#include <string_view>

#include "bernal/core/error.hpp"

namespace bernal {

/// Where a part of a scene stands in the user's file, whole and key by key; empty for what was made in C++.
struct Locations {
  Location whole;
  std::map<std::string, Location, std::less<>> keys;

  /// Of the key if it is written there, else of the whole.
  const Location& of(std::string_view key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? whole : found->second;
  }
};

}  // namespace bernal
