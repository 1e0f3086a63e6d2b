#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// The text, and at its end what says that bernal wrote it, between what makes it a comment there: a digest
/// of all the rest, so that whoever changes anything breaks the seal.
std::string sealed(std::string text, std::string_view before, std::string_view after);
/// Of a script whose comments begin so; it answers for the files that go with it, which stand as they will.
std::string sealed_script(std::string text, const std::vector<std::filesystem::path>& with = {},
                          std::string_view comment = "# ");

/// Whether the text has a seal that is whole.
bool is_sealed(std::string_view text);

/// Whether it has a seal, whole or broken.
bool has_seal(const std::filesystem::path& file);

/// Whether bernal wrote a file that goes with others, and nobody has changed it: it is sealed, or a file
/// among the others that is answers for it. False where it cannot be read.
bool is_as_bernal_wrote(const std::filesystem::path& file, const std::vector<std::filesystem::path>& others);

}  // namespace bernal
