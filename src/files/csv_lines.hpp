#pragma once
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// How a file is read.
struct CsvReading {
  /// Another program may end its last line without a line feed; one of bernal's that does was cut off.
  bool last_line_may_lack_feed = false;
  /// Is told all bytes in order, as they are read, by the end of the last line.
  std::function<void(std::string_view bytes)> see = {};
};

/// The lines of a file of spheres, one after the other, with CRLF taken for LF and without the byte order
/// mark that the first may begin with. Its errors are Error{bad_packing} with the file and, where one has
/// been read, the line.
class CsvLines {
 public:
  /// Throws where there is nothing to be read: no file, a folder, a device.
  explicit CsvLines(const std::filesystem::path& file, CsvReading how = {});

  /// Reads the next one. Throws for a line that no sphere needs, and for one that is cut off.
  bool next();
  std::string_view line() const { return line_; }
  int number() const { return number_; }
  const std::string& file() const { return file_; }
  /// Of a field of the line. Throws where it is no finite double.
  double read_number(std::string_view field, std::string_view column) const;
  /// Whether the line is a remark that says the unit, which is put into `unit`, as `take_unit` does.
  bool says_unit(std::string& unit) const;
  /// `unit` becomes the one of this name. Throws for a name that is unknown and where `unit` is another one.
  void take_unit(std::string_view name, std::string& unit) const;

  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void cannot_read(const std::string& why) const;

  /// Tells what it takes from the file.
  class Bytes : public std::filebuf {
   public:
    std::function<void(std::string_view)> see;

   protected:
    int_type underflow() override;
  };

  std::string file_;
  bool last_line_may_lack_feed_;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{1} << 18);
  Bytes bytes_;
  std::istream stream_{&bytes_};
  std::string line_;
  int number_ = 0;
};

/// "mm" of a remark "# unit: mm", whose case and blanks are free, and after which a table's empty columns may
/// stand.
std::optional<std::string_view> unit_in_remark(std::string_view line);

/// "unknown unit "parsec"; use one of …", or nothing of a known one.
std::string complaint_of_unit(std::string_view name);

/// Text from a file that may hold anything, made fit for one line of a message.
std::string quoted(std::string_view text);

}  // namespace bernal
