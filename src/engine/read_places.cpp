#include "engine/read_places.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/engine/engine_error.hpp"
#include "files/input_file.hpp"

namespace bernal::engine {
namespace {

class DumpReader {
 public:
  explicit DumpReader(const std::filesystem::path& file) : name_(file.string()), in_(file) {
    if (!in_) throw EngineError("the engine has left no places: see its log", {name_});
  }

  bool next() {
    ++line_number_;
    return static_cast<bool>(std::getline(in_, line_));
  }
  void require(const std::string& what) {
    if (!next())
      fail(fmt::format("the engine's result ends before {}: it was cut off; is the disk full?", what));
  }
  void require_heading(std::string_view heading) {
    require(std::string(heading));
    if (!std::string_view(line_).starts_with(heading))
      fail(fmt::format("the engine's result has no line \"{}\" here", heading));
  }
  /// The numbers of this line, `count` of them.
  template <std::size_t count>
  std::array<double, count> numbers() {
    std::array<double, count> values{};
    const char* at = line_.data();
    const char* const end = line_.data() + line_.size();
    for (double& value : values) {
      while (at < end && *at == ' ') ++at;
      const auto [next, error] = std::from_chars(at, end, value);
      if (error != std::errc() || !std::isfinite(value))
        fail(
            fmt::format("the engine's result has no finite numbers here: \"{}\"; its motion was not stable, "
                        "or the file was cut off",
                        plain_text(line_, 80)));
      at = next;
    }
    return values;
  }
  bool is_whole() const { return !in_.eof(); }
  [[noreturn]] void fail(const std::string& why) const { throw EngineError(why, {name_, line_number_}); }

 private:
  std::string name_;
  InputFile in_;
  std::string line_;
  int line_number_ = 0;
};

}  // namespace

void read_places(const std::filesystem::path& file, std::uint64_t count, bool tells_radii,
                 const std::function<void(const Bounds<3>& box, const PlacedByEngine&)>& take) {
  DumpReader in(file);
  in.require_heading("ITEM: TIMESTEP");
  in.require("the step");
  in.require_heading("ITEM: NUMBER OF ATOMS");
  in.require("the number of spheres");
  if (const double there = in.numbers<1>()[0]; there != static_cast<double>(count))
    in.fail(
        fmt::format("the engine has lost spheres: {:.0f} of {} are left; give fewer \"ranks\", or another "
                    "\"seed\"",
                    there, count));
  in.require_heading("ITEM: BOX BOUNDS");
  Bounds<3> box;
  for (int k = 0; k < 3; ++k) {
    in.require("the box");
    const auto [lower, upper] = in.numbers<2>();
    if (!(lower < upper)) in.fail("the engine's box is empty");
    box.lower[k] = lower;
    box.upper[k] = upper;
  }
  in.require_heading(tells_radii ? "ITEM: ATOMS id x y z radius" : "ITEM: ATOMS id x y z");
  std::vector<bool> there(count, false);
  for (std::uint64_t n = 0; n < count; ++n) {
    in.require(fmt::format("sphere {} of {}", n + 1, count));
    std::array<double, 5> row{};
    if (tells_radii) {
      row = in.numbers<5>();
    } else {
      const auto places = in.numbers<4>();
      std::ranges::copy(places, row.begin());
      row[4] = std::numeric_limits<double>::quiet_NaN();
    }
    const double id = row[0];
    const bool is_known = id >= 1 && id <= static_cast<double>(count) && id == std::floor(id);
    if (!is_known || there[static_cast<std::size_t>(id) - 1])
      in.fail(
          fmt::format("the engine's result has a sphere {:.0f} {}", id, is_known ? "twice" : "that is none"));
    const std::size_t i = static_cast<std::size_t>(id) - 1;
    there[i] = true;
    take(box, {i, {row[1], row[2], row[3]}, row[4]});
    if (n + 1 == count && !in.is_whole())
      in.fail("the engine's result ends within its last line: it was cut off");
  }
}

Places read_places(const std::filesystem::path& file, const std::vector<double>& radii) {
  Places places;
  places.spheres.resize(radii.size());
  places.spheres.r = radii;
  read_places(file, radii.size(), false, [&](const Bounds<3>& box, const PlacedByEngine& sphere) {
    places.box = box;
    places.spheres.set_center(sphere.number, sphere.center);
  });
  return places;
}

}  // namespace bernal::engine
