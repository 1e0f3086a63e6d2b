#include "bernal/report/zones_in_place.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "plan/places_of_zones.hpp"
#include "scene/zones.hpp"

namespace bernal {
namespace {

/// Those of the spheres with these numbers that reach out of a domain.
std::vector<std::uint64_t> outside(const Spheres<dynamic>& all, const std::vector<std::uint64_t>& numbers,
                                   const Domain& domain, const CertifyOptions& options) {
  Spheres<dynamic> own(all.dimension());
  for (const std::uint64_t i : numbers)
    own.push_back(all.center(static_cast<std::size_t>(i)), all.r[static_cast<std::size_t>(i)]);
  CertifyOptions certify_walls = options;
  certify_walls.gap = certify_walls.wall_gap = 0;
  certify_walls.allowed_overlap = 0;
  certify_walls.list = CertifyOptions::all;
  std::vector<std::uint64_t> out;
  for (const auto& [sphere, gap] : certify(own, domain, certify_walls).protrusions)
    out.push_back(numbers[static_cast<std::size_t>(sphere)]);
  std::ranges::sort(out);
  return out;
}

}  // namespace

std::optional<ZonesInPlace> zones_in_place(const Scene& stated, const Domain& whole,
                                           const Spheres<dynamic>& spheres,
                                           std::span<const std::uint32_t> classes,
                                           const CertifyOptions& options) {
  const bool are_layers = lays_zones(stated) && !has_own_domains(stated);
  if (stated.zones.empty() || are_layers || classes.size() != spheres.size()) return {};
  Scene scene = stated;
  for (MeshFile* mesh : scene.meshes()) mesh->sha256.clear();
  scene.start = {};
  // A piece of what lies in no zone takes what the pieces before it leave.
  std::vector<std::vector<std::uint64_t>> left(scene.zones.size() + 1);
  for (std::size_t i = 0; i < classes.size(); ++i)
    left[std::min<std::size_t>(classes[i], scene.zones.size())].push_back(i);
  for (const PlaceOfZone& place : places_of_zones(scene, whole)) {
    std::vector<std::uint64_t>& own = left[place.sphere_class];
    own = outside(spheres, own, place.domain, options);
  }
  ZonesInPlace found;
  for (const auto& own : left) found.misplaced.insert(found.misplaced.end(), own.begin(), own.end());
  std::ranges::sort(found.misplaced);
  return found;
}

void add_to(Certificate& certificate, const ZonesInPlace& zones) {
  const std::size_t n = zones.misplaced.size();
  if (n > 0)
    refuse(certificate, fmt::format("{} sphere{} not in the place of {} zone", grouped(n),
                                    n == 1 ? " is" : "s are", n == 1 ? "its" : "their"));
  else
    certificate.statement += " Every sphere lies in the place of its zone.";
}

}  // namespace bernal
