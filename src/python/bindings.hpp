#pragma once
#include <memory>
#include <string>
#include <string_view>

#include <pybind11/pybind11.h>

#include "bernal/scene/packing.hpp"

namespace bernal::python {

/// What Python holds of a packing: nobody changes it, so that its columns can be lent out.
using PackingPointer = std::shared_ptr<Packing>;

/// What the library says, with its options as keywords: "give ‹unit=mm›" is "give unit='mm'".
std::string in_words_of_python(std::string_view message);

// The parts of the extension: each adds its own to the module.
void bind_scene(pybind11::module_&);
void bind_packing(pybind11::module_&);
void bind_work(pybind11::module_&);
void bind_design(pybind11::module_&);

}  // namespace bernal::python
