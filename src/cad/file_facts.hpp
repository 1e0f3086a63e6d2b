#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "cad/polygon_soup.hpp"

namespace bernal::cad {

/// What the text of a Collada document says in its own `asset` (those of its parts do not count): without a
/// unit it is metre by its specification; the axis stays open where it is not said.
FileFacts facts_of_collada(std::string_view xml);

/// The unit of an AMF: millimetre by its specification where it is not said.
FileFacts facts_of_amf(std::string_view xml);

/// The unit of the model in a 3MF, millimetre where it is not said, and its objects by their ids.
struct ThreeMfFacts {
  struct Object {
    std::string name;
    bool is_part = true;  ///< and not what supports it while it is printed
  };
  FileFacts facts;
  std::map<std::string, Object> objects;
  /// Why its objects make no model: one is a part of itself, they repeat each other beyond measure. Empty if
  /// they do.
  std::string trouble = {};
};
ThreeMfFacts facts_of_3mf(std::string_view xml);

/// The whole file, without the mark of UTF-8 that editors put in front.
std::string text_without_mark(const std::filesystem::path& file);

}  // namespace bernal::cad
