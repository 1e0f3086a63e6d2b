#include "cost/cost_folder.hpp"

#include "bernal/core/error.hpp"
#include "files/input_file.hpp"
#include "files/output_file.hpp"
#include "files/sha256.hpp"
#include "files/staged_folder.hpp"

namespace fs = std::filesystem;

namespace bernal::cost {
namespace {

[[noreturn]] void refuse_output(const fs::path& file, const std::string& why) {
  throw Error(ErrorCode::cannot_write, why + " give another ‹folder›", {file.string()});
}

bool is_named_by(const TrialRecord& record, const fs::path& file) {
  std::error_code unknown;
  return fs::is_regular_file(fs::symlink_status(file, unknown)) &&
         record.names_file(file.filename().string(), sha256_of(file));
}

void check_output(const fs::path& file, const TrialRecord& record) {
  if (!stands(file) || is_named_by(record, file)) return;
  std::error_code unknown;
  if (fs::is_directory(file, unknown))
    refuse_output(file, "is a folder, and a file is to be written there; remove it, or");
  refuse_output(file, "is not as bernal cost wrote it, and would be replaced; remove it, or");
}

}  // namespace

const std::vector<std::string>& output_names() {
  static const std::vector<std::string> names = {"cost.csv", "cost.md", "cost.svg", "cost.html",
                                                 "recommended.toml"};
  return names;
}

std::vector<std::string> files_of_earlier_call(const fs::path& folder, const TrialRecord& record) {
  std::vector<std::string> names;
  for (const std::string& name : output_names())
    if (is_named_by(record, folder / name)) names.push_back(name);
  return names;
}

void check_outputs(const fs::path& folder, const Scene& scene, const TrialRecord& record) {
  std::vector<fs::path> read = {scene.file};
  if (scene.start.file) read.push_back(*scene.start.file);
  for (const std::string& name : output_names()) {
    const fs::path there = folder / name;
    std::error_code unknown;
    for (const fs::path& file : read)
      if (!file.empty() && fs::equivalent(there, file, unknown))
        refuse_output(there, "is what the scene is read from, and would be replaced;");
    check_output(there, record);
  }
}

void write_beside(const fs::path& file, const std::string& text, TrialRecord& record) {
  InputFile in(file);
  const std::string there{std::istreambuf_iterator<char>(in), {}};
  if (!in.bad() && there == text && stands(file)) return;
  check_output(file, record);
  fs::remove(file);
  OutputFile out(file);
  out.append(text);
  out.close();
  record.add_file(file.filename().string(), sha256_of(file));
}

}  // namespace bernal::cost
