#pragma once
#include <gtest/gtest.h>

#include <string>

#include "bernal/run/run.hpp"
#include "support/plans.hpp"

namespace bernal::testing {

/// What a run of this scene says when it refuses it as a bad scene; empty if it does not.
inline std::string error_of(const std::string& toml) {
  try {
    run(plan_of(toml));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    return error.what();
  }
  return "";
}

}  // namespace bernal::testing
