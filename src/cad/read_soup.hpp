#pragma once
#include <filesystem>
#include <string>

#include "cad/polygon_soup.hpp"

namespace bernal::cad {

/// What stands in a file, by that reader which does it justice.
struct ChosenSoup {
  PolygonSoup soup;
  std::string reader;  ///< which one it was and why, one phrase
  FileFacts facts;
};

/// Reads any format that one of the readers knows. True surfaces, of STEP and the like, are tessellated to
/// within `deflection`, in metres, where a file that does not say its unit has one of `metres`; 0 leaves it
/// to the reader. Throws Error{bad_mesh} when the file is missing, cannot be parsed, holds no faces or
/// coordinates that are not finite.
ChosenSoup read_soup(const std::filesystem::path& file, double deflection, double metres);

}  // namespace bernal::cad
