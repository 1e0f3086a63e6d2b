#include "meshes/conforming_surface.hpp"
