#pragma once
#include <cstdio>

#include "bernal/scene/packing.hpp"

/// A line for each layer that the scene names, and for each material; nothing where it names none.
void print_layers(std::FILE* where, const bernal::Packing& packing);
