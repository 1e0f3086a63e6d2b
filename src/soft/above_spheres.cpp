#include "soft/above_spheres.hpp"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "domain/nearest_first.hpp"
#include "near/cell_layout.hpp"
#include "soft/below_level.hpp"

namespace bernal {
namespace {

/// Normals of planes have components in so many steps of their length.
constexpr double directions = 8;

/// Columns by the cells across `up` that their spheres are in; in a cell those that end highest come first,
/// so that a search leaves it at the first that ends too low.
class Columns {
 public:
  struct Column {
    Vector<3> end;  ///< centre of the sphere on it
    double r;
    double top;  ///< of the sphere, along `up`
  };

  Columns(const Spheres<3>& spheres, const Boundary<3>& boundary, const Vector<3>& up)
      : up_(up),
        a_(up.unitOrthogonal()),
        b_(up.cross(a_)),
        columns_(columns_of(spheres, boundary, up)),
        layout_(bounds(), {}, std::ranges::max(spheres.r), std::ranges::max(spheres.r), columns_.size()),
        cells_(layout_.cell_count()) {
    for (std::uint32_t k = 0; k < columns_.size(); ++k)
      cells_[layout_.cell_of(layout_.levels()[0], across(columns_[k].end))].push_back(k);
    for (auto& cell : cells_)
      std::ranges::sort(cell, std::greater<>(), [this](std::uint32_t k) { return columns_[k].top; });
  }

  /// Calls visit(column) for those that may be nearer to p than `reach`; until it returns true.
  template <class Visit>
  void for_each_near(const Vector<3>& p, double reach, Visit&& visit) const {
    const double height = up_.dot(p);
    const auto& level = layout_.levels()[0];
    const auto block = layout_.block_around(level, across(p), reach + level.largest_radius);
    CellLayout<2>::any_run(level, block, [&](std::size_t first, std::size_t end) {
      for (std::size_t cell = first; cell < end; ++cell)
        for (const std::uint32_t k : cells_[cell]) {
          if (columns_[k].top + reach < height) break;
          if (visit(columns_[k])) return true;
        }
      return false;
    });
  }

  /// A plane that touches the column about where it is nearest to p: of few directions, so that many spheres
  /// meet the same ones.
  NearFacet plane_near(const Column& column, const Vector<3>& p) const {
    const Vector<3> away = p - axis_point(column, p);
    Vector<3> steps = (directions * away.normalized()).array().round();
    if (steps.isZero(0)) steps = directions * up_;
    const bool beside = up_.dot(p - column.end) < 0;
    Vector<3> normal = steps.normalized();
    if (beside) normal = (normal - normal.dot(up_) * up_).normalized();
    if (!normal.allFinite() || normal.isZero(0)) normal = a_;
    std::uint32_t id = static_cast<std::uint32_t>(&column - columns_.data() + 1) * 2654435761u;
    for (int k = 0; k < 3; ++k)
      id = (id ^ static_cast<std::uint32_t>(static_cast<int>(steps[k]) + 64)) * 16777619u;
    const Vector<3> on = column.end + column.r * normal;
    return {(p - on).dot(normal), {.kind = Facet::Kind::plane, .id = id, .a = on, .b = normal}};
  }

  /// The point on a column's axis that is nearest to p.
  Vector<3> axis_point(const Column& column, const Vector<3>& p) const {
    const double along = up_.dot(p - column.end);
    return along < 0 ? Vector<3>(column.end + along * up_) : column.end;
  }

 private:
  /// Along periods a column stands in the images next to its own, too.
  static std::vector<Column> columns_of(const Spheres<3>& spheres, const Boundary<3>& boundary,
                                        const Vector<3>& up) {
    std::vector<Vector<3>> shifts = {Vector<3>::Zero()};
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      const std::size_t n = shifts.size();
      for (std::size_t i = 0; i < n; ++i)
        for (const double side : {-1.0, 1.0})
          shifts.push_back(shifts[i] + side * boundary.edges[k] * Vector<3>::Unit(k));
    }
    std::vector<Column> columns;
    for (const Vector<3>& shift : shifts)
      for (std::size_t i = 0; i < spheres.size(); ++i) {
        const Vector<3> c = spheres.center(i) + shift;
        columns.push_back({c, spheres.r[i], up.dot(c) + spheres.r[i]});
      }
    return columns;
  }
  Vector<2> across(const Vector<3>& p) const { return {b_.dot(p), a_.dot(p)}; }
  Bounds<2> bounds() const {
    Bounds<2> all{across(columns_[0].end), across(columns_[0].end)};
    for (const Column& column : columns_) {
      all.lower = all.lower.cwiseMin(across(column.end));
      all.upper = all.upper.cwiseMax(across(column.end));
    }
    return all;
  }

  Vector<3> up_, a_, b_;
  std::vector<Column> columns_;
  CellLayout<2> layout_;
  std::vector<std::vector<std::uint32_t>> cells_;
};

class AboveSpheres final : public Container {
 public:
  AboveSpheres(std::shared_ptr<const Container> whole, const Spheres<3>& spheres, const Vector<3>& up)
      : Container(whole->arithmetic(), whole->resolution(), whole->boundary(), whole->dimension(),
                  whole->inset()),
        whole_(std::move(whole)),
        columns_(spheres, whole_->boundary(), up) {
    const std::vector<Vector<3>> points = even_points_inside(*whole_);
    const auto clear = std::ranges::count_if(points, [this](const auto& p) { return nearest(p, 1) > 0; });
    volume_ = whole_->volume() * static_cast<double>(clear) /
              static_cast<double>(std::max<std::size_t>(1, points.size()));
  }

  std::string_view kind() const override { return whole_->kind(); }
  double volume() const override { return volume_; }
  Bounds<3> bounds() const override { return whole_->bounds(); }
  double clearance(const Vector<3>& p) const override { return nearest(p, whole_->clearance(p)); }
  double clearance_within(const Vector<3>& p, double reach) const override {
    return nearest(p, whole_->clearance_within(p, reach));
  }
  bool contains(const Vector<3>& c, double r) const override {
    return nearest(c, r) >= r && whole_->contains(c, r);
  }
  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    const auto before = static_cast<std::ptrdiff_t>(out.size());
    whole_->facets_near(c, reach, out);
    add_columns(c, reach, before, out);
  }
  bool few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const override {
    const auto before = static_cast<std::ptrdiff_t>(out.size());
    if (!whole_->few_facets_near(c, reach, most, out)) return false;
    add_columns(c, reach, before, out);
    return out.size() - static_cast<std::size_t>(before) <= most;
  }
  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const override {
    whole_->contacts(c, r, out);
    columns_.for_each_near(c, r, [&](const Columns::Column& column) {
      const Vector<3> away = c - columns_.axis_point(column, c);
      const double distance = away.norm() - column.r;
      if (distance < r && away.norm() > 0) out.push_back({away.normalized(), distance});
      return false;
    });
  }

 private:
  double nearest(const Vector<3>& p, double limit) const {
    columns_.for_each_near(p, limit, [&](const Columns::Column& column) {
      limit = std::min(limit, (p - columns_.axis_point(column, p)).norm() - column.r);
      return limit < 0;
    });
    return limit;
  }
  void add_columns(const Vector<3>& c, double reach, std::ptrdiff_t before,
                   std::vector<NearFacet>& out) const {
    columns_.for_each_near(c, reach, [&](const Columns::Column& column) {
      const NearFacet near = columns_.plane_near(column, c);
      if (near.distance >= reach) return false;
      insert_nearest_first(near, before, out);
      return false;
    });
  }

  std::shared_ptr<const Container> whole_;
  Columns columns_;
  double volume_;
};

}  // namespace

std::shared_ptr<const Container> above_spheres(std::shared_ptr<const Container> whole,
                                               const Spheres<3>& spheres, const Vector<3>& up) {
  return std::make_shared<AboveSpheres>(std::move(whole), spheres, up);
}

}  // namespace bernal
