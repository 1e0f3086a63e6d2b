#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "bernal/core/error.hpp"

namespace bernal {

/// The sizes that a scene says on the phi scale, where the larger number is the finer grain.
class SaidInPhi {
 public:
  /// The value of a key that measures diameters, in that line.
  void note(const toml::node&, std::string_view key, int line);
  /// Throws the error with what is said so in its line, where that are two sizes or more: they may be refused
  /// for their order.
  void explain(const Error&) const;

 private:
  std::vector<std::pair<int, std::string>> said_;  ///< lines, and what stands there
};

}  // namespace bernal
