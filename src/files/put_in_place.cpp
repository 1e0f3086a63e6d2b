#include "files/put_in_place.hpp"

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "files/output_file.hpp"
#include "files/staged_folder.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

using Kind = FolderTree::Kind;

std::string name_of_line(const std::string& line) {
  std::string name;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const bool escaped = line[k] == '\\' && k + 1 < line.size();
    if (escaped) ++k;
    name += escaped && line[k] == 'n' ? '\n' : line[k];
  }
  return name;
}

/// Whether nobody is at work with a folder of which a lock cannot be had: file systems know none, and it has
/// stood for much longer than publishing takes.
bool is_left(const fs::path& folder, int why_no_lock) {
  constexpr std::chrono::seconds long_enough(10);
  if (why_no_lock != ENOLCK && why_no_lock != EOPNOTSUPP && why_no_lock != ENOSYS) return false;
  std::error_code unknown;
  const auto changed = fs::last_write_time(folder, unknown);
  return !unknown && fs::file_time_type::clock::now() > changed + long_enough;
}

/// Moves files so that they can be moved back.
class Moves {
 public:
  explicit Moves(const FolderTree& tree) : tree_(tree) {}

  /// Makes the folder that is missing there.
  void move(const fs::path& from, const fs::path& to) {
    make_folder(to.parent_path());
    if (const auto why = tree_.move(from, to)) fail_to_write("cannot be replaced", *why, tree_.path() / to);
    done_.emplace_back(from, to);
  }
  void take_back() {
    for (; !done_.empty(); done_.pop_back()) tree_.move(done_.back().second, done_.back().first);
    for (; !made_.empty(); made_.pop_back()) tree_.remove_folder(made_.back());
  }

 private:
  void make_folder(const fs::path& folder) {
    const Kind kind = folder.empty() ? Kind::folder : tree_.kind_of(folder);
    if (kind == Kind::folder) return;
    make_folder(folder.parent_path());
    if (kind != Kind::missing)
      fail_to_write("is in the way",
                    "files of the result go below it, and it is no folder but a file or a link",
                    tree_.path() / folder);
    if (const auto why = tree_.make_folder(folder))
      fail_to_write("the folder cannot be made", *why, tree_.path() / folder);
    made_.push_back(folder);
  }

  const FolderTree& tree_;
  std::vector<std::pair<fs::path, fs::path>> done_;
  std::vector<fs::path> made_;
};

std::vector<std::string> names_in(const FolderTree& tree, const fs::path& list) {
  return names_of_replaced(tree.text_of(list).value_or(""));
}

/// Whoever wrote a file there keeps it.
void make_way(const FolderTree& tree, const fs::path& file, Moves& moves) {
  fs::path kept;
  for (int k = 1; kept.empty() || tree.kind_of(kept) != Kind::missing; ++k)
    kept = fs::path(file).concat(k == 1 ? ".kept" : ".kept-" + std::to_string(k));
  moves.move(file, kept);
}

/// From whatever point on: what is complete takes the place of the earlier result.
void go_on(const FolderTree& tree, Moves& moves) {
  const fs::path complete = complete_name, placing = placing_name;
  if (is_begun(tree, complete_name)) {
    for (const std::string& name : names_in(tree, complete / replaced_name))
      if (is_name_in(tree.path(), name) && tree.kind_of(name) == Kind::regular)
        moves.move(name, complete / earlier_name / name);
    moves.move(complete, placing);
  }
  if (!is_begun(tree, placing_name)) return;
  for (const fs::path& name : tree.files_below(placing, earlier_name)) {
    if (name == replaced_name) continue;
    if (tree.kind_of(name) != Kind::missing) make_way(tree, name, moves);
    moves.move(placing / name, name);
  }
  for (const std::string& name : names_in(tree, placing / replaced_name)) {
    if (!is_name_in(tree.path(), name)) continue;
    for (fs::path below = fs::path(name).parent_path(); !below.empty(); below = below.parent_path())
      tree.remove_folder(below);  // unless something is left in it
  }
}

}  // namespace

void fail_to_write(const std::string& what, const std::string& why, const fs::path& path) {
  throw Error(ErrorCode::cannot_write, what + ": " + why, {path.string()});
}

std::string line_of_replaced(const std::string& name) {
  std::string line;
  for (const char c : name) line += c == '\n' ? "\\n" : c == '\\' ? "\\\\" : std::string(1, c);
  return line + '\n';
}

std::vector<std::string> names_of_replaced(const std::string& list) {
  std::istringstream in(list);
  std::vector<std::string> names;
  for (std::string line; std::getline(in, line);) names.push_back(name_of_line(line));
  return names;
}

bool is_begun(const FolderTree& tree, const char* name) {
  return tree.kind_of(fs::path(name) / replaced_name) == Kind::regular;
}

Lock turn_in(const fs::path& folder) { return Lock(FolderTree(folder).open_folder(), longest_wait); }

fs::path new_staging(const fs::path& folder) {
  std::string pattern = (folder / fmt::format("{}XXXXXX", staging_prefix)).string();
  return ::mkdtemp(pattern.data()) == nullptr ? fs::path() : fs::path(pattern);
}

namespace {

/// The staging folders of all who write there, or did.
std::vector<std::string> stagings_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem))
    if (std::string name = at->path().filename().string(); name.starts_with(staging_prefix))
      names.push_back(std::move(name));
  return names;
}

}  // namespace

void remove_abandoned(const FolderTree& tree) {
  for (const std::string& name : stagings_in(tree.path())) {
    const Lock lock(tree.open_folder(name));
    if (lock.is_held()) tree.remove_all(name);
  }
}

void put_in_place(const FolderTree& tree, const fs::path& staging) {
  Moves moves(tree);
  try {
    moves.move(staging, complete_name);
    go_on(tree, moves);
  } catch (const Error&) {
    moves.take_back();
    throw;
  }
}

void finish_in_turn(const FolderTree& tree) {
  for (const char* name : {complete_name, placing_name}) {
    if (!is_begun(tree, name)) continue;  // it is none of ours
    const Lock lock(tree.open_folder(name));
    if (!lock.is_held() && !is_left(tree.path() / name, lock.why_not())) return;  // it is being done
    Moves moves(tree);
    try {
      go_on(tree, moves);
    } catch (const Error& error) {
      moves.take_back();
      fail_to_write(
          "holds a result that a run was killed over, and that cannot be put into its place",
          fmt::format("{}; move that away or make the folder writable, and try again", error.what()),
          tree.path());
    }
    // Under a name of its own, that whoever is killed over this blocks nobody.
    const fs::path done = new_staging(tree.path()).filename();
    if (!done.empty() && tree.remove_folder(done) && !tree.move(placing_name, done)) tree.remove_all(done);
  }
}

void finish_publishing(const fs::path& folder) {
  const FolderTree tree(folder);
  if (!is_begun(tree) && stagings_in(folder).empty()) return;
  const Lock turn = turn_in(folder);
  if (turn.is_elsewhere()) return;
  finish_in_turn(tree);
  remove_abandoned(tree);
}

}  // namespace bernal
