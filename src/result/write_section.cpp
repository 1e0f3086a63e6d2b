#include "bernal/result/write_section.hpp"

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/report/section.hpp"
#include "cad/read/known_formats.hpp"
#include "files/input_file.hpp"
#include "files/staged_folder.hpp"
#include "result/result_folder.hpp"

namespace bernal {

void write_section(const Packing& packing, std::string_view plane, const std::filesystem::path& file) {
  if (packing.spheres.dimension() != 3)
    throw Error(ErrorCode::bad_argument,
                fmt::format("a section is that of a packing of three dimensions, and this one has {}",
                            packing.spheres.dimension()));
  const Section section = section_of(packing.spheres, packing.domain, section_plane(plane));
  const std::string svg = section_svg(section, packing.spheres, name_of(packing.scene.unit));
  const auto is_picture = [&] {
    std::string head(4, ' ');
    InputFile(file).read(head.data(), 4);
    return head == "<svg";
  };
  if (cad::extension_of(file) != ".svg")
    throw Error(ErrorCode::bad_argument, "a section is written as SVG: give a file that ends in .svg",
                {file.string()});
  const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
  if (manifest_of(folder).contains(file.filename().string()))
    throw Error(ErrorCode::cannot_write, "belongs to the result there; give the section another name",
                {file.string()});
  std::error_code unknown;
  if (stands(file) && !(std::filesystem::is_regular_file(file, unknown) && is_picture()))
    throw Error(ErrorCode::cannot_write, "is no picture; nothing is written in its place", {file.string()});
  StagedFolder staged(folder);
  staged.write(file.filename().string(), svg);
  staged.publish();
}

}  // namespace bernal
