#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bernal/core/error.hpp"

namespace bernal {

/// What a user may write to the right of an equals sign.
using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

/// One `key = value` of the scene and where it stands; line 0 for a default that was filled in.
struct Parameter {
  Value value;
  Location where;
};

/// A named thing of the scene (a container, a size distribution, a stage) with its parameters. Plain data:
/// the reader has checked names, types and ranges against the schema, and has filled in every default, so a
/// getter of an existing key never fails. Missing keys and wrong types throw Error{bad_argument}, which
/// only a scene made in C++ can cause.
struct Spec {
  std::string name;
  std::map<std::string, Parameter, std::less<>> parameters;
  Location where;
  std::vector<Spec> parts = {};  ///< of a mixture: what it is made of

  bool has(std::string_view key) const { return parameters.find(key) != parameters.end(); }
  double number(std::string_view key) const;  ///< double or integer
  std::int64_t integer(std::string_view key) const;
  bool flag(std::string_view key) const;
  const std::string& text(std::string_view key) const;
  const std::vector<double>& numbers(std::string_view key) const;
  Location location(std::string_view key) const;  ///< of the key if it has one, else of the whole
};

/// At most one of these says when there are enough spheres; in a periodic box that is given neither size nor
/// edge, `count` and `packing_fraction` together say how large it is. Where nothing is said the stages place
/// what they can, or for relaxation in a container what the plan expects.
struct Target {
  std::optional<std::int64_t> count;
  std::optional<double> packing_fraction;
  /// `packing_fraction = "predicted"`: `build` puts in a number, what is predicted less the error of that.
  bool predicted = false;
  bool fill = false;  ///< as many as the stages can place, at any price
  Location where;

  bool has_packing_fraction() const { return packing_fraction || predicted; }
  /// Whether it is left to the stages how many spheres there are.
  bool is_open() const { return !count && !has_packing_fraction(); }
};

/// A packing problem as the user states it: plain data, no behaviour. Lengths are in `unit`.
struct Scene {
  std::filesystem::path file;  ///< empty for a scene made in C++
  std::string unit = "m";
  std::uint64_t seed = 1;
  Spec container;  ///< box, cylinder, sphere, mesh, periodic
  Spec sizes;      ///< constant, classes, uniform, …; lengths as written
  bool sizes_are_diameters = false;
  std::string draw = "random";  ///< random | quantiles
  Target target;
  std::string walls = "filtered";  ///< double | filtered | exact
  double overlap = 0;              ///< largest overlap ratio that the result may keep
  std::vector<Spec> stages;        ///< in order; the protocol of the container's kind if the file names none
  bool stages_are_default = false;

  bool is_periodic() const { return container.name == "periodic"; }
  int dimension() const { return is_periodic() ? static_cast<int>(container.integer("dimension")) : 3; }
};

}  // namespace bernal
