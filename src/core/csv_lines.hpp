#pragma once
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// The lines of a file of spheres, one after the other, with CRLF taken for LF. Its errors are
/// Error{bad_packing} with the file and, where one has been read, the line.
class CsvLines {
 public:
  /// Throws where there is nothing to be read: no file, a folder, a device.
  explicit CsvLines(const std::filesystem::path& file);

  /// Reads the next one. Throws for a line that no sphere needs, and for one that is cut off.
  bool next();
  std::string_view line() const { return line_; }
  int number() const { return number_; }
  /// Of a field of the line. Throws where it is no finite double.
  double read_number(std::string_view field, std::string_view column) const;
  /// The name of the unit, of a line "# unit: mm"; nothing of any other. Throws for one that is unknown.
  std::string unit() const;

  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void cannot_read(const std::string& why) const;

  std::string file_;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 18);
  std::ifstream stream_;
  std::string line_;
  int number_ = 0;
};

/// Text from a file that may hold anything, made fit for one line of a message.
std::string quoted(std::string_view text);

}  // namespace bernal
