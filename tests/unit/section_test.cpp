#include "bernal/report/section.hpp"
#include "bernal/result/write_section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <regex>
#include <set>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/result/write_packing.hpp"
#include "support/containers.hpp"
#include "support/folder.hpp"
#include "support/packings.hpp"

namespace bernal {
namespace section_test {

using testing::Folder;
using testing::packing_of;
using testing::scattered;
using testing::text_of;

Vector<3> in_space(const SectionPlane& plane, const Vector<2>& p) {
  return plane.offset * plane.normal + p[0] * plane.right + p[1] * plane.up;
}

/// By the even-odd rule.
bool is_within(const std::vector<std::vector<Vector<2>>>& outline, const Vector<2>& p) {
  bool inside = false;
  for (const auto& loop : outline) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
      if ((a[1] > p[1]) == (b[1] > p[1])) continue;
      inside ^= p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    }
  }
  return inside;
}

/// Axes, oblique, and such as meet corners or run along facets.
std::vector<std::string> planes_for(const Domain& domain) {
  const Vector<3> c = bounds_of(domain).center();
  const double width = bounds_of(domain).size().minCoeff();
  std::vector<std::string> planes;
  const Vector<3> normals[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -2, 3}, {-1, 1, 1}};
  for (const Vector<3>& n : normals)
    for (const double off : {0.0, 0.11, -0.17})
      planes.push_back(
          fmt::format("{} x + {} y + {} z = {}", n[0], n[1], n[2], n.dot(c) + off * width * n.norm()));
  return planes;
}

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Section, OutlineIsWhereTheContainerIs) {
  for (const test::ContainerUnderTest& tested : test::containers_under_test()) {
    const Bounds<3> bounds = bounds_of(tested.shape);
    Random random(3, stream(Stream::test));
    int inside = 0, decided = 0;
    for (const std::string& text : planes_for(tested.shape)) {
      const SectionPlane plane = section_plane(text);
      EXPECT_NEAR(std::abs(plane.right.cross(plane.up).dot(plane.normal)), 1, 1e-14);
      const Section section = section_of(Spheres<3>{}, tested.shape, plane);
      int within = 0;
      Bounds<2> window{section.outline[0][0], section.outline[0][0]};
      for (const auto& loop : section.outline)
        for (const Vector<2>& p : loop) window = {window.lower.cwiseMin(p), window.upper.cwiseMax(p)};
      constexpr int trials = 120;
      for (int k = 0; k < trials; ++k) {
        const Vector<2> p = uniform_point(random, window);
        const Vector<3> q = in_space(plane, p);
        const bool in_bounds =
            (q.array() >= bounds.lower.array()).all() && (q.array() <= bounds.upper.array()).all();
        const auto clearance = static_cast<double>(test::precise_clearance(tested.shape, q));
        within += is_within(section.outline, p);
        if (std::abs(clearance) < 1e-4 || (is_periodic(tested.shape) && !in_bounds)) continue;
        EXPECT_EQ(is_within(section.outline, p), clearance > 0) << tested.name << ", " << text;
        ++decided;
        inside += clearance > 0;
      }
      // Five standard deviations of the share.
      const double share = section.area / window.volume();
      EXPECT_NEAR(within, trials * share, 1 + 5 * std::sqrt(trials * share * (1 - share) + 1e-9))
          << tested.name << ", " << text;
    }
    EXPECT_GT(inside, 20) << tested.name;
    EXPECT_GT(decided, 250) << tested.name;
  }
}

TEST(Section, CirclesAreWhatSpheresLeaveOnThePlane) {
  const Box box{Vector<3>(-1, 2, 0), Vector<3>(10, 8, 9)};
  const Spheres<3> spheres = scattered(400, 0.2, 1.2, bounds_of(box), 5, true);
  Random random(4, stream(Stream::test));
  for (const std::string text : {"y = 5", "z = 4.5", "x + 2 y - 3 z = -2", "2 x = 7"}) {
    const SectionPlane plane = section_plane(text);
    const Section section = section_of(spheres, box, plane);
    ASSERT_GT(section.circles.size(), 20u);
    double area = 0;
    for (const Section::Circle& circle : section.circles) {
      // The circle's points are on the sphere, and its centre on the plane is the foot of the sphere's.
      const Vector<3> foot = in_space(plane, circle.center), c = spheres.center(circle.sphere);
      EXPECT_NEAR((c - foot).cross(plane.normal).norm(), 0, 1e-14 * 30);
      EXPECT_NEAR((foot + circle.radius * plane.right - c).norm(), spheres.r[circle.sphere], 1e-14 * 30);
      area += std::numbers::pi * circle.radius * circle.radius;
    }
    EXPECT_NEAR(section.covered_area, area, 1e-12 * area);
    std::set<std::size_t> cut;
    for (const Section::Circle& circle : section.circles) cut.insert(circle.sphere);
    for (std::size_t i = 0; i < spheres.size(); ++i)
      EXPECT_EQ(cut.contains(i), std::abs(plane.normal.dot(spheres.center(i)) - plane.offset) < spheres.r[i]);
  }
}

/// The mean over parallel planes is the packing fraction (Cavalieri; Delesse 1847), images included.
TEST(Section, MeanAreaFractionOfAPeriodicBoxIsThePackingFraction) {
  const Box box = periodic_box(Vector<3>(6, 5, 7));
  Spheres<3> spheres;
  Random random(9, stream(Stream::test));
  double volume = 0;
  for (int i = 0; i < 12; ++i) {
    spheres.push_back(uniform_point(random, bounds_of(box)), random.uniform(0.5, 2.4));
    volume += 4. / 3 * std::numbers::pi * std::pow(spheres.r.back(), 3);
  }
  constexpr int planes = 700;
  double mean = 0;
  for (int k = 0; k < planes; ++k)
    mean += section_of(spheres, box, section_plane(fmt::format("z = {}", 7 * (k + 0.5) / planes)))
                .area_fraction() /
            planes;
  // Along z the area is a parabola a sphere: the midpoint rule is off by h² / 24 of the jump of its slope,
  // 4 π r at both ends.
  const double h = 7. / planes;
  EXPECT_NEAR(mean, volume / 210, 12 * h * h / 24 * 4 * std::numbers::pi * 2.4 / 30);
}

TEST(Section, ObliquePlanesOfPeriodicDomainsCountWhatIsInThem) {
  const std::vector<Domain> domains = {periodic_box(Vector<3>(6, 5, 7)),
                                       periodic_box(Vector<3>(6, 5, 7), {false, false, true}),
                                       Cylinder{{1, 2, 3}, {0, 0, 1}, 4, 6, true}};
  for (const Domain& domain : domains) {
    const Bounds<3> bounds = bounds_of(domain);
    const Boundary<3> boundary = boundary_of<3>(domain);
    Random random(11, stream(Stream::test));
    Spheres<3> spheres;
    for (int i = 0; i < 20; ++i) {
      const double r = random.uniform(0.4, 1.6);
      Bounds<3> inner = bounds;
      for (int k = 0; k < 3; ++k) {
        const double margin = boundary.repeats(k) ? 0 : std::holds_alternative<Cylinder>(domain) ? 2.2 : r;
        inner.lower[k] += margin;
        inner.upper[k] -= margin;
      }
      spheres.push_back(uniform_point(random, inner), r);
    }
    const SectionPlane plane = section_plane("x + 0.5 y + 2 z = 16");
    const Section section = section_of(spheres, domain, plane);
    Bounds<2> window{section.outline[0][0], section.outline[0][0]};
    for (const Vector<2>& p : section.outline[0])
      window = {window.lower.cwiseMin(p), window.upper.cwiseMax(p)};
    constexpr int trials = 800;
    double covered = 0;
    for (int k = 0; k < trials; ++k) {
      const Vector<2> p = uniform_point(random, window);
      if (!is_within(section.outline, p)) continue;
      for (std::size_t i = 0; i < spheres.size(); ++i)
        for (int image = 0; image < 27; ++image) {
          const Vector<3> shift =
              Vector<3>(image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1).cwiseProduct(boundary.edges);
          if ((!boundary.repeats(0) && image % 3 != 1) || (!boundary.repeats(1) && image / 3 % 3 != 1) ||
              (!boundary.repeats(2) && image / 9 != 1))
            continue;
          covered += (in_space(plane, p) - spheres.center(i) - shift).norm() < spheres.r[i];
        }
    }
    covered *= window.volume() / trials;
    ASSERT_GT(covered, 1) << name_of(domain) << " " << section.covered_area;
    // What one point adds has a variance of at most a few; five standard deviations.
    EXPECT_NEAR(section.covered_area, covered, 5 * 2 * window.volume() / std::sqrt(trials));
  }
}

/// A centre outside of the period stands for its image inside.
TEST(Section, DoesNotDependOnWhichImageIsMeant) {
  const Box box = periodic_box(Vector<3>(6, 5, 7));
  Random random(12, stream(Stream::test));
  Spheres<3> inside, shifted;
  for (int i = 0; i < 40; ++i) {
    const Vector<3> c = uniform_point(random, bounds_of(box));
    inside.push_back(c, random.uniform(0.3, 1.2));
    const Vector<3> periods(i % 5 - 2, i % 3 - 1, i % 7 - 3);
    shifted.push_back(c + periods.cwiseProduct(Vector<3>(6, 5, 7)), inside.r.back());
  }
  for (const std::string text : {"z = 1.5", "x = 0", "y = 5", "x + 0.5 y + 2 z = 11"}) {
    const SectionPlane plane = section_plane(text);
    const Section here = section_of(inside, box, plane), there = section_of(shifted, box, plane);
    EXPECT_GT(here.circles.size(), 5u);
    EXPECT_EQ(there.circles.size(), here.circles.size()) << text;
    EXPECT_NEAR(there.covered_area, here.covered_area, 1e-9) << text;
  }
}

TEST(Section, APlaneInAFaceCutsThatFace) {
  const Box box{{0, 0, 0}, {10, 8, 6}};
  const Domain mesh = test::box_mesh({0, 0, 0}, {10, 8, 6});
  for (const Domain& domain : {Domain(box), mesh})
    for (const auto& [text, area] :
         {std::pair{"z = 0", 80.0}, {"z = 6", 80.0}, {"x = 0", 48.0}, {"x = 10", 48.0}})
      EXPECT_NEAR(section_of(Spheres<3>{}, domain, section_plane(text)).area, area, 1e-12 * area) << text;
  const Cylinder cylinder{{0, 0, 0}, {0, 0, 1}, 2, 5};
  const double lid = section_of(Spheres<3>{}, cylinder, section_plane("z = 0")).area;
  EXPECT_EQ(section_of(Spheres<3>{}, cylinder, section_plane("z = 5")).area, lid);
  EXPECT_THROW(section_of(Spheres<3>{}, cylinder, section_plane("z = 5.1")), Error);
  // At the end of a period stands what stands at its begin.
  Spheres<3> spheres;
  spheres.push_back({5, 4, 0.5}, 1);
  const Box periodic = periodic_box(Vector<3>(10, 8, 6));
  EXPECT_EQ(section_of(spheres, periodic, section_plane("z = 6")).covered_area,
            section_of(spheres, periodic, section_plane("z = 0")).covered_area);
}

TEST(Section, PlanesOfAnyScaleAreTheSame) {
  const SectionPlane plain = section_plane("x + y = 3");
  for (const std::string factor : {"1e200", "1e300", "1e-200", "1e-300", "3"}) {
    const SectionPlane plane =
        section_plane(fmt::format("{0} x + {0} y = {1}", factor, 3 * std::stod(factor)));
    EXPECT_NEAR((plane.normal - plain.normal).norm(), 0, 1e-15) << factor;
    EXPECT_NEAR(plane.offset, plain.offset, 1e-15) << factor;
  }
  EXPECT_EQ(section_plane("1e200 z = 3e200").offset, 3);
  EXPECT_EQ(section_plane("2 x = 7").offset, 3.5);
}

TEST(Section, TheMiddleIsSeenFromTheSide) {
  const auto text = [](const Domain& domain) { return middle_plane(domain).text; };
  EXPECT_EQ(text(Box{{1, 2, 3}, {4, 4, 4}}), "y = 4");
  EXPECT_EQ(text(Cylinder{{0, 0, 0}, {0, 0, 1}, 1, 2}), "y = 0");
  EXPECT_EQ(text(periodic_box(Vector<3>(2, 4, 8))), "z = 4");
  EXPECT_EQ(text(periodic_box(Vector<3>(2, 4, 8), {false, false, true})), "y = 2");
  EXPECT_EQ(text(periodic_box(Vector<3>(2, 4, 8), {false, true, false})), "x = 1");
  // Two cubes with nothing in the middle between them: through one of them.
  Mesh apart = test::box_mesh({0, 0, 0}, {1, 1, 1});
  test::append(apart, test::box_mesh({0, 5, 0}, {1, 1, 1}));
  EXPECT_NEAR(section_of(Spheres<3>{}, apart, middle_plane(apart)).area, 1, 1e-14);
  EXPECT_EQ(middle_plane(Box{}).right, Vector<3>(1, 0, 0));
  EXPECT_EQ(middle_plane(Box{}).up, Vector<3>(0, 0, 1));
}

TEST(Section, WhatIsNoSectionIsRefused) {
  const Packing packing = packing_of(scattered(30, 0.5, 1, bounds_of(Box{{0, 0, 0}, {10, 10, 10}}), 2),
                                     Box{{0, 0, 0}, {10, 10, 10}});
  const Folder folder;
  const auto said = [&](std::string_view plane) {
    return error_of([&] { write_section(packing, plane, folder / "a.svg"); });
  };
  EXPECT_EQ(said("z = 11"),
            "the plane \"z = 11\" does not meet the box, which reaches from 0, 0, 0 to 10, 10, 10");
  EXPECT_NE(said("z < 3").find("a section is asked for as"), std::string::npos);
  EXPECT_NE(said("the middle").find("is no plane"), std::string::npos);
  EXPECT_EQ(said("the middle").find('<'), std::string::npos);  // a side is no section
  EXPECT_NE(said("").find("is no plane"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.svg"));
  folder.write("a.svg", "mine");
  EXPECT_NE(said("z = 3").find("is no picture"), std::string::npos);
  EXPECT_EQ(text_of(folder / "a.svg"), "mine");
  std::filesystem::remove(folder / "a.svg");
  EXPECT_EQ(said("z = 3"), "");
  const std::string first = text_of(folder / "a.svg");
  EXPECT_EQ(said("z = 4"), "");
  EXPECT_NE(text_of(folder / "a.svg"), first);
}

TEST(Section, IsWrittenAsSvgAndNotOverAResult) {
  const Packing packing = packing_of(scattered(30, 0.5, 1, bounds_of(Box{{0, 0, 0}, {10, 10, 10}}), 2),
                                     Box{{0, 0, 0}, {10, 10, 10}});
  const Folder folder;
  const auto said = [&](std::string_view name) {
    return error_of([&] { write_section(packing, "z = 3", folder / name); });
  };
  for (const char* name : {"a.png", "a", "svg"}) {
    EXPECT_NE(said(name).find("ends in .svg"), std::string::npos) << name;
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
  EXPECT_EQ(said("a.SVG"), "");
  write_packing(packing, folder / "out");
  for (const char* name : {"out/packing.svg", "out/section.svg"}) {
    const std::string before = text_of(folder / name);
    EXPECT_NE(said(name).find("belongs to the result there"), std::string::npos) << said(name);
    EXPECT_EQ(text_of(folder / name), before);
  }
  EXPECT_EQ(said("out/z.svg"), "");
}

TEST(Section, CaptionsGiveLengthsTheirUnit) {
  const Box box{{0, 0, 0}, {10, 10, 10}};
  Spheres<3> spheres;
  spheres.push_back({5, 5, 5}, 2);
  const auto caption = [&](std::string_view plane) {
    const std::string svg = section_svg(section_of(spheres, box, section_plane(plane)), spheres, "mm");
    const std::size_t end = svg.find("   ·");
    return svg.substr(svg.rfind('>', end) + 1, end - svg.rfind('>', end) - 1);
  };
  EXPECT_EQ(caption("y = 5"), "y = 5 mm");
  EXPECT_EQ(caption("y=5.5e0"), "y=5.5e0 mm");
  EXPECT_EQ(caption("x=y"), "x=y");
  EXPECT_EQ(caption("x = 2 y"), "x = 2 y");
}

TEST(Section, WhatSticksOutLeavesTheWordsClear) {
  // A sphere of the box's own size: its images reach far beyond.
  Spheres<3> spheres;
  spheres.push_back({0.2, 0.2, 5}, 4.9);
  const Section section = section_of(spheres, periodic_box(Vector<3>(10, 10, 10)), section_plane("z = 5"));
  const std::string svg = section_svg(section, spheres, "mm");
  static const std::regex inner("<svg x=\"([^\"]+)\" y=\"([^\"]+)\" width=\"([^\"]+)\" height=\"([^\"]+)\"");
  static const std::regex canvas("viewBox=\"0 0 ([0-9.]+) ([0-9.]+)\"");
  std::smatch window, all;
  ASSERT_TRUE(std::regex_search(svg, window, inner));
  ASSERT_TRUE(std::regex_search(svg, all, canvas));
  const auto value = [](const std::smatch& match, std::size_t k) { return std::stod(match[k]); };
  EXPECT_GE(value(window, 1), 12);
  EXPECT_LE(value(window, 1) + value(window, 3), value(all, 1) - 12 + 0.01);
  EXPECT_GE(value(window, 2), 12 + 36);                                            // the caption
  EXPECT_LE(value(window, 2) + value(window, 4), value(all, 2) - 52 - 12 + 0.51);  // scale bar and key
}

TEST(Section, PictureHasEveryCircleAndWhatItIs) {
  const Box box{{0, 0, 0}, {10, 10, 10}};
  Spheres<3> spheres;
  spheres.push_back({5, 4, 5}, 2);
  spheres.push_back({2, 5, 2}, 1);
  spheres.push_back({8, 9.5, 8}, 1);
  const auto picture = [&](const Domain& domain, std::string_view plane) {
    return section_svg(section_of(spheres, domain, section_plane(plane)), spheres, "mm");
  };
  static const std::regex circle("<circle cx=\"([^\"]+)\" cy=\"([^\"]+)\" r=\"([^\"]+)\"/>");
  const auto circles = [](const std::string& svg) {
    const std::string discs = svg.substr(0, svg.find("<g font-family"));
    return std::distance(std::sregex_iterator(discs.begin(), discs.end(), circle), std::sregex_iterator());
  };
  const std::string walls = picture(box, "y = 5");
  EXPECT_EQ(circles(walls), 2);
  EXPECT_EQ(walls.find("clip-path"), std::string::npos);
  // π (4 - 1) + π of 100
  EXPECT_NE(walls.find("y = 5 mm   ·   area fraction 0.1257   ·   2 circles"), std::string::npos) << walls;
  EXPECT_NE(picture(periodic_box(Vector<3>(10, 10, 10)), "x = 8").find("clip-path"), std::string::npos);
  EXPECT_EQ(circles(picture(box, "z = 0.5")), 0);
}

TEST(Section, PictureOfVeryManyCirclesIsOfACorner) {
  const auto picture = [](int across) {
    Spheres<3> spheres;
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < across; ++j) spheres.push_back({i + 0.5, j + 0.5, 0.5}, 0.45);
    const Box box{Vector<3>::Zero(), Vector<3>(across, across, 1)};
    return section_svg(section_of(spheres, box, section_plane("z = 0.5")), spheres, "mm");
  };
  const std::string all = picture(170), corner = picture(340);
  EXPECT_EQ(all.find("a corner"), std::string::npos);
  EXPECT_NE(corner.find("a corner, 0.51 of the edges"), std::string::npos);
  EXPECT_NE(corner.find("115,600 circles"), std::string::npos);
  EXPECT_LT(corner.size(), all.size() + all.size() / 10);
}

}  // namespace section_test
}  // namespace bernal
