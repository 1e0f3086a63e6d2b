#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "bernal/core/monitor.hpp"

namespace bernal {

/// A figure, a table or all of a published paper, which can be computed again: Farr, Powder Technology 245,
/// 28 (2013); Zhao, Li & Liu, Chinese Journal of Computational Physics (2007); Han, Feng & Owen, Powder
/// Technology 155, 33 (2005).
struct Figure {
  std::string_view name;  ///< "fig1", …, "table2", "zhao2007"
  std::string_view what;  ///< one line
  std::string_view time;  ///< that it takes on two cores: "20 s"
  bool packs;             ///< has more packings to show with FigureOptions::pack
  bool sized;             ///< heeds FigureOptions::spheres
};
std::span<const Figure> all_figures();

struct FigureOptions {
  /// Also packs some of the sizes in three dimensions, where `Figure::packs`; in zhao2007 all of them with
  /// the published loop and 10,000 spheres.
  bool pack = false;
  /// Where `Figure::sized`, packings have at most so many spheres, at least 100: quick, and rough. 0: as many
  /// as are published or take the time that `Figure` states.
  int spheres = 0;
  std::uint64_t seed = 1;
  Monitor monitor = {};
};

/// Computes a figure and writes NAME.svg and NAME.csv (table1: the CSV alone; fig4: those of table2; fig2soft
/// a page NAME.md too, packs by LAMMPS and throws EngineError without), or for a paper NAME.md, a page that
/// puts printed and own values side by side, and the CSV and SVG files that it names, into `folder`, all or
/// none. Returns the files; none where the monitor stopped it. Nothing in them depends on the number of
/// threads but times. Throws Error{bad_argument} for another name or number of spheres, Error{cannot_write}.
std::vector<std::filesystem::path> write_figure(std::string_view name, const std::filesystem::path& folder,
                                                const FigureOptions& options = {});

/// A map of the packing fraction of all mixtures of two lognormal populations of these widths.
struct MapOptions {
  double sigma_a = 0, sigma_b = 0;
  double least_ratio = 1, most_ratio = 10;  ///< of the volume-weighted mean diameters, b over a
  int points = 1000;                        ///< along each axis, at least 2
  int rods = 2000;
  Monitor monitor = {};
};

struct WrittenMap {
  std::vector<std::filesystem::path> files;  ///< none where the monitor stopped it
  double phi = 0, ratio = 0, share = 0;      ///< the densest mixture of all
  double error = 0;                          ///< the largest Prediction::error
};

/// Writes map.csv, a line `ratio,share,phi` a point, and map.svg, contours over the share of b in the volume
/// and the ratio of sizes, into `folder`, both or none. Cost: 0.1 ms a point on one core with 2,000 rods, of
/// wide distributions; all cores are used. Throws Error{bad_argument}, Error{cannot_write}.
WrittenMap write_map(const MapOptions& options, const std::filesystem::path& folder);

}  // namespace bernal
