#include "hard/table/hard_case.hpp"
#include "bernal/run/run.hpp"

#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"
#include "support/plain_check.hpp"

namespace bernal::hard {
namespace {

constexpr std::string_view offered = "{offered}";

/// The first line that `bernal inspect` offers for the mesh of this scene.
std::string offered_line(const std::filesystem::path& file) {
  const Scene scene = read_scene(file);
  const auto& mesh = std::get<MeshFile>(scene.container);
  const ImportFor purpose{scene.unit, radii_of(scene)->min()};
  const std::vector<std::string> lines =
      lines_that_help(mesh, purpose, read_mesh(mesh, purpose), Effort::thorough);
  return lines.empty() ? "# nothing is offered" : lines.front();
}

/// The case as files; the path of its scene.
std::filesystem::path written(const Case& c, const testing::Folder& folder) {
  for (const File& file : c.files) folder.write(file.name, file.content());
  return folder.write("scene.toml", c.scene);
}

End end_of(const std::filesystem::path& file, WallArithmetic walls) {
  End end;
  end.walls = walls;
  const auto start = std::chrono::steady_clock::now();
  const auto stop = [&] {
    end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  try {
    Scene read = read_scene(file);
    read.walls = walls;
    const Packing packing = run(build(read), {.seed = {}, .threads = 1, .monitor = {}});
    stop();
    end.spheres = packing.spheres.size();
    end.packing_fraction = packing.packing_fraction();
    end.volume = packing.volume;
    if (packing.spheres.dimension() == 3) end.bounds = bounds_of(packing.domain);
    end.outcome = packing.outcome;
    end.reason = packing.reason;
    end.certificate =
        certify(packing.spheres, packing.domain,
                {.allowed_overlap = read.overlap, .arithmetic = Arithmetic::exact, .threads = 1});
    end.plain_objection = testing::plain_objection(packing.spheres, packing.domain, read.overlap);
  } catch (const Error& error) {
    stop();
    end.refusal = error.what();
    // Names of folders say nothing and differ from machine to machine.
    for (const std::string& folder : {file.parent_path().string() + "/", std::string(BERNAL_SOURCE "/")})
      for (std::size_t at; (at = end.refusal.find(folder)) != std::string::npos;)
        end.refusal.erase(at, folder.size());
  }
  return end;
}

}  // namespace

Case with_offered_line(Case c) {
  const std::size_t at = c.scene.find(offered);
  if (at == std::string::npos) return c;
  c.scene.erase(at, offered.size());
  const testing::Folder folder;
  c.offered = offered_line(written(c, folder));
  c.scene.insert(at, c.offered);
  return c;
}

End end_of(const Case& c, WallArithmetic walls) {
  const testing::Folder folder;
  return end_of(written(c, folder), walls);
}

std::vector<WallArithmetic> levels_of(const Case& c) {
  if (c.expected.kind == Expected::Kind::refused || c.scene.find("kind = \"periodic\"") != std::string::npos)
    return {WallArithmetic::filtered};
  return {WallArithmetic::plain, WallArithmetic::filtered, WallArithmetic::exact};
}

std::string objection(const Case& c, const End& end) {
  const Expected& expected = c.expected;
  if (expected.kind == Expected::Kind::refused) {
    if (end.refusal.empty()) return fmt::format("was packed, {} spheres: {}", end.spheres, end.reason);
    if (end.refusal.find('\n') != std::string::npos) return "more than one line: " + end.refusal;
    if (end.refusal.find(expected.words) == std::string::npos) return "another reason: " + end.refusal;
    return "";
  }
  if (!end.refusal.empty()) return "was refused: " + end.refusal;
  if (!end.certificate.certified) return end.certificate.statement;
  if (!end.plain_objection.empty()) return end.plain_objection;
  if (end.spheres < expected.least || end.spheres > expected.most)
    return fmt::format("{} spheres: {}", end.spheres, end.reason);
  if (expected.kind == Expected::Kind::packed && end.outcome != Outcome::converged)
    return fmt::format("{}: {}", name_of(end.outcome), end.reason);
  if (end.outcome == Outcome::converged && end.spheres == 0) return "converged without a sphere";
  if (end.reason.empty()) return "no reason is given";
  if (end.reason.find(expected.words) == std::string::npos) return "another reason: " + end.reason;
  if (expected.volume && !(std::abs(end.volume - *expected.volume) <= expected.within * *expected.volume))
    return fmt::format("volume {:.17g}, not {:.17g}", end.volume, *expected.volume);
  if (expected.lower) {
    const double off = (end.bounds.lower - *expected.lower).norm();
    if (!(off <= 1e-6 * (end.bounds.upper - end.bounds.lower).norm()))
      return fmt::format("stands {} aside", off);
  }
  return "";
}

std::string scene(const std::string& container, const std::string& spheres, const std::string& rest) {
  return "unit = \"mm\"\n[container]\n" + container + "\n[spheres]\n" + spheres + "\n" + rest;
}

std::string stages(std::initializer_list<const char*> names) {
  std::string text;
  for (const char* name : names) text += fmt::format("[[stage]]\ndo = \"{}\"\n", name);
  return text;
}

const std::vector<Protocol>& protocols() {
  static const std::vector<Protocol> all = {
      {"default", ""},
      {"insert", stages({"insert"})},
      {"relax", stages({"relax"})},
      {"grow", stages({"grow"})},
      {"settle", stages({"insert", "compress", "shake", "refill"})},
  };
  return all;
}

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (auto* cases : {tight_cases, thin_cases, far_and_scaled_cases, size_cases, count_cases, refusal_cases,
                      mesh_cases, broken_mesh_cases, format_cases, model_cases}) {
    std::vector<Case> more = cases();
    std::ranges::move(more, std::back_inserter(all));
  }
  return all;
}

}  // namespace bernal::hard
