// Functions that take time: each returns a Job whose result is an object of Python.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/formats/export.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/measure/chambers.hpp"
#include "bernal/mesh_files/mesh_packing.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/report/json.hpp"
#include "bernal/result/certify_levels.hpp"
#include "bernal/result/layers_table.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "bernal/verify/certificate.hpp"
#include "python/bindings.hpp"
#include "python/job.hpp"

namespace py = pybind11;

namespace bernal::python {
namespace {

using Path = std::filesystem::path;
using Text = std::optional<std::string>;
using JobPointer = std::unique_ptr<Job>;

JobPointer job(Job::Work work) { return std::make_unique<Job>(std::move(work)); }
Job::Finish text(std::string made) {
  return [made = std::move(made)]() -> py::object { return py::str(made); };
}
Job::Finish packing(Packing made) {
  auto shared = std::make_shared<Packing>(std::move(made));
  return [shared]() -> py::object { return py::cast(shared); };
}

JobPointer explain_job(const Scene& scene) {
  return job([scene](const Monitor& monitor) -> Job::Finish {
    monitor.report({"estimate", -1, {}});
    const Plan plan = build(scene);
    check_start(plan);
    return [json = plan_as_json(plan), words = explain(plan)]() -> py::object {
      return py::make_tuple(json, words);
    };
  });
}

/// During the activity "estimate" there is no packing yet that an interrupt could return.
JobPointer pack_job(Scene scene, std::optional<std::uint64_t> seed, int threads) {
  if (seed && scene.target.mass) scene.seed = *seed;  // of whose radii it is the mass
  return job([=](const Monitor& monitor) {
    monitor.report({"estimate", -1, {}});
    const Plan plan = build(scene);
    if (monitor.stop()) throw Cancelled();
    monitor.report({"prepare", -1, {}});
    return packing(run(plan, {seed, threads, monitor}));
  });
}

/// Of a packing that stands in no folder: that each sphere holds its layers, on all levels.
LayersTable layers_in_memory(const Packing& packing) {
  LayersTable found;
  try {
    found.layers = layers_of(packing).outer.size();
  } catch (const Error& error) {
    found.fault = error.what();
  }
  for (const PackingsInside& inside : packing.inside)
    for (const auto& packed : inside.templates) {
      const LayersTable deeper = layers_in_memory(*packed);
      found.layers += deeper.layers;
      if (found.fault.empty()) found.fault = deeper.fault;
    }
  return found;
}

JobPointer verify_job(const PackingPointer& of, std::optional<std::size_t> list, int threads, bool exact,
                      const std::optional<Path>& folder) {
  return job([=](const Monitor& monitor) {
    const Scene& scene = of->scene;
    Certificate certificate =
        certify_levels(*of, {.allowed_overlap = scene.overlap,
                             .gap = scene.gap,
                             .wall_gap = scene.wall_gap,
                             .arithmetic = exact ? Arithmetic::exact : Arithmetic::filtered,
                             .list = list.value_or(CertifyOptions::all),
                             .threads = threads,
                             .monitor = monitor});
    if (certificate.cancelled) throw Cancelled();
    certificate.statement += certified_walls(scene, of->domain);
    const auto zones = zones_in_place(scene, of->domain, of->spheres, of->classes, {.threads = threads});
    if (zones) add_to(certificate, *zones);
    if (const auto table = folder ? layers_table_of(*of, *folder) : std::nullopt) {
      add_to(certificate, *table);
    } else if (const LayersTable held = layers_in_memory(*of); !held.fault.empty()) {
      refuse(certificate, held.fault);
    } else if (held.layers > 0) {
      certificate.statement +=
          fmt::format(" The {} layers of the scene fit the spheres.", grouped(held.layers));
    }
    return text(certificate_as_json(certificate, zones));
  });
}

template <class T>
py::array_t<T> array_of(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Arrays with one entry for each sphere. A sphere in no chamber has -1.
py::dict per_sphere(const Measurements& measured) {
  py::dict all;
  all["coordination"] = array_of(measured.of_contacts.coordination);
  if (measured.local) {
    all["local_packing_fraction"] = array_of(measured.local->packing_fraction);
    all["cell_volume"] = array_of(measured.local->cell_volume);
    all["neighbours"] = array_of(measured.local->neighbours);
  }
  if (measured.chambers) {
    std::vector<std::int64_t> chambers;
    for (const std::uint32_t chamber : measured.chambers->of_sphere)
      chambers.push_back(chamber == Chambers::none ? -1 : static_cast<std::int64_t>(chamber));
    all["chamber"] = array_of(chambers);
  }
  return all;
}

JobPointer measure_job(const PackingPointer& of, double contact_gap, const Text& slab) {
  return job([=](const Monitor& monitor) -> Job::Finish {
    const SceneRadii radii = asked_radii_of(*of);
    MeasureOptions options;
    options.gap = of->scene.gap;
    options.wall_gap = of->scene.wall_gap;
    options.contact_gap = contact_gap;
    if (slab) options.slab = slab_in(*slab, of->scene.unit);
    options.bed = bed_options_of(of->scene);
    options.container = of->container;
    options.monitor = monitor;
    options.all_or_nothing = true;
    Measurements measured = measure(of->spheres, of->domain, radii.asked, options);
    return [json = measurements_as_json(*of, measured), measured = std::move(measured)]() -> py::object {
      return py::make_tuple(json, per_sphere(measured));
    };
  });
}

JobPointer write_job(const PackingPointer& of, const Path& folder, bool with_mesh, std::size_t list,
                     const std::optional<Path>& imported_from) {
  return job([=](const Monitor& monitor) -> Job::Finish {
    const WriteOptions options{
        .with_mesh = with_mesh, .list = list, .monitor = monitor, .all_or_nothing = true};
    if (!imported_from) check_writable(folder, of->scene, options);
    WrittenPacking written = imported_from ? write_imported(*of, *imported_from, folder, options)
                                           : write_packing(*of, folder, options);
    return [written = std::move(written)]() -> py::object {
      return py::make_tuple(written.files, certificate_as_json(written.certificate), written.notes);
    };
  });
}

JobPointer read_job(const Path& folder) {
  return job([=](const Monitor&) { return packing(read_packing(folder)); });
}

JobPointer export_job(const PackingPointer& of, const std::string& format,
                      const std::map<std::string, std::string>& words, const Path& file) {
  const Output output = output_of(format, words);
  return job([=](const Monitor& monitor) -> Job::Finish {
    WrittenExport written = write_export(*of, output, file, monitor);
    return [written = std::move(written)]() -> py::object {
      return py::make_tuple(written.files, written.note);
    };
  });
}

/// The report as JSON, the files, and what they hold.
JobPointer mesh_job(const PackingPointer& of, const std::string& format,
                    const std::map<std::string, std::string>& words, const Path& file) {
  const MeshFileOptions options = mesh_options_of(format, words);
  return job([=](const Monitor& monitor) -> Job::Finish {
    MeshedPacking meshed = mesh_packing(*of, options, file, monitor);
    return [json = mesh_report_as_json(*of, meshed.report), meshed = std::move(meshed)]() -> py::object {
      return py::make_tuple(json, meshed.files, meshed.note);
    };
  });
}

/// Name and help of each key of meshes.
std::vector<std::pair<std::string, std::string>> keys_of_meshes() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const MeshKey& key : mesh_keys())
    all.emplace_back(key.name, key.words.empty()
                                   ? key.what
                                   : fmt::format("{}: {}", key.what, fmt::join(key.words, ", ")));
  return all;
}

/// The default name of a format's file.
std::string file_of_format(const std::string& name) {
  for (const ExportFormat& format : export_formats())
    if (format.name == name) return format.file;
  throw Error(ErrorCode::bad_argument, "no such format: " + name);
}

/// Inspects the mesh that is the container of the scene.
JobPointer inspect_job(const Scene& scene, std::optional<double> radius, const std::optional<Path>& places) {
  const auto& file = std::get<MeshFile>(scene.container);
  if (radius && !(*radius > 0)) throw Error(ErrorCode::bad_argument, "radius must be a length above 0");
  return job([=](const Monitor& monitor) {
    monitor.report({"diagnose", -1, {}});
    const ImportedMesh imported = read_mesh(file);
    const bool usable = imported.report.usable();
    const std::vector<std::string> lines = lines_that_help(file, {}, imported, Effort::thorough);
    if (places) write_places(imported, *places);
    std::optional<Chambers> chambers;
    if (radius && usable) chambers = chambers_for(imported.mesh, *radius);
    return text(inspection_as_json(file.file, file.unit ? name_of(*file.unit) : std::string_view(),
                                   imported.report, chambers, lines));
  });
}

std::optional<Unit> unit_of(const Text& name) {
  return name ? std::optional<Unit>(unit_named(*name)) : std::nullopt;
}

JobPointer import_job(std::function<ImportedPacking(const Monitor&)> import) {
  return job([import = std::move(import)](const Monitor& monitor) -> Job::Finish {
    ImportedPacking made = import(monitor);
    auto shared = std::make_shared<Packing>(std::move(made.packing));
    return [shared, notes = std::move(made.notes)]() -> py::object {
      py::dict all;
      for (const auto& [about, words] : notes) all[py::str(about)] = in_words_of_python(words);
      return py::make_tuple(shared, all);
    };
  });
}

std::optional<Scene> scene_if(const Scene* scene) {
  return scene ? std::optional<Scene>(*scene) : std::nullopt;
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Centres of shape (N, D) and radii of shape (N,).
JobPointer import_arrays_job(const Numbers& centers, const Numbers& radii, const std::string& unit,
                             const Scene* container, const std::vector<double>& box,
                             const std::string& periodic) {
  Spheres<dynamic> spheres;
  spheres.x.assign(static_cast<std::size_t>(centers.shape(1)), {});
  for (py::ssize_t i = 0; i < centers.shape(0); ++i)
    for (py::ssize_t k = 0; k < centers.shape(1); ++k)
      spheres.x[static_cast<std::size_t>(k)].push_back(centers.at(i, k));
  spheres.r.assign(radii.data(), radii.data() + radii.size());
  const ImportOptions options{
      .unit = unit_named(unit), .box = box, .periodic = periodic, .container = scene_if(container)};
  return import_job([=](const Monitor& monitor) { return import_spheres(spheres, options, monitor); });
}

JobPointer import_file_job(const Path& file, const std::string& format, const std::string& columns,
                           std::optional<double> diameter, std::optional<double> radius,
                           const std::optional<Path>& radii, const Text& unit, const std::vector<double>& box,
                           const std::string& periodic, const Scene* container,
                           const std::vector<double>& shift, std::optional<int> frame,
                           std::optional<int> dimension, const std::string& level) {
  const ImportOptions options{.format = format,
                              .columns = columns,
                              .diameter = diameter,
                              .radius = radius,
                              .radii = radii,
                              .unit = unit_of(unit),
                              .box = box,
                              .periodic = periodic,
                              .container = scene_if(container),
                              .shift = shift,
                              .frame = frame,
                              .level = level,
                              .dimension = dimension};
  return import_job([=](const Monitor& monitor) { return import_packing(file, options, monitor); });
}

}  // namespace

void bind_work(py::module_& module) {
  py::class_<Job>(module, "Job")
      .def("wait", &Job::wait)
      .def("progress", &Job::progress)
      .def("cancel", &Job::cancel)
      .def("result", &Job::result);
  module.def("stop_all_jobs", &stop_all_jobs);
  module.def("is_ending_elsewhere", &is_ending_elsewhere);
  module.def("explain", &explain_job);
  module.def("pack", &pack_job);
  module.def("verify", &verify_job);
  module.def("measure", &measure_job);
  module.def("write", &write_job);
  module.def("read", &read_job);
  module.def("export", &export_job);
  module.def("mesh", &mesh_job);
  module.def("mesh_keys", &keys_of_meshes);
  module.def("file_of_format", &file_of_format);
  module.def("inspect", &inspect_job);
  module.def("import_", &import_file_job);
  module.def("import_arrays", &import_arrays_job);
}

}  // namespace bernal::python
