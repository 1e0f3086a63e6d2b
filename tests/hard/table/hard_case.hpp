#pragma once
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "bernal/plan/plan.hpp"
#include "bernal/verify/certificate.hpp"

// The hard suite: one named case a row, why it is hard, and how it must end. The test asserts that it does;
// `tests/hard/table/write` makes data/results/hard.md of the same rows.
namespace bernal::hard {

/// How a case must end.
struct Expected {
  enum class Kind {
    packed,     ///< what was asked for is there: `bernal pack` ends with 0
    explained,  ///< a certified packing; where it is less than was asked for, the reason says so: 0 or 3
    refused     ///< one line, before anything is packed: 2
  };
  Kind kind = Kind::packed;
  std::size_t least = 1, most = std::numeric_limits<std::size_t>::max();  ///< spheres
  std::string words = {};                                                 ///< in what is said
  std::optional<double> volume = {};                                      ///< of the container
  double within = 1e-6;                                                   ///< of that volume
  std::optional<Vector<3>> lower = {};  ///< corner of the container's bounds, to a millionth of its diagonal
};

inline Expected exactly(std::size_t n) { return {.least = n, .most = n}; }
inline Expected at_least(std::size_t n) { return {.least = n}; }
inline Expected explained(std::size_t least = 0) { return {Expected::Kind::explained, least}; }
inline Expected refused(std::string words) {
  return {.kind = Expected::Kind::refused, .words = std::move(words)};
}
inline Expected of_volume(Expected expected, double volume, double within = 1e-6) {
  expected.volume = volume;
  expected.within = within;
  return expected;
}

struct File {
  std::string name;
  std::function<std::string()> content;
};

struct Case {
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.why; }

  std::string group, name;
  std::string why;  ///< it is hard
  std::string
      scene;  ///< in TOML; finds `files` beside it; `{offered}` is the line that `bernal inspect` offers
  Expected expected;
  std::vector<File> files = {};
  std::string offered = {};  ///< the line that took the place of `{offered}`, see `with_offered_line`
};

std::vector<Case> all_cases();

std::vector<Case> tight_cases();
std::vector<Case> thin_cases();
std::vector<Case> far_and_scaled_cases();
std::vector<Case> size_cases();
std::vector<Case> count_cases();
std::vector<Case> refusal_cases();
std::vector<Case> mesh_cases();
std::vector<Case> broken_mesh_cases();
std::vector<Case> format_cases();
std::vector<Case> model_cases();

/// How a case ended once.
struct End {
  WallArithmetic walls = WallArithmetic::filtered;
  std::string refusal;  ///< where it was refused
  std::size_t spheres = 0;
  double packing_fraction = 0, volume = 0;
  Bounds<3> bounds = {};
  Outcome outcome = Outcome::converged;
  std::string reason;
  Certificate certificate;      ///< in exact arithmetic
  std::string plain_objection;  ///< of the independent check in plain double; empty if it has none
  double seconds = 0;           ///< to read, build and run
};

/// The levels of arithmetic for walls that a case is run at: one in a periodic box and where it is to be
/// refused.
std::vector<WallArithmetic> levels_of(const Case&);
/// The case with `{offered}` replaced, if it has that; costs what `bernal inspect` does.
Case with_offered_line(Case);
/// Precondition: `{offered}` is replaced.
End end_of(const Case&, WallArithmetic);

/// What is wrong with an end; empty if nothing is.
std::string objection(const Case&, const End&);

// What the rows are written with.

/// A scene in millimetres.
std::string scene(const std::string& container, const std::string& spheres, const std::string& rest = "");
std::string stages(std::initializer_list<const char*> names);

struct Protocol {
  std::string name, stages;
};
/// The default and every method alone; Han, Feng & Owen's as in their paper.
const std::vector<Protocol>& protocols();

}  // namespace bernal::hard
