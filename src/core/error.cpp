#include "bernal/core/error.hpp"

namespace bernal {

std::string Location::text() const {
  if (file.empty()) return line > 0 ? "line " + std::to_string(line) : "";
  return line > 0 ? file + ":" + std::to_string(line) : file;
}

Error::Error(ErrorCode code, const std::string& message, Location location)
    : std::runtime_error(location.text().empty() ? message : location.text() + ": " + message),
      code_(code),
      location_(std::move(location)) {}

std::string Error::message() const {
  const std::string where = location_.text(), all = what();
  return where.empty() ? all : all.substr(where.size() + 2);
}

}  // namespace bernal
