#include "bernal/domain/domain.hpp"

namespace bernal {

std::string_view kind_of(const Domain& domain) {
  const Shape* shape = std::get_if<Shape>(&domain);
  return shape ? kind_of(*shape) : "periodic";
}

std::string name_of(const Domain& domain) {
  const PeriodicBox* box = std::get_if<PeriodicBox>(&domain);
  if (!box) return std::string(kind_of(domain));
  if (!box->has_walls()) return "periodic box";
  std::string axes;
  int walls = 0;
  for (int k = 0; k < box->dimension(); ++k) {
    if (!box->has_wall(k)) continue;
    axes += (walls++ > 0 ? ", " : "") + std::to_string(k);
  }
  if (walls == box->dimension()) return "box with walls all around";
  return "box periodic but along " + std::string(walls > 1 ? "axes " : "axis ") + axes;
}

int dimension_of(const Domain& domain) {
  const PeriodicBox* box = std::get_if<PeriodicBox>(&domain);
  return box ? box->dimension() : 3;
}

double volume_of(const Domain& domain) {
  const PeriodicBox* box = std::get_if<PeriodicBox>(&domain);
  return box ? box->edges.prod() : volume_of(std::get<Shape>(domain));
}

Vector<dynamic> extent_of(const Domain& domain) {
  if (const PeriodicBox* box = std::get_if<PeriodicBox>(&domain)) return box->edges;
  return bounds_of(std::get<Shape>(domain)).size();
}

}  // namespace bernal
