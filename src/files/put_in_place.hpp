#pragma once
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "files/folder_tree.hpp"
#include "files/lock.hpp"

namespace bernal {

// How files of a result get into their places, in steps of which each leaves what the next process completes:
// `staging` becomes `complete`; what it replaces moves into `complete/earlier`; `complete` becomes `placing`;
// its files move into their places; it goes.

/// What the staging folder is called once all is written, while what the files replace moves to
/// `earlier_name` below it; and then, while they move into their places.
inline constexpr const char *complete_name = ".bernal-complete", *placing_name = ".bernal-placing",
                            *earlier_name = ".earlier";
/// In it, which files it replaces, a line each; nothing that lacks it is touched.
inline constexpr const char* replaced_name = ".replaced";

std::string line_of_replaced(const std::string& name);
std::vector<std::string> names_of_replaced(const std::string& list);

/// Whether the folder of that name is one of ours, begun or left.
bool is_begun(const FolderTree&, const char* name);
inline bool is_begun(const FolderTree& tree) {
  return is_begun(tree, complete_name) || is_begun(tree, placing_name);
}

/// For another process that publishes in the same folder, which takes milliseconds.
inline constexpr std::chrono::seconds longest_wait(30);
inline constexpr std::chrono::milliseconds between_tries(2);

/// Whoever makes, moves or removes in a folder what others could take for theirs does it in turn. Waits for
/// that; it is elsewhere still where this took too long. Where file systems know no locks everybody has it.
Lock turn_in(const std::filesystem::path& folder);

/// Throws Error{cannot_write} at that path: what it cannot, and why.
[[noreturn]] void fail_to_write(const std::string& what, const std::string& why,
                                const std::filesystem::path& path);

/// A new folder with a name that nobody else has; empty where none can be made.
std::filesystem::path new_staging(const std::filesystem::path& folder);

/// Removes staging folders whose processes were killed. The turn is the caller's.
void remove_abandoned(const FolderTree&);

/// Moves `staging` to its places, or nothing. Throws Error{cannot_write}. The turn is the caller's.
void put_in_place(const FolderTree&, const std::filesystem::path& staging);

/// Completes what a process was killed over, none that another one is at work with. Throws
/// Error{cannot_write}. The turn is the caller's.
void finish_in_turn(const FolderTree&);

/// Completes what a process that was killed had begun to publish in the folder, waits for one that is at it,
/// and removes staging folders of processes that were killed; does nothing if there is no such thing. Only
/// regular files are moved, into folders that no link leads out of; what stands there stays. Throws
/// Error{cannot_write}.
void finish_publishing(const std::filesystem::path& folder);

}  // namespace bernal
