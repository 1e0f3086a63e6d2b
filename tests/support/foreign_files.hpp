#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/formats/import.hpp"
#include "support/folder.hpp"

namespace bernal::testing {

/// A file of another program, and how it is asked for.
struct ForeignFile {
  std::string name, text;
  ImportOptions options = {};
};

inline ImportedPacking imported(const ForeignFile& of) {
  const Folder folder;
  return import_packing(folder.write(of.name, of.text), of.options);
}

/// It is refused in one line that has the words.
inline void expect_refusal(const ForeignFile& of, const std::vector<std::string>& words) {
  try {
    imported(of);
    ADD_FAILURE() << of.text << "\nis taken";
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), what.npos) << what;
    for (const std::string& word : words)
      EXPECT_NE(what.find(word), what.npos) << word << "\nis not in: " << what;
  }
}

/// A frame of a dump that claims so many atoms.
inline std::string frame_of_dump(int claimed, const std::string& rows) {
  return fmt::format(
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
      "ITEM: ATOMS id x y z radius\n{}",
      claimed, rows);
}

}  // namespace bernal::testing
