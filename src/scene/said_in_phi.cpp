#include "scene/said_in_phi.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "scene/read_value.hpp"

namespace bernal {

void SaidInPhi::note(const toml::node& node, std::string_view key, int line) {
  if (const auto* text = node.as_string(); text && trimmed(text->get()).ends_with("phi"))
    said_.emplace_back(line, fmt::format("{} = {}", key, written(node)));
}

void SaidInPhi::explain(const Error& error) const {
  std::vector<std::string> here;
  for (const auto& [line, text] : said_)
    if (line == error.location().line) here.push_back(text);
  if (here.size() < 2) return;
  const std::string where = error.location().text(), what = error.what();
  throw Error(error.code(),
              fmt::format("{}; the scene says {}: on the phi scale the larger number is the finer grain",
                          what.substr(where.empty() ? 0 : where.size() + 2), fmt::join(here, ", ")),
              error.location());
}

}  // namespace bernal
