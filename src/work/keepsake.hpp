#pragma once
#include <vector>

#include "work/work.hpp"

namespace bernal {

/// The spheres as they stand before a stage, so that a stage which is cut short takes nothing away from what
/// the ones before it left. Cost: a copy of the spheres.
class Keepsake {
 public:
  explicit Keepsake(const Work& work);

  /// Puts everything back if less of the domain is filled now.
  void give_back_if_denser(Work& work) const;

 private:
  struct Ball {
    Vector<3> center;
    double r;
    std::uint32_t tag;
  };

  double packing_fraction_ = 0;
  std::vector<Ball> bed_;
  // in a box, where all have places
  Spheres<dynamic> spheres_;
  Vector<dynamic> edges_;
  double needed_volume_ = 0;
};

}  // namespace bernal
