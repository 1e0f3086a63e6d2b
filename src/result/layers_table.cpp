#include "bernal/result/layers_table.hpp"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "files/csv_lines.hpp"
#include "result/nest_folder.hpp"
#include "result/write_layers.hpp"
#include "scene/unpublished.hpp"

namespace bernal {
namespace layers_table {

namespace fs = std::filesystem;

/// What one line has to say.
struct Line {
  std::size_t sphere;
  const Layer& layer;
  double inner, outer;
};

std::string words_of(const Line& of) {
  return fmt::format("\"{}\" of sphere {}, of {}, goes from {:.9g} to {:.9g}", of.layer.name, of.sphere,
                     material_of(of.layer), of.inner, of.outer);
}

/// Takes what stands after the last comma off the line.
std::string_view last_field(std::string_view& line) {
  const std::size_t comma = line.rfind(',');
  if (comma == std::string_view::npos) return {};
  const std::string_view field = line.substr(comma + 1);
  line = line.substr(0, comma);
  return field;
}

bool says(const CsvLines& lines, const Line& expected) {
  constexpr double rounding = 1e-12;
  std::string_view rest = lines.line();
  const std::string_view outer = last_field(rest), inner = last_field(rest);
  if (rest != fmt::format("{},{},{}", expected.sphere, expected.layer.name, material_of(expected.layer)))
    return false;
  return std::abs(lines.read_number(inner, "inner") - expected.inner) <= rounding * expected.outer &&
         std::abs(lines.read_number(outer, "outer") - expected.outer) <= rounding * expected.outer;
}

/// Reads a table to its end, or throws where it says otherwise; returns how many layers it has.
std::uint64_t read_table(const fs::path& file, const Packing& packing) {
  const SphereLayers layers = layers_of(packing);
  CsvLines lines(file);
  if (layers.of_class.empty()) lines.fail("the scene names no layers: the table is that of another result");
  const auto next_is = [&](std::string_view text) {
    if (!lines.next() || lines.line() != text) lines.fail(fmt::format("expected {}", text));
  };
  next_is(fmt::format("# unit: {}", name_of(packing.scene.unit)));
  next_is(header_of_layers);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    double inner = 0;
    const std::vector<Layer>& of = layers.of_class[packing.classes.empty() ? 0 : packing.classes[i]];
    const auto outer = layers.of(i);
    for (std::size_t k = 0; k < outer.size(); ++k, ++count) {
      const Line expected{i, of[k], inner, outer[k]};
      if (!lines.next()) lines.fail(fmt::format("ends here, where {} is missing", words_of(expected)));
      if (!says(lines, expected))
        lines.fail(
            fmt::format("says otherwise than the scene and the spheres, by which {}", words_of(expected)));
      inner = outer[k];
    }
  }
  if (lines.next()) lines.fail("has more layers than the spheres");
  return count;
}

/// Whether a result has a table: arrays of spheres have none beside them.
bool is_expected(const Packing& packing, const fs::path& folder) {
  return has_layers(packing.scene) && spheres_of_result(folder).extension() != ".npy";
}

}  // namespace layers_table

std::optional<LayersTable> layers_table_of(const Packing& packing, const std::filesystem::path& folder) {
  std::optional<LayersTable> found;
  const auto file = where_it_stands(folder / layers_as_text);
  std::error_code unknown;
  const bool is_there = std::filesystem::exists(file, unknown);
  if (!is_there && layers_table::is_expected(packing, folder))
    found = {.layers = 0, .fault = fmt::format("{} is missing, which has the layers", file.string())};
  if (is_there) {
    found.emplace();
    try {
      found->layers = layers_table::read_table(file, packing);
    } catch (const Error& error) {  // a table that tells lies is a verdict, not bad input
      if (error.code() != ErrorCode::bad_packing) throw;
      found->fault = error.location().file.empty() ? fmt::format("{}: {}", file.string(), error.message())
                                                   : error.what();
    }
  }
  const std::vector<InsideFiles> files = files_of_insides(packing);
  for (std::size_t k = 0; k < files.size(); ++k)
    for (std::size_t t = 0; t < files[k].packings.size(); ++t) {
      const auto inside = layers_table_of(*packing.inside[k].templates[t], folder / files[k].packings[t]);
      if (!inside) continue;
      if (!found) found.emplace();
      found->layers += inside->layers;
      if (found->fault.empty()) found->fault = inside->fault;
    }
  return found;
}

void add_to(Certificate& certificate, const LayersTable& table) {
  std::string& statement = certificate.statement;
  if (table.fault.empty())
    statement += fmt::format(" {} has the {} layers of the scene and the spheres.", layers_as_text,
                             grouped(table.layers));
  else
    refuse(certificate, table.fault);
}

}  // namespace bernal
