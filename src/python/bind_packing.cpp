// A packing: its columns as arrays without copies, its domain, how its run went, pictures, pickles.
#include <memory>
#include <string>
#include <string_view>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bernal/cells/write_cells.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/report/picture.hpp"
#include "bernal/report/section.hpp"
#include "bernal/scene/nest.hpp"
#include "bernal/scene/packing_bytes.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "bernal/viewer/view_page.hpp"
#include "python/bindings.hpp"
#include "python/lock.hpp"

namespace py = pybind11;

namespace bernal::python {
namespace {

/// A read-only array over the memory of `column`, which keeps `owner` alive.
py::array view_of(const std::vector<double>& column, const py::object& owner) {
  py::array_t<double> view(static_cast<py::ssize_t>(column.size()), column.data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

py::tuple columns_of(const py::object& self) {
  const auto& packing = self.cast<const Packing&>();
  py::list views;
  for (const auto& column : packing.spheres.x) views.append(view_of(column, self));
  views.append(view_of(packing.spheres.r, self));
  return py::tuple(views);
}

/// The class of each sphere, and name, material and density of each class.
py::tuple classes_of_packing(const Packing& packing) {
  py::list all;
  if (!packing.classes.empty())
    for (const SphereClass& of : classes_of(packing.scene))
      all.append(py::make_tuple(of.name, of.material, of.material_density));
  return py::make_tuple(
      py::array_t<std::uint32_t>(static_cast<py::ssize_t>(packing.classes.size()), packing.classes.data()),
      all);
}

template <class T>
py::array_t<T> copy_of(const std::vector<T>& column) {
  return py::array_t<T>(static_cast<py::ssize_t>(column.size()), column.data());
}

/// Of each layer of each class the spheres that have it, and where it begins and ends in them.
py::list layers_of_packing(const Packing& packing) {
  SphereLayers layers;
  {
    const Unlocked others_run;
    layers = layers_of(packing);
  }
  py::list all;
  if (layers.of_class.empty()) return all;
  const std::vector<SphereClass> classes = classes_of(packing.scene);
  for (std::size_t c = 0; c < layers.of_class.size(); ++c) {
    std::vector<std::uint32_t> spheres;
    for (std::uint32_t i = 0; i < packing.spheres.size(); ++i)
      if (c == (packing.classes.empty() ? 0 : packing.classes[i])) spheres.push_back(i);
    for (std::size_t k = 0; k < layers.of_class[c].size(); ++k) {
      const Layer& layer = layers.of_class[c][k];
      std::vector<double> inner, outer;
      for (const std::uint32_t i : spheres) {
        inner.push_back(k == 0 ? 0 : layers.of(i)[k - 1]);
        outer.push_back(layers.of(i)[k]);
      }
      all.append(py::dict(py::arg("class") = classes[c].name, py::arg("name") = layer.name,
                          py::arg("material") = material_of(layer),
                          py::arg("material_density") = layer.material_density,
                          py::arg("spheres") = copy_of(spheres), py::arg("inner") = copy_of(inner),
                          py::arg("outer") = copy_of(outer)));
    }
  }
  return all;
}

/// What lies inside the spheres of each class that is filled.
py::list insides_of_packing(const Packing& packing) {
  const std::vector<SphereClass> classes = classes_of(packing.scene);
  const std::vector<std::vector<Layer>> layers = layers_by_class(packing.scene);
  py::list all;
  for (const PackingsInside& inside : packing.inside) {
    const bool has_layers = inside.of_class < layers.size() && !layers[inside.of_class].empty();
    py::list templates;
    for (const auto& made : inside.templates)
      templates.append(std::const_pointer_cast<Packing>(made));  // which Python cannot change
    py::array_t<double> rotations(
        std::vector<py::ssize_t>{static_cast<py::ssize_t>(inside.rotations.size()), 4});
    double* q = rotations.mutable_data();
    for (const auto& rotation : inside.rotations) q = std::copy(rotation.begin(), rotation.end(), q);
    all.append(py::dict(
        py::arg("class") = inside.of_class < classes.size() ? classes[inside.of_class].name : "spheres",
        py::arg("layer") = has_layers ? layers[inside.of_class][inside.layer].name : std::string(),
        py::arg("templates") = templates, py::arg("spheres") = copy_of(inside.spheres),
        py::arg("which") = copy_of(inside.which), py::arg("rotations") = rotations));
  }
  return all;
}

py::list levels_of_packing(const Packing& packing) {
  py::list all;
  for (const NestLevel& level : levels_of(packing))
    all.append(py::dict(py::arg("name") = level.name, py::arg("depth") = level.depth,
                        py::arg("packings") = level.packings, py::arg("packed") = level.packed,
                        py::arg("filled") = level.filled, py::arg("spheres") = level.spheres,
                        py::arg("ball") = level.ball, py::arg("unit") = name_of(level.unit),
                        py::arg("packing_fraction") = level.packing_fraction,
                        py::arg("share") = level.share));
  return all;
}

py::list history_of(const Packing& packing) {
  py::list all;
  for (const Milestone& m : packing.history)
    all.append(py::dict(py::arg("stage") = m.stage, py::arg("spheres") = m.spheres,
                        py::arg("packing_fraction") = m.packing_fraction, py::arg("potential") = m.potential,
                        py::arg("max_overlap") = m.max_overlap, py::arg("seconds") = m.seconds));
  return all;
}

py::list effects_of(const Packing& packing) {
  py::list all;
  for (const Effect& e : packing.effects)
    all.append(
        py::dict(py::arg("name") = e.name, py::arg("calls") = e.calls, py::arg("seconds") = e.seconds));
  return all;
}

py::tuple bounds_of_domain(const Packing& packing) {
  const Bounds<dynamic> bounds = bounds_of<dynamic>(packing.domain);
  return py::make_tuple(std::vector<double>(bounds.lower.begin(), bounds.lower.end()),
                        std::vector<double>(bounds.upper.begin(), bounds.upper.end()));
}

/// Copies of vertices and triangles; None where the domain is no mesh.
py::object walls_of(const Packing& packing) {
  const auto* mesh = std::get_if<Mesh>(&packing.domain);
  if (!mesh) return py::none();
  const auto rows = [](std::size_t n) { return std::vector<py::ssize_t>{static_cast<py::ssize_t>(n), 3}; };
  py::array_t<double> vertices(rows(mesh->vertices.size()));
  py::array_t<std::uint32_t> triangles(rows(mesh->triangles.size()));
  double* x = vertices.mutable_data();
  for (const Vector<3>& v : mesh->vertices) x = std::copy(v.begin(), v.end(), x);
  std::uint32_t* t = triangles.mutable_data();
  for (const auto& triangle : mesh->triangles) t = std::copy(triangle.begin(), triangle.end(), t);
  return py::make_tuple(vertices, triangles);
}

std::vector<double> coordination_of(const Packing& packing, const std::vector<double>& gaps) {
  std::vector<double> all;
  for (const Contacts& contacts :
       measure_contacts_across(packing.scene.gap, packing.scene.wall_gap, packing.spheres, packing.domain,
                               gaps, packing.container))
    all.push_back(contacts.coordination);
  return all;
}

/// An array with a column for each axis.
py::array_t<double> rows_of(const std::vector<std::vector<double>>& columns, std::size_t rows) {
  py::array_t<double> made(
      std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(columns.size())});
  double* x = made.mutable_data();
  for (std::size_t i = 0; i < rows; ++i)
    for (const std::vector<double>& column : columns) *x++ = column[i];
  return made;
}

py::dict contacts_of(const Packing& packing, double contact_gap) {
  ContactList list;
  {
    const Unlocked others_run;
    list = contact_list(packing.spheres, packing.domain,
                        {contact_gap, packing.scene.gap, packing.scene.wall_gap, packing.container});
  }
  py::dict all;
  all["i"] = copy_of(list.i);
  all["j"] = copy_of(list.j);
  all["gap"] = copy_of(list.gap);
  all["normal"] = rows_of(list.normal, list.size());
  all["place"] = rows_of(list.place, list.size());
  return all;
}

/// An array with `columns` numbers a row; value(row, column).
template <class T, class Value>
py::array_t<T> table_of(std::size_t rows, std::size_t columns, const Value& value) {
  py::array_t<T> made(
      std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(columns)});
  T* to = made.mutable_data();
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < columns; ++k) *to++ = static_cast<T>(value(i, k));
  return made;
}

/// A column of the shapes of cells.
template <class T, class Value>
py::array_t<T> column_of(const std::vector<CellShape>& shapes, const Value& value) {
  py::array_t<T> made(static_cast<py::ssize_t>(shapes.size()));
  T* to = made.mutable_data();
  for (const CellShape& shape : shapes) *to++ = static_cast<T>(value(shape));
  return made;
}

py::dict cells_of_packing(const Packing& packing, int flat_sides) {
  ShapedCells made;
  {
    const Unlocked others_run;
    made = shaped_cells_of(packing, {flat_sides});
  }
  const auto& [cells, shapes] = made;
  const auto d = static_cast<std::size_t>(cells.dimension);
  const auto or_none = [](std::uint32_t number) {
    return number == Cells::none ? std::int64_t{-1} : static_cast<std::int64_t>(number);
  };
  const auto axis = [](std::size_t k) { return static_cast<Eigen::Index>(k); };
  py::dict all;
  all["corners"] = table_of<double>(cells.corners.size(), d,
                                    [&](std::size_t i, std::size_t k) { return cells.corners[i][axis(k)]; });
  all["periods"] = table_of<double>(1, d, [&](std::size_t, std::size_t k) {
                     return cells.periods[axis(k)];
                   }).attr("ravel")();
  all["first_corner"] = copy_of(cells.first_corner);
  all["face_corners"] =
      table_of<std::int64_t>(cells.corners_of_faces.size(), 1, [&](std::size_t i, std::size_t) {
        return cells.corners_of_faces[i].corner;
      }).attr("ravel")();
  all["corner_images"] = table_of<std::int64_t>(
      cells.corners_of_faces.size(), d,
      [&](std::size_t i, std::size_t k) { return cells.corners_of_faces[i].image[k]; });
  all["face_cells"] = table_of<std::int64_t>(cells.faces.size(), 2, [&](std::size_t i, std::size_t k) {
    return k == 0 ? or_none(cells.faces[i].cell) : or_none(cells.faces[i].beyond);
  });
  all["face_images"] = table_of<std::int64_t>(
      cells.faces.size(), d, [&](std::size_t i, std::size_t k) { return cells.faces[i].image[k]; });
  all["face_walls"] = table_of<std::int64_t>(cells.faces.size(), 1, [&](std::size_t i, std::size_t) {
                        return or_none(cells.faces[i].wall);
                      }).attr("ravel")();
  all["first_side"] = copy_of(cells.first_side);
  all["cell_faces"] = table_of<std::int64_t>(cells.sides.size(), 1, [&](std::size_t i, std::size_t) {
                        return cells.sides[i].face;
                      }).attr("ravel")();
  all["from_beyond"] = table_of<bool>(cells.sides.size(), 1, [&](std::size_t i, std::size_t) {
                         return cells.sides[i].beyond;
                       }).attr("ravel")();
  all["volumes"] = column_of<double>(shapes, [](const CellShape& shape) { return shape.volume; });
  all["surfaces"] = column_of<double>(shapes, [](const CellShape& shape) { return shape.surface; });
  all["centroids"] = table_of<double>(
      shapes.size(), d, [&](std::size_t i, std::size_t k) { return shapes[i].centroid[axis(k)]; });
  all["sphericity"] = column_of<double>(shapes, [](const CellShape& shape) { return shape.sphericity; });
  all["aspect"] = column_of<double>(shapes, [](const CellShape& shape) { return shape.aspect; });
  all["faces"] = column_of<std::int64_t>(shapes, [](const CellShape& shape) { return shape.faces; });
  all["neighbours"] =
      column_of<std::int64_t>(shapes, [](const CellShape& shape) { return shape.neighbours; });
  return all;
}

std::string section_of_packing(const Packing& packing, const std::optional<std::string>& plane) {
  if (packing.spheres.dimension() != 3)
    throw Error(ErrorCode::bad_argument, "sections are for packings of three dimensions");
  const SectionPlane at = plane ? section_plane(*plane) : middle_plane(packing.domain);
  return section_svg(section_of(packing.spheres, packing.domain, at), packing.spheres,
                     name_of(packing.scene.unit));
}

}  // namespace

void bind_packing(py::module_& module) {
  using OthersRun = py::call_guard<Unlocked>;
  py::class_<Packing, PackingPointer>(module, "Packing")
      .def("columns", &columns_of)
      .def("classes", &classes_of_packing)
      .def("weights",
           [](const Packing& packing) {
             return py::array_t<double>(static_cast<py::ssize_t>(packing.weights.size()),
                                        packing.weights.data());
           })
      .def("layers", &layers_of_packing)
      .def("inside", &insides_of_packing)
      .def("levels", &levels_of_packing)
      .def("history", &history_of)
      .def("effects", &effects_of)
      .def("bounds", &bounds_of_domain)
      .def("walls", &walls_of)
      .def("scene", [](const Packing& packing) { return packing.scene; })
      .def("picture", &picture_of, OthersRun())
      .def("section", &section_of_packing, OthersRun())
      .def("coordination", &coordination_of, OthersRun())
      .def("contacts", &contacts_of)
      .def("cells", &cells_of_packing)
      .def(
          "hash", [](const Packing& packing) { return hash_of(packing.spheres); }, OthersRun())
      .def("domain", [](const Packing& packing) { return name_of(packing.domain); })
      .def(
          "view", [](const Packing& packing) { return view_page(packing); }, OthersRun())
      .def(py::pickle([](const Packing& packing) { return py::bytes(bytes_of(packing)); },
                      [](const py::bytes& bytes) {
                        return std::make_shared<Packing>(packing_of_bytes(std::string_view(bytes)));
                      }))
      .def_property_readonly("dimension", [](const Packing& p) { return p.spheres.dimension(); })
      .def_property_readonly("packing_fraction", &Packing::packing_fraction)
      .def_property_readonly("outcome", [](const Packing& p) { return name_of(p.outcome); })
      .def_readonly("expected_packing_fraction", &Packing::expected_packing_fraction)
      .def_readonly("expected_of_sizes", &Packing::expected_of_sizes)
      .def_readonly("volume", &Packing::volume)
      .def_readonly("size_scale", &Packing::size_scale)
      .def_readonly("reason", &Packing::reason)
      .def_readonly("seed", &Packing::seed)
      .def_readonly("threads", &Packing::threads)
      .def_readonly("seconds", &Packing::seconds)
      .def_property_readonly("program", [](const Packing& p) { return text_of(p.program); });
}

}  // namespace bernal::python
