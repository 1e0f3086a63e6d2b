#pragma once
#include "bernal/core/error.hpp"

namespace bernal {

/// Another program that was to do its part is not there, crashed, or left no whole result, or is still to be
/// run by Slurm: not bad input. In one line that names the remedy, and the folder with what there is.
class EngineError : public Error {
 public:
  explicit EngineError(const std::string& message, Location location = {})
      : Error(ErrorCode::bad_argument, message, std::move(location)) {}
};

}  // namespace bernal
