#include "describe.hpp"

#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

using namespace bernal;

namespace {

std::string shown(const Value& value) {
  struct {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
    std::string operator()(double v) const { return fmt::format("{}", v); }
    std::string operator()(const std::string& v) const { return v; }
    std::string operator()(const std::vector<double>& v) const {
      return fmt::format("[{}]", fmt::join(v, ", "));
    }
  } show;
  return std::visit(show, value);
}

}  // namespace

std::string describe_container(const Plan& plan) {
  const std::string& unit = plan.scene.unit;
  const Vector<dynamic> size = extent_of(plan.domain);
  std::string text(kind_of(plan.domain));
  if (plan.scene.container.has("file")) text += fmt::format(" {}", plan.scene.container.text("file"));
  if (plan.box_follows) text += ", as large as the packing needs: about";
  return fmt::format("{}, {:.6g} {}, volume {:.6g} {}^{}", text, fmt::join(size, " x "), unit,
                     volume_of(plan.domain), unit, size.size());
}

std::string describe_sizes(const Scene& scene) {
  std::string text = fmt::format("{} in {}: {}", scene.sizes_are_diameters ? "diameter" : "radius",
                                 scene.unit, scene.sizes.name);
  for (const auto& [key, parameter] : scene.sizes.parameters)
    text += fmt::format(", {} {}", key, shown(parameter.value));
  return text;
}

std::string describe_target(const Scene& scene) {
  if (scene.target.count) return grouped(static_cast<std::uint64_t>(*scene.target.count));
  if (scene.target.packing_fraction)
    return fmt::format("up to packing fraction {}", *scene.target.packing_fraction);
  return "as many as fit";
}
