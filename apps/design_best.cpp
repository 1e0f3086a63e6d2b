#include "design.hpp"
void add_design_best(CLI::App&, int&) {}
