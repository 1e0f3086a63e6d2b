#include "verify/repeated_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bernal/core/error.hpp"

namespace bernal::verify {
namespace {

constexpr double most_images = 256;  // along an axis

/// a + b, or an error if that is no double (Knuth's sum).
double exact_sum(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  if ((a - (sum - of_b)) + (b - of_b) != 0 || !std::isfinite(sum))
    throw Error(ErrorCode::bad_mesh,
                "the container's mesh repeats itself with a period that its coordinates plus whole periods "
                "do not have exactly");
  return sum;
}

double exact_product(double count, double period) {
  const double product = count * period;
  return exact_sum(product, std::fma(count, period, -product));
}

struct Extent {
  double lower = Box<3>::infinity, upper = -Box<3>::infinity;
};

Extent extent_of(const Mesh& mesh, int axis) {
  Extent extent;
  for (const Vector<3>& v : mesh.vertices) {
    extent.lower = std::min(extent.lower, v[axis]);
    extent.upper = std::max(extent.upper, v[axis]);
  }
  return extent;
}

/// The images along an axis, by the first and the last: 0 is the mesh as it stands.
struct Images {
  Extent extent;
  double period = 0;  // 0: there is none
  int first = 0, last = 0;
};

using AllImages = std::array<Images, 3>;

AllImages images_of(const Mesh& mesh) {
  AllImages all;
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    all[k].extent = extent_of(mesh, static_cast<int>(k));
    const double extent = all[k].extent.upper - all[k].extent.lower;
    if (mesh.periodic[k]) all[k].period = period_of(mesh, static_cast<int>(k));
    squared += mesh.periodic[k] ? 0.25 * extent * extent : extent * extent;
  }
  const double farthest = std::sqrt(squared) * (1 + 1e-9);
  for (Images& along : all) {
    if (along.period == 0) continue;
    const double end = 0.5 * along.period + farthest;
    const double first = std::floor((-end - along.extent.lower) / along.period),
                 last = std::ceil((end - along.extent.upper) / along.period);
    if (!(last - first <= most_images))
      throw Error(ErrorCode::bad_mesh, "the container's mesh repeats itself with too short a period");
    along.first = static_cast<int>(first);
    along.last = static_cast<int>(last);
  }
  return all;
}

/// In which end of the mesh a triangle lies: axis and side, or nowhere.
struct End {
  int axis = -1;
  bool upper = false;
};

End end_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& t, const AllImages& images) {
  for (int k = 0; k < 3; ++k) {
    const Images& along = images[static_cast<std::size_t>(k)];
    for (const bool upper : {false, true}) {
      const double plane = upper ? along.extent.upper : along.extent.lower;
      if (along.period > 0 &&
          std::ranges::all_of(t, [&](std::uint32_t v) { return mesh.vertices[v][k] == plane; }))
        return {k, upper};
    }
  }
  return {};
}

/// Without the openings between images.
Mesh closed_images(const Mesh& mesh) {
  const AllImages images = images_of(mesh);
  std::vector<End> ends;
  for (const auto& t : mesh.triangles) ends.push_back(end_of(mesh, t, images));
  if (std::ranges::all_of(ends, [](const End& end) { return end.axis >= 0; }))
    throw Error(ErrorCode::bad_mesh, "the container's mesh has no walls");
  Mesh all;
  std::array<int, 3> at{};
  for (at[0] = images[0].first; at[0] <= images[0].last; ++at[0])
    for (at[1] = images[1].first; at[1] <= images[1].last; ++at[1])
      for (at[2] = images[2].first; at[2] <= images[2].last; ++at[2]) {
        const auto first = static_cast<std::uint32_t>(all.vertices.size());
        for (const Vector<3>& v : mesh.vertices) {
          Vector<3> image = v;
          for (std::size_t k = 0; k < 3; ++k)
            if (at[k] != 0)
              image[static_cast<int>(k)] =
                  exact_sum(v[static_cast<int>(k)], exact_product(at[k], images[k].period));
          all.vertices.push_back(image);
        }
        for (std::size_t t = 0; t < ends.size(); ++t) {
          const auto axis = static_cast<std::size_t>(std::max(0, ends[t].axis));
          if (ends[t].axis >= 0 && at[axis] != (ends[t].upper ? images[axis].last : images[axis].first))
            continue;
          const auto& [a, b, c] = mesh.triangles[t];
          all.triangles.push_back({first + a, first + b, first + c});
        }
      }
  return all;
}

void check(const Mesh& mesh) {
  bool good = !mesh.vertices.empty() && !mesh.triangles.empty();
  for (const Vector<3>& v : mesh.vertices) good = good && v.allFinite();
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) good = good && v < mesh.vertices.size();
  if (!good || mesh.exact || mesh.surface)
    throw Error(ErrorCode::bad_mesh,
                "the container's mesh that repeats itself has no triangles, or corners that are no doubles");
}

}  // namespace

double period_of(const Mesh& mesh, int axis) {
  check(mesh);
  const Extent extent = extent_of(mesh, axis);
  return exact_sum(extent.upper, -extent.lower);
}

RepeatedWall::RepeatedWall(const Mesh& mesh) {
  check(mesh);
  images_ = std::make_unique<const Mesh>(closed_images(mesh));
  wall_ = std::make_unique<const MeshWall>(*images_);
}

}  // namespace bernal::verify
