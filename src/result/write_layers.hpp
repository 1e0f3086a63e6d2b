#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bernal/scene/sphere_layers.hpp"
#include "files/output_file.hpp"

namespace bernal {

/// The name of the table of layers in a result that has any, with its spheres as text.
inline constexpr std::string_view layers_as_text = "layers.csv";

inline constexpr std::string_view header_of_layers = "sphere,layer,material,inner,outer";

/// A line for each layer of each sphere, from the centre out: `sphere` (its line in spheres.csv, counted from
/// 0), `layer`, `material`, and where it begins and ends, `inner` and `outer`, measured from the centre, in
/// the scene's unit: the shortest text that reads back to the same double.
void write_layers_csv(OutputFile& file, const SphereLayers& layers, const Packing& packing);

/// A number for each sphere.
struct NamedColumn {
  std::string name;
  std::vector<double> values;
};

/// Where the layer of each name ends in each sphere: "outer_core"; NaN in spheres without it. None where
/// there are no layers.
std::vector<NamedColumn> columns_of_layers(const SphereLayers& layers, const Packing& packing);

}  // namespace bernal
