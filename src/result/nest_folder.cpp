#include "result/nest_folder.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/result/read_packing.hpp"
#include "files/bytes_of_file.hpp"
#include "files/csv_lines.hpp"
#include "files/output_file.hpp"
#include "result/places_of_result.hpp"
#include "scene/insides.hpp"
#include "scene/unpublished.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

/// Spheres are counted from 0, as everywhere, packings from 1, as their folders are.
constexpr std::string_view header_of_table = "sphere,template,qw,qx,qy,qz";
constexpr std::size_t columns_of_table = 6;

void write_table(const fs::path& file, const PackingsInside& inside) {
  OutputFile out(file);
  out.append(fmt::format("{}\n", header_of_table));
  for (std::size_t k = 0; k < inside.spheres.size(); ++k) {
    const auto& [w, x, y, z] = inside.rotations[k];
    out.append(fmt::format("{},{},{},{},{},{}\n", inside.spheres[k], inside.which[k] + 1, w, x, y, z));
  }
  out.close();
}

/// A whole number from `least` on.
std::uint32_t whole(const CsvLines& lines, double value, double least, std::string_view column) {
  if (!(value >= least && value < 0x1p32) || value != std::floor(value))
    lines.fail(fmt::format("\"{}\" has to be a whole number from {}, not {}", column, least, value));
  return static_cast<std::uint32_t>(value - least);
}

void read_table(const fs::path& file, PackingsInside& inside) {
  constexpr std::array<std::string_view, columns_of_table> names = {"sphere", "template", "qw",
                                                                    "qx",     "qy",       "qz"};
  CsvLines lines(file);
  if (!lines.next() || lines.line() != header_of_table)
    lines.fail(fmt::format("expected the header {}, found {}", header_of_table, quoted(lines.line())));
  while (lines.next()) {
    std::string_view rest = lines.line();
    std::array<double, columns_of_table> values{};
    for (std::size_t k = 0; k < columns_of_table; ++k) {
      const std::size_t comma = rest.find(',');
      if ((comma == std::string_view::npos) != (k + 1 == columns_of_table))
        lines.fail(fmt::format("expected {} fields: {}", columns_of_table, header_of_table));
      values[k] = lines.read_number(rest.substr(0, comma), names[k]);
      if (comma != std::string_view::npos) rest.remove_prefix(comma + 1);
    }
    inside.spheres.push_back(whole(lines, values[0], 0, names[0]));
    inside.which.push_back(whole(lines, values[1], 1, names[1]));
    inside.rotations.push_back({values[2], values[3], values[4], values[5]});
  }
}

/// The folders of a result are its own.
fs::path in_folder(const fs::path& folder, const std::string& name, const fs::path& file) {
  if (!name.starts_with("inside/") || !is_name_in(folder, name))
    throw Error(
        ErrorCode::bad_packing,
        fmt::format("names {}, which is no place below inside/", bernal::quoted(std::string_view(name))),
        {file.string()});
  return folder / name;
}

}  // namespace

std::vector<InsideFiles> files_of_insides(const Packing& packing) {
  std::vector<InsideFiles> all;
  for (std::size_t k = 0; k < packing.inside.size(); ++k) {
    InsideFiles& files = all.emplace_back();
    files.folder = "inside/" + filled_class(packing.scene, packing.scene.inside[k]).folder;
    files.table = fmt::format("{}/{}", files.folder, table_of_rotations);
    const std::size_t n = packing.inside[k].templates.size();
    for (std::size_t t = 1; t <= n; ++t)
      files.packings.push_back(fmt::format("{}/{}", files.folder, folder_of_template(t, n)));
    if (n > 0) files.scene = files.packings.front() + "/scene.toml";
  }
  return all;
}

void write_nest(const Packing& packing, StagedFolder& staged) {
  const std::vector<InsideFiles> files = files_of_insides(packing);
  for (std::size_t k = 0; k < files.size(); ++k) {
    const PackingsInside& inside = packing.inside[k];
    const fs::path table = staged.add(files[k].table);
    write_table(table, inside);
    PackingsInside read;
    read_table(table, read);
    if (read.spheres != inside.spheres || read.which != inside.which || read.rotations != inside.rotations)
      throw Error(ErrorCode::cannot_write, "reads back differently from what was written", {table.string()});
  }
  staged.write(nest_file, nest_as_json(packing, files));
}

void read_nest(Packing& packing, const fs::path& folder) {
  if (packing.scene.inside.empty()) return;
  const fs::path file = where_it_stands(folder / nest_file);
  std::error_code unknown;
  if (!fs::exists(file, unknown))
    throw Error(
        ErrorCode::bad_packing,
        "is missing: it says which packings lie inside of the spheres; take a folder that bernal pack "
        "wrote",
        {file.string()});
  const std::string text = bytes_of_file(file);
  const std::vector<InsideFiles> all = files_in_nest(text, file);
  if (all.size() != packing.scene.inside.size())
    throw Error(ErrorCode::bad_packing,
                fmt::format("has {} kinds of packings inside of spheres, and the scene has {}", all.size(),
                            packing.scene.inside.size()),
                {file.string()});
  for (std::size_t k = 0; k < all.size(); ++k) {
    const FilledClass of = filled_class(packing.scene, packing.scene.inside[k]);
    PackingsInside& inside = packing.inside.emplace_back();
    inside.of_class = of.of_class;
    inside.layer = of.layer;
    for (std::size_t t = 0; t < all[k].packings.size(); ++t) {
      auto packed = std::make_shared<Packing>(read_packing(in_folder(folder, all[k].packings[t], file)));
      packed->outcome = all[k].outcomes[t];  // which spheres and scene do not say
      inside.templates.push_back(std::move(packed));
    }
    read_table(in_folder(folder, all[k].table, file), inside);
  }
  const bool goes_together = std::ranges::all_of(packing.inside, [](const PackingsInside& inside) {
    return std::ranges::all_of(inside.which, [&](std::uint32_t t) { return t < inside.templates.size(); });
  });
  if (!goes_together) return;  // the certificate says which sphere holds a packing that is not there
  if (const std::string place = nest_differs(text, packing, all); !place.empty())
    throw Error(
        ErrorCode::bad_packing,
        fmt::format("says otherwise than the files that it names, at {}: one of them has changed since "
                    "it was written; pack {} again",
                    place, (folder / "scene.toml").string()),
        {file.string()});
}

}  // namespace bernal
