#include "measure/shared_corners.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"

namespace bernal {
namespace {

using Corner = Cells::Corner;
using Image = Cells::Image;

constexpr double told_apart_of_reach = 1e-9;
/// Of coordinates near 1.
constexpr double told_apart_of_places = 1e-14;
constexpr std::size_t pieces_a_range = 256;
/// Every round has fewer corners; hardly any packing needs a second one.
constexpr int most_rounds = 1000;

Image plus(const Image& a, const Image& b) {
  Image sum;
  for (std::size_t k = 0; k < 3; ++k) sum[k] = static_cast<std::int8_t>(a[k] + b[k]);
  return sum;
}
Image minus(const Image& a, const Image& b) {
  Image difference;
  for (std::size_t k = 0; k < 3; ++k) difference[k] = static_cast<std::int8_t>(a[k] - b[k]);
  return difference;
}
Image image_in(const CellNeighbour& neighbour) {
  Image image;
  for (std::size_t k = 0; k < 3; ++k) image[k] = static_cast<std::int8_t>(neighbour.image[k]);
  return image;
}
Vector<3> moved(const Image& image, const Vector<3>& periods) {
  return {image[0] * periods[0], image[1] * periods[1], image[2] * periods[2]};
}

/// Takes out corners that follow themselves, and ways there and back; returns how many are left.
std::size_t reduced(std::span<Corner> loop) {
  std::size_t n = loop.size();
  const auto take_out = [&](std::size_t k) {
    std::move(loop.begin() + static_cast<std::ptrdiff_t>(k) + 1,
              loop.begin() + static_cast<std::ptrdiff_t>(n), loop.begin() + static_cast<std::ptrdiff_t>(k));
    --n;
  };
  for (bool again = true; again && n > 1;) {
    again = false;
    for (std::size_t k = 0; k < n && !again; ++k) {
      const std::size_t next = (k + 1) % n, after = (k + 2) % n;
      again = loop[k] == loop[next] || (n > 2 && loop[k] == loop[after]);
      if (!again) continue;
      if (loop[k] != loop[next])
        take_out(std::max(next, after)), take_out(std::min(next, after));
      else
        take_out(next);
    }
  }
  return n;
}

}  // namespace

SharedCorners::SharedCorners(const std::vector<CellPiece>& pieces, const Vector<3>& periods, int dimension)
    : pieces_(pieces), periods_(periods), dimension_(dimension), first_corner_{0}, first_face_{0} {
  std::uint32_t corners = 0, first = 0;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    corners += static_cast<std::uint32_t>(pieces[i].corners.size());
    first_corner_.push_back(corners);
    for (const CellPiece::Face& face : pieces[i].faces) {
      faces_.push_back({i, face.label, Cells::none, first, face.count});
      first += face.count;
    }
    first_face_.push_back(static_cast<std::uint32_t>(faces_.size()));
  }
  loops_.resize(first);
  parent_.resize(corners);
  for (std::uint32_t k = 0; k < corners; ++k) parent_[k].corner = k;
  find_twins();
  std::vector<Same> same = pairs();
  for (int round = 0; !same.empty() || round == 0; ++round) {
    if (round == most_rounds) {
      const Face& face = faces_[0];
      throw Error(ErrorCode::bad_packing,
                  fmt::format("the cells of sphere {} and of those around it cannot be fitted together; are "
                              "there spheres of far smaller sizes than others?",
                              face.cell));
    }
    throw_if_interrupted();
    for (const Same& pair : same) unite(pair);
    number_corners();
    make_loops();
    while (dimension_ == 3 && drop_corners_of_two_edges()) {
    }
    same = differences();
  }
}

void SharedCorners::find_twins() {
  parallel_ranges(pieces_.size(), pieces_a_range, [&](std::size_t from, std::size_t to) {
    for (std::uint32_t f = first_face_[from]; f < first_face_[to]; ++f) {
      Face& face = faces_[f];
      if (face.label < 0) continue;
      const CellNeighbour behind = neighbour_of(face.label);
      const ConvexCell::Label back =
          label_of({face.cell, {-behind.image[0], -behind.image[1], -behind.image[2]}});
      for (std::uint32_t t = first_face_[behind.sphere]; t < first_face_[behind.sphere + 1]; ++t)
        if (faces_[t].label == back) face.twin = t;
    }
  });
}

double SharedCorners::told_apart(std::uint32_t cell, std::uint32_t other) const {
  return std::max(told_apart_of_places,
                  told_apart_of_reach * std::min(pieces_[cell].reach, pieces_[other].reach));
}

/// What see(piece, found) finds of every piece, in threads, in the order of the pieces.
template <class See>
std::vector<SharedCorners::Same> SharedCorners::from_ranges(const See& see) const {
  std::vector<std::vector<Same>> found((pieces_.size() + pieces_a_range - 1) / pieces_a_range);
  parallel_for(found.size(), [&](std::size_t range) {
    const std::size_t last = std::min(pieces_.size(), (range + 1) * pieces_a_range);
    for (std::size_t i = range * pieces_a_range; i < last; ++i) see(i, found[range]);
  });
  std::vector<Same> all;
  for (const std::vector<Same>& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

std::vector<SharedCorners::Same> SharedCorners::pairs() const {
  return from_ranges([&](std::size_t i, std::vector<Same>& found) {
    for (std::uint32_t f = first_face_[i]; f < first_face_[i + 1]; ++f) {
      add_short_edges(f, found);
      if (faces_[f].twin != Cells::none && faces_[f].twin >= f) add_seen_by_both(f, found);
    }
  });
}

std::span<const std::uint32_t> SharedCorners::loop_of_piece(std::uint32_t f) const {
  const CellPiece& piece = pieces_[faces_[f].cell];
  return piece.loop(piece.faces[f - first_face_[faces_[f].cell]]);
}

void SharedCorners::add_short_edges(std::uint32_t f, std::vector<Same>& found) const {
  const std::uint32_t cell = faces_[f].cell;
  const std::vector<Vector<3>>& corners = pieces_[cell].corners;
  const std::span<const std::uint32_t> loop = loop_of_piece(f);
  const double apart = told_apart(cell, cell);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const std::uint32_t next = loop[(k + 1) % loop.size()];
    const double squared = (corners[loop[k]] - corners[next]).squaredNorm();
    if (squared <= apart * apart)
      found.push_back({first_corner_[cell] + loop[k], first_corner_[cell] + next, {}, std::sqrt(squared)});
  }
}

void SharedCorners::add_seen_by_both(std::uint32_t f, std::vector<Same>& found) const {
  const std::uint32_t cell = faces_[f].cell, behind = faces_[faces_[f].twin].cell;
  const std::vector<Vector<3>>&corners = pieces_[cell].corners, &others = pieces_[behind].corners;
  const Image image = image_in(neighbour_of(faces_[f].label));
  const Vector<3> between = pieces_[behind].center + moved(image, periods_) - pieces_[cell].center;
  const double apart = told_apart(cell, behind);
  const std::span<const std::uint32_t> theirs = loop_of_piece(faces_[f].twin);
  for (const std::uint32_t mine : loop_of_piece(f)) {
    const std::uint32_t* nearest = nullptr;
    double least = apart * apart;
    for (const std::uint32_t& their : theirs) {
      const double squared = (others[their] + between - corners[mine]).squaredNorm();
      if (squared > least) continue;
      least = squared;
      nearest = &their;
    }
    if (nearest)
      found.push_back(
          {first_corner_[cell] + mine, first_corner_[behind] + *nearest, image, std::sqrt(least)});
  }
}

Corner SharedCorners::root(std::uint32_t corner) {
  std::uint32_t at = corner;
  Image image{};
  while (parent_[at].corner != at) {
    image = plus(image, parent_[at].image);
    at = parent_[at].corner;
  }
  for (std::uint32_t k = corner; k != at;) {
    const Corner before = parent_[k];
    parent_[k] = {at, image};
    image = minus(image, before.image);
    k = before.corner;
  }
  return corner == at ? Corner{at, {}} : Corner{at, parent_[corner].image};
}

void SharedCorners::unite(const Same& same) {
  Corner one = root(same.one), other = root(same.other);
  if (one.corner == other.corner) return;
  // one + image of one = other + image of other + image
  Image by = minus(plus(other.image, same.image), one.image);
  if (one.corner < other.corner) {
    std::swap(one, other);
    by = minus({}, by);
  }
  merged_ = std::max(merged_, same.distance);
  parent_[one.corner] = {other.corner, by};
}

std::uint32_t SharedCorners::piece_of(std::uint32_t corner) const {
  return static_cast<std::uint32_t>(std::ranges::upper_bound(first_corner_, corner) - first_corner_.begin() -
                                    1);
}
Vector<3> SharedCorners::place_of(std::uint32_t corner) const {
  const std::uint32_t piece = piece_of(corner);
  return pieces_[piece].center + pieces_[piece].corners[corner - first_corner_[piece]];
}
Vector<3> SharedCorners::place_of(const Corner& corner) const {
  return place_of(origin_[corner.corner]) + moved(corner.image, periods_);
}

void SharedCorners::number_corners() {
  number_.resize(parent_.size());
  origin_.clear();
  for (std::uint32_t k = 0; k < parent_.size(); ++k) {
    const Corner of = root(k);
    if (of.corner == k) {
      number_[k] = {static_cast<std::uint32_t>(origin_.size()), {}};
      origin_.push_back(k);
    } else {  // a root comes before all that are united with it
      number_[k] = {number_[of.corner].corner, of.image};
    }
  }
}

void SharedCorners::make_loops() {
  parallel_ranges(pieces_.size(), pieces_a_range, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      for (std::uint32_t f = first_face_[i]; f < first_face_[i + 1]; ++f) {
        const std::span<const std::uint32_t> loop = loop_of_piece(f);
        Corner* const first = loops_.data() + faces_[f].first;
        for (std::size_t k = 0; k < loop.size(); ++k) first[k] = number_[first_corner_[i] + loop[k]];
        const std::size_t left = reduced(std::span(first, loop.size()));
        faces_[f].count = left < least_corners() ? 0 : static_cast<std::uint32_t>(left);
      }
  });
}

/// Returns whether there were any.
bool SharedCorners::drop_corners_of_two_edges() {
  struct Ends {
    std::array<Corner, 2> to;
    std::uint8_t count = 0;  // 3: more than two
  };
  std::vector<Ends> ends(origin_.size());
  const auto add = [&](const Corner& from, const Corner& to) {
    Ends& all = ends[from.corner];
    const Corner end{to.corner, minus(to.image, from.image)};
    if (all.count == 3) return;
    for (std::uint8_t k = 0; k < all.count; ++k)
      if (all.to[k] == end) return;
    if (all.count < 2) all.to[all.count] = end;
    ++all.count;
  };
  for (const Face& face : faces_)
    for (std::uint32_t k = 0; k < face.count; ++k) {
      const Corner &a = loops_[face.first + k], &b = loops_[face.first + (k + 1) % face.count];
      add(a, b);
      add(b, a);
    }
  bool dropped = false;
  for (std::uint32_t c = 0; c < ends.size(); ++c) {
    if (ends[c].count != 2) continue;
    dropped = true;
    const Vector<3> a = place_of(ends[c].to[0]), b = place_of(ends[c].to[1]), p = position(c);
    const Vector<3> along = (b - a).stableNormalized();
    merged_ = std::max(merged_, (p - a - along * along.dot(p - a)).norm());
  }
  if (!dropped) return false;
  for (Face& face : faces_) {
    const auto first = loops_.begin() + face.first, end = first + face.count;
    const auto kept = std::remove_if(first, end, [&](const Corner& c) { return ends[c.corner].count == 2; });
    if (kept == end) continue;
    const std::size_t left = reduced(std::span(first, kept));
    face.count = left < least_corners() ? 0 : static_cast<std::uint32_t>(left);
  }
  return true;
}

std::vector<SharedCorners::Same> SharedCorners::differences() const {
  return from_ranges([&](std::size_t i, std::vector<Same>& found) {
    for (std::uint32_t f = first_face_[i]; f < first_face_[i + 1]; ++f) {
      const Face& face = faces_[f];
      if (face.label < 0 || (face.twin < f && faces_[face.twin].twin == f)) continue;
      compare(face, found);
    }
  });
}

/// What is to be united where the two cells of a face see it differently.
void SharedCorners::compare(const Face& face, std::vector<Same>& out) const {
  const std::span<const Corner> mine = loop(face);
  std::vector<Corner> theirs;  // the other way around, as seen from the cell of `mine`
  const bool has_twin = face.twin != Cells::none && faces_[faces_[face.twin].twin].first == face.first;
  if (has_twin) {
    const Image image = image_in(neighbour_of(face.label));
    for (const Corner& corner : loop(faces_[face.twin]))
      theirs.push_back({corner.corner, plus(corner.image, image)});
    std::ranges::reverse(theirs);
  }
  if (mine.size() == theirs.size()) {
    if (mine.empty()) return;
    const auto start = std::ranges::find(theirs, mine[0]);
    std::ranges::rotate(theirs, start == theirs.end() ? theirs.begin() : start);
    if (std::ranges::equal(mine, theirs)) return;
  }
  const auto same = [&](const Corner& a, const Corner& b) {
    return Same{origin_[a.corner], origin_[b.corner], minus(b.image, a.image),
                (place_of(a) - place_of(b)).norm()};
  };
  struct Best {
    double distance = std::numeric_limits<double>::infinity();
    Corner to = {};
  };
  const auto take = [&](Best& best, const Corner& from, const Corner& to) {
    if (from == to) return;
    if (const double distance = (place_of(from) - place_of(to)).norm(); distance < best.distance)
      best = {distance, to};
  };
  bool any = false;
  const auto resolve = [&](std::span<const Corner> loop, std::span<const Corner> other) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if (!other.empty() && std::ranges::find(other, loop[k]) != other.end()) continue;
      Best best;
      for (const Corner& corner : other)
        if (std::ranges::find(loop, corner) == loop.end()) take(best, loop[k], corner);
      take(best, loop[k], loop[(k + 1) % loop.size()]);
      take(best, loop[k], loop[(k + loop.size() - 1) % loop.size()]);
      any = true;
      out.push_back(same(loop[k], best.to));
    }
  };
  if (theirs.empty() || mine.empty()) {  // by its shortest edge
    const std::span<const Corner> loop = theirs.empty() ? mine : std::span<const Corner>(theirs);
    Best best;
    Corner from;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const double before = best.distance;
      take(best, loop[k], loop[(k + 1) % loop.size()]);
      if (best.distance < before) from = loop[k];
    }
    out.push_back(same(from, best.to));
    return;
  }
  resolve(mine, theirs);
  resolve(theirs, mine);
  if (!any) out.push_back(same(mine[0], mine[1]));  // the same corners in another order
}

}  // namespace bernal
