#pragma once
#include <filesystem>
#include <string>

#include "cad/read/polygon_soup.hpp"
#include "cad/read/xml_document.hpp"

namespace bernal::cad {

/// What the text of a Collada document says in its own `asset` (those of its parts do not count): without a
/// unit it is metre by its specification; the axis stays open where it is not said.
FileFacts facts_of_collada(std::string xml);

/// The unit that the root of a 3MF or AMF names: millimetre by their specifications where it names none.
void set_unit(pugi::xml_node root, FileFacts&);

/// The whole file, without the mark of UTF-8 that editors put in front.
std::string text_without_mark(const std::filesystem::path& file);

}  // namespace bernal::cad
