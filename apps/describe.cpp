#include "describe.hpp"

#include <algorithm>
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
      constexpr std::size_t most = 8;
      if (v.size() <= most) return fmt::format("[{}]", fmt::join(v, ", "));
      return fmt::format("[{}, … {} numbers … {}]", fmt::join(v.begin(), v.begin() + 3, ", "), v.size() - 4,
                         v.back());
    }
  } show;
  return std::visit(show, value);
}

std::string shown(const Spec& sizes) {
  std::string text = sizes.name;
  for (const auto& [key, parameter] : sizes.parameters)
    text += fmt::format(", {} {}", key, shown(parameter.value));
  if (sizes.parts.empty()) return text;
  std::vector<std::string> parts;
  for (const Spec& part : sizes.parts) parts.push_back(fmt::format("({})", shown(part)));
  return text + fmt::format(", of {}", fmt::join(parts, " and "));
}

}  // namespace

std::string describe_container(const Plan& plan) {
  const std::string& unit = plan.scene.unit;
  const Vector<dynamic> size = bounds_of<dynamic>(plan.domain).size();
  std::string text(is_periodic(plan.domain) && has_walls(plan.domain) ? name_of(plan.domain)
                                                                      : std::string(kind_of(plan.domain)));
  if (plan.scene.container.has("file")) text += fmt::format(" {}", plan.scene.container.text("file"));
  if (plan.box_follows) text += ", as large as the packing needs";
  return fmt::format("{}{} {:.6g} {}, volume {:.6g} {}^{}", text, plan.box_follows ? ": about" : ",",
                     fmt::join(size, " x "), unit, volume_of(plan.domain), unit, size.size());
}

std::string describe_sizes(const Scene& scene) {
  return fmt::format("{} in {}: {}{}", scene.sizes_are_diameters ? "diameter" : "radius", scene.unit,
                     shown(scene.sizes), scene.draw == "random" ? "" : "; drawn by " + scene.draw);
}

std::string describe_target(const Scene& scene) {
  std::string fraction;
  if (scene.target.packing_fraction)
    fraction = fmt::format("packing fraction {}{}", *scene.target.packing_fraction,
                           scene.target.predicted ? ", the predicted one less its error" : "");
  if (scene.target.count) {
    const std::string count = grouped(static_cast<std::uint64_t>(*scene.target.count));
    return fraction.empty() ? count : count + " at " + fraction;
  }
  if (!fraction.empty()) return "up to " + fraction;
  if (scene.target.fill) return "as many as can be made to fit";
  const bool expects = std::ranges::any_of(
      scene.stages, [](const Spec& stage) { return stage.name == "relax" || stage.name == "grow"; });
  return expects && !scene.is_periodic() ? "as many as are expected to fit" : "as many as fit";
}
