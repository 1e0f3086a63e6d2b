#include "cad/write_shapes.hpp"

#include <fmt/format.h>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <cmath>

#include "cad/opencascade/mesh_solid.hpp"

namespace bernal::cad {

namespace {

gp_Pnt point_at(const Vector<3>& p) { return {p[0], p[1], p[2]}; }
gp_Dir direction_of(const Vector<3>& v) { return {v[0], v[1], v[2]}; }

struct Failed {
  std::string what;
};

/// The only solid of a result; any other number is an error.
TopoDS_Shape only_solid(const TopoDS_Shape& shape, const char* what) {
  TopExp_Explorer solid(shape, TopAbs_SOLID);
  if (!solid.More())
    throw Failed{fmt::format(
        "OpenCASCADE makes nothing of {}; export triangles, such as STL, or treat contacts otherwise", what)};
  const TopoDS_Shape found = solid.Current();
  solid.Next();
  if (solid.More())
    throw Failed{fmt::format(
        "OpenCASCADE makes several solids of {}; export triangles, such as STL, or treat contacts otherwise",
        what)};
  return found;
}

/// The part on the kept sides of the planes of a shape within `reach` of `center`: by a box for axis-aligned
/// planes, by subtracting a cylinder for others.
TopoDS_Shape cut_by(const TopoDS_Shape& shape, const std::vector<BallShape::Plane>& cuts,
                    const Vector<3>& center, double reach, const char* what) {
  if (cuts.empty()) return shape;
  Vector<3> lower = center - Vector<3>::Constant(2 * reach), upper = center + Vector<3>::Constant(2 * reach);
  bool has_box = false;
  TopoDS_Shape left = shape;
  for (const BallShape::Plane& plane : cuts) {
    const int axis = plane.normal.cwiseAbs().maxCoeff() == 1
                         ? static_cast<int>(std::distance(
                               plane.normal.data(), std::find_if(plane.normal.data(), plane.normal.data() + 3,
                                                                 [](double x) { return std::abs(x) == 1; })))
                         : -1;
    if (axis >= 0) {
      has_box = true;
      (plane.normal[axis] > 0 ? upper : lower)[axis] = plane.normal[axis] * plane.offset;
      continue;
    }
    const double depth = plane.offset - plane.normal.dot(center);
    if (!(depth < reach)) continue;
    const gp_Ax2 axes(point_at(center + depth * plane.normal), direction_of(plane.normal));
    const double radius = 1.5 * std::sqrt(std::max(0.0, reach * reach - depth * depth));
    BRepAlgoAPI_Cut cut(left, BRepPrimAPI_MakeCylinder(axes, radius, 2 * (reach - depth)).Solid());
    left = only_solid(cut.Shape(), what);
  }
  if (!has_box) return left;
  BRepAlgoAPI_Common common(left, BRepPrimAPI_MakeBox(point_at(lower), point_at(upper)).Solid());
  return only_solid(common.Shape(), what);
}

TopoDS_Shape solid_of(const BallShape& ball) {
  const gp_Ax2 axes(point_at(ball.center), direction_of(ball.pole), direction_of(ball.meridian));
  const TopoDS_Shape outer = BRepPrimAPI_MakeSphere(axes, ball.radius).Solid();
  constexpr const char* what = "a sphere and the planes that cut it";
  if (ball.hole == 0) return cut_by(outer, ball.cuts, ball.center, ball.radius, what);
  const TopoDS_Shape inner = BRepPrimAPI_MakeSphere(axes, ball.hole).Solid();
  if (!ball.cuts.empty()) {
    BRepAlgoAPI_Cut cut(cut_by(outer, ball.cuts, ball.center, ball.radius, what), inner);
    return only_solid(cut.Shape(), "a layer of a sphere and the planes that cut it");
  }
  const auto shell_of = [](const TopoDS_Shape& solid) {
    return TopoDS::Shell(TopExp_Explorer(solid, TopAbs_SHELL).Current());
  };
  return BRepBuilderAPI_MakeSolid(shell_of(outer), TopoDS::Shell(shell_of(inner).Reversed())).Solid();
}

TopoDS_Shape solid_of(const NeckShape& neck) {
  const Vector<3> along = (neck.rims[1] - neck.rims[0]).normalized();
  const Vector<3> from = neck.rims[0] - neck.radius * along;
  const double length = (neck.rims[1] - neck.rims[0]).norm() + 2 * neck.radius;
  TopoDS_Shape left =
      BRepPrimAPI_MakeCylinder(gp_Ax2(point_at(from), direction_of(along)), neck.radius, length).Solid();
  for (std::size_t end = 0; end < 2; ++end) {
    const double r = neck.radii[end], rim = std::sqrt(r * r - neck.radius * neck.radius);
    const Vector<3> center = neck.rims[end] + (end == 0 ? -rim : rim) * along;
    const gp_Ax2 axes(point_at(center), direction_of(along.unitOrthogonal()));
    BRepAlgoAPI_Cut cut(left, BRepPrimAPI_MakeSphere(axes, r).Solid());
    left = only_solid(cut.Shape(), "a bridge between two spheres");
  }
  const Vector<3> middle = 0.5 * (neck.rims[0] + neck.rims[1]);
  return cut_by(left, neck.cuts, middle, length, "a bridge and the planes that cut it");
}

struct ContainerShape {
  const SolidShapes& shapes;

  TopoDS_Shape operator()(const Box& box) const {
    const Vector<3> lower = box.corner, size = box.size;
    return BRepPrimAPI_MakeBox(point_at(lower), point_at(lower + size)).Solid();
  }
  TopoDS_Shape operator()(const Cylinder& cylinder) const {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(point_at(cylinder.base), direction_of(cylinder.axis)),
                                    cylinder.radius, cylinder.height)
        .Solid();
  }
  TopoDS_Shape operator()(const Sphere& sphere) const {
    return BRepPrimAPI_MakeSphere(point_at(sphere.center), sphere.radius).Solid();
  }
  TopoDS_Shape operator()(const Mesh& mesh) const {
    if (shapes.faces.empty()) return {};
    const TopoDS_Shape solid = solid_of_mesh(mesh, shapes.faces);
    if (solid.IsNull())
      throw Failed{
          "OpenCASCADE makes no closed surface of the container's triangles; export triangles, such as STL"};
    return solid;
  }
  TopoDS_Shape operator()(const Revolved& revolved) const {
    const gp_Ax2 frame(point_at(revolved.base), direction_of(revolved.axis));
    BRepBuilderAPI_MakePolygon profile;
    for (const Vector<2>& p : revolved.profile)
      profile.Add(
          gp_Pnt(frame.Location().XYZ() + p[0] * frame.XDirection().XYZ() + p[1] * frame.Direction().XYZ()));
    profile.Close();
    BRepBuilderAPI_MakeFace face(profile.Wire(), true);
    if (!face.IsDone()) throw Failed{"OpenCASCADE makes no face of the container's profile"};
    return BRepPrimAPI_MakeRevol(face.Shape(), frame.Axis()).Shape();
  }
  TopoDS_Shape operator()(const Polygon&) const { return {}; }
};

/// Accurate to about 1e-9; with few points a face the sum is far less accurate.
double volume_of_shape(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties, 1e-10);
  return std::abs(properties.Mass());
}

struct Group {
  std::string name;
  TopoDS_Compound compound;
};

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes) {
  TopoDS_Compound all;
  const BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& shape : shapes) builder.Add(all, shape);
  return all;
}

bool write_step(const std::vector<Group>& groups, const std::filesystem::path& file) {
  constexpr double colours[][3] = {{0.27, 0.47, 0.67}, {0.80, 0.40, 0.20}, {0.30, 0.60, 0.35},
                                   {0.65, 0.55, 0.25}, {0.55, 0.35, 0.60}, {0.35, 0.65, 0.65},
                                   {0.75, 0.30, 0.35}, {0.50, 0.50, 0.50}};
  opencascade::handle<TDocStd_Document> document = new TDocStd_Document("BinXCAF");
  XCAFDoc_DocumentTool::Set(document->Main(), false);
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const auto painter = XCAFDoc_DocumentTool::ColorTool(document->Main());
  std::size_t next = 0;
  for (const Group& group : groups) {
    const TDF_Label label = shapes->AddShape(group.compound, false);
    TDataStd_Name::Set(label, TCollection_ExtendedString(group.name.c_str(), true));
    const auto& [red, green, blue] = colours[next++ % std::size(colours)];
    painter->SetColor(label, Quantity_Color(red, green, blue, Quantity_TOC_RGB), XCAFDoc_ColorGen);
  }
  STEPCAFControl_Writer writer;
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);  // parameter curves of surfaces are derived
  return writer.Transfer(document, STEPControl_AsIs) && writer.Write(file.c_str()) == IFSelect_RetDone;
}

WrittenShapes write_solids(const SolidShapes& shapes, SolidFormat format, const std::filesystem::path& file) {
  WrittenShapes result;
  std::vector<std::vector<TopoDS_Shape>> types(shapes.type_names.size());
  for (const BallShape& ball : shapes.balls) types[ball.type - 1].push_back(solid_of(ball));
  std::vector<TopoDS_Shape> necks;
  for (const NeckShape& neck : shapes.necks) necks.push_back(solid_of(neck));
  std::vector<Group> groups;
  for (std::size_t type = 0; type < types.size(); ++type)
    if (!types[type].empty()) groups.push_back({shapes.type_names[type], compound_of(types[type])});
  if (!necks.empty()) groups.push_back({"bridges", compound_of(necks)});
  for (const auto& type : types)
    for (const TopoDS_Shape& solid : type) result.volume += volume_of_shape(solid);
  for (const TopoDS_Shape& solid : necks) result.volume += volume_of_shape(solid);
  result.solids = shapes.balls.size() + shapes.necks.size();
  const TopoDS_Shape container = std::visit(ContainerShape{shapes}, shapes.domain);
  result.has_container = !container.IsNull();
  if (result.has_container) groups.push_back({"container", compound_of({container})});

  bool is_written = false;
  if (format == SolidFormat::step) {
    is_written = write_step(groups, file);
  } else {
    std::vector<TopoDS_Shape> all;
    for (const Group& group : groups) all.push_back(group.compound);
    is_written = BRepTools::Write(compound_of(all), file.c_str());
  }
  if (!is_written) result.failure = "OpenCASCADE cannot write it";
  return result;
}

}  // namespace
}  // namespace bernal::cad

void bernal_write_shapes(const bernal::cad::SolidShapes& shapes, bernal::cad::SolidFormat format,
                         const std::filesystem::path& file, bernal::cad::WrittenShapes& result) {
  try {
    result = bernal::cad::write_solids(shapes, format, file);
  } catch (const bernal::cad::Failed& failed) {
    result.failure = failed.what;
  } catch (const Standard_Failure& failure) {
    const std::string_view phrases = failure.GetMessageString();
    result.failure = fmt::format("OpenCASCADE gives up: {}", phrases.empty() ? "no reason given" : phrases);
  }
}
