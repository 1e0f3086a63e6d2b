#include "formats/level_layers.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"

namespace bernal {
namespace level_layers {

using Kinds = std::vector<ShellsInFile>;
using Which = std::vector<std::uint32_t>;

/// What is the same of every sphere: a length, to rounding of its radius, or a share; else nothing.
std::optional<double> common(const std::vector<double>& radii, const std::function<double(std::size_t)>& of,
                             bool is_length) {
  constexpr double rounding = 1e-12;
  const double first = of(0);
  for (std::size_t i = 1; i < radii.size(); ++i)
    if (std::abs(of(i) - first) > rounding * (is_length ? radii[i] : 1)) return std::nullopt;
  return first;
}

/// A name for each shell: its material's, with a number where others are of that too.
std::vector<Layer> named(const std::vector<std::string>& materials, const DensitiesInFile& densities) {
  std::vector<Layer> layers;
  for (const std::string& material : materials) {
    Layer& layer = layers.emplace_back(Layer{.name = material});
    const auto is_taken = [&](const Layer& other) { return &other != &layer && other.name == layer.name; };
    for (int k = 2; std::ranges::any_of(layers, is_taken); ++k)
      layer.name = fmt::format("{} {}", material, k);
    if (layer.name != material) layer.material = material;
    if (const auto known = densities.find(material); known != densities.end())
      layer.material_density = known->second;
  }
  return layers;
}

/// Says where the layers end, by what is the same of all spheres; one of them takes what the others leave.
/// False where more than one would have to.
bool place(std::vector<Layer>& layers, const Kinds& kinds, const Which& which,
           const std::vector<double>& radii) {
  const std::size_t n = layers.size();
  for (std::size_t k = 0; k < n; ++k) {
    const auto outer = [&](std::size_t i) { return k + 1 == n ? radii[i] : kinds[which[i]].ends[k]; };
    const auto inner = [&](std::size_t i) { return k == 0 ? 0.0 : kinds[which[i]].ends[k - 1]; };
    const auto cube = [&](std::size_t i, double x) { return std::pow(x / radii[i], 3); };
    layers[k].radius = common(radii, outer, true);
    if (const auto thickness = common(
            radii, [&](std::size_t i) { return outer(i) - inner(i); }, true))
      layers[k].thickness = Normal{.mean = *thickness};
    layers[k].share = common(
        radii, [&](std::size_t i) { return cube(i, outer(i)) - cube(i, inner(i)); }, false);
  }
  std::size_t open = n;  // the outermost that may be: radii are counted from the centre
  while (open-- > 0) {
    const auto within = layers.begin() + static_cast<std::ptrdiff_t>(open);
    const bool are_said =
        std::all_of(layers.begin(), within,
                    [](const Layer& of) { return of.radius || of.thickness || of.share; }) &&
        std::all_of(within + 1, layers.end(), [](const Layer& of) { return of.thickness || of.share; });
    if (are_said) break;
  }
  if (open >= n) return false;
  for (std::size_t k = 0; k < n; ++k) {  // one way of saying it
    Layer& layer = layers[k];
    if (k >= open) layer.radius.reset();
    if (k == open || layer.radius) layer.thickness.reset();
    if (k == open || layer.radius || layer.thickness) layer.share.reset();
  }
  return true;
}

bool is_whole(const ShellsInFile& of, double radius) {
  if (of.ends.size() + 1 != of.materials.size()) return false;
  double inner = 0;
  for (const double end : of.ends) {
    if (!(end > inner && end < radius)) return false;
    inner = end;
  }
  return true;
}

}  // namespace level_layers

void take_layers(FileContents& contents, const std::vector<ShellsInFile>& kinds,
                 const std::vector<std::uint32_t>& which, const DensitiesInFile& densities) {
  const auto note = [&](const char* about, std::string text) {
    contents.notes.push_back({about, std::move(text)});
  };
  const std::vector<double>& radii = contents.spheres.r;
  for (std::size_t i = 0; i < which.size(); ++i)
    if (!level_layers::is_whole(kinds[which[i]], radii[i]))
      return note("layers",
                  fmt::format("are not taken over: what sphere {} holds is not as bernal wrote it", i));
  const auto filled = std::ranges::count_if(which, [&](std::uint32_t k) { return kinds[k].is_filled; });
  if (filled > 0)
    note("inside",
         fmt::format("the packings in {} of {} spheres are not taken over; ‹level› reads each by itself",
                     grouped(static_cast<std::uint64_t>(filled)), grouped(which.size())));
  const auto is_layered = [&](std::uint32_t k) { return kinds[k].materials.size() > 1; };
  if (std::ranges::none_of(which, is_layered)) return;
  const std::vector<std::string>& materials = kinds[which.front()].materials;
  if (std::ranges::any_of(which, [&](std::uint32_t k) { return kinds[k].materials != materials; }))
    return note("layers", "are not taken over: some spheres have others than the rest");
  std::vector<Layer> layers = level_layers::named(materials, densities);
  if (!level_layers::place(layers, kinds, which, radii))
    return note("layers",
                "are not taken over: they differ from sphere to sphere, as those of drawn thickness do");
  std::vector<std::string_view> names;
  for (const Layer& layer : layers) names.push_back(layer.name);
  note("layers", fmt::format("{}", fmt::join(names, ", ")));
  contents.layers = std::move(layers);
}

}  // namespace bernal
