#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Where the sizes may lie. Lengths are diameters in any unit.
struct SizeLimits {
  std::optional<double> min, max;  ///< both or none; none is without limits
  bool from_above = false;         ///< narrower sizes keep the largest diameter, else the smallest
};

/// The limits that follow from the options that the user gave. Throws bernal::Error{bad_argument}.
SizeLimits limits_of(std::optional<double> min, std::optional<double> max, std::optional<double> ratio);

/// A family of size distributions, ordered from narrow to wide by a number t in [from, to].
struct SizeFamily {
  struct Member {
    std::string name;   ///< "sigma"
    double value;       ///< of that
    std::string table;  ///< as [spheres] takes it after "diameter = "
  };
  double from, to;
  std::function<Member(double t)> member;
  std::string what;  ///< "lognormal sizes", then of what limits
  /// The family near a t that was found, with all other parameters that a member chooses held fixed, so that
  /// phi is continuous in t; empty if there are none.
  std::function<std::function<Member(double t)>(double t)> held;
};

/// The families by name, in the order of --help.
std::vector<std::string> family_names();

/// `exponent` is that of fuller. A member that is chosen by how it packs is computed with so many `rods`.
SizeFamily family_of(std::string_view name, const SizeLimits& limits, double exponent, int rods);
