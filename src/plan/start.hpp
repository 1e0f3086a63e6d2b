#pragma once
#include <filesystem>

#include "bernal/plan/plan.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Reads what a scene begins from, in its unit; nothing where it names no start. The scene then says itself
/// what was left to the file: the digest, the box, how many there are if nothing else is drawn. Throws
/// Error{bad_packing} for a file that is none, Error{bad_scene} for one that does not go with the scene.
StartSpheres read_start(Scene& scene);

/// The radii of spheres as a distribution: each size with the share that it has there.
std::unique_ptr<SizeDistribution> radii_there(const std::vector<double>& radii);

/// Gives the first of the sequence their places, before the first stage acts on them. Spheres that overlap,
/// or protrude from the container, have places only for a stage that frees them of it: throws
/// Error{bad_packing} for any other, with the worst pair, its lines and the remedy.
void take_start(const Plan& plan, const Frame& frame, SpheresOfRun& spheres, Reporter& report);

/// Lets the scene's engine give the spheres their places, which overlap as soft particles do, for the first
/// stage to free them of that; see `RunOptions::engine_folder`. A container's are as many as a relaxation
/// would begin with there; those that the engine leaves outside are put back at random. Throws as
/// `engine::run_engine`.
void take_engine(const Plan& plan, const std::filesystem::path& folder, SpheresOfRun& spheres,
                 Reporter& report);

}  // namespace bernal
