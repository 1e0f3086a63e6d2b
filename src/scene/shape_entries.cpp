#include <fmt/format.h>

#include "scene/scene_entries.hpp"

namespace bernal::schema {
namespace {

/// The profile as one line.
Member profile_member() {
  Member member;
  member.get = [](const void* lathed) -> std::optional<Value> {
    const auto& lines = static_cast<const Lathed*>(lathed)->profile;
    return lines.empty() || lines.front().empty() ? std::nullopt
                                                  : std::optional<Value>(Polygon{{lines.front()}});
  };
  member.set = [](void* lathed, const Value& value) {
    static_cast<Lathed*>(lathed)->profile = {std::get<Polygon>(value).loops.front()};
  };
  return member;
}

/// Says what the shape itself refuses, at the key that it is about.
template <class Shape>
void require_solid(const Shape& shape, const Section& section, std::string_view key) {
  try {
    solid_of(shape);
  } catch (const Error& error) {
    section.fail(section.locations.keys.contains(key) ? key : "",
                 fmt::format("{}: {}", section.name, error.what()));
  }
}

void cone_rule(const Cone& cone, const Section& section) {
  if (cone.radii.size() != 2)
    section.refuse("radii", "must be two, at the base and at the top: [r0, r1], one of which may be 0");
  require_solid(cone, section, "radii");
}
void tube_rule(const Tube& tube, const Section& section) { require_solid(tube, section, "inner_radius"); }
void lathed_rule(const Lathed& lathed, const Section& section) {
  if (lathed.profile.empty() || lathed.profile.front().empty())
    section.fail("", fmt::format("{} needs a \"profile\", an array of three points [r, z] or more, or a "
                                 "\"file\" of such",
                                 section.name));
  require_solid(lathed, section, "profile");
}

template <class Shape>
Key axis_key() {
  return key(Type::direction, &Shape::axis, "axis", "from the base upwards; its length is of no matter");
}

}  // namespace

Entry cone_entry() {
  return entry<Cone>(
      {.name = "cone",
       .help = "a circular cone or frustum along any axis",
       .keys = {required(of_quantity(Quantity::length,
                                     key(Type::amounts, &Cone::radii, "radii",
                                         "at the base and at the top, [r0, r1]; one of them may be 0"))),
                required(length(&Cone::height, "height", "its length along the axis")), axis_key<Cone>(),
                key(Type::position, &Cone::base, "base", "the middle of its base"), obstacles_key()},
       .rule = rule(cone_rule)});
}

Entry tube_entry() {
  return entry<Tube>(
      {.name = "tube",
       .help = "what is between two cylinders of one axis: an annulus with a floor and a lid",
       .keys = {required(length(&Tube::radius, "radius", "that of the outer wall")),
                required(length(&Tube::inner_radius, "inner_radius", "that of the inner wall")),
                required(length(&Tube::height, "height", "its length along the axis")), axis_key<Tube>(),
                key(Type::position, &Tube::base, "base", "the middle of its base"), obstacles_key()},
       .rule = rule(tube_rule)});
}

Entry lathed_entry() {
  return entry<Lathed>(
      {.name = "revolved",
       .help = "what a profile sweeps over as it turns about an axis: a hopper, a flask, a vessel",
       .keys = {key(Type::points, profile_member(), "profile",
                    "points [r, z] in order: the distance from the axis, and the height over the base; a "
                    "wall r(z), which level ends close, where every point is higher than the one before; "
                    "with one end on the axis a level line closes it; else the line between its ends"),
                {.name = "file", .type = Type::file, .help = "two columns, r and z: the profile's points"},
                axis_key<Lathed>(),
                key(Type::position, &Lathed::base, "base", "the point of the axis where z is 0"),
                obstacles_key()},
       .choices = {{{"profile"}, {"file"}}},
       .rule = rule(lathed_rule)});
}

}  // namespace bernal::schema
