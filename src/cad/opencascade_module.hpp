#pragma once

namespace bernal::cad {

/// A function of the module of OpenCASCADE, which is loaded by whom asks for it, mostly a child process:
/// OpenCASCADE is seventy libraries, a quarter of a second. nullptr where there is no module, or no
/// OpenCASCADE on this machine.
void* opencascade_function(const char* name);

}  // namespace bernal::cad
