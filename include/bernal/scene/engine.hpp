#pragma once
#include <string>
#include <variant>
#include <vector>

namespace bernal {

/// How the processes of an engine are started.
enum class EngineLauncher {
  mpirun,  ///< as a child of this process, which waits for it
  slurm,   ///< by a script that the user submits; the run that comes after it reads the result
};

/// What any engine is told: how it is started and for how long it works.
struct EngineProcess {
  int ranks = 1;  ///< processes that share the spheres; a single one is started without a launcher
  EngineLauncher launcher = EngineLauncher::mpirun;
  std::vector<std::string> command = {};     ///< starts the ranks; else mpirun, in a Slurm script srun
  std::vector<std::string> executable = {};  ///< the engine, and options of its own; else Debian's name of it
  std::vector<std::string> slurm = {};       ///< lines "#SBATCH …" of the script, such as "--time=02:00:00"
  int steps = 1000;                          ///< of its motion, in all
  bool keep = false;  ///< what it read and wrote stays beside the result, and is taken up again
  /// Across the longest axis of a periodic box, one after the other in memory while its spheres are freed of
  /// overlap and certified; 1: all of them at once.
  int slabs = 1;
};

/// LAMMPS, with the package GRANULAR: periodic boxes, boxes, cylinders and spheres.
struct Lammps {
  EngineProcess process = {};
};

/// LIGGGHTS: parts of CAD, boxes, cylinders along an axis and periodic boxes.
struct Liggghts {
  EngineProcess process = {};
  /// The spheres are poured: they fall from above the bed, rub and bounce, until all are at rest.
  bool pour = false;
  double friction = 0.3;     ///< Coulomb's, between spheres and with walls; where they are poured
  double restitution = 0.5;  ///< speed after an impact over that before, of spheres of mean size
};

}  // namespace bernal
