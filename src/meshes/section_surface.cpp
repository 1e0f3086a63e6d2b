#include "meshes/section_surface.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "core/disjoint_sets.hpp"
#include "geometry/edges.hpp"

namespace bernal {
namespace {

using Kind = SurfacePatch::Kind;
/// From a vertex to another.
using DirectedEdge = std::array<std::uint32_t, 2>;

const Vector<3>& vertex_of(std::span<const Vector<3>> vertices, std::span<const Vector<3>> more,
                           std::uint32_t number) {
  return number < vertices.size() ? vertices[number] : more[number - vertices.size()];
}

using Chain = std::vector<std::uint32_t>;

/// Closed chains of edges; each ends where it begins. Where no edge goes on, one of `links` may, either way.
std::vector<Chain> closed_chains_of(std::vector<DirectedEdge> edges, const std::vector<Chain>& links) {
  std::ranges::sort(edges);
  std::vector<std::uint8_t> used(edges.size(), 0), is_link_used(links.size(), 0);
  std::multimap<std::uint32_t, std::size_t> link_at;
  for (std::size_t k = 0; k < links.size(); ++k)
    for (const std::uint32_t end : {links[k].front(), links[k].back()}) link_at.emplace(end, k);
  const auto goes_on = [&](Chain& chain) {
    const std::uint32_t at = chain.back();
    for (auto edge = std::ranges::lower_bound(edges, std::array{at, std::uint32_t{0}});
         edge != edges.end() && (*edge)[0] == at; ++edge) {
      std::uint8_t& is_used = used[static_cast<std::size_t>(edge - edges.begin())];
      if (is_used) continue;
      is_used = 1;
      chain.push_back((*edge)[1]);
      return true;
    }
    for (auto [link, last] = link_at.equal_range(at); link != last; ++link) {
      if (is_link_used[link->second]) continue;
      is_link_used[link->second] = 1;
      Chain along = links[link->second];
      if (along.front() != at) std::ranges::reverse(along);
      chain.insert(chain.end(), along.begin() + 1, along.end());
      return true;
    }
    return false;
  };
  std::vector<Chain> chains;
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (used[first]) continue;
    used[first] = 1;
    Chain chain{edges[first][0], edges[first][1]};
    while (chain.back() != chain.front() && goes_on(chain)) {
    }
    if (chain.back() == chain.front()) chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace

void SurfaceParts::Range::take(const Range& other) {
  low = std::min(low, other.low);
  high = std::max(high, other.high);
}

SurfaceParts::SurfaceParts(const ConformingSurface& surface, int axis) : surface_(surface), axis_(axis) {
  find_pieces();
  std::vector<Range> extent(surface.patches.size(), {std::numeric_limits<double>::infinity(),
                                                     -std::numeric_limits<double>::infinity()});
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::uint32_t patch = surface.patch[t];
    if (is_wall(patch)) continue;
    const Range range = range_of(surface.triangles[t]);
    longest_edge_ = std::max(longest_edge_, range.high - range.low);
    if (!is_neck(patch)) extent[piece_[patch]].take(range);
  }
  for (const Range& of : extent) largest_extent_ = std::max(largest_extent_, of.high - of.low);
}

SurfaceParts::Range SurfaceParts::range_of(const FaceCorners& triangle) const {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const std::uint32_t c : triangle) {
    const double at = vertex_of(surface_.vertices, surface_.lids.vertices, c)[axis_];
    range.take({at, at});
  }
  return range;
}

bool SurfaceParts::is_wall(std::uint32_t patch) const {
  return surface_.patches[patch].kind == Kind::wall || surface_.patches[patch].kind == Kind::period_end;
}

bool SurfaceParts::is_neck(std::uint32_t patch) const { return surface_.patches[patch].kind == Kind::neck; }

/// Patches of one sphere, as its own and those of its caps, share vertices.
void SurfaceParts::find_pieces() {
  const std::size_t patches = surface_.patches.size();
  DisjointSets sets(patches);
  std::vector<std::uint32_t> first(surface_.vertices.size(), not_of_whole);
  const auto for_each_corner = [&](bool necks, const auto& body) {
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const std::uint32_t patch = surface_.patch[t];
      if (is_wall(patch) || is_neck(patch) != necks) continue;
      for (const std::uint32_t corner : surface_.triangles[t]) body(patch, corner);
    }
  };
  for_each_corner(false, [&](std::uint32_t patch, std::uint32_t corner) {
    if (first[corner] == not_of_whole) first[corner] = patch;
    sets.unite(first[corner], patch);
  });
  piece_.resize(patches);
  for (std::uint32_t p = 0; p < patches; ++p) piece_[p] = sets.find(p);
  piece_of_vertex_ = std::move(first);
  for (std::uint32_t& piece : piece_of_vertex_)
    if (piece != not_of_whole) piece = piece_[piece];
  pieces_of_neck_.resize(patches);
  for_each_corner(true, [&](std::uint32_t patch, std::uint32_t corner) {
    const std::uint32_t piece = piece_of_vertex_[corner];
    auto& pieces = pieces_of_neck_[patch];
    if (piece != not_of_whole && std::ranges::find(pieces, piece) == pieces.end()) pieces.push_back(piece);
  });
}

std::vector<std::uint8_t> SurfaceParts::chosen_pieces(const Range& near) const {
  std::vector<std::uint8_t> chosen(surface_.patches.size(), 0);
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
    const std::uint32_t patch = surface_.patch[t];
    if (is_wall(patch) || !range_of(surface_.triangles[t]).meets(near)) continue;
    chosen[is_neck(patch) ? patch : piece_[patch]] = 1;
    for (const std::uint32_t piece : pieces_of_neck_[patch]) chosen[piece] = 1;
  }
  return chosen;
}

PartOfSurface SurfaceParts::near(double low, double high) const {
  const Range near{low - longest_edge_, high + longest_edge_};
  const std::vector<std::uint8_t> chosen = chosen_pieces(near);
  std::vector<std::uint8_t> takes(surface_.patches.size(), 0);
  for (std::uint32_t p = 0; p < takes.size(); ++p) {
    if (is_wall(p)) continue;
    const auto& pieces = pieces_of_neck_[p];
    takes[p] = !is_neck(p)      ? chosen[piece_[p]]
               : pieces.empty() ? chosen[p]
                                : std::ranges::all_of(pieces, [&](auto k) { return chosen[k] != 0; });
  }
  Range all = near;
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
    if (takes[surface_.patch[t]]) all.take(range_of(surface_.triangles[t]));
  PartBuilder builder(surface_.vertices, surface_.lids.vertices);
  PartOfSurface& part = builder.part();
  part.surface.patches = surface_.patches;
  part.surface.regions = surface_.regions;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
    const std::uint32_t patch = surface_.patch[t];
    if (is_wall(patch) ? !range_of(surface_.triangles[t]).meets(all) : !takes[patch]) continue;
    builder.add(surface_.triangles[t], patch);
    part.triangles.push_back(t);
  }
  const auto lid = static_cast<std::uint32_t>(part.surface.patches.size());
  part.surface.patches.push_back({.kind = Kind::period_end});  // beyond which nothing is
  for (const FaceCorners& triangle : surface_.lids.triangles)
    if (range_of(triangle).meets(all)) builder.add(triangle, lid);
  std::array<std::vector<DirectedEdge>, 2> open;  // of spheres and necks, and of walls
  for (const EdgeUse& use : open_edges(part.surface.triangles)) {
    const std::uint32_t patch = part.surface.patch[use.triangle];
    open[patch == lid || is_wall(patch) ? 1 : 0].push_back(use.upwards ? DirectedEdge{use.low, use.high}
                                                                       : DirectedEdge{use.high, use.low});
  }
  std::vector<Chain> chords;
  for (const Chain& chord : surface_.lids.chords)
    if (const Chain there = builder.numbers_of(chord); !there.empty()) chords.push_back(there);
  for (const Chain& rim : closed_chains_of(std::move(open[0]), chords))
    builder.add_cone(rim, Vector<3>::Zero(), lid);
  for (const Chain& end : closed_chains_of(std::move(open[1]), {})) {
    const bool is_above = part.surface.vertices[end[0]][axis_] > (all.low + all.high) / 2;
    builder.add_cone(end, (is_above ? 1.0 : -1.0) * Vector<3>::Unit(axis_), lid);
  }
  return std::move(part);
}

std::uint32_t PartBuilder::number_of(std::uint32_t vertex) {
  if (number_.empty()) number_.assign(vertices_.size() + more_.size(), not_of_whole);
  std::uint32_t& number = number_[vertex];
  if (number == not_of_whole) {
    number = static_cast<std::uint32_t>(part_.vertex.size());
    part_.vertex.push_back(vertex < vertices_.size() ? vertex : not_of_whole);
    part_.surface.vertices.push_back(vertex_of(vertices_, more_, vertex));
  }
  return number;
}

std::vector<std::uint32_t> PartBuilder::numbers_of(std::vector<std::uint32_t> vertices) const {
  for (std::uint32_t& vertex : vertices) {
    vertex = number_.empty() ? not_of_whole : number_[vertex];
    if (vertex == not_of_whole) return {};
  }
  return vertices;
}

void PartBuilder::add(const FaceCorners& triangle, std::uint32_t patch) {
  FaceCorners corners{};
  for (std::size_t k = 0; k < 3; ++k) corners[k] = number_of(triangle[k]);
  part_.surface.triangles.push_back(corners);
  part_.surface.patch.push_back(patch);
}

void PartBuilder::add_cone(const std::vector<std::uint32_t>& chain, const Vector<3>& out,
                           std::uint32_t patch) {
  Bounds<3> bounds = Bounds<3>::of_nothing();
  Vector<3> middle = Vector<3>::Zero();
  for (std::size_t k = 1; k < chain.size(); ++k) {
    const Vector<3>& vertex = part_.surface.vertices[chain[k]];
    bounds.add(vertex);
    middle += vertex;
  }
  const auto apex = static_cast<std::uint32_t>(part_.surface.vertices.size());
  part_.surface.vertices.push_back(middle / static_cast<double>(chain.size() - 1) +
                                   bounds.diagonal() / 2 * out);
  part_.vertex.push_back(not_of_whole);
  for (std::size_t k = 1; k < chain.size(); ++k) {
    part_.surface.triangles.push_back({apex, chain[k], chain[k - 1]});
    part_.surface.patch.push_back(patch);
  }
}

}  // namespace bernal
