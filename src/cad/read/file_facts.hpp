#pragma once
#include <filesystem>
#include <string>

#include "cad/read/polygon_soup.hpp"
#include "cad/read/xml_document.hpp"

namespace bernal::cad {

/// Unit and axis from the `asset` of a Collada document (not of its parts). The default unit is metre by the
/// specification; the axis stays unknown if absent.
FileFacts facts_of_collada(std::string xml);

/// The unit in the root of a 3MF or AMF; millimetre by their specifications if absent.
void set_unit(pugi::xml_node root, FileFacts&);

/// The whole file without a UTF-8 byte order mark.
std::string text_without_mark(const std::filesystem::path& file);

}  // namespace bernal::cad
