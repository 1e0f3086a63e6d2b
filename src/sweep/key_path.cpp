#include "sweep/key_path.hpp"

#include <algorithm>
#include <charconv>
#include <span>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "scene/read_value.hpp"
#include "scene/toml_file.hpp"

namespace bernal::sweep {
namespace {

bool is_bare(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

/// "[2]" at the beginning of a text, which it is cut off from.
std::optional<std::size_t> take_index(std::string_view& text) {
  std::size_t index = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data() + 1, end, index);
  if (error != std::errc{} || next == end || *next != ']') return {};
  text.remove_prefix(static_cast<std::size_t>(next + 1 - text.data()));
  return index;
}

std::string path_text(std::span<const KeyPath::Step> steps) {
  std::string text;
  for (const KeyPath::Step& step : steps)
    text += step.name.empty() ? fmt::format("[{}]", step.index) : (text.empty() ? "" : ".") + step.name;
  return text;
}

[[noreturn]] void fail(const Assignment& at, const std::string& why) {
  throw Error(ErrorCode::bad_scene, why, location_of(at.where, {}));
}

}  // namespace

std::optional<KeyPath> KeyPath::parsed(std::string_view text) {
  KeyPath path;
  while (!text.empty()) {
    if (text.front() == '[' && !path.steps_.empty()) {
      const auto index = take_index(text);
      if (!index) return {};
      path.steps_.push_back({{}, *index});
    } else {
      if (!path.steps_.empty()) {
        if (text.front() != '.') return {};
        text.remove_prefix(1);
      }
      const std::string_view name = text.substr(0, text.find_first_of(".["));
      if (!is_bare(name)) return {};
      path.steps_.push_back({std::string(name), 0});
      text.remove_prefix(name.size());
    }
  }
  if (path.steps_.empty()) return {};
  return path;
}

std::string KeyPath::text() const { return path_text(steps_); }

const std::string& KeyPath::last_name() const {
  return std::ranges::find_if(steps_.rbegin(), steps_.rend(), [](const Step& s) { return !s.name.empty(); })
      ->name;
}

bool KeyPath::overlaps(const KeyPath& other) const {
  const std::size_t common = std::min(steps_.size(), other.steps_.size());
  return std::equal(steps_.begin(), steps_.begin() + static_cast<std::ptrdiff_t>(common),
                    other.steps_.begin());
}

void Slot::take(toml::node& node) {
  held_.clear();
  node.visit([&](auto& value) { held_.push_back(std::move(value)); });
}

void Slot::put_into(toml::table& table, const toml::key& key) {
  held_.get(0)->visit([&](auto& value) { table.insert(key, std::move(value)); });
}

void Slot::put_into(toml::array& array, std::size_t at) {
  held_.get(0)->visit([&](auto& value) {
    array.replace(array.cbegin() + static_cast<std::ptrdiff_t>(at), std::move(value));
  });
}

void Overlay::put(Assignment& assignment) {
  const auto steps = std::span(assignment.path.steps());
  toml::node* node = &scene_;
  const auto what_is = [&](std::size_t k) {
    return k == 0 ? std::string("the scene") : fmt::format("\"{}\"", path_text(steps.first(k)));
  };
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const KeyPath::Step& step = steps[k];
    const bool is_last = k + 1 == steps.size();
    auto undo = std::make_unique<Undo>();
    if (!step.name.empty()) {
      toml::table* table = node->as_table();
      if (!table)
        fail(assignment, fmt::format("{} is {} in the scene, which has no \"{}\"", what_is(k), written(*node),
                                     step.name));
      const auto found = table->find(step.name);
      if (!is_last && found != table->end()) {
        node = &found->second;
        continue;
      }
      if (!is_last && steps[k + 1].name.empty())
        fail(assignment,
             fmt::format(
                 "the scene has no \"{0}\", and so no \"{1}\"{2}", path_text(steps.first(k + 1)),
                 path_text(steps.first(k + 2)),
                 step.name == "stage" ? "; bernal explain prints its protocol, ready to be pasted" : ""));
      undo->table = table;
      undo->key = toml::key(step.name, assignment.where);
      if (found != table->end()) {
        undo->key_before = found->first;
        undo->before.take(found->second);
        table->erase(found);
      }
      undone_.push_back(std::move(undo));
      Undo& done = *undone_.back();
      if (is_last) {
        done.from = &assignment;
        assignment.value.put_into(*table, done.key);
        return;
      }
      node = &table->insert(done.key, toml::table()).first->second;
      continue;
    }
    toml::array* array = node->as_array();
    if (!array)
      fail(assignment, fmt::format("{} is {} in the scene, not an array", what_is(k), written(*node)));
    if (step.index >= array->size())
      fail(assignment,
           fmt::format(
               "the scene has {} {}: \"{}[0]\"{}", array->size(), what_is(k), path_text(steps.first(k)),
               array->size() > 1 ? fmt::format(" to \"{}[{}]\"", path_text(steps.first(k)), array->size() - 1)
                                 : " alone"));
    if (!is_last) {
      node = array->get(step.index);
      continue;
    }
    undo->array = array;
    undo->index = step.index;
    undo->before.take(*array->get(step.index));
    undo->from = &assignment;
    undone_.push_back(std::move(undo));
    assignment.value.put_into(*array, step.index);
  }
}

Overlay::~Overlay() {
  for (auto undo = undone_.rbegin(); undo != undone_.rend(); ++undo) {
    Undo& u = **undo;
    if (u.array) {
      u.from->value.take(*u.array->get(u.index));
      u.before.put_into(*u.array, u.index);
      continue;
    }
    const auto found = u.table->find(u.key.str());
    if (found == u.table->end()) continue;
    if (u.from) u.from->value.take(found->second);
    u.table->erase(found);
    if (u.key_before) u.before.put_into(*u.table, *u.key_before);
  }
}

}  // namespace bernal::sweep
