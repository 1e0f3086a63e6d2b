#pragma once
#include <memory>

#include <pybind11/pybind11.h>

#include "bernal/scene/packing.hpp"

namespace bernal::python {

/// What Python holds of a packing: nobody changes it, so that its columns can be lent out.
using PackingPointer = std::shared_ptr<Packing>;

// The parts of the extension: each adds its own to the module.
void bind_scene(pybind11::module_&);
void bind_packing(pybind11::module_&);
void bind_work(pybind11::module_&);
void bind_design(pybind11::module_&);

}  // namespace bernal::python
