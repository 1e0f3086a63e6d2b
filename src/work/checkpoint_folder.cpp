#include "work/checkpoint_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "files/descriptor.hpp"
#include "files/folder_tree.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr const char* folder_name = ".bernal-checkpoint";
constexpr const char* latest = "latest";
constexpr const char* before_it = "before";
constexpr const char* not_whole_yet = "new";
/// Another number whenever what stands here is laid out in another way. What stages write is told apart by
/// the packings number, and where that is the same, by its layout (`Archive::check_layout`).
constexpr char format[] = "bernal checkpoint 3\n";
constexpr std::size_t word = sizeof(std::uint64_t), block_bytes = std::size_t{1} << 20;
constexpr std::size_t end_bytes = 2 * word;

/// Of words one after the other: every step is a bijection of the state, so that no change within one word
/// goes unnoticed, and turns what it has by half, so that changes of several words do not cancel.
class SumOfBytes {
 public:
  /// All calls but the last are of whole words.
  void add(const char* bytes, std::size_t count) {
    for (; count >= word; bytes += word, count -= word) {
      std::uint64_t next;
      std::memcpy(&next, bytes, word);
      absorb(next);
    }
    if (count == 0) return;
    std::uint64_t rest = 0;
    std::memcpy(&rest, bytes, count);
    absorb(rest ^ std::uint64_t{count} << 60);
  }
  std::uint64_t value() const { return sum_; }

 private:
  void absorb(std::uint64_t next) { sum_ = std::rotl((sum_ ^ next) * 0x9E3779B97F4A7C15u, 32); }
  std::uint64_t sum_ = 0x243F6A8885A308D3u;
};

[[noreturn]] void fail_to_write(const fs::path& path) {
  throw Error(ErrorCode::cannot_write, fmt::format("no checkpoint can be written: {}", std::strerror(errno)),
              {path.string()});
}

/// Whatever has that name goes: a link or a pipe would lead elsewhere.
Descriptor new_file(const fs::path& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
  return Descriptor(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
}

class FileWriter final : public Archive {
 public:
  explicit FileWriter(const fs::path& path) : path_(path), file_(new_file(path)) {
    if (!file_.is_open()) fail_to_write(path);
    buffer_.reserve(block_bytes);
  }
  bool reads() const override { return false; }

  void finish() {
    flush();
    const std::uint64_t end[] = {written_, sum_.value()};
    if (!file_.write({reinterpret_cast<const char*>(end), sizeof end}) || ::fsync(file_.number()) != 0)
      fail_to_write(path_);
  }

 private:
  void bytes(void* data, std::size_t count) override {
    const char* next = static_cast<const char*>(data);
    while (count > 0) {
      const std::size_t part = std::min(count, block_bytes - buffer_.size());
      buffer_.append(next, part);
      next += part;
      count -= part;
      if (buffer_.size() == block_bytes) flush();
    }
  }
  std::uint64_t left() const override { return 0; }

  void flush() {
    sum_.add(buffer_.data(), buffer_.size());
    if (!file_.write(buffer_)) fail_to_write(path_);
    written_ += buffer_.size();
    buffer_.clear();
  }

  fs::path path_;
  Descriptor file_;
  std::string buffer_;
  SumOfBytes sum_;
  std::uint64_t written_ = 0;
};

class FileReader final : public Archive {
 public:
  explicit FileReader(const fs::path& path)
      : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)) {
    struct stat facts {};
    if (!file_.is_open() || ::fstat(file_.number(), &facts) != 0 || !S_ISREG(facts.st_mode)) return;
    if (facts.st_size < static_cast<off_t>(end_bytes)) return;
    size_ = static_cast<std::uint64_t>(facts.st_size) - end_bytes;
    is_whole_ = matches_its_sum();
    rewind();
  }
  bool is_whole() const { return is_whole_; }
  bool reads() const override { return true; }

 private:
  /// Reads all of it once.
  bool matches_its_sum() {
    SumOfBytes sum;
    for (rewind(); taken_ < size_; at_ = buffer_.size()) {
      if (!fill()) return false;
      sum.add(buffer_.data(), buffer_.size());
    }
    std::uint64_t end[2];
    if (::pread(file_.number(), end, sizeof end, static_cast<off_t>(size_)) != sizeof end) return false;
    return end[0] == size_ && end[1] == sum.value();
  }
  void rewind() {
    taken_ = 0;
    at_ = 0;
    buffer_.clear();
  }
  /// The next block.
  bool fill() {
    buffer_.resize(std::min<std::uint64_t>(block_bytes, size_ - taken_));
    at_ = 0;
    for (std::size_t got = 0; got < buffer_.size();) {
      const ssize_t now = ::pread(file_.number(), buffer_.data() + got, buffer_.size() - got,
                                  static_cast<off_t>(taken_ + got));
      if (now < 0 && errno == EINTR) continue;
      if (now <= 0) return false;
      got += static_cast<std::size_t>(now);
    }
    taken_ += buffer_.size();
    return true;
  }
  void bytes(void* data, std::size_t count) override {
    if (count > left()) fail();
    char* next = static_cast<char*>(data);
    while (count > 0) {
      if (at_ == buffer_.size() && !fill()) fail();
      const std::size_t part = std::min(count, buffer_.size() - at_);
      std::memcpy(next, buffer_.data() + at_, part);
      next += part;
      at_ += part;
      count -= part;
    }
  }
  std::uint64_t left() const override { return size_ - taken_ + (buffer_.size() - at_); }

  Descriptor file_;
  std::uint64_t size_ = 0, taken_ = 0;  // of the bytes before the end; and how many have been in the buffer
  std::string buffer_;
  std::size_t at_ = 0;
  bool is_whole_ = false;
};

[[noreturn]] void refuse(const fs::path& folder, const std::string& what) {
  throw Error(ErrorCode::bad_argument, what, {folder.parent_path().string()});
}

[[noreturn]] void refuse_other(const fs::path& folder, const CheckpointOwner& here,
                               const CheckpointOwner& there) {
  if (there.program.packings_number != here.program.packings_number)
    refuse(folder,
           fmt::format("holds a checkpoint of {}: go on with that one, or leave ‹resume› out to start anew",
                       beside_this(there.program)));
  if (there.scene != here.scene)
    refuse(folder,
           "holds a checkpoint of another scene: name its scene or another folder, or leave ‹resume› out to "
           "start anew");
  if (there.files != here.files)
    refuse(folder,
           "holds a checkpoint of a run with another CAD file or start than stands there now: put that back, "
           "or leave ‹resume› out to start anew");
  refuse(folder, fmt::format("holds a checkpoint of the seed {0}: give ‹seed={0}›, or leave ‹resume› out to "
                             "start anew",
                             there.seed));
}

}  // namespace

CheckpointFolder::CheckpointFolder(const fs::path& result) : folder_(result / folder_name) {}

CheckpointFolder::~CheckpointFolder() {
  std::error_code ignored;  // as where there is something in it
  if (!lock_.of().is_open() || !fs::remove(folder_, ignored)) return;
  if (made_result_) fs::remove(folder_.parent_path(), ignored);
}

/// Returns false where another process has it. Where file systems know no locks everybody has it.
bool CheckpointFolder::hold() {
  if (lock_.of().is_open()) return true;
  Lock lock(FolderTree(folder_.parent_path()).open_folder(folder_name));
  errno = lock.why_not();
  if (!lock.of().is_open()) fail_to_write(folder_);
  if (lock.is_elsewhere()) return false;
  lock_ = std::move(lock);
  return true;
}

bool CheckpointFolder::claim() {
  std::error_code problem;
  made_result_ = made_result_ || !fs::exists(folder_.parent_path(), problem);
  fs::create_directories(folder_, problem);
  if (problem)
    throw Error(ErrorCode::cannot_write, "no checkpoint can be written: " + problem.message(),
                {folder_.string()});
  return hold();
}

void CheckpointFolder::write(CheckpointOwner& owner, const std::function<void(Archive&)>& write) {
  std::error_code problem;
  if (!claim())
    throw Error(ErrorCode::cannot_write,
                "no checkpoint can be written: another run with the same folder writes its own there",
                {folder_.string()});
  const fs::path fresh = folder_ / not_whole_yet;
  try {
    FileWriter file(fresh);
    char name[sizeof format];
    std::memcpy(name, format, sizeof format);
    file(name, owner);
    write(file);
    file.finish();
  } catch (...) {
    fs::remove(fresh, problem);  // room for others, where the disk is full
    throw;
  }
  if (::rename((folder_ / latest).c_str(), (folder_ / before_it).c_str()) != 0 && errno != ENOENT)
    fail_to_write(folder_ / before_it);
  if (::rename(fresh.c_str(), (folder_ / latest).c_str()) != 0) fail_to_write(folder_ / latest);
  ::fsync(lock_.of().number());
}

std::unique_ptr<Archive> CheckpointFolder::open(const CheckpointOwner& owner, std::string& note,
                                                Program& by) {
  std::error_code problem;
  if (!fs::is_directory(fs::symlink_status(folder_, problem))) return nullptr;
  if (!hold()) refuse(folder_, "another run is at work in this folder: wait until it has ended");
  for (const char* name : {latest, before_it}) {
    auto file = std::make_unique<FileReader>(folder_ / name);
    std::error_code unknown;
    if (!file->is_whole()) {
      if (fs::symlink_status(folder_ / name, unknown).type() != fs::file_type::not_found)
        note = fmt::format("{} was not whole, and passed over", (folder_ / name).string());
      continue;
    }
    char found[sizeof format];
    CheckpointOwner there;
    (*file)(found);
    if (std::memcmp(found, format, sizeof format) != 0)
      refuse(folder_,
             fmt::format("holds a checkpoint of {}: go on with that one, or leave ‹resume› out to start anew",
                         std::string_view(found, sizeof found) < format
                             ? beside_this({"0.1", "", 0})
                             : "a later bernal, and this is " + text_of(owner.program)));
    (*file)(there);
    if (there.program.packings_number != owner.program.packings_number || there.scene != owner.scene ||
        there.files != owner.files || there.seed != owner.seed)
      refuse_other(folder_, owner, there);
    by = there.program;
    return file;
  }
  return nullptr;
}

bool CheckpointFolder::stands_in(const fs::path& result) {
  std::error_code unknown;
  return std::ranges::any_of(std::initializer_list<const char*>{latest, before_it}, [&](const char* name) {
    return fs::symlink_status(result / folder_name / name, unknown).type() != fs::file_type::not_found;
  });
}

void CheckpointFolder::remove_from(const fs::path& result) {
  std::error_code unknown;
  if (!fs::is_directory(fs::symlink_status(result / folder_name, unknown))) return;
  try {
    CheckpointFolder own(result);
    if (!own.hold()) return;
    std::error_code ignored;
    fs::remove_all(own.folder_, ignored);
  } catch (const Error&) {  // it is nobody's to take away
  }
}

}  // namespace bernal
