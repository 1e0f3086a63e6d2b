#pragma once
#include <memory>
#include <string>
#include <string_view>

#include <pybind11/pybind11.h>

#include "bernal/scene/packing.hpp"

namespace bernal::python {

/// A packing as Python holds it. Nobody changes it, so arrays of NumPy can look at its columns.
using PackingPointer = std::shared_ptr<Packing>;

/// A message of the library with its options as keywords: "give unit='mm'" for "give ‹unit=mm›".
std::string in_words_of_python(std::string_view message);

// Each adds its part to the module.
void bind_scene(pybind11::module_&);
void bind_packing(pybind11::module_&);
void bind_work(pybind11::module_&);
void bind_design(pybind11::module_&);

}  // namespace bernal::python
