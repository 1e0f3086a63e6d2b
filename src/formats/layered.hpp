#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/format.hpp"

namespace bernal {

/// The spheres of a file, layer by layer. A sphere whose scene names no layers for it is one layer of its own
/// material.
struct LayeredSpheres {
  /// A layer that the scene names, or the spheres of a class without any.
  struct Kind {
    std::string name;  ///< "kernel", or "kernel of fuel" where several classes have a layer of that name
    std::uint32_t material = 0;  ///< its place in `materials`
  };

  std::vector<std::size_t> first = {};  ///< one entry a sphere, and one more: where its layers begin
  std::vector<double> outer = {};       ///< where each ends, in the file's unit; the last is the radius there
  std::vector<std::uint32_t> kind = {};  ///< of each, its place in `kinds`
  std::vector<Kind> kinds = {};
  std::vector<std::string> materials = {};

  std::span<const double> of(std::size_t sphere) const {
    return {outer.data() + first[sphere], outer.data() + first[sphere + 1]};
  }
};

/// Whether the file holds the layers of spheres one by one: the scene names some, and the output does not
/// leave them out.
bool shows_layers(const Exported&);

/// The balls of one layer, of that name: their outer ones, then those that are hollow within it.
struct BallsOfLayer {
  Spheres<dynamic> balls;
  std::size_t outer = 0;
};
BallsOfLayer balls_of_layer(const Exported&, const std::string& name);

/// Layers shrink as their spheres do where contacts are treated. Throws as `layers_of`.
LayeredSpheres layered(const Exported&);

}  // namespace bernal
