#pragma once
#include <string>

namespace bernal::cad {

/// A function of the module of OpenCASCADE, which is loaded by whom asks for it, mostly a child process:
/// OpenCASCADE is seventy libraries, a quarter of a second. nullptr where there is no module, or no
/// OpenCASCADE on this machine.
void* opencascade_function(const char* name);

/// What to do where there is none: "install it and build again".
std::string opencascade_remedy();

}  // namespace bernal::cad
