#include "bernal/measure/slab.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/quantity.hpp"
#include "bernal/core/text.hpp"
#include "cad/repair/plane_cut.hpp"
#include "measure/localised.hpp"
#include "measure/volume_in.hpp"

namespace bernal {
namespace {

/// What follows the number that a text begins with; the whole of it where there is none.
std::string_view behind_number(std::string_view text) {
  double value;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? text.substr(static_cast<std::size_t>(end - text.data())) : text;
}

/// "40", "40 mm"
std::optional<double> length_in(std::string_view text, Unit unit) {
  const std::string_view length = trimmed(text);
  double value;
  const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), value);
  if (error == std::errc() && end == length.data() + length.size()) return value;
  std::string complaint;
  return number_with_unit(length, Quantity::length, unit, complaint);
}

std::vector<bool> centers_between(const LowerPart& part, const Spheres<dynamic>& spheres) {
  std::vector<bool> inside(spheres.size());
  Vector<3> center = Vector<3>::Zero();  // two dimensions lie in the plane z = 0
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    center.head(spheres.dimension()) = spheres.center(i);
    inside[i] = part.contains(center);
  }
  return inside;
}

}  // namespace

LowerPart slab_in(std::string_view text, Unit unit) {
  const auto refuse = [&] {
    return Error(
        ErrorCode::bad_argument,
        fmt::format("\"{:.60}\" is no slab; write \"z = 10..40\", \"x = -5 mm..5 mm\" or \"z < 20\"", text));
  };
  const std::size_t sign = text.find_first_of("=<>");
  if (sign == text.npos) throw refuse();
  std::string_view right = text.substr(sign + 1);
  if (text[sign] != '=' && right.starts_with('=')) right.remove_prefix(1);  // <= means the same as <
  const auto plane_at = [&](std::string_view where) {
    const std::optional<double> length = length_in(where, unit);
    if (!length) throw refuse();
    try {
      return cad::plane_in(fmt::format("{} {} {}", text.substr(0, sign), text[sign], *length));
    } catch (const Error&) {
      throw refuse();
    }
  };
  const std::size_t dots = right.find("..");
  if ((text[sign] == '=') != (dots != right.npos)) throw refuse();
  if (dots == right.npos) {
    const cad::CutPlane plane = plane_at(right);  // normal · p <= offset stays
    if (text[sign] == '<') return {-plane.normal, plane.offset};
    return {plane.normal, std::numeric_limits<double>::infinity(), -plane.offset};
  }
  // A unit behind the second length is that of the first, too: "10..40 mm".
  std::string from(trimmed(right.substr(0, dots)));
  const std::string_view to = trimmed(right.substr(dots + 2));
  if (behind_number(from).empty()) from += behind_number(to);
  const cad::CutPlane lower = plane_at(from), upper = plane_at(to);
  if (!(lower.offset < upper.offset)) throw refuse();
  return {-upper.normal, upper.offset, lower.offset};
}

Slab measure_slab(const LowerPart& asked, const Spheres<dynamic>& spheres, const Domain& domain,
                  std::span<const double> contact_gaps, double gap) {
  const Vector<3>& down = asked.direction;
  if (!has_ends_along(domain, down) || (dimension_of(domain) == 2 && down[2] != 0))
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("a slab of the {} needs walls on either side, and there are none", name_of(domain)));
  const Frame frame = frame_of(domain);
  const VolumeBelow below(to_local(domain, frame), down);
  const double origin = asked.height_of(frame.origin);
  const double lowest = frame.scale * below.lowest() + origin,
               highest = frame.scale * below.highest() + origin;
  const LowerPart part{down, std::min(asked.height, highest), std::max(asked.from, lowest)};
  const LowerPart local = part.to_local(frame);
  const double volume = part.from < part.height ? volume_in(local, below) : 0;
  if (!(volume > 0))
    throw Error(ErrorCode::bad_argument,
                fmt::format("the slab holds nothing of the {}, which reaches from {:.6g} to {:.6g} across it",
                            name_of(domain), lowest, highest));
  return {part, filled_in(local, spheres.dimension(), localised(spheres, frame)) / volume,
          contacts_of_some(centers_between(part, spheres), gap, spheres, domain, contact_gaps)};
}

}  // namespace bernal
