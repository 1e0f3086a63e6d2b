#include <memory>
#include <optional>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/mesh_files/mesh_packing.hpp"
#include "bernal/result/read_packing.hpp"
#include "commands.hpp"
#include "progress_bar.hpp"
#include "say.hpp"
#include "say_unpublished.hpp"

using namespace bernal;

namespace {

struct MeshCall {
  std::filesystem::path folder, file;
  MeshFileOptions options;
  std::string contact = "bridge", regions = "fluid";
  int threads = 0;
  bool json = false, quiet = false;
};

ContactTreatment treatment_named(const std::string& name) {
  if (name == "bridge") return ContactTreatment::bridge;
  if (name == "gap") return ContactTreatment::gap;
  if (name == "shrink") return ContactTreatment::shrink;
  return ContactTreatment::cap;
}

std::string text_of_place(const Vector<3>& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]);
}

void print_surface(const BedMeshReport& report, std::string_view unit) {
  fmt::print("spheres      {}; {} necks", grouped(report.spheres), grouped(report.necks));
  if (report.shrunk_necks > 0)
    fmt::print(", {} of them narrower than asked for", grouped(report.shrunk_necks));
  fmt::print("\nsurface      {} triangles, least edge {:.4g} {}, least angle {:.2f} degrees near {}\n",
             grouped(report.triangles), report.least_edge, unit, report.least_triangle_angle,
             text_of_place(report.place_of_least_angle));
}

void print_quality(const BedMeshReport& report) {
  fmt::print("mesh         {} tetrahedra, {} nodes\n", grouped(report.tetrahedra), grouped(report.nodes));
  fmt::print("quality      SICN from {:.4f}, mean {:.3f}; dihedral angles {:.2f} to {:.2f} degrees\n",
             report.least_sicn, report.mean_sicn, report.least_angle, report.largest_angle);
  if (report.least_curved_sicn) fmt::print("curved       SICN from {:.4f}\n", *report.least_curved_sicn);
  fmt::print("by tenths   ");
  for (const std::size_t count : report.histogram) fmt::print(" {}", grouped(count));
  fmt::print("\n");
  for (std::size_t k = 0; k < report.worst.size(); ++k)
    fmt::print("{:<13}{:.4f} at {}\n", k == 0 ? "worst" : "", report.worst[k].sicn,
               text_of_place(report.worst[k].center));
}

void print_report(const BedMeshReport& report, std::string_view unit) {
  print_surface(report, unit);
  print_quality(report);
  fmt::print("porosity     {:.6f} in closed form, {:.6f} of the mesh", report.porosity,
             report.meshed_porosity);
  if (report.contact_area > 0) fmt::print("; contact area {:.6g} {}^2", report.contact_area, unit);
  fmt::print("\n");
  for (const BedMeshReport::Group& group : report.groups)
    fmt::print("{:<13}{} tetrahedra, volume {:.9g} {}^3\n", group.name, grouped(group.tetrahedra),
               group.volume, unit);
  fmt::print("seconds     ");
  for (const BedMeshReport::Part& part : report.parts) {
    fmt::print(" {} {:.1f}", part.name, part.seconds);
    if (part.peak_bytes > 0) fmt::print(" ({:.2f} GB)", part.peak_bytes / 1e9);
  }
  fmt::print("\n");
}

int mesh_of(MeshCall call) try {
  if (call.file == "-")
    throw Error(ErrorCode::bad_argument, "a mesh may need several files; give -o the name of one");
  call.options.contact = treatment_named(call.contact);
  call.options.solids = call.regions == "all";
  std::optional<tbb::global_control> limit;
  if (call.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(call.threads));
  ProgressBar bar(call.quiet || call.json);
  bar.now("read");
  const Packing packing = read_packing(call.folder);
  say_if_unpublished(call.folder);
  const MeshedPacking meshed = mesh_packing(packing, call.options, call.file, bar.monitor());
  bar.clear();
  const BedMeshReport& report = meshed.report;
  if (call.json)
    fmt::print("{}", mesh_report_as_json(packing, report));
  else if (!call.quiet)
    print_report(report, name_of(packing.scene.unit));
  if (!call.quiet) {
    say(stderr, "{:<10} {}\n", call.options.format, meshed.note);
    for (std::size_t i = 0; i < meshed.files.size(); ++i)
      say(stderr, "{:<10} {}\n", i == 0 ? "files" : "", plain_text(meshed.files[i].string(), 5000));
  }
  if (report.keeps_promise()) return exit_code::done;
  say(stderr, "bernal: the least SICN is {:.4f}, below {}: smaller --mesh-size and --neck-size help\n",
      report.least_sicn, BedMeshReport::promised_sicn);
  return exit_code::not_reached;
} catch (const Cancelled&) {
  if (!call.quiet) say(stderr, "bernal: stopped by the user; nothing is written\n");
  return exit_code::not_reached;
}

std::vector<std::string> names_of_mesh_formats() {
  std::vector<std::string> names;
  for (const MeshFormat& format : mesh_formats()) names.push_back(format.name);
  return names;
}

std::vector<Entry> entries_of_mesh_formats() {
  std::vector<Entry> entries;
  for (const MeshFormat& format : mesh_formats())
    entries.push_back({format.name, fmt::format("{}; {}", format.what, format.ending)});
  return entries;
}

}  // namespace

Command mesh_command() {
  const auto call = std::make_shared<MeshCall>();
  MeshFileOptions& options = call->options;
  return {
      "mesh",
      "Tetrahedra between spheres, and in them: beds for flow, heat and loads",
      {folder(required({"RESULT", &call->folder, "What bernal pack wrote", "DIR"})),
       offering(required({"--to", &options.format, "The format, one of those below", "FORMAT"}),
                names_of_mesh_formats()),
       required({"-o,--output", &call->file, "The file; those that go with it stand beside it", "FILE"}),
       one_of({"--contact", &call->contact, "What is done where spheres touch or nearly do; bridge if absent",
               "WORD"},
              {"bridge", "gap", "shrink", "cap"}),
       within({"--gap", &options.gap, "Contacts nearer than this, in radii; 0.01 if absent", "SHARE"}, 1e-6,
              0.5),
       within({"--bridge-radius", &options.bridge_radius, "Of bridges, in radii; 0.2 if absent", "SHARE"},
              0.01, 0.7),
       within({"--mesh-size", &options.sphere_edge, "Edges on spheres, in radii; 0.3 if absent", "SHARE"},
              0.02, 0.9),
       within({"--neck-size", &options.neck_edge, "Edges where bridges begin, in radii; 0.15 if absent",
               "SHARE"},
              0.01, 0.9),
       within({"--gap-size", &options.gap_edge,
               "Edges where surfaces are near each other, in widths of the gap; 4 if absent", "WIDTHS"},
              0.5, 50.0),
       one_of({"--regions", &call->regions, "What is meshed: the fluid, or the spheres too; fluid if absent",
               "WORD"},
              {"fluid", "all"}),
       within({"--order", &options.order, "2: elements with middles of edges, on the true spheres", "N"}, 1,
              2),
       threads_option(call->threads, "the mesh"), json_option(call->json),
       quiet_option(call->quiet, "Print nothing but errors")},
      {.text =
           "Spheres that touch are treated first: bridge joins them by cylinders, gap makes only these "
           "smaller, "
           "shrink all by one factor, cap cuts caps off. Then bernal makes a surface whose triangles fit to "
           "each other, equal at opposite ends of periods, and the program tetgen fills it (apt-get install "
           "tetgen). Tetrahedra of little quality are improved. What is printed: the quality as SICN, which "
           "is "
           "1 for the regular tetrahedron and 0 for a flat one, the places of the worst, and the porosity in "
           "closed form beside the one that the mesh has.\n\nLengths are in the unit of the scene.",
       .lists = {{.title = "Formats", .entries = entries_of_mesh_formats()}},
       .examples = {{"bernal mesh out --to openfoam -o case/bed.foam",
                     "polyMesh of the pores, for checkMesh"},
                    {"bernal mesh out --to gmsh -o bed.msh --regions all",
                     "pores and spheres, for Gmsh, meshio"},
                    {"bernal mesh out --to abaqus -o rve.inp --regions all --order 2", "C3D10, for CalculiX"},
                    {"bernal mesh out --to vtu -o bed.vtu --contact gap", "for ParaView, with quality"}},
       .exit_codes = {{"0", "the mesh is there, and its least SICN is 0.1 or more"},
                      {"2", "bad input, or no mesh"},
                      {"3", "written, with a least SICN below 0.1; or stopped by Ctrl-C, nothing written"}}},
      [call] { return mesh_of(*call); }};
}
