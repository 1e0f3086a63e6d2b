#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "bernal/core/spheres.hpp"

namespace bernal {

/// A register of several numbers, by the compiler's vector extension.
template <class T>
inline constexpr bool is_register =
    !std::is_scalar_v<T> && !std::is_class_v<T> && !std::is_union_v<T> && !std::is_array_v<T>;

/// A struct that says of itself, `using ArchivedAsBytes = void;`, that its bytes are its value: it has no
/// addresses, so no pointer, no span, no view.
template <class T>
concept SaysItIsBytes = requires {
  typename T::ArchivedAsBytes;
};

/// Whether the bytes of a type are its value: of numbers, of registers, of such structs, and of fixed arrays
/// and pairs of these.
template <class T>
inline constexpr bool is_archived_as_bytes =
    std::is_arithmetic_v<T> || std::is_enum_v<T> || is_register<T> || SaysItIsBytes<T>;
template <class Scalar, int Rows, int Columns, int Options, int MostRows, int MostColumns>
inline constexpr bool
    is_archived_as_bytes<Eigen::Matrix<Scalar, Rows, Columns, Options, MostRows, MostColumns>> =
        Rows >= 0 && Columns >= 0 && is_archived_as_bytes<Scalar>;
template <class T, std::size_t N>
inline constexpr bool is_archived_as_bytes<std::array<T, N>> = is_archived_as_bytes<T>;
template <class T, std::size_t N>
inline constexpr bool is_archived_as_bytes<T[N]> = is_archived_as_bytes<T>;
template <class A, class B>
inline constexpr bool is_archived_as_bytes<std::pair<A, B>> =
    is_archived_as_bytes<A>&& is_archived_as_bytes<B>;

/// Bytes that stand for values: those of something that is to go on later, in another process. One function
/// says what belongs to it, and both writes and reads, so that the two cannot drift apart:
///
///   void archive(Archive& a) { a(count_, places_, radii_); }
///
/// Numbers, and structs that say it of themselves, go as their bytes, for machines of one kind; vectors with
/// their lengths; whatever has a member `archive`, or a function archive(Archive&, T&), by that. Nothing else
/// compiles.
/// Order and types of what is read must be those of what was written. `check_layout` finds out whether they
/// have the same sizes: so bytes of another program, which keeps more, less or something else, are told.
/// Cost: that of copying.
class Archive {
 public:
  Archive() = default;
  virtual ~Archive() = default;
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  /// Whether values are set here, not kept.
  virtual bool reads() const = 0;

  template <class... Values>
  void operator()(Values&... values) {
    (take(values), ...);
  }

  /// Keeps a digest of the sizes of all values so far, in their order, or reads it. Throws Error{bad_packing}
  /// where these were others when it was written.
  void check_layout() {
    const std::uint64_t here = layout_;
    std::uint64_t there = here;
    take(there);
    if (there != here) fail();
  }

 protected:
  /// Keeps or sets them.
  virtual void bytes(void* data, std::size_t count) = 0;
  /// How many are still to be read.
  virtual std::uint64_t left() const = 0;
  /// Throws Error{bad_packing}: there are not so many.
  [[noreturn]] static void fail();

 private:
  template <class T>
  void take(T& value) {
    static_assert(!std::is_const_v<T>);
    if constexpr (requires { value.archive(*this); })
      value.archive(*this);
    else if constexpr (requires { archive(*this, value); })
      archive(*this, value);
    else if constexpr (is_archived_as_bytes<T>)
      take_bytes(value);
    else
      take_parts(value);
  }

  // Cold, so that the hundred states that are kept hold calls of these, and not their code.
  template <class T>
  [[gnu::cold, gnu::noinline]] void take_bytes(T& value) {
    note_size(sizeof value);
    bytes(static_cast<void*>(&value), sizeof value);
  }

  void note_size(std::uint64_t of_value) {
    layout_ = std::rotl((layout_ ^ of_value) * 0x9E3779B97F4A7C15u, 29);
  }

  /// A length, of values that take at least that many bytes each.
  std::size_t length(std::size_t now, std::size_t least_bytes) {
    std::uint64_t n = now;
    bytes(&n, sizeof n);
    if (reads() && least_bytes > 0 && n > left() / least_bytes) fail();
    return static_cast<std::size_t>(n);
  }

  template <class T, class Allocator>
  [[gnu::cold, gnu::noinline]] void take_parts(std::vector<T, Allocator>& values) {
    constexpr bool own = requires(T & value) { value.archive(*this); }
    || requires(T & value) { archive(*this, value); };
    constexpr bool plain = is_archived_as_bytes<T> && !own;
    const std::size_t n = length(values.size(), plain ? sizeof(T) : 1);
    if (reads()) values.resize(n);
    if constexpr (plain) {
      note_size(sizeof(T));
      if (n > 0) bytes(static_cast<void*>(values.data()), n * sizeof(T));
    } else {
      for (T& value : values) take(value);
    }
  }
  [[gnu::cold, gnu::noinline]] void take_parts(std::vector<bool>& values) {
    std::vector<char> plain(values.begin(), values.end());
    take_parts(plain);
    if (reads()) values.assign(plain.begin(), plain.end());
  }
  [[gnu::cold, gnu::noinline]] void take_parts(std::string& text) {
    note_size(1);
    const std::size_t n = length(text.size(), 1);
    if (reads()) text.resize(n);
    if (n > 0) bytes(text.data(), n);
  }
  template <class T, std::size_t N>
  void take_parts(std::array<T, N>& values) {
    for (T& value : values) take(value);
  }
  template <class T>
  [[gnu::cold, gnu::noinline]] void take_parts(std::optional<T>& value) {
    bool there = value.has_value();
    take(there);
    if (reads()) value.reset();
    if (reads() && there) value.emplace();
    if (there) take(*value);
  }
  template <int D>
  [[gnu::cold, gnu::noinline]] void take_parts(Spheres<D>& spheres) {
    (*this)(spheres.x, spheres.r);
  }
  template <class Derived>
  [[gnu::cold, gnu::noinline]] void take_parts(Eigen::PlainObjectBase<Derived>& values) {
    std::int64_t rows = values.rows(), columns = values.cols();
    (*this)(rows, columns);
    if (reads()) {
      const std::uint64_t most = left() / sizeof(typename Derived::Scalar);
      if (rows < 0 || columns < 0 || (columns > 0 && static_cast<std::uint64_t>(rows) > most / columns))
        fail();
      values.derived().resize(rows, columns);
    }
    if (values.size() > 0)
      bytes(values.data(), static_cast<std::size_t>(values.size()) * sizeof(typename Derived::Scalar));
  }

  std::uint64_t layout_ = 0;
};

/// Into a string.
class ArchiveToBytes final : public Archive {
 public:
  explicit ArchiveToBytes(std::string& bytes) : bytes_(bytes) {}
  bool reads() const override { return false; }

 private:
  void bytes(void* data, std::size_t count) override { bytes_.append(static_cast<const char*>(data), count); }
  std::uint64_t left() const override { return 0; }
  std::string& bytes_;
};

/// And out of one, which outlives this.
class ArchiveFromBytes final : public Archive {
 public:
  explicit ArchiveFromBytes(std::string_view bytes) : bytes_(bytes) {}
  bool reads() const override { return true; }

 private:
  void bytes(void* data, std::size_t count) override {
    if (count > bytes_.size()) fail();
    std::memcpy(data, bytes_.data(), count);
    bytes_.remove_prefix(count);
  }
  std::uint64_t left() const override { return bytes_.size(); }
  std::string_view bytes_;
};

}  // namespace bernal
