#include "cad/repair/repair_crossings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "cad/diagnose/counted.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/cgal_surfaces.hpp"
#include "cad/repair/patch.hpp"
#include "core/disjoint_sets.hpp"
#include "geometry/changes.hpp"
#include "geometry/measures.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {
namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

/// The cut grows by a ring of neighbours if a round did not help much.
constexpr int most_rings = 6;
constexpr int most_rounds = 20;
/// No more than this share of a component is cut out.
constexpr double most_cut = 0.5;
/// A piece separated by the cut is dropped if it has at most this share of the component's area.
constexpr double small_piece = 0.05;
/// CGAL cannot be interrupted; this many faces take it a few minutes.
constexpr std::size_t most_faces = 2'000'000;

Pairs within_components(const Pairs& pairs, const MeshTopology& topology) {
  Pairs own;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(own),
               [&](const auto& pair) { return topology.component[pair[0]] == topology.component[pair[1]]; });
  return own;
}

/// Also marks the faces that share a corner with a marked one.
void add_ring(const Mesh& mesh, std::vector<bool>& marked) {
  std::vector<bool> corner(mesh.vertices.size(), false);
  for (std::size_t t = 0; t < marked.size(); ++t)
    if (marked[t])
      for (const std::uint32_t i : mesh.triangles[t]) corner[i] = true;
  for (std::size_t t = 0; t < marked.size(); ++t)
    for (const std::uint32_t i : mesh.triangles[t]) marked[t] = marked[t] || corner[i];
}

/// Also marks the small pieces into which a component falls without the marked faces; unmarks a component
/// that would nearly disappear.
void drop_small_pieces(const Mesh& mesh, const MeshTopology& topology, std::vector<bool>& marked) {
  Mesh rest = mesh;
  std::vector<bool> kept = marked;
  kept.flip();
  keep_only(rest, kept);
  std::vector<std::uint32_t> old;
  for (std::uint32_t t = 0; t < marked.size(); ++t)
    if (!marked[t]) old.push_back(t);

  const MeshTopology pieces = topology_of(rest);
  std::vector<double> of_component(topology.components, 0), left(topology.components, 0),
      of_piece(pieces.components, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    of_component[topology.component[t]] += doubled_area(mesh, mesh.triangles[t]).norm();
  for (std::size_t t = 0; t < old.size(); ++t) {
    const double area = doubled_area(rest, rest.triangles[t]).norm();
    of_piece[pieces.component[t]] += area;
    left[topology.component[old[t]]] += area;
  }
  for (std::size_t t = 0; t < old.size(); ++t)
    if (of_piece[pieces.component[t]] <= small_piece * of_component[topology.component[old[t]]])
      marked[old[t]] = true;
  for (std::size_t t = 0; t < marked.size(); ++t)
    if (left[topology.component[t]] < (1 - most_cut) * of_component[topology.component[t]]) marked[t] = false;
}

/// One round of cutting; absent if no face could be cut or a hole could not be filled.
std::optional<Mesh> cut_once(const Mesh& mesh, const MeshTopology& topology, const Pairs& own, int rings) {
  std::vector<bool> marked(mesh.triangles.size(), false);
  for (const auto& [s, t] : own) marked[s] = marked[t] = true;
  for (int ring = 0; ring < rings; ++ring) add_ring(mesh, marked);
  drop_small_pieces(mesh, topology, marked);
  if (std::find(marked.begin(), marked.end(), true) == marked.end()) return std::nullopt;

  std::vector<std::array<std::uint32_t, 2>> was_open;  // directed sides of triangles
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (!marked[t] && topology.neighbor[t][k] == no_index)
        was_open.push_back({mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]});
  std::ranges::sort(was_open);
  Mesh result = mesh;
  marked.flip();
  keep_only(result, marked);
  Patcher patcher(result);
  for (const HoleLoop& hole : hole_loops(result, topology_of(result))) {
    std::size_t old_edges = 0;
    for (std::size_t k = 0; k < hole.corners.size(); ++k)
      old_edges += std::ranges::binary_search(
          was_open, std::array{hole.corners[(k + 1) % hole.corners.size()], hole.corners[k]});
    if (old_edges == hole.corners.size()) continue;
    if (old_edges > 0 || hole.branched || !patcher.fill(hole)) return std::nullopt;
  }
  return result;
}

/// Cuts until no component crosses itself, or without further success. Returns the number of crossings left.
std::size_t cut_within_components(Mesh& mesh, const Monitor& monitor) {
  MeshTopology topology = topology_of(mesh);
  Pairs own = within_components(self_intersecting_pairs(mesh), topology);
  for (int rings = 0, round = 0; rings <= most_rings && round < most_rounds; ++round) {
    if (own.empty() || monitor.stop()) break;
    std::optional<Mesh> next = cut_once(mesh, topology, own, rings);
    if (!next) {
      ++rings;
      continue;
    }
    MeshTopology next_topology = topology_of(*next);
    Pairs next_own = within_components(self_intersecting_pairs(*next), next_topology);
    if (4 * next_own.size() > 3 * own.size()) ++rings;
    if (next_own.size() >= own.size()) continue;
    mesh = std::move(*next);
    topology = std::move(next_topology);
    own = std::move(next_own);
  }
  return own.size();
}

/// Closed components, each crossing another of the group.
struct Group {
  std::vector<Mesh> outward, inward;
  std::size_t faces = 0;
};

struct Bodies {
  Mesh others;  ///< faces outside all groups
  std::vector<Group> groups;
  std::size_t apart = 0;  ///< crossing pairs of components of which one is no body
};

Bodies bodies_of(const Mesh& mesh) {
  const MeshTopology topology = topology_of(mesh);
  const Pairs pairs = self_intersecting_pairs(mesh);
  std::vector<bool> is_body = topology.closed_components();
  for (const auto& [s, t] : within_components(pairs, topology)) is_body[topology.component[s]] = false;
  DisjointSets joined(topology.components);
  std::vector<bool> grouped(topology.components, false);
  Bodies result;
  std::vector<std::array<std::uint32_t, 2>> apart;
  for (const auto& [s, t] : pairs) {
    const std::uint32_t a = topology.component[s], b = topology.component[t];
    if (a == b) continue;
    if (is_body[a] && is_body[b]) {
      joined.unite(a, b);
      grouped[a] = grouped[b] = true;
    } else {
      apart.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(apart.begin(), apart.end());
  result.apart = static_cast<std::size_t>(std::unique(apart.begin(), apart.end()) - apart.begin());

  std::vector<Mesh> bodies = split(mesh, topology.component, topology.components);
  for (std::uint32_t c = 0; c < topology.components; ++c)
    if (!grouped[c]) append(result.others, bodies[c]);

  std::map<std::uint32_t, std::vector<std::uint32_t>> members;
  for (std::uint32_t c = 0; c < topology.components; ++c)
    if (grouped[c]) members[joined.find(c)].push_back(c);
  for (const auto& [first, components] : members) {
    double largest = 0;
    for (const std::uint32_t c : components)
      if (const double v = signed_volume(bodies[c]); std::abs(v) > std::abs(largest)) largest = v;
    Group& made = result.groups.emplace_back();
    for (const std::uint32_t c : components) {
      const double volume = signed_volume(bodies[c]);
      made.faces += bodies[c].triangles.size();
      if (volume < 0) turn_inside_out(bodies[c]);
      ((volume < 0) == (largest < 0) ? made.outward : made.inward).push_back(std::move(bodies[c]));
    }
  }
  return result;
}

struct Counts {
  std::size_t with_itself = 0, united = 0, made = 0, taken_out = 0, failed = 0, too_large = 0;
};

/// Unites the bodies pairwise, so that each face takes part in few unions; those that cannot be united stay.
std::vector<Mesh> unite_all(std::vector<Mesh> bodies, const Monitor& monitor, Counts& counts) {
  std::vector<Mesh> failed;
  while (bodies.size() > 1 && !monitor.stop()) {
    std::vector<Mesh> next;
    for (std::size_t i = 0; i < bodies.size(); i += 2) {
      if (i + 1 == bodies.size()) {
        next.push_back(std::move(bodies[i]));
      } else if (std::optional<Mesh> both = combine(bodies[i], bodies[i + 1], Combine::unite)) {
        next.push_back(std::move(*both));
      } else {
        ++counts.failed;
        next.push_back(std::move(bodies[i]));
        failed.push_back(std::move(bodies[i + 1]));
      }
    }
    bodies = std::move(next);
  }
  bodies.insert(bodies.end(), failed.begin(), failed.end());
  return bodies;
}

void combine_bodies(Mesh& mesh, const Monitor& monitor, Counts& counts) {
  Bodies bodies = bodies_of(mesh);
  if (bodies.groups.empty()) return;
  mesh = std::move(bodies.others);
  for (Group& own : bodies.groups) {
    if (own.faces > most_faces || monitor.stop()) {
      counts.too_large += own.faces > most_faces;
      for (Mesh& body : own.inward) turn_inside_out(body);
      for (const auto* side : {&own.outward, &own.inward})
        for (const Mesh& body : *side) append(mesh, body);
      continue;
    }
    const std::size_t failed_before = counts.failed, count = own.outward.size();
    std::vector<Mesh> united = unite_all(std::move(own.outward), monitor, counts);
    if (const std::size_t made_of = count - (counts.failed - failed_before); made_of > 1) {
      counts.united += made_of;
      ++counts.made;
    }
    for (Mesh& hole : own.inward) {
      std::optional<Mesh> rest = combine(united.front(), hole, Combine::take_out);
      if (rest) {
        ++counts.taken_out;
        united.front() = std::move(*rest);
      } else {
        ++counts.failed;
        turn_inside_out(hole);
        united.push_back(std::move(hole));
      }
    }
    for (const Mesh& body : united) append(mesh, body);
  }
  weld_equal_points(mesh);
}

/// Closed components that cross themselves become the outer walls of what they wind around.
void unite_with_themselves(Mesh& mesh, const Monitor& monitor, Counts& counts) {
  const MeshTopology topology = topology_of(mesh);
  const std::vector<bool> is_closed = topology.closed_components();
  std::vector<bool> crosses(topology.components, false);
  for (const auto& [s, t] : within_components(self_intersecting_pairs(mesh), topology))
    crosses[topology.component[s]] = true;
  std::vector<Mesh> bodies = split(mesh, topology.component, topology.components), united;
  std::vector<bool> stays(topology.components, true);
  for (std::uint32_t c = 0; c < topology.components; ++c) {
    if (!crosses[c] || !is_closed[c] || monitor.stop()) continue;
    Mesh& body = bodies[c];
    if (body.triangles.size() > most_faces) continue;
    const bool is_void = signed_volume(body) < 0;
    if (is_void) turn_inside_out(body);
    std::optional<Mesh> walls = unite_with_itself(body);
    if (!walls) continue;
    if (is_void) turn_inside_out(*walls);
    united.push_back(std::move(*walls));
    stays[c] = false;
  }
  if (united.empty()) return;
  std::vector<bool> kept;
  for (const std::uint32_t component : topology.component) kept.push_back(stays[component]);
  keep_only(mesh, kept);
  for (const Mesh& walls : united) append(mesh, walls);
  weld_equal_points(mesh);
  counts.with_itself = united.size();
}

}  // namespace

RepairedMesh cut_out_crossings(Mesh mesh, const Monitor& monitor) {
  const Pairs pairs = self_intersecting_pairs(mesh);
  if (pairs.empty()) return {std::move(mesh), "nothing crosses"};
  if (pairs.size() >= most_self_intersections(mesh)) {
    std::string why =
        fmt::format("{} pairs of faces cross, or more, which are too many to be cut out", pairs.size());
    return {std::move(mesh), std::move(why)};
  }
  const MeshTopology topology = topology_of(mesh);
  if (orient_consistently(mesh, topology) == no_index)
    return {std::move(mesh), "crossings stay: the surface is one-sided and has no inside"};

  Counts counts;
  const std::size_t before = pairs.size();
  unite_with_themselves(mesh, monitor, counts);
  const std::size_t own_before = within_components(self_intersecting_pairs(mesh), topology_of(mesh)).size();
  const std::size_t own_after = own_before > 0 ? cut_within_components(mesh, monitor) : 0;
  combine_bodies(mesh, monitor, counts);
  cut_within_components(mesh, monitor);  // crossings from rounding the corners of the unions

  std::vector<std::string> phrases;
  if (counts.with_itself > 0)
    phrases.push_back(
        fmt::format("of {} itself the outer walls are kept",
                    counted(counts.with_itself, "part that crosses", "parts of which each crosses")));
  if (own_after < own_before)
    phrases.push_back(
        fmt::format("cut out {} where a part crosses itself, and patched over them: some room may "
                    "be lost there",
                    counted(own_before - own_after, "crossing", "crossings")));
  if (counts.made > 0)
    phrases.push_back(fmt::format("united {} that cross{}", counted(counts.united, "body", "bodies"),
                                  counts.made > 1 ? fmt::format(" into {}", counts.made) : ""));
  if (counts.taken_out > 0)
    phrases.push_back(fmt::format(
        "took {} that {} oriented inward out of {} surroundings", counted(counts.taken_out, "body", "bodies"),
        counts.taken_out == 1 ? "is" : "are", counts.taken_out == 1 ? "its" : "their"));
  if (counts.failed > 0)
    phrases.push_back(fmt::format("{} could not be united: the result would touch itself along an edge",
                                  counted(counts.failed, "body", "bodies")));
  if (counts.too_large > 0)
    phrases.push_back(fmt::format("left {} of crossing bodies with more than {} faces",
                                  counted(counts.too_large, "group", "groups"), most_faces));
  const std::size_t after = self_intersecting_pairs(mesh).size();
  if (after > 0) {
    phrases.push_back(fmt::format("{} of {} remain", after, counted(before, "crossing", "crossings")));
    if (bodies_of(mesh).apart > 0)
      phrases.push_back("some of them with an open sheet, which encloses nothing: wrap keeps it as a wall");
  }
  return {std::move(mesh), fmt::format("{}", fmt::join(phrases, "; "))};
}

}  // namespace bernal::cad
