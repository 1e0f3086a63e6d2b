// Predictions by the rod model, and searches for sizes that pack as asked.
#include <algorithm>
#include <memory>
#include <vector>

#include <pybind11/stl.h>

#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/predict/design.hpp"
#include "bernal/predict/predict.hpp"
#include "python/bindings.hpp"
#include "python/job.hpp"
#include "python/lock.hpp"

namespace py = pybind11;

namespace bernal::python {
namespace {

using JobPointer = std::unique_ptr<Job>;

py::dict as_dict(const Prediction& p) {
  return py::dict(py::arg("phi") = p.phi, py::arg("error") = p.error, py::arg("rods") = p.rods);
}

py::dict as_dict(const Optimum& optimum) {
  py::dict made = as_dict(optimum.prediction);
  made["shares"] = optimum.shares;
  made["starts"] = optimum.starts;
  made["agreeing"] = optimum.agreeing;
  made["spread"] = optimum.spread;
  made["evaluations"] = optimum.evaluations;
  return made;
}

JobPointer predict_job(const Scene& scene, int rods, double gap_factor) {
  if (scene.dimension() != 3) throw Error(ErrorCode::bad_scene, "the rod model is for three dimensions");
  return std::make_unique<Job>([=](const Monitor&) -> Job::Finish {
    const Prediction made = predict_packing_fraction(*radii_of(scene), rods, gap_factor);
    return [=]() -> py::object { return as_dict(made); };
  });
}

/// The sizes of the parts, which are diameters, mixed by volume. Parts without a share are left out.
std::unique_ptr<SizeDistribution> mixed(const std::vector<Scene>& parts, std::span<const double> shares) {
  Mixture mixture{.of = {}, .shares = {}, .basis = Basis::volume};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!(shares[k] > 0)) continue;
    mixture.of.push_back(parts[k].sizes);
    mixture.shares.push_back(shares[k]);
  }
  Scene scene;
  scene.sizes = std::move(mixture);
  scene.sizes_are_diameters = true;
  return radii_of(scene);
}

/// The search is quicker where each part is of one size.
JobPointer maximise_job(const std::vector<Scene>& parts, int rods) {
  return std::make_unique<Job>([=](const Monitor& monitor) -> Job::Finish {
    const SearchOptions options{.rods = rods, .from = {}, .monitor = monitor};
    std::vector<double> radii;
    for (const Scene& part : parts)
      if (const auto* only = std::get_if<Constant>(&part.sizes)) radii.push_back(0.5 * only->value);
    const auto mixture = [&](std::span<const double> shares) { return mixed(parts, shares); };
    const Optimum found = radii.size() == parts.size()
                              ? maximise_packing_fraction(radii, options)
                              : maximise_packing_fraction(mixture, static_cast<int>(parts.size()), options);
    if (found.cancelled) throw Cancelled();
    return [=]() -> py::object { return as_dict(found); };
  });
}

/// `family` returns a scene with the sizes; the thread of the search calls it.
JobPointer target_job(const py::function& family, double from, double to, double target, int rods) {
  const std::shared_ptr<py::function> held(new py::function(family), [](py::function* function) {
    const Locked lock;
    delete function;
  });
  return std::make_unique<Job>([=](const Monitor& monitor) -> Job::Finish {
    const auto member = [&](double parameter) {
      if (monitor.stop()) throw Cancelled();
      const Locked lock;
      return radii_of(called(*held, py::make_tuple(parameter)).cast<Scene>());
    };
    const Match match = match_packing_fraction(member, from, to, target, rods);
    return [=]() -> py::object {
      py::dict made = as_dict(match.prediction);
      made["found"] = match.found;
      made["parameter"] = match.parameter;
      made["reachable"] = py::make_tuple(match.least, match.most);
      return made;
    };
  });
}

JobPointer sizes_job(double min, double max, int count, int rods) {
  return std::make_unique<Job>([=](const Monitor& monitor) -> Job::Finish {
    const DensestSizes found =
        densest_sizes(0.5 * min, 0.5 * max, count, {.rods = rods, .from = {}, .monitor = monitor});
    if (found.optimum.cancelled) throw Cancelled();
    return [=]() -> py::object {
      py::dict made = as_dict(found.optimum);
      made["radii"] = found.radii;
      return made;
    };
  });
}

JobPointer density_job(double min, double max, int bins, int rods) {
  return std::make_unique<Job>([=](const Monitor& monitor) -> Job::Finish {
    const DensestDensity found =
        densest_density(0.5 * min, 0.5 * max, bins, {.rods = rods, .from = {}, .monitor = monitor});
    if (found.optimum.cancelled) throw Cancelled();
    return [=]() -> py::object {
      py::dict made = as_dict(found.optimum);
      made["radii"] = found.radii;
      py::list levels;
      for (const auto& [count, phi] : found.levels) levels.append(py::make_tuple(count, phi));
      made["levels"] = levels;
      made["power_law_phi"] = found.power_law_phi;
      made["power_law_exponent"] = found.power_law_exponent;
      return made;
    };
  });
}

}  // namespace

void bind_design(py::module_& module) {
  module.def("predict", &predict_job);
  module.def("maximise", &maximise_job);
  module.def("target", &target_job);
  module.def("densest_sizes", &sizes_job);
  module.def("densest_density", &density_job);
  module.def("relative_viscosity", &relative_viscosity);
}

}  // namespace bernal::python
