#include "bernal/result/write_local.hpp"

#include <array>
#include <charconv>
#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "files/input_file.hpp"
#include "files/output_file.hpp"
#include "files/staged_folder.hpp"
#include "result/result_folder.hpp"

namespace bernal {
namespace {

constexpr std::string_view heading_of_local = "packing_fraction,cell_volume,neighbours";

bool is_local_table(const std::filesystem::path& file) {
  InputFile in(file);
  std::string unit(200, ' '), heading(heading_of_local.size() + 2, ' ');
  in.getline(unit.data(), static_cast<std::streamsize>(unit.size()));
  in.getline(heading.data(), static_cast<std::streamsize>(heading.size()));
  return unit.starts_with("# unit: ") && heading.starts_with(heading_of_local);
}

}  // namespace

void write_local(const Packing& packing, const LocalPacking& local, const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
  if (manifest_of(folder).contains(file.filename().string()))
    throw Error(ErrorCode::cannot_write, "belongs to the result there; give the table another name",
                {file.string()});
  std::error_code unknown;
  if (std::filesystem::exists(std::filesystem::symlink_status(file, unknown)) &&
      !(std::filesystem::is_regular_file(file, unknown) && is_local_table(file)))
    throw Error(ErrorCode::cannot_write,
                "is no table of local packing fractions; nothing is written in its place", {file.string()});
  StagedFolder staged(folder);
  OutputFile out(staged.add(file.filename().string()));
  out.append(fmt::format("# unit: {}\n{}\n", name_of(packing.scene.unit), heading_of_local));
  std::array<char, 96> line;
  for (std::size_t i = 0; i < local.packing_fraction.size(); ++i) {
    char* end = std::to_chars(line.data(), line.data() + line.size(), local.packing_fraction[i]).ptr;
    *end++ = ',';
    end = std::to_chars(end, line.data() + line.size(), local.cell_volume[i]).ptr;
    *end++ = ',';
    end = std::to_chars(end, line.data() + line.size(), local.neighbours[i]).ptr;
    *end++ = '\n';
    out.append({line.data(), static_cast<std::size_t>(end - line.data())});
  }
  out.close();
  staged.publish();
}

}  // namespace bernal
