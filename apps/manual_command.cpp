#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/version.hpp"
#include "commands.hpp"
#include "completion.hpp"
#include "manual.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

std::vector<std::string> names_of_commands(const Command& of) {
  std::vector<std::string> names;
  for (const Command& command : of.commands) names.push_back(command.name);
  return names;
}

struct ManualCall {
  std::vector<std::string> names;
  std::filesystem::path folder;
};

/// The day for the pages, "2025-01-31" in UTC: that of SOURCE_DATE_EPOCH, which reproducible builds set, else
/// today.
std::string day_of_pages() {
  std::time_t seconds = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  if (const char* given = std::getenv("SOURCE_DATE_EPOCH")) {
    const std::string_view text = given;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (error != std::errc{} || end != text.data() + text.size() || seconds < 0)
      throw Error(ErrorCode::bad_argument,
                  fmt::format("SOURCE_DATE_EPOCH must be seconds since 1970, not {}", plain_text(text)));
  }
  const std::chrono::year_month_day day{
      std::chrono::floor<std::chrono::days>(std::chrono::system_clock::from_time_t(seconds))};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()));
}

/// Writes a page under another name and renames it, so that nobody ever reads half a page.
void write_page(const Page& page, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / (page.name + ".1");
  const std::filesystem::path whole = fmt::format("{}.{}.tmp", file.string(), getpid());
  std::error_code failed;
  std::ofstream stream(whole, std::ios::binary);
  stream << page.text;
  stream.close();
  if (stream) std::filesystem::rename(whole, file, failed);
  if (stream && !failed) return;
  std::error_code ignored;
  std::filesystem::remove(whole, ignored);
  throw Error(ErrorCode::cannot_write, "cannot be written", {file.string()});
}

int write_manual(const ManualCall& call, const Command& bernal) {
  const std::vector<Page> pages =
      manual_pages(bernal, fmt::format("{} {}", bernal.name, version()), day_of_pages());
  if (!call.folder.empty()) {
    if (!call.names.empty()) throw Error(ErrorCode::bad_argument, "-o writes every page; leave COMMAND out");
    std::error_code failed;
    std::filesystem::create_directories(call.folder, failed);
    if (failed) throw Error(ErrorCode::cannot_write, failed.message(), {call.folder.string()});
    for (const Page& page : pages) write_page(page, call.folder);
    return exit_code::done;
  }
  const std::string name =
      call.names.empty() ? bernal.name : fmt::format("{}-{}", bernal.name, fmt::join(call.names, "-"));
  std::vector<std::string_view> known;
  for (const Page& page : pages) {
    known.push_back(page.name);
    if (page.name != name) continue;
    say(stdout, "{}", page.text);
    return exit_code::done;
  }
  throw Error(ErrorCode::bad_argument, fmt::format("there is no page {}{}", name, remedy(name, known)));
}

/// Prints what `COMMAND --help` prints; with no names that of bernal itself.
int print_help(const std::vector<std::string>& names, const Command& bernal) {
  const Command* of = &bernal;
  std::vector<std::string> words{bernal.name};
  for (const std::string& name : names) {
    std::vector<std::string_view> known;
    for (const Command& command : of->commands) known.push_back(command.name);
    const auto found = std::ranges::find(of->commands, name, &Command::name);
    if (found == of->commands.end())
      throw Error(ErrorCode::bad_argument,
                  known.empty() ? fmt::format("{} has no command of its own; leave \"{}\" out",
                                              fmt::join(words, " "), name)
                                : fmt::format("unknown command \"{}\"{}", name, remedy(name, known)));
    of = &*found;
    words.push_back(name);
  }
  words.emplace_back("--help");
  std::vector<char*> call;
  for (std::string& word : words) call.push_back(word.data());
  return run_command_line(static_cast<int>(call.size()), call.data(), bernal, {});
}

int write_completion(const std::string& shell, const Command& bernal) {
  say(stdout, "{}", shell == "zsh" ? zsh_completion(bernal) : bash_completion(bernal));
  return exit_code::done;
}

}  // namespace

Command help_command(const Command& bernal) {
  const auto names = std::make_shared<std::vector<std::string>>();
  return {"help",
          "Say what a command does, and its options: the same as COMMAND --help",
          {offering({"COMMAND", names.get(), "The command, such as pack or design target; bernal if absent"},
                    names_of_commands(bernal))},
          {.examples = {{"bernal help", "all commands"},
                        {"bernal help pack", "the options of one"},
                        {"bernal keys container", "what a scene may say is told by keys"}},
           .exit_codes = {{"0", "done"}, {"2", "bad input"}}},
          [names, &bernal] { return print_help(*names, bernal); }};
}

Command manual_command(const Command& bernal) {
  const auto call = std::make_shared<ManualCall>();
  return {"manual",
          "Write the manual: a page for each command, as man reads it",
          {offering({"COMMAND", &call->names, "The command, such as pack or design target; bernal if absent"},
                    names_of_commands(bernal)),
           folder({"-o,--output", &call->folder, "Folder for all pages; made if it does not exist", "DIR"})},
          {.text = "The Debian package brings these pages along: man bernal-pack. The day that they bear is "
                   "that of SOURCE_DATE_EPOCH, where it is set.",
           .examples = {{"bernal manual pack | man -l -", "read a page without installing it"},
                        {"bernal manual -o ~/.local/share/man/man1", "install all of them for oneself"}},
           .exit_codes = {{"0", "done"}, {"2", "bad input"}}},
          [call, &bernal] { return write_manual(*call, bernal); }};
}

Command completion_command(const Command& bernal) {
  const auto shell = std::make_shared<std::string>();
  return {"completion",
          "Write what makes a shell complete the words of bernal",
          {one_of(required({"SHELL", shell.get(), "The shell"}), {"bash", "zsh"})},
          {.text = "The Debian package brings both along. Without it, one of the lines below installs them.",
           .examples = {{"source <(bernal completion bash)", "for this shell, bash"},
                        {"bernal completion bash > ~/.local/share/bash-completion/completions/bernal",
                         "for every bash, if the package bash-completion is there"},
                        {"bernal completion zsh > ~/.zfunc/_bernal",
                         "for every zsh that has fpath+=(~/.zfunc) before compinit in its ~/.zshrc"}},
           .exit_codes = {{"0", "done"}, {"2", "bad input"}}},
          [shell, &bernal] { return write_completion(*shell, bernal); }};
}
