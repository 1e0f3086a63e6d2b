#pragma once
#include <string>

#include "bernal/domain/domain.hpp"
#include "formats/format.hpp"

namespace bernal {

/// What the spheres of a file lie in.
struct ImportDomain {
  Scene scene;  ///< unit and container
  Domain domain;
  std::vector<double> shift;  ///< that brings the corner of a periodic box to zero; empty: none
  std::string words;
};

/// Of spheres with sizes, in the file's unit; those of a scene's container are converted to its unit.
ImportDomain domain_of_import(FileContents& contents, Unit unit, const Reading& reading);

/// The unit of a file: its own, else that of the options, else that of the scene whose container is meant.
Unit unit_of_import(const FileContents& contents, const Reading& reading);

}  // namespace bernal
