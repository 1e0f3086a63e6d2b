#pragma once
#include <string>

namespace bernal::cad {

/// A function of the OpenCASCADE module, which is loaded on the first call (seventy libraries, a quarter of a
/// second), usually in a child process. nullptr if the module or OpenCASCADE is not installed.
void* opencascade_function(const char* name);

/// The remedy if it is missing: "install it and build again".
std::string opencascade_remedy();

}  // namespace bernal::cad
