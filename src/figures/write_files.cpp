#include "figures/write_files.hpp"

#include "io/output_file.hpp"
#include "io/staged_folder.hpp"

namespace bernal::figures {

std::vector<std::filesystem::path> write_files(const Files& files, const std::filesystem::path& folder) {
  if (files.empty()) return {};
  StagedFolder staged(folder);
  for (const File& file : files) {
    OutputFile out(staged.add(file.name));
    out.append(file.text);
    out.close();
  }
  return staged.publish();
}

}  // namespace bernal::figures
