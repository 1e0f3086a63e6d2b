#include "files/npy_header.hpp"

#include <charconv>

namespace bernal {
namespace {

/// Reads Python's literals one after the other; whatever is not as expected makes it fail for good.
class Literals {
 public:
  explicit Literals(std::string_view text) : rest_(text) {}

  bool failed() const { return failed_; }
  bool at_end() {
    skip_blanks();
    return rest_.empty();
  }
  /// Whether this comes next, which is then taken.
  bool takes(std::string_view sign) {
    skip_blanks();
    if (!rest_.starts_with(sign)) return false;
    rest_.remove_prefix(sign.size());
    return true;
  }
  void expect(std::string_view sign) { failed_ = !takes(sign) || failed_; }

  bool is_text() {
    skip_blanks();
    return !rest_.empty() && (rest_.front() == '\'' || rest_.front() == '"');
  }
  std::string text() {
    if (!is_text()) return fail(), "";
    const char mark = rest_.front();
    const auto end = rest_.find(mark, 1);
    if (end == rest_.npos || rest_.substr(0, end).find('\\') != rest_.npos) return fail(), "";
    std::string found(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return found;
  }
  std::uint64_t number() {
    skip_blanks();
    std::uint64_t value = 0;
    const auto [stop, problem] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (problem != std::errc{}) return fail(), 0;
    rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
    takes("L");  // of Python 2
    return value;
  }
  void fail() {
    failed_ = true;
    rest_ = {};
  }

 private:
  void skip_blanks() {
    const auto first = rest_.find_first_not_of(" \n\r\t");
    rest_.remove_prefix(first == rest_.npos ? rest_.size() : first);
  }

  std::string_view rest_;
  bool failed_ = false;
};

/// Calls item() for what a comma parts, up to `end`.
template <class Item>
void read_list(Literals& in, std::string_view end, const Item& item) {
  while (!in.failed() && !in.takes(end)) {
    item();
    if (in.takes(end)) return;
    in.expect(",");
  }
}

void read_type(Literals& in, NpyHeader& header) {
  if (in.is_text()) {
    header.members = {{"", in.text()}};
    return;
  }
  header.is_structure = true;
  in.expect("[");
  read_list(in, "]", [&] {
    in.expect("(");
    std::string name = in.text();
    in.expect(",");
    header.members.emplace_back(std::move(name), in.text());
    in.takes(",");
    in.expect(")");  // a member that is an array itself has its shape here
  });
}

}  // namespace

std::optional<NpyHeader> npy_header_in(std::string_view text) {
  Literals in(text);
  NpyHeader header;
  bool has_type = false, has_order = false, has_shape = false;
  in.expect("{");
  read_list(in, "}", [&] {
    const std::string key = in.text();
    in.expect(":");
    if (key == "descr") {
      has_type = true;
      header.members.clear();
      read_type(in, header);
    } else if (key == "fortran_order") {
      has_order = true;
      header.fortran_order = in.takes("True");
      if (!header.fortran_order) in.expect("False");
    } else if (key == "shape") {
      has_shape = true;
      in.expect("(");
      header.shape.clear();
      read_list(in, ")", [&] { header.shape.push_back(in.number()); });
    } else {
      in.fail();
    }
  });
  if (in.failed() || !in.at_end() || !has_type || !has_order || !has_shape || header.members.empty())
    return {};
  return header;
}

}  // namespace bernal
