#pragma once
#include <filesystem>
#include <vector>

#include "bernal/core/unit.hpp"
#include "scene/entry.hpp"

namespace bernal {

/// Whether a key is what stands in the columns of the entry's "file".
bool comes_from_file(const schema::Entry& entry, const schema::Key& key);

/// Gives the keys of an entry that may stand in a "file" the numbers of its columns, lengths in that unit;
/// returns these keys. Throws as `read_columns`.
std::vector<const schema::Key*> keys_from_columns(const std::filesystem::path& file,
                                                  const schema::Entry& entry, Unit unit, void* options);

}  // namespace bernal
