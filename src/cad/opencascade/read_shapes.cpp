#include <fmt/format.h>
#include <fmt/ranges.h>

#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <ShapeFix_Shape.hxx>
#include <Standard_Failure.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <fstream>

#include "cad/diagnose/counted.hpp"
#include "cad/opencascade/loose_edges.hpp"
#include "cad/opencascade/read_shapes.hpp"
#include "cad/opencascade/sewing.hpp"
#include "cad/opencascade/tessellate.hpp"
#include "core/lower_case.hpp"

namespace bernal::cad {

namespace {

constexpr double default_deflection = 1e-3;   // of the diagonal
constexpr double smallest_deflection = 1e-5;  // of the diagonal; the mesher takes minutes at this
constexpr double fine_edges = 1e-8;           // of the diagonal: what is left between edges and their chords

struct NamedShape {
  TopoDS_Shape shape;
  std::string name;
};

/// The solids of a file, and the faces outside solids.
struct Parts {
  std::vector<NamedShape> solids;
  std::vector<TopoDS_Shape> faces;
  FileFacts facts;
  std::vector<std::string> missing = {};  ///< named files that do not exist
};

std::string name_of(const TDF_Label& label) {
  opencascade::handle<TDataStd_Name> name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  const TCollection_ExtendedString& text = name->Get();
  std::string utf8(static_cast<std::size_t>(text.LengthOfCString()) + 1, '\0');
  Standard_PCharacter begin = utf8.data();
  utf8.resize(static_cast<std::size_t>(text.ToUTF8CString(begin)));
  return utf8;
}

void split(const TopoDS_Shape& shape, const std::string& name, Parts& parts) {
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
    parts.solids.push_back({solid.Current(), name});
  for (TopExp_Explorer face(shape, TopAbs_FACE, TopAbs_SOLID); face.More(); face.Next())
    parts.faces.push_back(face.Current());
}

/// A part placed by its assemblies, with the name of its product.
void collect(const TDF_Label& label, const TopLoc_Location& placement, Parts& parts) {
  TDF_Label product = label;
  TopLoc_Location location = placement;
  if (XCAFDoc_ShapeTool::IsReference(label)) {
    XCAFDoc_ShapeTool::GetReferredShape(label, product);
    location = placement * XCAFDoc_ShapeTool::GetLocation(label);
  }
  if (XCAFDoc_ShapeTool::IsAssembly(product)) {
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(product, components);
    for (const TDF_Label& component : components) collect(component, location, parts);
    return;
  }
  split(XCAFDoc_ShapeTool::GetShape(product).Moved(location), name_of(product), parts);
}

void collect(const opencascade::handle<TDocStd_Document>& document, Parts& parts) {
  TDF_LabelSequence roots;
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(roots);
  for (const TDF_Label& root : roots) collect(root, {}, parts);
}

opencascade::handle<TDocStd_Document> new_document() {
  opencascade::handle<TDocStd_Document> document = new TDocStd_Document("BinXCAF");
  XCAFDoc_DocumentTool::Set(document->Main(), false);
  return document;
}

struct KnownUnit {
  std::string_view step, iges;
  FileFacts::Length length;
};

const std::vector<KnownUnit>& known_units() {
  static const std::vector<KnownUnit> all = {
      {"millimetre", "mm", {1e-3, "millimetre"}}, {"metre", "m", {1, "metre"}},
      {"inch", "in", {0.0254, "inch"}},           {"inch", "inch", {0.0254, "inch"}},
      {"foot", "ft", {0.3048, "foot"}},           {"centimetre", "cm", {1e-2, "centimetre"}},
      {"micrometre", "um", {1e-6, "micrometre"}}, {"kilometre", "km", {1e3, "kilometre"}},
      {"mile", "mi", {1609.344, "mile"}},         {"mil", "mil", {2.54e-5, "thousandth of an inch"}},
      {"", "uin", {2.54e-8, "microinch"}},
  };
  return all;
}

/// Notes the file's unit: OpenCASCADE converts it to millimetres.
void note_units(const std::vector<std::string>& names, FileFacts& facts) {
  facts.unit = FileFacts::Length{1e-3, "millimetre"};
  std::vector<std::string> phrases;
  for (std::string name : names) {
    name = in_lower_case(name);
    for (const KnownUnit& known : known_units())
      if (name == known.step || name == known.iges) {
        name = known.length.name;
        facts.written_in = known.length;
      }
    if (!name.empty() && std::find(phrases.begin(), phrases.end(), name) == phrases.end())
      phrases.push_back(name);
  }
  if (phrases.size() != 1) facts.written_in.reset();
  if (phrases.empty()) {
    facts.unit.reset();
    facts.notes.push_back("the file names no unit of length; OpenCASCADE takes millimetre");
  } else if (phrases.size() > 1 || phrases.front() != "millimetre") {
    facts.notes.push_back(
        fmt::format("the file is in {}; OpenCASCADE converts to millimetre", fmt::join(phrases, " and ")));
  } else {
    facts.written_in.reset();
  }
}

/// Why a file cannot be parsed as STEP, which begins with the name of the standard and ends with END- and
/// that name.
std::string unparsed_step(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const std::string_view name = "ISO-10303-21;";
  const std::size_t begin = text.find(name);
  if (begin == std::string::npos || begin >= 100)
    return "it does not begin as STEP does, with ISO-10303-21; export it again";
  if (text.find("END-ISO-10303-21") == std::string::npos)
    return "it ends before END-ISO-10303-21: it has been cut off; copy or export it again";
  if (begin > 0)
    return fmt::format(
        "OpenCASCADE cannot parse it: {} bytes stand in front of ISO-10303-21, a byte order mark "
        "perhaps; save it without them",
        begin);
  return "OpenCASCADE cannot parse it as STEP; export it again, or as STL";
}

std::string read_step(const std::filesystem::path& file, Parts& parts) {
  STEPCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(false);
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  reader.SetSHUOMode(false);
  reader.SetGDTMode(false);
  reader.SetMatMode(false);
  reader.SetViewMode(false);
  // It finds files that this one names only if the path is absolute.
  if (reader.ReadFile(std::filesystem::absolute(file).c_str()) != IFSelect_RetDone)
    return unparsed_step(file);
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  std::vector<std::string> names;
  for (const TCollection_AsciiString& name : lengths) names.emplace_back(name.ToCString());
  note_units(names, parts.facts);
  auto document = new_document();
  const bool any = reader.Transfer(document);
  using Files = NCollection_DataMap<TCollection_AsciiString, opencascade::handle<STEPCAFControl_ExternFile>>;
  for (Files::Iterator other(reader.ExternFiles()); other.More(); other.Next())
    if (other.Value()->GetLoadStatus() != IFSelect_RetDone)
      parts.missing.emplace_back(other.Key().ToCString());
  std::ranges::sort(parts.missing);
  if (!any && parts.missing.empty()) return "OpenCASCADE finds no shape in the STEP file";
  collect(document, parts);
  return {};
}

std::string read_iges(const std::filesystem::path& file, Parts& parts) {
  IGESCAFControl_Reader reader;
  reader.SetNameMode(true);
  reader.SetColorMode(false);
  reader.SetLayerMode(false);
  reader.SetReadVisible(true);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone)
    return "OpenCASCADE cannot parse it as IGES; export it again, or as STEP";
  const auto unit = reader.IGESModel()->GlobalSection().UnitName();
  note_units({unit.IsNull() ? "" : unit->ToCString()}, parts.facts);
  auto document = new_document();
  if (!reader.Transfer(document)) return "OpenCASCADE finds no shape in the IGES file";
  collect(document, parts);
  return {};
}

std::string read_brep(const std::filesystem::path& file, Parts& parts) {
  TopoDS_Shape shape;
  if (!BRepTools::Read(shape, file.c_str(), BRep_Builder()) || shape.IsNull())
    return "OpenCASCADE cannot parse it as BREP; export it again, or as STEP";
  BRepTools::Clean(shape);  // triangles of another deflection
  split(shape, {}, parts);
  return {};
}

TopoDS_Compound together(const Parts& parts) {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const NamedShape& solid : parts.solids) builder.Add(all, solid.shape);
  for (const TopoDS_Shape& face : parts.faces) builder.Add(all, face);
  return all;
}

/// The first few names.
std::string list_of(const std::vector<std::string>& files) {
  constexpr std::size_t most = 6;
  const auto end = files.begin() + std::ptrdiff_t(std::min(files.size(), most));
  return fmt::format("{}{}", fmt::join(files.begin(), end, ", "),
                     files.size() > most ? fmt::format(" and {} more", files.size() - most) : "");
}

/// Counted from 1; 0 if there is none.
std::size_t face_without_surface(const TopoDS_Shape& shape) {
  std::size_t number = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    ++number;
    if (BRep_Tool::Surface(TopoDS::Face(face.Current())).IsNull()) return number;
  }
  return 0;
}

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::AddClose(shape, box);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

void sew_faces(Parts& parts, double diagonal) {
  if (parts.faces.empty()) return;
  const Sewn sewn = sew(parts.faces, diagonal);
  if (sewn.shells.empty()) return;
  parts.facts.notes.push_back(
      fmt::format("{} surfaces that belong to no solid were sewn{} with a tolerance of {:.2g}{}; {}",
                  parts.faces.size(), sewn.parts > 1 ? fmt::format(" into {} parts", sewn.parts) : "",
                  sewn.tolerance, parts.facts.unit ? " mm" : "",
                  sewn.free_edges == 0 ? "no edge is left open"
                                       : fmt::format("{} edges are left open", sewn.free_edges)));
  for (const TopoDS_Shape& shell : sewn.shells) parts.solids.push_back({shell, {}});
}

void heal(Parts& parts) {
  std::size_t healed = 0;
  for (NamedShape& solid : parts.solids) {
    if (BRepCheck_Analyzer(solid.shape).IsValid()) continue;
    ShapeFix_Shape fix(solid.shape);
    if (!fix.Perform() || fix.Shape().IsNull()) continue;
    solid.shape = fix.Shape();
    ++healed;
  }
  if (healed > 0)
    parts.facts.notes.push_back(
        fmt::format("{} of {} solids were healed by OpenCASCADE", healed, parts.solids.size()));
}

void tessellate(const Parts& parts, double deflection, double diagonal, bool true_surface,
                ReadAttempt& result) {
  std::size_t untriangulated = 0, without_area = 0;
  SurfaceDeviation deviation;
  for (const NamedShape& solid : parts.solids) {
    const std::size_t first = result.soup.polygons.size();
    const Tessellated made =
        append_tessellation(solid.shape, deflection, result.soup, true_surface ? &result.surface : nullptr,
                            fine_edges * diagonal);
    if (result.soup.polygons.size() > first) result.soup.solids.push_back({solid.name, first});
    deviation.outside = std::max(deviation.outside, made.deviation.outside);
    deviation.inside = std::max(deviation.inside, made.deviation.inside);
    untriangulated += made.untriangulated;
    without_area += made.without_area;
  }
  result.facts.deflection = deflection;
  result.facts.deviation = deviation;
  const std::string_view unit = result.facts.unit ? " mm" : "";
  result.facts.notes.push_back(
      fmt::format("tessellated with a deflection of {:.3g}{}: the surface of the file lies up to {:.3g}{} "
                  "outside and {:.3g}{} "
                  "inside of the triangles, measured at 15 points of each{}",
                  deflection, unit, deviation.outside, unit, deviation.inside, unit,
                  std::max(deviation.outside, deviation.inside) > deflection * (1 + 1e-9)
                      ? ", farther than the deflection"
                      : ""));
  if (untriangulated > 0)
    result.facts.notes.push_back(
        fmt::format("{} faces could not be triangulated and are missing", untriangulated));
  if (without_area > 0)
    result.facts.notes.push_back(fmt::format("{} faces without area were dropped", without_area));
}

ReadAttempt read(const std::filesystem::path& file, ShapeFormat format, double deflection,
                 const std::optional<SpheresInside>& inside) {
  ReadAttempt result;
  Parts parts;
  result.failure = format == ShapeFormat::step   ? read_step(file, parts)
                   : format == ShapeFormat::iges ? read_iges(file, parts)
                                                 : read_brep(file, parts);
  if (!result.ok()) return result;

  if (const std::size_t number = face_without_surface(together(parts)); number > 0) {
    result.failure = fmt::format("face {} has no surface; export the part again", number);
    return result;
  }
  const double diagonal = diagonal_of(together(parts));
  if (parts.solids.empty() && parts.faces.empty()) {
    result.failure =
        parts.missing.empty()
            ? "holds no solids and no surfaces; export the solid, not curves, sketches or a drawing"
            : fmt::format(
                  "its parts stand in other files, which cannot be read beside it: {}; put them there, or "
                  "export all into one file",
                  list_of(parts.missing));
    return result;
  }
  if (!parts.missing.empty())
    parts.facts.notes.push_back(fmt::format(
        "the file names parts in other files, which cannot be read beside it, and goes without: {}",
        list_of(parts.missing)));
  if (!(diagonal > 0) || !std::isfinite(diagonal)) {
    result.failure = "its surfaces have no extent";
    return result;
  }
  if (!(deflection > 0)) deflection = default_deflection * diagonal;
  if (inside) deflection = std::max(deflection, smallest_deflection * diagonal);
  if (deflection < smallest_deflection * diagonal) {
    const std::string_view unit = parts.facts.unit ? " mm" : "";
    result.failure = fmt::format(
        "a deflection of {:.3g}{} is less than a hundred-thousandth of the part, which is {:.3g}{} across; "
        "choose at least {:.3g}{} (deflection in [container]; a fiftieth of the smallest radius if absent)",
        deflection, unit, diagonal, unit, rounded_up(smallest_deflection * diagonal), unit);
    return result;
  }
  sew_faces(parts, diagonal);
  // Before anything is healed or meshed, which both fail in their own words where tolerances are large.
  if (inside)
    result.failure =
        known_too_loosely(together(parts), inside->smallest_radius, parts.facts.unit ? " mm" : "");
  if (!result.ok()) {
    result.failed_option = "true_surface";
    return result;
  }
  heal(parts);
  result.facts = std::move(parts.facts);
  tessellate(parts, deflection, diagonal, inside.has_value(), result);
  if (!std::all_of(result.soup.points.begin(), result.soup.points.end(),
                   [](const Vector<3>& p) { return p.allFinite(); }))
    result.failure = "a coordinate is not finite";
  return result;
}

}  // namespace
}  // namespace bernal::cad

void bernal_read_shapes(const std::filesystem::path& file, bernal::cad::ShapeFormat format, double deflection,
                        const std::optional<bernal::cad::SpheresInside>& inside,
                        bernal::cad::ReadAttempt& result) {
  try {
    result = bernal::cad::read(file, format, deflection, inside);
  } catch (const Standard_Failure& failure) {
    const std::string_view phrases = failure.GetMessageString();
    result.failure = fmt::format("OpenCASCADE gives up: {}", phrases.empty() ? "no reason given" : phrases);
  }
}
