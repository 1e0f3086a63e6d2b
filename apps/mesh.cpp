#include <map>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/mesh_files/mesh_packing.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/result/read_packing.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "results.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct MeshCall {
  std::filesystem::path folder, file;
  std::string format;
  std::map<std::string, std::string> words;  ///< of the keys
  int threads = 0;
  bool json = false, quiet = false;
};

std::string text_of_place(const Vector<3>& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]);
}

void print_surface(const BedMeshReport& report, std::string_view unit) {
  fmt::print("spheres      {}; {} bridges", grouped(report.spheres), grouped(report.necks));
  if (report.shrunk_necks > 0)
    fmt::print(", {} of them narrower than asked for, by up to {:.0f} %, so that they stay apart",
               grouped(report.shrunk_necks), 100 * report.largest_neck_shrink);
  if (report.cut_fillets > 0) fmt::print(", {} cylinders at ends of periods", grouped(report.cut_fillets));
  if (report.widened_necks > 0) fmt::print(", {} wider", grouped(report.widened_necks));
  if (report.deepened_caps > 0) fmt::print(", {} caps deeper than asked for", grouped(report.deepened_caps));
  if (report.clipped > 0) fmt::print("; {} spheres cut by faces of the part", grouped(report.clipped));
  if (report.cleared > 0)
    fmt::print("; {} spheres that {} nearly touches made smaller there, whole or in a layer",
               grouped(report.cleared), report.clipped > 0 ? "a face of the part" : "an end of a period");
  if (report.gaps_at_edges > 0)
    fmt::print("; {} with a gap instead, at walls where no bridge fits into a flat part",
               grouped(report.gaps_at_edges));
  if (report.shrunk_spheres > 0)
    fmt::print("; {} smaller than packed, by up to {:.2g} %", grouped(report.shrunk_spheres),
               100 * report.largest_sphere_shrink);
  if (report.wall_deviation > 0)
    fmt::print("\nwalls        triangles of curved walls, about {:.3g} {} off them at most",
               report.wall_deviation, unit);
  fmt::print("\nsurface      {} triangles, least edge {:.4g} {}, least angle {:.2f} degrees near {}\n",
             grouped(report.triangles), report.least_edge, unit, report.least_triangle_angle,
             text_of_place(report.place_of_least_angle));
}

void print_quality(const BedMeshReport& report, std::string_view unit) {
  fmt::print("mesh         {} tetrahedra, {} nodes\n", grouped(report.tetrahedra), grouped(report.nodes));
  if (report.prisms > 0)
    fmt::print(
        "prisms       {}, on {:.1f} % of the spheres, {:.4g} {} high in the mean, from {:.4g}; "
        "scaled Jacobian from {:.4f}\n",
        grouped(report.prisms), 100 * report.prism_share, report.mean_prism_height, unit,
        report.least_prism_height, report.least_scaled_jacobian);
  fmt::print("quality      SICN from {:.4f}, mean {:.3f}; dihedral angles {:.2f} to {:.2f} degrees\n",
             report.least_sicn, report.mean_sicn, report.least_angle, report.largest_angle);
  if (report.least_curved_sicn)
    fmt::print("curved       SICN from {:.4f}; {} edges on round surfaces, {} of them kept straight\n",
               *report.least_curved_sicn, grouped(report.curved_edges), grouped(report.straight_edges));
  fmt::print("by tenths   ");
  for (const std::size_t count : report.histogram) fmt::print(" {}", grouped(count));
  fmt::print("\n");
  for (std::size_t k = 0; k < report.worst.size(); ++k)
    fmt::print("{:<13}{:.4f} at {}\n", k == 0 ? "worst" : "", report.worst[k].sicn,
               text_of_place(report.worst[k].center));
}

void print_report(const BedMeshReport& report, std::string_view unit) {
  print_surface(report, unit);
  if (!report.is_surface) print_quality(report, unit);
  fmt::print("porosity     {:.6f} in closed form, {:.6f} {}", report.porosity, report.meshed_porosity,
             report.is_surface ? "between the triangles" : "of the mesh");
  if (report.packed_porosity) fmt::print("; {:.6f} as packed", *report.packed_porosity);
  if (report.contact_area > 0) fmt::print("; contact area {:.6g} {}^2", report.contact_area, unit);
  fmt::print("\n");
  for (const BedMeshReport::Group& group : report.groups) {
    fmt::print("{:<12} ", group.name);
    if (!report.is_surface) fmt::print("{} tetrahedra, ", grouped(group.tetrahedra));
    fmt::print("volume {:.9g} {}^3", group.volume, unit);
    if (group.stated_volume)
      fmt::print(", {:.9g} in closed form ({:+.2g} %)", *group.stated_volume,
                 100 * (group.volume / *group.stated_volume - 1));
    fmt::print("\n");
  }
  fmt::print("seconds     ");
  for (const BedMeshReport::Part& part : report.parts) {
    fmt::print(" {} {:.1f}", part.name, part.seconds);
    if (part.peak_bytes > 0) fmt::print(" ({:.2f} GB)", part.peak_bytes / 1e9);
  }
  fmt::print("\n");
}

/// Where the mesh may not be of what the user thinks of.
void say_cautions(const Packing& packing, const std::filesystem::path& folder) {
  for (const std::filesystem::path& changed : changed_files(packing.scene))
    say(stderr, "caution    {} has changed since it was packed into; the walls are those that it holds now\n",
        plain_text(changed.string()));
  if (const std::string shortfall = shortfall_of_result(folder); !shortfall.empty())
    say(stderr, "caution    the packing is not what was asked for: {}\n", shortfall);
}

int mesh_of(const MeshCall& call) {
  require_named_file(call.file);
  const MeshFileOptions options = mesh_options_of(call.format, call.words);
  const auto limit = limited_to(call.threads);
  ProgressBar bar(call.quiet || call.json);
  bar.now("read");
  const Packing packing = read_result(call.folder);
  if (!call.quiet) say_cautions(packing, call.folder);
  const MeshedPacking meshed = mesh_packing(packing, options, call.file, bar.monitor());
  bar.clear();
  const BedMeshReport& report = meshed.report;
  if (call.json)
    fmt::print("{}", mesh_report_as_json(packing, report));
  else if (!call.quiet)
    print_report(report, name_of(packing.scene.unit));
  if (!call.quiet) say_written(call.format, meshed.note, meshed.files);
  if (report.keeps_promise()) return exit_code::done;
  say(stderr, "bernal: the least SICN is {:.4f}, below {}: smaller --mesh-size and --neck-size help\n",
      report.worst_sicn(), BedMeshReport::promised_sicn);
  return exit_code::not_reached;
}

std::vector<Entry> entries_of_mesh_formats() {
  std::vector<Entry> entries;
  for (const MeshFormat& format : mesh_formats())
    entries.push_back({format.name, fmt::format("{}; {}", format.what, format.ending)});
  return entries;
}

Option option_of(const MeshKey& key, std::map<std::string, std::string>& words) {
  Option option{option_of_key(key.name),
                [&words, name = key.name](const std::string& word) { words[name] = word; }, key.what,
                key.placeholder};
  if (!key.words.empty()) return one_of(std::move(option), key.words);
  if (std::holds_alternative<std::string MeshFileOptions::*>(key.to)) return option;
  if (std::holds_alternative<int MeshFileOptions::*>(key.to))
    return within(std::move(option), static_cast<int>(key.least), static_cast<int>(key.most));
  return within(std::move(option), key.least, key.most);
}

}  // namespace

Command mesh_command() {
  const auto call = std::make_shared<MeshCall>();
  Command command{
      "mesh",
      "Tetrahedra between spheres, and in them: beds for flow, heat and loads",
      {folder(required({"RESULT", &call->folder, "What bernal pack wrote", "DIR"})),
       offering(required({"--to", &call->format, "The format, one of those below", "FORMAT"}),
                names_of(mesh_formats())),
       required({"-o,--output", &call->file, "The file; those that go with it stand beside it", "FILE"})},
      {.text =
           "Spheres that touch are treated first: bridge joins them by cylinders, fillet by parts of tori "
           "that touch both, gap makes only these smaller, shrink all by one factor, cap cuts caps off. Then "
           "bernal makes a surface whose triangles fit to "
           "each other, equal at opposite ends of periods, and the program tetgen fills it (apt-get install "
           "tetgen). Tetrahedra of little quality are improved. What is printed: the quality as SICN, which "
           "is "
           "1 for the regular tetrahedron and 0 for a flat one, the places of the worst, and the porosity in "
           "closed form beside the one that the mesh has.\n\nLengths are in the unit of the scene.",
       .lists = {{.title = "Formats", .entries = entries_of_mesh_formats()}},
       .examples = {{"bernal mesh out --to openfoam -o case/bed.foam",
                     "polyMesh of the pores, for checkMesh"},
                    {"bernal mesh out --to openfoam -o case/bed.foam --prisms 3", "with boundary layers"},
                    {"bernal mesh out --to openfoam -o case --patches \"inlet: z = 0, outlet: z = 4 cm\"",
                     "with inlet and outlet of a CAD part"},
                    {"bernal mesh out --to gmsh -o bed.msh --regions all",
                     "pores and spheres, for Gmsh, meshio"},
                    {"bernal mesh out --to abaqus -o rve.inp --regions all --order 2", "C3D10, for CalculiX"},
                    {"bernal mesh out --to snappy -o case/bed.foam --prisms 2",
                     "case of snappyHexMesh, with layers; needs no tetgen"},
                    {"bernal mesh out --to vtu -o bed.vtu --contact gap", "for ParaView, with quality"}},
       .exit_codes = {{"0", "the mesh is there, and its least SICN is 0.1 or more"},
                      {"2", "bad input, or no mesh"},
                      {"3", "written, with a least SICN below 0.1; or stopped by Ctrl-C, nothing written"}}},
      [call] { return all_or_nothing(call->quiet, [&] { return mesh_of(*call); }); }};
  for (const MeshKey& key : mesh_keys()) command.options.push_back(option_of(key, call->words));
  command.options.push_back(threads_option(call->threads, "the mesh"));
  command.options.push_back(json_option(call->json));
  command.options.push_back(quiet_option(call->quiet, "Print nothing but errors"));
  return command;
}
