#include "cad/opencascade_module.hpp"

#include <dlfcn.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <vector>

namespace bernal::cad {
namespace {

/// The program or library that contains this code: the command, or the Python module.
std::filesystem::path own_file() {
  Dl_info info{};
  void* extra = nullptr;
  std::error_code unknown;
  if (dladdr1(reinterpret_cast<const void*>(&own_file), &info, &extra, RTLD_DL_LINKMAP) != 0 && extra) {
    // The program itself has no name here, and argv[0] may be anything.
    const std::string name = static_cast<const link_map*>(extra)->l_name;
    if (!name.empty()) return std::filesystem::canonical(name, unknown);
  }
  return std::filesystem::read_symlink("/proc/self/exe", unknown);
}

std::vector<std::filesystem::path> places_of_module(const std::filesystem::path& own) {
  std::vector<std::filesystem::path> places;
  for (const std::filesystem::path place : std::initializer_list<const char*>{BERNAL_OPENCASCADE_MODULES})
    if (place.is_absolute() || own.is_absolute())
      places.push_back((own.parent_path() / place).lexically_normal());
  return places;
}

/// Whether a file belongs to the owner of the caller's file, to the user or to root, and nobody else may
/// write to it: so a program in a world-writable folder loads nothing that somebody else put there.
bool is_trusted(const std::filesystem::path& file, const std::filesystem::path& own) {
  struct stat of_file {
  }, of_own{};
  if (stat(file.c_str(), &of_file) != 0 || stat(own.c_str(), &of_own) != 0) return false;
  const bool owned = of_file.st_uid == 0 || of_file.st_uid == geteuid() || of_file.st_uid == of_own.st_uid;
  return S_ISREG(of_file.st_mode) && owned && (of_file.st_mode & S_IWOTH) == 0;
}

}  // namespace

void* opencascade_function(const char* name) {
  const std::filesystem::path own = own_file();
  for (const std::filesystem::path& module : places_of_module(own))
    if (is_trusted(module, own))
      if (void* loaded = dlopen(module.c_str(), RTLD_LAZY | RTLD_LOCAL))
        if (void* symbol = dlsym(loaded, name)) return symbol;
  return nullptr;
}

std::string opencascade_remedy() {
  const std::filesystem::path own = own_file();
  const auto places = places_of_module(own);
  if (places.empty()) return "install it and build again";
  const bool is_there = std::ranges::any_of(
      places, [&](const std::filesystem::path& module) { return is_trusted(module, own); });
  return is_there ? "install its libraries, on Debian by apt install " BERNAL_OPENCASCADE_PACKAGE
                  : "there is no " + places.front().string() +
                        ", which a copy of the program alone leaves behind: link to the installed one, or "
                        "install the Debian package bernal";
}

}  // namespace bernal::cad
