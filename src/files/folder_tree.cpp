#include "files/folder_tree.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr int as_folder = O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW;

FolderTree::Kind kind_at(int folder, const fs::path& name) {
  struct stat facts {};
  if (::fstatat(folder, name.c_str(), &facts, AT_SYMLINK_NOFOLLOW) != 0) return FolderTree::Kind::missing;
  return S_ISREG(facts.st_mode)   ? FolderTree::Kind::regular
         : S_ISDIR(facts.st_mode) ? FolderTree::Kind::folder
                                  : FolderTree::Kind::other;
}

/// Calls visit(name) for what stands in an open folder.
template <class Visit>
void for_each_in(int folder, const Visit& visit) {
  const int again = ::openat(folder, ".", as_folder);  // which reads from the beginning, and is closed below
  const std::unique_ptr<DIR, int (*)(DIR*)> list(again < 0 ? nullptr : ::fdopendir(again), ::closedir);
  if (!list) {
    if (again >= 0) ::close(again);
    return;
  }
  std::vector<std::string> names;  // first, for what a visit changes
  while (const dirent* entry = ::readdir(list.get())) names.emplace_back(entry->d_name);
  for (const std::string& name : names)
    if (name != "." && name != "..") visit(name);
}

}  // namespace

FolderTree::FolderTree(const fs::path& folder)
    : path_(folder),
      root_(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}

Descriptor FolderTree::open_folder(const fs::path& name) const {
  Descriptor at(root_.is_open() ? ::openat(root_.number(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1);
  for (const fs::path& part : name) {
    if (!at.is_open() || part == "..") return Descriptor();
    at = Descriptor(::openat(at.number(), part.c_str(), as_folder));
  }
  return at;
}

Descriptor FolderTree::folder_of(const fs::path& name) const {
  return name.is_absolute() || !name.has_filename() ? Descriptor() : open_folder(name.parent_path());
}

FolderTree::Kind FolderTree::kind_of(const fs::path& name) const {
  const Descriptor folder = folder_of(name);
  return folder.is_open() ? kind_at(folder.number(), name.filename()) : Kind::missing;
}

std::optional<std::string> FolderTree::text_of(const fs::path& name) const {
  const Descriptor folder = folder_of(name);
  if (!folder.is_open()) return std::nullopt;
  const Descriptor file(
      ::openat(folder.number(), name.filename().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat facts {};
  if (!file.is_open() || ::fstat(file.number(), &facts) != 0 || !S_ISREG(facts.st_mode)) return std::nullopt;
  std::string text;
  char block[1 << 14];
  for (;;) {
    const ssize_t got = ::read(file.number(), block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return std::nullopt;
    if (got == 0) return text;
    text.append(block, static_cast<std::size_t>(got));
  }
}

std::vector<fs::path> FolderTree::files_below(const fs::path& name, const std::string& but) const {
  std::vector<fs::path> files;
  const Descriptor folder = open_folder(name);
  if (!folder.is_open()) return files;
  for_each_in(folder.number(), [&](const std::string& entry) {
    const Kind kind = entry == but ? Kind::missing : kind_at(folder.number(), entry);
    if (kind == Kind::regular) files.emplace_back(entry);
    if (kind != Kind::folder) return;
    for (const fs::path& below : files_below(name / entry)) files.push_back(entry / below);
  });
  return files;
}

FolderTree::Complaint FolderTree::move(const fs::path& from, const fs::path& to) const {
  const Descriptor source = folder_of(from), target = folder_of(to);
  if (!source.is_open() || !target.is_open()) return "the way there leads through a link or no folder";
  if (kind_at(target.number(), to.filename()) != Kind::missing) return "something stands there";
  const std::string name = from.filename(), as = to.filename();
#ifdef RENAME_NOREPLACE
  if (::renameat2(source.number(), name.c_str(), target.number(), as.c_str(), RENAME_NOREPLACE) == 0)
    return std::nullopt;
  if (errno != EINVAL && errno != ENOSYS) return std::strerror(errno);
#endif
  if (::renameat(source.number(), name.c_str(), target.number(), as.c_str()) == 0) return std::nullopt;
  return std::strerror(errno);
}

FolderTree::Complaint FolderTree::make_folder(const fs::path& name) const {
  const Descriptor folder = folder_of(name);
  if (!folder.is_open()) return "the way there leads through a link or no folder";
  if (::mkdirat(folder.number(), name.filename().c_str(), 0777) == 0) return std::nullopt;
  return std::strerror(errno);
}

bool FolderTree::remove_folder(const fs::path& name) const {
  const Descriptor folder = folder_of(name);
  return folder.is_open() && ::unlinkat(folder.number(), name.filename().c_str(), AT_REMOVEDIR) == 0;
}

void FolderTree::remove_all(const fs::path& name) const {
  if (const Descriptor folder = open_folder(name); folder.is_open()) {
    for_each_in(folder.number(), [&](const std::string& entry) {
      const Kind kind = kind_at(folder.number(), entry);
      if (kind == Kind::regular) ::unlinkat(folder.number(), entry.c_str(), 0);
      if (kind == Kind::folder) remove_all(name / entry);
    });
  }
  remove_folder(name);
}

}  // namespace bernal
