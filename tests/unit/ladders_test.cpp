// Keys that buy accuracy say with which values: a law over all that a scene may say.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"
#include "scene/toml_text.hpp"

namespace bernal::ladders_test {
namespace {

using schema::Entry;
using schema::Key;

std::vector<const Entry*> all_entries() {
  std::vector<const Entry*> all(schema::own_entries().begin(), schema::own_entries().end());
  for (const Entry& entry : schema::container_entries()) all.push_back(&entry);
  for (const StageTable* table : stage_tables()) all.push_back(&table->keys);
  return all;
}

double number_of(const schema::Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::get<double>(value);
}

TEST(Ladders, HoldValuesThatTheirKeysAcceptFromOneEndToTheOther) {
  int keys = 0;
  for (const Entry* entry : all_entries())
    for (const Key& key : entry->keys) {
      if (key.ladder.empty()) continue;
      ++keys;
      SCOPED_TRACE(std::string(entry->name) + "." + std::string(key.name));
      EXPECT_GE(key.ladder.size(), 3u);
      for (const schema::Value& value : key.ladder)
        EXPECT_TRUE(schema::accepts(key, value)) << toml_text(value);
      if (key.type == schema::Type::word) continue;
      std::vector<double> numbers;
      for (const schema::Value& value : key.ladder) numbers.push_back(number_of(value));
      // A number that is the better the smaller it is may begin with 0, which stands for not at all.
      if (numbers[0] == 0 && numbers[1] > numbers[2]) numbers.erase(numbers.begin());
      EXPECT_TRUE(std::ranges::is_sorted(numbers) || std::ranges::is_sorted(numbers, std::greater<>{}));
      EXPECT_EQ(std::ranges::adjacent_find(numbers), numbers.end());
      // Whoever says nothing can be led to more and to less.
      if (const auto otherwise = key.of(entry->defaults.get());
          otherwise && key.type != schema::Type::length) {
        EXPECT_LE(std::min(std::ranges::min(numbers), number_of(key.ladder.front())), number_of(*otherwise));
        EXPECT_GE(std::ranges::max(numbers), number_of(*otherwise));
      }
    }
  EXPECT_GT(keys, 15);
}

TEST(Ladders, EveryStageHasOne) {
  for (const StageTable* table : stage_tables())
    EXPECT_TRUE(std::ranges::any_of(table->keys.keys, [](const Key& key) { return !key.ladder.empty(); }))
        << table->name();
}

}  // namespace
}  // namespace bernal::ladders_test
