#pragma once
#include <functional>
#include <vector>

#include "bernal/domain/container.hpp"

namespace bernal {

/// Something near a place: the unit vector away from it, and how far its surface is.
struct Obstacle {
  Vector<3> away;
  double distance;
};

/// Appends everything nearer than `reach` to a place. A place beyond a wall has an obstacle without
/// direction.
using Surroundings = std::function<void(const Vector<3>& place, double reach, std::vector<Obstacle>&)>;

/// The walls as surroundings. The container outlives them.
Surroundings walls_of(const Container& container);

/// A place and how near the nearest obstacle is.
struct Room {
  Vector<3> place = Vector<3>::Zero();
  double radius = 0;
};

/// The room at a place, as far as `reach`.
Room room_at(const Vector<3>& place, double reach, const Surroundings& surroundings);

// In two dimensions places stay in the plane z = 0.

/// From a place uphill to one with the room `enough`, or to the top of the hill: the roomiest place that is
/// near. Steps, at most `step` long on an axis, are those that make the nearest obstacle farthest when each
/// is taken for the plane through its nearest point: a linear programme. Between planes one step finds the
/// top, to rounding; between curved walls some ten do. Cost: the surroundings and some 10 µs a step.
Room climb(Room from, double enough, double step, const Surroundings& surroundings, int dimension = 3);

/// From a place that has at least this room along `direction`, round what is in the way, to where it goes no
/// further, keeping the room; some 100 steps at most. Cost: as `climb`.
Room slide(Room from, double room, const Vector<3>& direction, double step, const Surroundings& surroundings,
           int dimension = 3);

/// The roomiest place that is known in a container, and what no place exceeds.
struct LargestRoom : Room {
  double bound = 0;
};

/// Cells of the bounds, halved as long as one may hold more than what is known; from the best of them uphill.
/// Exact to rounding in boxes, cylinders, spheres and convex meshes; in others the bound says how much may
/// have been missed after `most_cells`. Cost: a clearance a cell, some milliseconds in all.
LargestRoom largest_room(const Container& container, int most_cells = 4000);

}  // namespace bernal
