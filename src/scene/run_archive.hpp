#pragma once
#include "bernal/scene/packing.hpp"
#include "core/archive.hpp"

namespace bernal {

// What a run did, as bytes: in checkpoints, and in packings for other processes.

inline void archive(Archive& a, Program& p) { a(p.version, p.commit, p.packings_number); }
inline void archive(Archive& a, Effect& effect) { a(effect.name, effect.calls, effect.seconds); }
inline void archive(Archive& a, Packing::BulkDensity& b) { a(b.asked, b.reached); }
inline void archive(Archive& a, PackedCells::Quantile& q) { a(q.share, q.wanted, q.by_radii, q.reached); }
inline void archive(Archive& a, PackedCells& c) {
  a(c.scale, c.quantiles, c.distance_by_radii, c.distance, c.error, c.mean_sphericity, c.rounds, c.steps);
}
inline void archive(Archive& a, Milestone& m) {
  a(m.stage, m.spheres, m.packing_fraction, m.potential, m.max_overlap, m.seconds);
}

}  // namespace bernal
