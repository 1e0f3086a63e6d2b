#pragma once
#include <string>
#include <vector>

#include "command_line.hpp"

/// A page of the manual, in the macros man(7), which man-db and mandoc read.
struct Page {
  std::string name;  ///< "bernal-pack"; the file is bernal-pack.1
  std::string text;
};

/// One page for the command and for each of its commands, made of the same data as --help. `version` is
/// "bernal 0.2.0", `day` "2025-01-31". Pure ASCII; the same arguments give the same pages.
std::vector<Page> manual_pages(const Command& bernal, const std::string& version, const std::string& day);
