#include "slabs/slab_store.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

/// Spheres that are read and written together.
constexpr std::size_t spheres_a_piece = 1 << 13;

[[noreturn]] void fail_with(const std::filesystem::path& file, const char* what) {
  throw Error(ErrorCode::cannot_write,
              fmt::format("a slab of spheres cannot be {}: {}", what,
                          errno != 0 ? std::strerror(errno) : "it is not whole"),
              {file.string()});
}

void read_piece(std::istream& in, std::vector<SlabSphere>& piece, const std::filesystem::path& file) {
  errno = 0;
  const auto bytes = static_cast<std::streamsize>(piece.size() * sizeof(SlabSphere));
  if (!in.read(reinterpret_cast<char*>(piece.data()), bytes)) fail_with(file, "read");
}

void write_piece(std::ostream& out, std::span<const SlabSphere> piece, const std::filesystem::path& file) {
  errno = 0;
  const auto bytes = static_cast<std::streamsize>(piece.size_bytes());
  if (!out.write(reinterpret_cast<const char*>(piece.data()), bytes)) fail_with(file, "written");
}

double in_one_period(double x) {
  x -= std::floor(x);
  return x < 1 ? x : 0;
}

}  // namespace

void SlabStore::Extent::include(double at) {
  lower = std::min(lower, at);
  upper = std::max(upper, at);
}

SlabStore::SlabStore(std::filesystem::path folder, int slabs, int axis)
    : folder_(std::move(folder)), axis_(axis), slabs_(static_cast<std::size_t>(slabs)) {
  std::error_code failed;
  std::filesystem::create_directory(folder_, failed);
  if (failed)
    throw Error(ErrorCode::cannot_write, fmt::format("cannot be made: {}", failed.message()),
                {folder_.string()});
}

void SlabStore::end() {
  std::error_code gone;
  for (int s = 0; s < size(); ++s) forget(s);
  std::filesystem::remove(folder_, gone);
}

std::filesystem::path SlabStore::file(int slab) const { return folder_ / fmt::format("slab-{}", slab); }

void SlabStore::forget(int slab) {
  std::error_code gone;
  std::filesystem::remove(file(slab), gone);
}

void SlabStore::clear() {
  for (int s = 0; s < size(); ++s) {
    forget(s);
    at(s) = {};
  }
}

void SlabStore::add(const SlabSphere& sphere) {
  const double along = sphere.at[static_cast<std::size_t>(axis_)] * size();
  const int slab = std::clamp(static_cast<int>(along), 0, size() - 1);
  Slab& here = at(slab);
  here.waiting.push_back(sphere);
  here.extent.include(offset(slab, sphere));
  ++here.count;
  if (here.waiting.size() >= spheres_a_piece) append(slab);
}

void SlabStore::append(int slab) {
  std::ofstream out(file(slab), std::ios::binary | std::ios::app);
  write_piece(out, at(slab).waiting, file(slab));
  at(slab).waiting.clear();
  errno = 0;
  if (!out.flush()) fail_with(file(slab), "written");
}

void SlabStore::close() {
  for (int s = 0; s < size(); ++s) {
    append(s);
    std::vector<SlabSphere>().swap(at(s).waiting);
  }
}

void SlabStore::for_each(int slab, const Visit& visit) const {
  std::ifstream in(file(slab), std::ios::binary);
  std::vector<SlabSphere> piece;
  for (std::uint64_t left = at(slab).count; left > 0; left -= piece.size()) {
    piece.resize(std::min<std::uint64_t>(left, spheres_a_piece));
    read_piece(in, piece, file(slab));
    for (const SlabSphere& sphere : piece) visit(sphere);
  }
}

void SlabStore::rewrite(int slab, const std::function<void(std::uint64_t k, SlabSphere&)>& change) {
  Slab& here = at(slab);
  here.extent = {};
  std::fstream both(file(slab), std::ios::binary | std::ios::in | std::ios::out);
  std::vector<SlabSphere> piece;
  for (std::uint64_t first = 0; first < here.count; first += piece.size()) {
    piece.resize(std::min<std::uint64_t>(here.count - first, spheres_a_piece));
    both.seekg(static_cast<std::streamoff>(first * sizeof(SlabSphere)));
    read_piece(both, piece, file(slab));
    for (std::size_t n = 0; n < piece.size(); ++n) {
      change(first + n, piece[n]);
      for (double& x : piece[n].at) x = in_one_period(x);
      here.extent.include(offset(slab, piece[n]));
    }
    both.seekp(static_cast<std::streamoff>(first * sizeof(SlabSphere)));
    write_piece(both, piece, file(slab));
  }
  errno = 0;
  if (!both.flush()) fail_with(file(slab), "written");
}

double SlabStore::offset(int slab, const SlabSphere& sphere) const {
  const double from_middle = sphere.at[static_cast<std::size_t>(axis_)] - (slab + 0.5) / size();
  return from_middle - std::round(from_middle);
}

SlabSurroundings surroundings(const SlabStore& store, int slab, const Vector<3>& edges, double width,
                              double gap) {
  SlabSurroundings here{.edges = edges};
  const int axis = store.axis();
  const SlabStore::Extent& own = store.extent(slab);
  const double middle = (slab + 0.5) / store.size(), share = width / edges[axis];
  const double lower = own.lower - share, upper = own.upper + share;
  const double length = upper - lower + gap / edges[axis];
  const bool is_cut = length < 1;
  if (is_cut) {
    here.origin = middle + lower;
    here.edges[axis] *= length;
  }
  const auto take = [&](const SlabSphere& sphere, double along) {
    Vector<3> c;
    for (int k = 0; k < 3; ++k) {
      c[k] = (k == axis && is_cut ? along - lower : sphere.at[static_cast<std::size_t>(k)]) * edges[k];
      if (!(c[k] >= 0 && c[k] < here.edges[k])) c[k] = 0;  // by rounding
    }
    here.spheres.push_back(c, sphere.r);
  };
  here.own = store.spheres(slab);
  std::uint64_t all = 0;
  for (int t = 0; t < store.size(); ++t) all += store.spheres(t);
  constexpr double more = 1.1;  // than lie there on the average
  here.spheres.reserve(here.own + static_cast<std::size_t>(std::min(1.0, 2 * more * share) *
                                                           static_cast<double>(all - here.own)));
  store.for_each(slab, [&](const SlabSphere& sphere) { take(sphere, store.offset(slab, sphere)); });
  for (int t = 0; t < store.size(); ++t) {
    if (t == slab) continue;
    // From this middle to the other's, and on to where the others begin and end there, in any period.
    const double to = (t - slab) / static_cast<double>(store.size());
    const SlabStore::Extent& there = store.extent(t);
    const auto reaches = [&](double period) {
      return to + there.lower + period <= upper && to + there.upper + period >= lower;
    };
    if (is_cut && !reaches(-1) && !reaches(0) && !reaches(1)) continue;
    store.for_each(t, [&](const SlabSphere& sphere) {
      double at = store.offset(slab, sphere);
      if (at < lower) at += 1;
      if (at > upper) at -= 1;
      if (!is_cut || (at >= lower && at <= upper)) take(sphere, at);
    });
  }
  return here;
}

}  // namespace bernal
