#pragma once
#include <istream>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"

/// Spheres as the user states them: those of one diameter (sigma = 0), or lognormal ones.
struct Population {
  double d43 = 1;  ///< volume-weighted mean diameter
  double sigma = 0;
  double volume = 1;  ///< of the spheres, in any unit
};

// Each throws bernal::Error{bad_argument} whose message names `where`.

/// "SIGMA" or "D43,D32,VOLUME".
Population parse_lognormal(const std::string& text, const std::string& where);
/// "D43,D32", of volume 1.
Population parse_lognormal_means(const std::string& text, const std::string& where);
/// "D,D,…", each of volume 1.
std::vector<Population> parse_diameters(const std::string& text, const std::string& where);
/// "D:V,D:V,…".
std::vector<Population> parse_classes(const std::string& text, const std::string& where);
/// One population a line, numbers between blanks, tabs or commas; '#' begins a comment. `format` is
///   l  d43 d32 volume      lognormal by its mean diameters
///   w  d43 sigma volume    lognormal by its width
///   d  diameter volume     one diameter
std::vector<Population> read_populations(std::istream& in, char format);

/// All of them mixed, as a scene has them: radii in units of the largest mean radius; those without volume
/// are left out.
bernal::Mixture sizes_of(const std::vector<Population>& populations);
