#include "bernal/measure/cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include <oneapi/tbb/global_control.h>
#include <nlohmann/json.hpp>

#include "bernal/cells/write_cells.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/local_packing.hpp"
#include "cells/placed_cells.hpp"
#include "cells/voxel_labels.hpp"
#include "domain/revolved_surface.hpp"
#include "support/folder.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace cells_test {

using namespace testing;

/// Points at random with radii that differ, in the bounds of a domain; those outside of it have cells, too.
Spheres<dynamic> points_in(const Domain& domain, std::size_t n, double spread, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  const int dimension = dimension_of(domain);
  const Bounds<dynamic> bounds = bounds_of<dynamic>(domain);
  const double radius = 0.3 * std::pow(volume_of(domain) / static_cast<double>(n), 1.0 / dimension);
  Spheres<dynamic> spheres(dimension);
  for (std::size_t i = 0; i < n; ++i) {
    Vector<dynamic> center(dimension);
    for (int k = 0; k < dimension; ++k) center[k] = random.uniform(bounds.lower[k], bounds.upper[k]);
    spheres.push_back(center, radius * random.uniform(1 - spread, 1 + spread));
  }
  return spheres;
}

Box box_of(const Vector<dynamic>& size, const std::vector<bool>& periodic) {
  Box box;
  box.corner = Vector<dynamic>::Constant(size.size(), 0.25);
  box.size = size;
  box.periodic = periodic;
  return box;
}

struct Case {
  const char* name;
  Domain domain;
  std::int64_t euler;  ///< of the whole
};

std::vector<Case> flat_cases() {
  Mesh wedge = surface_of(Revolved{.profile = {{0, 0}, {1, 0}, {0.5, 1}, {0, 1}}}, 7);
  return {{"periodic", box_of(Vector<3>(1, 2, 1.5), {true, true, true}), 0},
          {"walls along one axis", box_of(Vector<3>(1, 2, 1.5), {true, false, true}), 0},
          {"walls along two axes", box_of(Vector<3>(1, 2, 1.5), {false, true, false}), 0},
          {"box", box_of(Vector<3>(1, 2, 1.5), {}), 1},
          {"mesh", wedge, 1},
          {"plane, periodic", box_of(Vector<2>(1, 2), {true, true}), 0},
          {"plane, box", box_of(Vector<2>(1, 2), {}), 1},
          {"polygon", Polygon{{{{0, 0}, {1, 0}, {1.5, 1}, {0.5, 1.5}, {-0.5, 0.7}}}}, 1}};
}

std::vector<Case> round_cases() {
  return {{"cylinder", Cylinder{.base = {1, 2, 3}, .axis = {1, 1, 2}, .radius = 0.5, .height = 2}, 1},
          {"periodic cylinder", Cylinder{.radius = 0.7, .height = 2, .periodic = true}, 0},
          {"sphere", Sphere{{1, 1, 1}, 2}, 1},
          {"cone", Revolved{.profile = {{0, 0}, {1, 0}, {0.5, 1}, {0, 1}}}, 1}};
}

/// The same place from every cell: what a corner of a face is in the cell of its other side.
void expect_complex(const Cells& cells, const char* name) {
  std::vector<int> seen(cells.faces.size(), 0);
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    std::map<std::pair<std::vector<int>, std::vector<int>>, int> edges;
    const auto key = [&](const Cells::Corner& corner, const Cells::Image& image) {
      std::vector<int> made{static_cast<int>(corner.corner)};
      for (std::size_t k = 0; k < 3; ++k) made.push_back(corner.image[k] + image[k]);
      return made;
    };
    for (const Cells::Side& side : cells.sides_of(i)) {
      ++seen[side.face];
      const Cells::Face& face = cells.faces[side.face];
      EXPECT_EQ(side.beyond ? face.beyond : face.cell, i) << name;
      const auto loop = cells.corners_of(side.face);
      ASSERT_GE(loop.size(), static_cast<std::size_t>(cells.dimension)) << name;
      if (cells.dimension == 2) continue;
      for (std::size_t k = 0; k < loop.size(); ++k) {
        auto from = key(loop[k], cells.image_of(side)),
             to = key(loop[(k + 1) % loop.size()], cells.image_of(side));
        if (side.beyond) std::swap(from, to);
        ++edges[{from, to}];
      }
    }
    for (const auto& [edge, times] : edges) {
      EXPECT_EQ(times, 1) << name;
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << name << ": an edge of one face only";
    }
  }
  for (std::size_t f = 0; f < cells.faces.size(); ++f)
    EXPECT_EQ(seen[f], cells.faces[f].wall == Cells::none ? 2 : 1) << name;
}

/// All corners of a cell are as near to its sphere, by power, as to any other.
void expect_power_diagram(const Cells& cells, const char* name) {
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    for (const Cells::Side& side : cells.sides_of(i))
      for (const Cells::Corner& corner : cells.corners_of(side.face)) {
        const Vector<3> p = cells.place(corner, cells.image_of(side));
        const double own = (p - cells.centers[i]).squaredNorm() - cells.radii[i] * cells.radii[i];
        for (std::size_t j = 0; j < cells.size(); ++j) {
          Vector<3> d = p - cells.centers[j];
          for (int k = 0; k < 3; ++k)
            if (cells.periods[k] > 0) d[k] -= cells.periods[k] * std::nearbyint(d[k] / cells.periods[k]);
          ASSERT_GE(d.squaredNorm() - cells.radii[j] * cells.radii[j], own - 1e-11) << name << " " << i;
        }
      }
}

TEST(Cells, AreThoseOfLocalPackingBetweenFlatWalls) {
  for (const auto& [name, domain, euler] : flat_cases())
    for (const std::size_t n : {std::size_t{1}, std::size_t{2}, std::size_t{9}, std::size_t{300}}) {
      const Spheres<dynamic> spheres = points_in(domain, n, 0.5, n);
      const Cells cells = cells_of(spheres, domain);
      const std::vector<CellShape> shapes = shapes_of(cells);
      const LocalPacking local = local_packing(spheres, domain).value();
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_NEAR(shapes[i].volume, local.cell_volume[i], 1e-10 * cells.volume) << name << " " << i;
      const CellStatistics found = statistics_of(cells, shapes);
      EXPECT_LT(found.volume_error, 1e-9) << name << " " << n;
      EXPECT_EQ(found.euler, euler) << name << " " << n;
      EXPECT_EQ(found.not_euler, 0u) << name << " " << n;
      EXPECT_EQ(found.cells + found.empty, n);
      EXPECT_LT(cells.merged, 1e-9 * std::cbrt(cells.volume)) << name << " " << n;
      expect_complex(cells, name);
      if (n < 100) expect_power_diagram(cells, name);
    }
}

TEST(Cells, FillRoundWallsThatAreMadeFlat) {
  for (const auto& [name, domain, euler] : round_cases())
    for (const int sides : {16, 256}) {
      const Spheres<dynamic> spheres = points_in(domain, 200, 0.3, 7);
      const Cells cells = cells_of(spheres, domain, {sides});
      const std::vector<CellShape> shapes = shapes_of(cells);
      const CellStatistics found = statistics_of(cells, shapes);
      EXPECT_LT(found.volume_error, 1e-9) << name;
      EXPECT_EQ(found.euler, euler) << name;
      EXPECT_EQ(found.not_euler, 0u) << name;
      EXPECT_GT(cells.deviation, 0) << name;
      EXPECT_LT(cells.deviation, 12.0 / (sides * sides))
          << name;  // that of a ball is twice pi^2 / 2 and a little more
      expect_complex(cells, name);
      const LocalPacking local = local_packing(spheres, domain).value();
      for (std::size_t i = 0; i < spheres.size(); ++i)
        if (shapes[i].faces > 0 && shapes[i].neighbours == shapes[i].faces)
          EXPECT_NEAR(shapes[i].volume, local.cell_volume[i], 1e-10) << name;
    }
}

TEST(Cells, OfLatticesStayTogether) {
  struct Lattice {
    const char* name;
    Packing (*make)(int);
    std::uint32_t faces, corners, edges;
    double sphericity;
  };
  const double pi = std::numbers::pi;
  const Lattice lattices[] = {
      {"simple cubic", [](int n) { return Packing(simple_cubic(n)); }, 6, 8, 12, std::cbrt(pi / 6)},
      {"body centred", [](int n) { return Packing(body_centred(n)); }, 14, 24, 36, 0.909918},
      {"face centred", [](int n) { return Packing(face_centred(n)); }, 12, 14, 24,
       std::cbrt(pi * std::sqrt(2.0)) / std::cbrt(6.0)}};
  for (const auto& [name, make, faces, corners, edges, sphericity] : lattices)
    for (const int n : {1, 2, 3, 5}) {
      const Packing packing = make(n);
      const Cells cells = cells_of(packing);
      for (const CellShape& shape : shapes_of(cells)) {
        EXPECT_EQ(shape.faces, faces) << name << " " << n;
        EXPECT_EQ(shape.corners, corners) << name << " " << n;
        EXPECT_EQ(shape.edges, edges) << name << " " << n;
        EXPECT_NEAR(shape.sphericity, sphericity, 1e-6) << name;
        EXPECT_NEAR(shape.aspect, 1, 1e-9) << name;
        EXPECT_NEAR(shape.volume, packing.volume / static_cast<double>(cells.size()), 1e-10) << name;
      }
      expect_complex(cells, name);
    }
}

TEST(Cells, HaveTheAspectOfTheirVolumeHoweverTheyAreCut) {
  Spheres<dynamic> one(3);
  one.push_back(Vector<3>(1, 1, 1), 0.5);
  const CellShape of_box = shape_of(cells_of(one, Box{Vector<3>::Zero(), Vector<3>(2, 4, 8)}), 0);
  EXPECT_NEAR(of_box.aspect, 4, 1e-12);
  for (const int sides : {8, 32, 256}) {
    EXPECT_NEAR(shape_of(cells_of(one, Sphere{Vector<3>(1, 1, 1), 1}, {sides}), 0).aspect, 1,
                8.0 / (sides * sides))
        << sides;
  }
}

TEST(Cells, OfRandomPointsHaveThePublishedMeans) {
  // Okabe, Boots, Sugihara & Chiu, Spatial Tessellations, 2nd ed., table 5.5.1: faces of a Poisson-Voronoi
  // cell 2 + 48 pi^2 / 35 = 15.5355, its edges 40.6065, edges of a face 144 pi^2 / (24 pi^2 + 35) = 5.2276.
  const Domain domain = periodic_box(Vector<dynamic>(Vector<3>::Ones()));
  const Cells cells = cells_of(points_in(domain, 4000, 0, 3), domain);
  const CellStatistics found = statistics_of(cells, shapes_of(cells));
  EXPECT_NEAR(found.faces_a_cell.mean, 2 + 48 * std::numbers::pi * std::numbers::pi / 35, 0.2);
  EXPECT_NEAR(found.edges_a_face.mean, 5.2276, 0.02);
  EXPECT_NEAR(found.volumes.deviation / found.volumes.mean, std::sqrt(0.17954), 0.02);
  EXPECT_EQ(found.corners * 4, found.edges * 2);  // four edges meet in a corner
  std::uint64_t counted = 0;
  for (std::size_t k = 0; k < found.with_faces.size(); ++k) counted += found.with_faces[k];
  EXPECT_EQ(counted, 4000u);
}

TEST(Cells, DoNotDependOnTheNumberOfThreads) {
  const Domain domain = periodic_box(Vector<dynamic>(Vector<3>::Ones()));
  const Spheres<dynamic> spheres = points_in(domain, 700, 0.5, 5);
  const auto made = [&](std::size_t threads) {
    Cells cells;
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    cells = cells_of(spheres, domain);
    return cells;
  };
  const Cells one = made(1), three = made(3);
  EXPECT_EQ(one.corners_of_faces, three.corners_of_faces);
  ASSERT_EQ(one.corners.size(), three.corners.size());
  for (std::size_t c = 0; c < one.corners.size(); ++c) EXPECT_EQ(one.corners[c], three.corners[c]);
}

TEST(Cells, OfHiddenAndCoincidentSpheresAreEmpty) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<dynamic>(Vector<3>(0.5, 0.5, 0.5)), 0.4);
  spheres.push_back(Vector<dynamic>(Vector<3>(0.5, 0.5, 0.5)), 0.4);
  spheres.push_back(Vector<dynamic>(Vector<3>(0.6, 0.5, 0.5)), 0.05);
  const Cells cells = cells_of(spheres, Box{});
  EXPECT_FALSE(cells.is_empty(0));
  EXPECT_TRUE(cells.is_empty(1));
  EXPECT_TRUE(cells.is_empty(2));
  EXPECT_EQ(cells.sides_of(0).size(), 6u);
  EXPECT_EQ(cells.walls[cells.faces[0].wall].name.size(), 2u);
}

TEST(Cells, RefuseWhatHasNoPolyhedra) {
  const Revolved tube{.profile = {{0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}}};
  const auto message = [](const Domain& domain, const CellsOptions& options = {}) -> std::string {
    try {
      (void)cells_of(points_in(domain, 5, 0, 1), domain, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(tube).find("not convex"), std::string::npos);
  EXPECT_NE(message(box_of(Vector<dynamic>::Ones(4), {})).find("not in 4"), std::string::npos);
  EXPECT_NE(message(Sphere{}, {3}).find("8 to 1024"), std::string::npos);
  EXPECT_NE(message(Polygon{{{{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}}}).find("not convex"),
            std::string::npos);
}

TEST(Cells, PlacedHaveImagesOfWhatTheyShare) {
  const Domain domain = periodic_box(Vector<dynamic>(Vector<3>(1, 1.5, 2)));
  const Cells cells = cells_of(points_in(domain, 20, 0.5, 11), domain);
  const PlacedCells all = placed(cells);
  for (std::size_t n = 0; n < all.nodes.size(); ++n) {
    const auto& [first, image] = all.origin_of_node[n];
    Vector<3> moved = all.nodes[first];
    for (int k = 0; k < 3; ++k) moved[k] += image[static_cast<std::size_t>(k)] * cells.periods[k];
    EXPECT_LT((all.nodes[n] - moved).norm(), 1e-12);
  }
  for (const PlacedCells::Edge& edge : all.edges) {
    const PlacedCells::Edge& first = all.edges[edge.origin.first];
    EXPECT_EQ(first.origin.image, Cells::Image{});
    const std::uint32_t of[] = {edge.from, edge.to};
    const std::uint32_t to[] = {edge.is_backwards ? first.to : first.from,
                                edge.is_backwards ? first.from : first.to};
    for (int end = 0; end < 2; ++end)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(all.nodes[of[end]][k],
                    all.nodes[to[end]][k] + edge.origin.image[static_cast<std::size_t>(k)] * cells.periods[k],
                    1e-12);
  }
  for (const PlacedCells::Face& face : all.faces) {
    EXPECT_EQ(face.nodes.size(), face.edges.size());
    EXPECT_EQ(face.nodes.size(), all.faces[face.origin.first].nodes.size());
  }
}

TEST(Cells, LabelVoxelsByTheLeastPower) {
  std::vector<Case> cases = flat_cases();
  cases.push_back({"tube", Revolved{.profile = {{0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}}}, 0});
  for (const auto& [name, domain, euler] : cases) {
    const Spheres<dynamic> spheres = points_in(domain, 30, 0.5, 13);
    const VoxelGrid grid = voxel_grid_of(domain, 24);
    std::vector<std::uint32_t> labels;
    label_cells(spheres, domain, grid,
                [&](std::string_view bytes) {
                  const auto* first = reinterpret_cast<const std::uint32_t*>(bytes.data());
                  labels.insert(labels.end(), first, first + bytes.size() / sizeof(std::uint32_t));
                },
                {});
    ASSERT_EQ(labels.size(), static_cast<std::size_t>(grid.voxels())) << name;
    const Vector<3> periods = boundary_in_space(domain).edges;
    std::size_t at = 0;
    for (std::int64_t z = 0; z < grid.count[2]; ++z)
      for (std::int64_t y = 0; y < grid.count[1]; ++y)
        for (std::int64_t x = 0; x < grid.count[0]; ++x) {
          const std::uint32_t label = labels[at++];
          if (label == 0xFFFFFFFF) {
            EXPECT_TRUE(has_walls(domain)) << name;
            continue;
          }
          const Vector<3> p(grid.center(0, x), grid.center(1, y),
                            grid.dimension == 2 ? 0 : grid.center(2, z));
          const auto power = [&](std::size_t i) {
            Vector<3> d = p;
            d.head(spheres.dimension()) -= spheres.center(i);
            for (int k = 0; k < 3; ++k)
              if (periods[k] > 0) d[k] -= periods[k] * std::nearbyint(d[k] / periods[k]);
            return d.squaredNorm() - spheres.r[i] * spheres.r[i];
          };
          ASSERT_GE(label, 1u) << name;
          for (std::size_t i = 0; i < spheres.size(); ++i)
            ASSERT_LE(power(label - 1), power(i) + 1e-9) << name;
        }
  }
}

TEST(CellFiles, AreWrittenWholeAndRefuseWhatTheyAreNot) {
  const Folder folder;
  Packing packing = packing_of(scattered(40, 0.8, 1.2, {Vector<3>::Zero(), Vector<3>::Constant(10)}, 1),
                               periodic_box(Vector<dynamic>(Vector<3>::Constant(10))));
  for (const CellFormat& format : cell_formats()) {
    const WrittenCells written =
        write_cells(packing, {.format = format.name}, folder / ("cells" + format.ending));
    for (const std::filesystem::path& file : written.files)
      EXPECT_GT(std::filesystem::file_size(file), 100u) << format.name;
    EXPECT_FALSE(written.note.empty());
  }
  const auto refused = [&](CellFileOptions options, const char* name = "x.vtp") {
    EXPECT_THROW((void)write_cells(packing, options, folder / name), Error) << options.format;
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << options.format;
  };
  refused({.format = "vtk"});
  refused({.format = "vtu", .strut_radius = 1.0});
  refused({.format = "vtu", .resolution = 10});
  refused({.format = "struts"}, "x.txt");
  refused({.format = "struts", .strut_radius = 0.1, .strut_density = 0.1});
  refused({.format = "struts", .strut_density = 1.5});
  refused({.format = "nrrd", .voxel = 0.1, .resolution = 10}, "x.nrrd");
  const Cells cells = cells_of(packing);
  const auto json =
      nlohmann::json::parse(cell_statistics_as_json(packing, cells, statistics_of(cells, shapes_of(cells))));
  EXPECT_EQ(json.at("not_euler"), 0);
  EXPECT_EQ(json.at("cells"), packing.spheres.size());
  EXPECT_NEAR(json.at("volume").get<double>(), 1000, 1e-6);
}

TEST(CellFiles, AreThoseOfCellsThatAreMadeAlready) {
  const Folder folder;
  const Packing packing = packing_of(scattered(40, 0.8, 1.2, {Vector<3>::Zero(), Vector<3>::Constant(10)}, 1),
                                     periodic_box(Vector<dynamic>(Vector<3>::Constant(10))));
  ShapedCells made = shaped_cells_of(packing);
  const auto written = [&](const ShapedCells* cells) {
    write_cells(packing, {.format = "obj"}, folder / "cells.obj", {}, cells);
    return testing::text_of(folder / "cells.obj");
  };
  const std::string own = written(nullptr);
  EXPECT_EQ(written(&made), own);
  for (Vector<3>& corner : made.cells.corners) corner *= 2;  // tells them from others
  EXPECT_NE(written(&made), own);
}

}  // namespace cells_test
}  // namespace bernal
