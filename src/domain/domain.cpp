#include "bernal/domain/domain.hpp"

namespace bernal {

std::string_view kind_of(const Domain& domain) {
  const Shape* shape = std::get_if<Shape>(&domain);
  return shape ? kind_of(*shape) : "periodic";
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
