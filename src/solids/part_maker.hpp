#pragma once
#include <string>
#include <vector>

#include "solids/convex_part.hpp"

namespace bernal {

/// Puts a convex part together from the planes of its faces and its corners.
class PartMaker {
 public:
  explicit PartMaker(std::vector<HalfSpace> planes);

  /// In which at least three planes meet, to within a tolerance.
  void add_corner(const Vector<3>& point, std::vector<std::uint32_t> planes);
  /// Throws Error{bad_argument} where corners and planes make no closed surface.
  ConvexPart made(double tolerance) &&;

 private:
  static ConvexPart::Face face_in(const HalfSpace&);
  static void put_where_planes_meet(const ConvexPart&, ConvexPart::Corner&, double tolerance);
  static void sort_around(const ConvexPart&, ConvexPart::Face&);

  std::vector<HalfSpace> planes_;
  std::vector<ConvexPart::Corner> corners_;
};

[[noreturn]] void refuse_part(const std::string& why);
std::string place_in_part(const Vector<3>&);

}  // namespace bernal
