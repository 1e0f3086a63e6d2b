#pragma once

// All of bernal: state a problem, pack it, certify, measure and write it.
//
//   Scene scene;
//   scene.container = Cylinder{.radius = 5, .height = 20};
//   scene.sizes = Lognormal{.median = 0.5, .sigma = 0.2};
//   const Packing packing = run(build(scene));

#include "bernal/cells/write_cells.hpp"
#include "bernal/fly/fly.hpp"
#include "bernal/formats/export.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/hard/grow.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/mesh_files/mesh_packing.hpp"
#include "bernal/predict/design.hpp"
#include "bernal/predict/predict.hpp"
#include "bernal/result/certify_levels.hpp"
#include "bernal/result/layers_table.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/layer_amounts.hpp"
#include "bernal/scene/nest.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/slabs/pack_in_slabs.hpp"
#include "bernal/soft/relax.hpp"
#include "bernal/soft/settle.hpp"
#include "bernal/verify/certificate.hpp"
#include "bernal/version.hpp"
#include "bernal/voxels/voxels.hpp"
