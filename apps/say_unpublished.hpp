#pragma once
#include <filesystem>

#include "bernal/core/text.hpp"
#include "bernal/result/read_packing.hpp"
#include "say.hpp"

/// Prints a note if the result is read from the place where a killed run left it.
inline void say_if_unpublished(const std::filesystem::path& folder) {
  if (bernal::is_unpublished(folder))
    say(stderr,
        "bernal: {}: a run was killed while it put its result there; this is that result, and nothing was "
        "moved: the next run that writes there puts it into place\n",
        bernal::plain_text(folder.string(), 5000));
}
