#pragma once
#include "bernal/scene/packing.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

/// `certify` of a packing and of what lies inside its spheres, to any depth, without ever making it: each
/// packing inside once, in its ball; that every ball is at most as large as the innermost layer of each
/// sphere that it lies in, in their units, as exact real numbers; that each filled sphere is there, is of its
/// class and holds one of the packings, turned by a unit quaternion, to 1e-12. A rotation changes no
/// distance, and the outermost spheres do not overlap: so no two spheres of all levels do, which is what the
/// statement says. Where overlap is allowed it is allowed on its own level.
///
/// Gaps and allowed overlap are those of each level's scene. Throws as `certify` and `layers_of`. Cost: that
/// of `certify` for each packing, and O(1) for each filled sphere.
Certificate certify_levels(const Packing&, const CertifyOptions& options = {});

/// The same, once the spheres of the packing are certified, and those inside: `of_insides` in the order of
/// `Packing::inside` and its templates.
Certificate with_levels(Certificate of_spheres, const Packing&,
                        const std::vector<std::vector<Certificate>>& of_insides);

}  // namespace bernal
