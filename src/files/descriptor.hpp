#pragma once
#include <string_view>
#include <utility>

namespace bernal {

/// An open file, folder or pipe by its number, which is closed with it; a negative one where it could not be
/// opened, as errno then says.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { close(); }

  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  /// Whether all of it could be written; errno says why not.
  bool write(std::string_view bytes) const;
  /// Whether the system says that this went well, too.
  bool close();

 private:
  int number_;
};

}  // namespace bernal
