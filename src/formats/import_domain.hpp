#pragma once
#include <string>

#include "bernal/domain/domain.hpp"
#include "formats/format.hpp"

namespace bernal {

/// The domain of imported spheres.
struct ImportDomain {
  Scene scene;  ///< unit and container
  Domain domain;
  std::vector<double> shift;  ///< moves the corner of a periodic box to zero; empty: none
  std::string words;
};

/// For spheres with sizes, in the file's unit; those in a scene's container are converted to its unit.
ImportDomain domain_of_import(FileContents& contents, Unit unit, const Reading& reading);

/// The unit of a file: its own, else that of the options, else that of the scene with the container.
Unit unit_of_import(const FileContents& contents, const Reading& reading);

}  // namespace bernal
