#pragma once
#include <stdexcept>
#include <string>

namespace bernal {

/// Where in a user's file something stands; `line` and `column` count from 1, 0 means unknown.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;

  /// "file:line", "file" or "" as far as known.
  std::string text() const;
};

enum class ErrorCode {
  bad_scene,     ///< the scene file: syntax, unknown name, wrong type, absurd value
  bad_mesh,      ///< a CAD file that cannot be read or cannot be a container
  bad_packing,   ///< spheres that were written by someone and cannot be read back
  bad_argument,  ///< a library call or a command line outside its precondition
  cannot_write,  ///< the file system refused
};

/// Bad input, in one line that names the remedy. `what()` is "file:line: message".
/// Not converging is never an Error; it is an Outcome.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message, Location location = {});
  ErrorCode code() const { return code_; }
  const Location& location() const { return location_; }
  /// Without the location.
  std::string message() const;

 private:
  ErrorCode code_;
  Location location_;
};

}  // namespace bernal
