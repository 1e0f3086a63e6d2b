#include <fcntl.h>
#include <minizip/zip.h>
#include <unistd.h>

#include <charconv>
#include <numeric>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "files/output_file.hpp"
#include "formats/surface_file.hpp"
#include "formats/templates.hpp"
#include "viewer/palette.hpp"

namespace bernal {
namespace {

/// 3MF's names of units. Source: 3D Manufacturing Format, Core Specification 1.3, section 3.4.
std::string_view unit_in_3mf(const Exported& file) {
  switch (file.unit()) {
    case Unit::um:
      return "micron";
    case Unit::mm:
      return "millimeter";
    case Unit::cm:
      return "centimeter";
    case Unit::in:
      return "inch";
    case Unit::ft:
      return "foot";
    case Unit::m:
      return "meter";
    case Unit::nm:
      break;
  }
  throw Error(ErrorCode::bad_argument, "3MF has no nanometres; give another unit, um or mm",
              file.output.locations.whole);
}

/// An archive written front to back, with every write checked.
class ZipWriter {
 public:
  explicit ZipWriter(std::filesystem::path path)
      : path_(std::move(path)), zip_(zipOpen64(path_.c_str(), APPEND_STATUS_CREATE)) {
    if (!zip_) fail();
  }
  ~ZipWriter() {
    if (zip_) zipClose(zip_, nullptr);
  }
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  void begin(const char* name) {
    zip_fileinfo info{};
    info.tmz_date = {0, 0, 0, 1, 0, 1980};  // a fixed time, for the same bytes
    constexpr int quick = 1, large = 1;
    check(
        zipOpenNewFileInZip64(zip_, name, &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, quick, large));
  }
  void add(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() > (1U << 18U)) flush();
  }
  void end() {
    flush();
    check(zipCloseFileInZip(zip_));
  }
  void close() {
    zipFile zip = zip_;
    zip_ = nullptr;
    check(zipClose(zip, nullptr));
    const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);  // as in OutputFile::close
    const bool on_disk = descriptor >= 0 && ::fsync(descriptor) == 0;
    if (descriptor >= 0) ::close(descriptor);
    if (!on_disk) fail();
  }

 private:
  void flush() {
    throw_if_interrupted();
    check(zipWriteInFileInZip(zip_, buffer_.data(), static_cast<unsigned>(buffer_.size())));
    buffer_.clear();
  }
  void check(int code) const {
    if (code != ZIP_OK) fail();
  }
  [[noreturn]] void fail() const {
    throw Error(ErrorCode::cannot_write, "the archive cannot be written; is the disk full?",
                {as_it_will_be(path_).string()});
  }

  std::filesystem::path path_;
  zipFile zip_;
  std::string buffer_;
};

void add_number(std::string& text, float value) {
  char digits[24];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// An object: the container, or spheres of one type.
struct Object {
  std::string name;
  Colour colour;
  bool container = false;
  std::vector<std::uint32_t> spheres;
};

std::vector<Object> objects_of(const Exported& file, const Surfaces& surfaces) {
  const bool one_boundary = file.output.surface == SurfaceChoice::pores;
  std::vector<Object> all;
  if (!surfaces.container().triangles.empty())
    all.push_back({one_boundary ? "pores" : "container", {0.62, 0.70, 0.80}, true, {}});
  if (!surfaces.has_spheres()) return all;
  if (one_boundary && !all.empty()) {
    all[0].spheres.resize(file.size());
    std::iota(all[0].spheres.begin(), all[0].spheres.end(), 0U);
    return all;
  }
  for (std::uint32_t type = 1; type <= file.type_count; ++type) {
    Object object{file.type_count == 1 ? "spheres" : fmt::format("spheres of type {}", type),
                  size_colour((type - 0.5) / file.type_count),
                  false,
                  {}};
    for (std::uint32_t i = 0; i < file.size(); ++i)
      if (file.types[i] == type) object.spheres.push_back(i);
    if (!object.spheres.empty()) all.push_back(std::move(object));
  }
  return all;
}

void write_object(ZipWriter& zip, std::size_t number, const Object& object, const Surfaces& surfaces) {
  zip.add(
      fmt::format("<object id=\"{}\" type=\"model\" pid=\"1\" pindex=\"{}\" name=\"{}\"><mesh><vertices>\n",
                  number + 2, number, object.name));
  std::string text;
  const auto own = [&](const SurfacePart& part) { return part.sphere ? true : object.container; };
  surfaces.visit(object.spheres, [&](const SurfacePart& part) {
    if (!own(part)) return;
    text.clear();
    for (const FloatPoint& p : part.vertices) {
      text += "<vertex x=\"";
      add_number(text, p[0]);
      text += "\" y=\"";
      add_number(text, p[1]);
      text += "\" z=\"";
      add_number(text, p[2]);
      text += "\"/>\n";
    }
    zip.add(text);
  });
  zip.add("</vertices><triangles>\n");
  const auto base = object.container ? 0U : static_cast<std::uint32_t>(surfaces.container().vertices.size());
  surfaces.visit(object.spheres, [&](const SurfacePart& part) {
    if (!own(part)) return;
    text.clear();
    for (const auto& [a, b, c] : part.triangles)
      fmt::format_to(std::back_inserter(text), "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", a - base,
                     b - base, c - base);
    zip.add(text);
  });
  zip.add("</triangles></mesh></object>\n");
}

std::string write_3mf_file(const Exported& file, StagedFolder& staged) {
  const std::string_view unit = unit_in_3mf(file);
  const Surfaces surfaces = surfaces_of(file);
  const std::vector<Object> objects = objects_of(file, surfaces);
  ZipWriter zip(staged.add(file.output.file.string()));
  for (const auto& [name, text] :
       {std::pair{"[Content_Types].xml", threemf_content_types_xml}, {"_rels/.rels", threemf_rels_xml}}) {
    zip.begin(name);
    zip.add(text);
    zip.end();
  }
  zip.begin("3D/3dmodel.model");
  zip.add(
      fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{}\" xml:lang=\"en-US\" "
                  "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<metadata "
                  "name=\"Title\">{}</metadata>\n"
                  "<resources>\n<basematerials id=\"1\">",
                  unit, file.title()));
  for (const Object& object : objects)
    zip.add(fmt::format("<base name=\"{}\" displaycolor=\"{}\"/>", object.name, object.colour.text()));
  zip.add("</basematerials>\n");
  for (std::size_t n = 0; n < objects.size(); ++n) write_object(zip, n, objects[n], surfaces);
  zip.add("</resources>\n<build>\n");
  for (std::size_t n = 0; n < objects.size(); ++n) zip.add(fmt::format("<item objectid=\"{}\"/>\n", n + 2));
  zip.add("</build>\n</model>\n");
  zip.end();
  zip.close();
  return surfaces.note();
}

}  // namespace

Format threemf_format() {
  Format made = surface_format("3mf", "triangles for printers, an object a type of spheres", "spheres.3mf",
                               write_3mf_file, {"types"});
  made.unit = Unit::mm;
  return made;
}

}  // namespace bernal
