#pragma once
#include <array>
#include <string_view>

#include "scene/entry.hpp"
#include "scene/known_words.hpp"

namespace bernal::schema {

// Everything that a scene may say, but for its stages. The reader, its errors, the defaults, the writer and
// the reference all follow these.

/// The keys at the top, before any table; [spheres]; [accuracy]. All of them of a Scene.
const Entry& scene_entry();
const Entry& spheres_entry();
const Entry& accuracy_entry();
const std::array<const Entry*, 3>& own_entries();

/// Of a Zone: where it lies; and what else it may say, of its `spheres`.
const Entry& zone_entry();
const Entry& spheres_of_zone_entry();

/// Of an Inside.
const Entry& inside_entry();

/// In the order of the alternatives of SceneContainer, SceneSizes and SceneEngine.
const std::vector<Entry>& container_entries();
const std::vector<Entry>& size_entries();
const std::vector<Entry>& engine_entries();
Entry polygon_entry();
Entry cone_entry();
Entry tube_entry();
Entry lathed_entry();
Entry extruded_entry();

/// Keys of a SceneContainer: what it may have taken out of it, and the radius of its edges.
Key obstacles_key();
Key rounding_key();
/// Those that may have obstacles, and be such themselves.
std::vector<KnownWord> kinds_of_solids();

/// What stands for a key that a distribution has not but other programs have, "; write …"; empty where
/// nothing is known of it. `number` is what the table gives to a key.
std::string instead_of(const Entry& sizes, std::string_view key,
                       const std::function<std::optional<double>(std::string_view)>& number);

inline const Entry& entry_of(const SceneContainer& container) {
  return container_entries()[container.index()];
}
/// What to call a container: a shape that is no Domain of its own, and one that obstacles or a rounding made
/// another, by the scene's word.
inline std::string_view word_of(const SceneContainer& container, const Domain& domain) {
  const bool is_shape = container.rounding > 0 || !container.obstacles.empty() ||
                        std::holds_alternative<Cone>(container) || std::holds_alternative<Tube>(container) ||
                        std::holds_alternative<Lathed>(container) ||
                        std::holds_alternative<Extruded>(container);
  return is_shape ? entry_of(container).name : kind_of(domain);
}
inline const Entry& entry_of(const SceneSizes& sizes) { return size_entries()[sizes.index()]; }
inline const Entry& entry_of(const SceneEngine& engine) { return engine_entries()[engine.index()]; }

/// The struct that a variant holds.
template <class... T>
void* options_of(std::variant<T...>& of) {
  return std::visit([](auto& options) -> void* { return &options; }, of);
}
template <class... T>
const void* options_of(const std::variant<T...>& of) {
  return std::visit([](const auto& options) -> const void* { return &options; }, of);
}
/// Makes it hold its n-th alternative.
template <class... T>
void hold(std::variant<T...>& of, std::size_t n) {
  using Variant = std::variant<T...>;
  static constexpr void (*make[])(Variant&) = {[](Variant& v) { v.template emplace<T>(); }...};
  make[n](of);
}

}  // namespace bernal::schema
