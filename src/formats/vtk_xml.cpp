#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <pugixml.hpp>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "files/csv_headings.hpp"
#include "files/csv_lines.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/vtk.hpp"
#include "viewer/base64.hpp"

namespace bernal {
namespace {

constexpr std::string_view appended_tag = "<AppendedData";
constexpr std::uint64_t most_rows = std::uint64_t{1} << 40, most_components = 1 << 12;
/// zlib's largest ratio.
constexpr std::uint64_t most_inflated = 1032;

/// "Float32"; absent for "String".
std::optional<RawNumber> xml_number(std::string_view type, bool is_swapped) {
  RawNumber number{.is_swapped = is_swapped};
  for (const auto& [word, kind] : {std::pair{"Float", 'f'}, {"UInt", 'u'}, {"Int", 'i'}}) {
    if (!type.starts_with(word)) continue;
    const std::string_view bits = type.substr(std::string_view(word).size());
    const std::optional<std::uint64_t> count = whole_number(bits);
    if (!count || *count > 64) return {};
    number.kind = kind;
    number.bytes = static_cast<int>(*count / 8);
    if (*count % 8 == 0 && number.is_known()) return number;
  }
  return {};
}

/// Reads the data in an XML file.
class XmlReader {
 public:
  XmlReader(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file.string()) {}

  VtkPoints read() {
    parse();
    const pugi::xml_node root = document_.child("VTKFile");
    if (!root) fail_at({}, "is XML, but no VTK file; save the spheres as .vtp or .vtu");
    take_root(root);
    const std::string type = root.attribute("type").value();
    const pugi::xml_node set = root.child(type.c_str());
    if (!set)
      fail_at(root, fmt::format("there is no element {} in it; save the file again with ParaView",
                                bernal::quoted(type)));
    points_.kind = type;
    remarks_of(document_);
    remarks_of(root);
    for (const pugi::xml_node piece : set.children("Piece")) take_piece(piece);
    return std::move(points_);
  }

 private:
  /// Appended data are not XML, and come last.
  void parse() {
    const std::size_t at = text_.find(appended_tag);
    std::string head(text_.substr(0, at));
    if (at != text_.npos) {
      const std::size_t end = text_.find('>', at), mark = text_.find('_', std::min(end, text_.size()));
      if (mark == text_.npos) fail_at({}, "ends before its appended data begin; was it cut off?");
      appended_ = text_.substr(mark + 1);
      head += std::string(text_.substr(at, end - at)) + (text_[end - 1] == '/' ? ">" : "/>") + "</VTKFile>";
    }
    constexpr unsigned how = pugi::parse_default | pugi::parse_comments;
    const pugi::xml_parse_result result = document_.load_buffer(head.data(), head.size(), how);
    if (!result)
      throw Error(
          ErrorCode::bad_packing,
          fmt::format("is not well-formed XML ({}); was it cut off or changed?", result.description()),
          {file_, line_at(result.offset)});
  }

  void take_root(const pugi::xml_node& root) {
    const std::string_view type = root.attribute("type").value();
    if (type != "PolyData" && type != "UnstructuredGrid") {
      const bool is_list = type.starts_with('P') || type == "Collection" || type.starts_with("vtk");
      fail_at(root,
              fmt::format("is a VTK file of the type {}, {}", bernal::quoted(type),
                          is_list ? "which names other files; import one of those, .vtp or .vtu"
                                  : "which has no spheres; save points with radii as PolyData (.vtp) or "
                                    "UnstructuredGrid (.vtu)"));
    }
    const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
    if (order != "LittleEndian" && order != "BigEndian")
      fail_at(root,
              fmt::format("byte_order is {}; write LittleEndian or BigEndian there", bernal::quoted(order)));
    is_swapped_ = order == "BigEndian";
    const std::string_view header = root.attribute("header_type").as_string("UInt32");
    if (header != "UInt32" && header != "UInt64")
      fail_at(root, fmt::format("header_type is {}; write UInt32 or UInt64 there", bernal::quoted(header)));
    header_ = {'u', header == "UInt64" ? 8 : 4, is_swapped_};
    const std::string_view compressor = root.attribute("compressor").value();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      fail_at(root, fmt::format("is compressed by {}, and only vtkZLibDataCompressor is known; save it with "
                                "that, or not compressed",
                                bernal::quoted(compressor)));
    is_compressed_ = !compressor.empty();
    const pugi::xml_node appended = root.child("AppendedData");
    const std::string_view encoding = appended.attribute("encoding").as_string("raw");
    if (encoding != "raw" && encoding != "base64")
      fail_at(appended, fmt::format("the encoding of the appended data is {}; save them as raw or base64",
                                    bernal::quoted(encoding)));
    is_appended_base64_ = encoding == "base64";
  }

  void remarks_of(const pugi::xml_node& node) {
    for (const pugi::xml_node child : node.children())
      if (child.type() == pugi::node_comment) points_.remarks += std::string(child.value()) + ";";
  }

  void take_piece(const pugi::xml_node& piece) {
    const std::uint64_t rows = whole(piece, "NumberOfPoints", {}, most_rows);
    for (const char* faces : {"NumberOfPolys", "NumberOfStrips"})
      if (const std::uint64_t count = whole(piece, faces, 0, most_rows); count > 0)
        fail_at(piece, faces_error(count));
    if (rows == 0) return;
    if (const pugi::xml_node cells = piece.child("Cells")) {
      const pugi::xml_node types = cells.find_child_by_attribute("DataArray", "Name", "types");
      const std::uint64_t count = whole(piece, "NumberOfCells", 0, most_rows);
      if (types && count > 0) {
        const std::vector<double> kinds = values_of(types, count, 1);
        const auto solids = std::ranges::count_if(kinds, is_face);
        if (solids > 0) fail_at(types, faces_error(static_cast<std::uint64_t>(solids)));
      }
    }
    const pugi::xml_node places = piece.child("Points").child("DataArray");
    if (!places) fail_at(piece, "there are no Points in this piece; save the file again with ParaView");
    if (whole(places, "NumberOfComponents", 3, most_components) != 3)
      fail_at(places, "Points need three components; write z = 0 in the plane");
    const std::vector<double> own = values_of(places, rows, 3);
    const std::uint64_t before = points_.size();
    points_.places.insert(points_.places.end(), own.begin(), own.end());
    for (const pugi::xml_node array : piece.child("PointData").children("DataArray"))
      take_array(array, rows, before);
    for (const VtkArray& array : points_.arrays)
      if (array.values.size() != points_.size() * array.components)
        fail_at(piece,
                fmt::format("this piece has no array {}, and others have", bernal::quoted(array.name)));
  }

  void take_array(const pugi::xml_node& node, std::uint64_t rows, std::uint64_t before) {
    if (std::string_view(node.attribute("type").value()) == "String") return;
    const std::string name = node.attribute("Name").as_string("unnamed");
    const std::uint64_t components = whole(node, "NumberOfComponents", 1, most_components);
    auto found = std::ranges::find_if(points_.arrays, [&](const VtkArray& array) {
      return array.name == name && array.components == components;
    });
    if (found == points_.arrays.end()) {
      if (before > 0)
        fail_at(node,
                fmt::format("the array {} is in this piece and in none before it", bernal::quoted(name)));
      found = points_.arrays.insert(found, {name, components});
    }
    if (found->values.size() != before * components)
      fail_at(node,
              fmt::format("there are two arrays {}; leave one of them in the file", bernal::quoted(name)));
    const std::vector<double> own = values_of(node, rows, components);
    found->values.insert(found->values.end(), own.begin(), own.end());
  }

  std::vector<double> values_of(const pugi::xml_node& node, std::uint64_t rows,
                                std::uint64_t components) const {
    const std::uint64_t count = rows * components;
    const std::string_view format = node.attribute("format").as_string("ascii");
    if (format == "ascii") return numbers_in_text(node, count);
    const std::string_view type = node.attribute("type").value();
    const std::optional<RawNumber> number = xml_number(type, is_swapped_);
    if (!number) fail_at(node, type_error(type));
    std::string_view source = node.child_value();
    bool is_base64 = true;
    if (format == "appended") {
      const std::uint64_t offset = whole(node, "offset", {}, text_.size());
      if (offset >= appended_.size()) refuse_cut(node);
      source = appended_.substr(offset);
      is_base64 = is_appended_base64_;
    } else if (format != "binary") {
      fail_at(node,
              fmt::format("format is {}; ascii, binary and appended are known", bernal::quoted(format)));
    }
    const std::uint64_t expected = count * static_cast<std::uint64_t>(number->bytes);
    const Encoded encoded{source, is_base64};
    const std::string bytes =
        is_compressed_ ? inflated(node, encoded, expected) : plain_bytes(node, encoded, expected);
    std::vector<double> values;
    append_raw_numbers(bytes, *number, values);
    return values;
  }

  std::vector<double> numbers_in_text(const pugi::xml_node& node, std::uint64_t count) const {
    std::vector<std::string_view> words;
    split_at(node.child_value(), vtk_blanks, words);
    if (words.size() != count)
      fail_at(node, fmt::format("{} numbers, but {} are expected of so many points; was the file changed?",
                                words.size(), count));
    std::vector<double> values;
    values.reserve(count);
    for (const std::string_view word : words) {
      const std::optional<double> value = number_in_text(word);
      if (!value) fail_at(node, fmt::format("{} is not a number", bernal::quoted(word)));
      values.push_back(*value);
    }
    return values;
  }

  /// Bytes as encoded in the file.
  struct Encoded {
    std::string_view text;
    bool is_base64;
    std::string first(std::uint64_t most) const {
      return is_base64 ? bytes_of_base64(text, most) : std::string(text.substr(0, most));
    }
  };

  /// The leading counts of the data.
  std::vector<std::uint64_t> counts(const pugi::xml_node& node, const Encoded& from,
                                    std::uint64_t many) const {
    const std::string bytes = from.first(many * header_bytes());
    if (bytes.size() != many * header_bytes()) refuse_cut(node);
    std::vector<std::uint64_t> all(many);
    for (std::size_t k = 0; k < many; ++k) {
      std::string own = bytes.substr(k * header_bytes(), header_bytes());
      if (is_swapped_) std::ranges::reverse(own);
      std::memcpy(&all[k], own.data(), own.size());
    }
    return all;
  }

  /// A count of bytes, then the bytes.
  std::string plain_bytes(const pugi::xml_node& node, const Encoded& from, std::uint64_t expected) const {
    const std::uint64_t said = counts(node, from, 1)[0];
    if (said != expected) refuse_length(node, said, expected);
    if (said > text_.size()) refuse_cut(node);
    std::string bytes = from.first(header_bytes() + said).substr(header_bytes());
    if (bytes.size() != said) refuse_cut(node);
    return bytes;
  }

  /// The number of blocks, the sizes of a block and of the last one, the compressed sizes, then the blocks.
  std::string inflated(const pugi::xml_node& node, const Encoded& from, std::uint64_t expected) const {
    const std::vector<std::uint64_t> lead = counts(node, from, 3);
    const std::uint64_t blocks = lead[0], in_block = lead[1], in_last = lead[2];
    if (blocks > text_.size() || in_block > expected || in_last > in_block || (blocks > 0 && in_block == 0) ||
        expected > most_inflated * text_.size())
      refuse_cut(node);
    const std::uint64_t said =
        blocks == 0 ? 0 : (blocks - 1) * in_block + (in_last == 0 ? in_block : in_last);
    if (said != expected) refuse_length(node, said, expected);
    const std::vector<std::uint64_t> sizes = counts(node, from, 3 + blocks);
    std::uint64_t compressed = 0;
    for (std::uint64_t k = 3; k < sizes.size(); ++k) {
      if (sizes[k] > text_.size() - compressed) refuse_cut(node);
      compressed += sizes[k];
    }
    const std::uint64_t begin = (3 + blocks) * header_bytes();
    const std::string bytes = from.first(begin + compressed);
    if (bytes.size() != begin + compressed) refuse_cut(node);
    std::string all(expected, '\0');
    std::uint64_t at = begin, to = 0;
    for (std::uint64_t k = 0; k < blocks; ++k) {
      const std::uint64_t wanted = std::min(in_block, expected - to);
      uLongf made = wanted;
      const int result = uncompress(reinterpret_cast<Bytef*>(all.data() + to), &made,
                                    reinterpret_cast<const Bytef*>(bytes.data() + at), sizes[3 + k]);
      if (result != Z_OK || made != wanted)
        fail_at(node, "the data cannot be uncompressed; was the file changed?");
      at += sizes[3 + k];
      to += wanted;
    }
    return all;
  }

  std::uint64_t header_bytes() const { return static_cast<std::uint64_t>(header_.bytes); }

  std::uint64_t whole(const pugi::xml_node& node, const char* name, std::optional<std::uint64_t> otherwise,
                      std::uint64_t most) const {
    const std::string_view word = stripped(node.attribute(name).value(), vtk_blanks);
    if (word.empty() && otherwise) return *otherwise;
    const std::optional<std::uint64_t> value = whole_number(word);
    if (!value || *value > most)
      fail_at(node,
              fmt::format("{} is {}, which is no number from 0 to {}", name, bernal::quoted(word), most));
    return *value;
  }

  int line_at(std::ptrdiff_t offset) const {
    const auto end = std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(text_.size()));
    return 1 + static_cast<int>(std::count(text_.begin(), text_.begin() + end, '\n'));
  }
  [[noreturn]] void fail_at(const pugi::xml_node& node, const std::string& why) const {
    throw Error(ErrorCode::bad_packing, why, {file_, node ? line_at(node.offset_debug()) : 0});
  }
  [[noreturn]] void refuse_cut(const pugi::xml_node& node) const {
    fail_at(node, "the data of this array are cut off or damaged; copy or save the file again");
  }
  [[noreturn]] void refuse_length(const pugi::xml_node& node, std::uint64_t said,
                                  std::uint64_t expected) const {
    fail_at(node, fmt::format(
                      "this array says that it has {} bytes, and so many points need {}; save the file again",
                      said, expected));
  }

  std::string_view text_, appended_;
  std::string file_;
  pugi::xml_document document_;
  VtkPoints points_;
  RawNumber header_;
  bool is_swapped_ = false, is_compressed_ = false, is_appended_base64_ = false;
};

}  // namespace

VtkPoints read_vtk_xml(std::string_view text, const std::filesystem::path& file) {
  return XmlReader(text, file).read();
}

}  // namespace bernal
