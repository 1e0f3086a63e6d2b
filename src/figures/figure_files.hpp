#pragma once
#include <string>
#include <vector>

#include "bernal/figures/figures.hpp"

namespace bernal::figures {

struct File {
  std::string name, text;
};
using Files = std::vector<File>;  ///< empty where the monitor stopped it

/// Writes all of them or none; returns where they are.
std::vector<std::filesystem::path> write_files(const Files&, const std::filesystem::path& folder);

// One file a figure.
Files figure_1(const FigureOptions&);
Files figure_2(const FigureOptions&);
Files figure_3(const FigureOptions&);
Files figure_5(const FigureOptions&);
Files figure_6(const FigureOptions&);
Files soft_particles(const FigureOptions&);
Files table_1(const FigureOptions&);
Files table_2(const FigureOptions&);
Files farr_2013(const FigureOptions&);
Files han_2005(const FigureOptions&);
Files zhao_2007(const FigureOptions&);

}  // namespace bernal::figures
