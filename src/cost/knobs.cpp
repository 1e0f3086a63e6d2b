#include "cost/knobs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cost/cost_folder.hpp"
#include "cost/faceted.hpp"
#include "result/write_off.hpp"
#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"

namespace bernal::cost {
namespace {

/// Packing fractions that are asked for where the scene asks for none, over what is attainable. Few of them
/// lie below it: they say little more than what was asked for.
constexpr std::array target_shares = {0.85, 0.95, 1.0025, 1.005, 1.0075, 1.01, 1.0125, 1.015, 1.0175, 1.02};
/// The rarest size that counts where triangles follow the sizes.
constexpr double rare = 1e-2;
constexpr std::array face_counts = {12, 30, 100, 300, 1000};

std::optional<double> number_of(const schema::Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  return {};
}

std::string text_of_value(const schema::Value& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  return fmt::format("{:g}", number_of(value).value_or(0));
}

/// Writes a value into the part of a scene that a key is of.
using Put = std::function<void(Scene&, const schema::Value&)>;

Step step_of(const Put& put, const schema::Value& value) {
  return {.text = text_of_value(value),
          .turn = [put, value](Setting& setting) { put(setting.scene, value); },
          .number = number_of(value)};
}

/// The ladder of a key with the scene's own value in its place.
Knob knob_of(const schema::Key& key, const schema::Value& own, const Put& put) {
  std::vector<schema::Value> values = key.ladder;
  if (key.type == schema::Type::length)
    for (schema::Value& value : values) value = *number_of(value) * *number_of(own);
  const auto is_own = [&](const schema::Value& value) { return text_of_value(value) == text_of_value(own); };
  if (std::ranges::none_of(values, is_own)) {
    // A 0 before smaller and smaller numbers stands for none of it, the least accurate of all.
    const auto last = values.end() - 1;
    const bool begins_with_off =
        *number_of(values.front()) == 0 && *number_of(*(values.begin() + 1)) > *number_of(*last);
    const auto first = values.begin() + (begins_with_off ? 1 : 0);
    const bool falls = *number_of(*first) > *number_of(*last);
    const auto behind = std::find_if(first, values.end(), [&](const schema::Value& value) {
      return falls ? *number_of(value) < *number_of(own) : *number_of(value) > *number_of(own);
    });
    values.insert(behind, own);
  }
  Knob knob{.name = std::string(key.name), .is_limit = key.is_limit};
  for (const schema::Value& value : values) {
    if (is_own(value)) knob.own = knob.steps.size();
    knob.order.push_back(knob.steps.size());
    knob.steps.push_back(step_of(put, is_own(value) ? own : value));
  }
  if (number_of(own)) {
    knob.is_whole = key.type == schema::Type::integer;
    knob.step_at = [put, whole = knob.is_whole](double number) {
      return step_of(put, whole ? schema::Value(static_cast<std::int64_t>(number)) : schema::Value(number));
    };
  }
  return knob;
}

/// How many spheres there are, where the scene leaves that to its stages.
std::optional<Knob> target_knob(const Subject& subject) {
  const Target& own = subject.scene.target;
  if (!own.is_open() || subject.box_follows) return {};
  const auto asking = [&](double fraction) {
    return Step{.text = fmt::format("{:g}", fraction),
                .turn = [fraction](Setting& s) { s.scene.target = {.packing_fraction = fraction}; },
                .number = fraction};
  };
  Knob knob{.name = "packing_fraction", .step_at = asking};
  const auto add = [&](Step step) {
    knob.order.push_back(knob.steps.size());
    knob.steps.push_back(std::move(step));
  };
  const bool expects = subject.places_expected && !own.fill;
  Step as_it_is{.text = own.fill ? "fill" : "open", .turn = [](Setting&) {}};
  if (expects) as_it_is.number = subject.attainable_packing_fraction;
  for (const double share : target_shares) {
    if (expects && share > 1 && knob.own == 0) {
      knob.own = knob.steps.size();
      add(as_it_is);
    }
    const double fraction = std::floor(1e4 * share * subject.attainable_packing_fraction) / 1e4;
    if (fraction > 0 && fraction < 1) add(asking(fraction));
  }
  if (expects) {
    add({.text = "fill", .turn = [](Setting& s) { s.scene.target = {.fill = true}; }});
  } else {
    knob.own = knob.steps.size();
    add(as_it_is);
  }
  return knob;
}

/// Meshes that stand for a curved container, the coarsest first, then the container itself.
std::optional<Knob> face_knob(const Subject& subject, const std::filesystem::path& folder,
                              TrialRecord& record) {
  if (!faceted(*subject.domain, face_counts.front())) return {};
  Knob knob{.name = "faces", .note = "no key: of a mesh that stands for the container"};
  for (const int faces : face_counts) {
    const Faceted made = *faceted(*subject.domain, faces);
    const std::filesystem::path file = folder / fmt::format("container_{}_faces.off", faces);
    std::filesystem::create_directories(folder);
    write_beside(file, as_off_file(made.mesh), record);
    const auto turn = [file, domain = subject.domain](Setting& setting) {
      setting.scene.container = MeshFile{.file = file, .unit = setting.scene.unit};
      setting.meant = domain;
    };
    knob.order.push_back(knob.steps.size());
    knob.steps.push_back({.text = fmt::format("{}", faces), .turn = turn, .wall_deviation = made.deviation});
  }
  knob.own = knob.steps.size();
  knob.order.push_back(knob.own);
  knob.steps.push_back({.text = "exact", .turn = [](Setting&) {}});
  return knob;
}

/// Triangles of a CAD file, then the surface itself with coarser and finer triangles under it.
std::optional<Knob> surface_knob(const Subject& subject) {
  const double smallest_radius = subject.smallest_radius;
  const auto* own = std::get_if<MeshFile>(&subject.scene.container);
  if (!own || !has_true_surface(own->file) || !(smallest_radius > 0)) return {};
  constexpr double of_triangles = 0.02;  // deflection over radius where a scene says none
  Knob knob{.name = "true_surface", .tells_all = true};
  const auto add = [&](Step step) {
    knob.order.push_back(knob.steps.size());
    knob.steps.push_back(std::move(step));
  };
  const auto turn_to = [](bool on, std::optional<double> deflection) {
    return [on, deflection](Setting& setting) {
      auto& mesh = std::get<MeshFile>(setting.scene.container);
      mesh.true_surface = on;
      mesh.deflection = deflection;
    };
  };
  const auto as_it_is = [](Setting&) {};
  if (own->true_surface)
    add({.text = "false",
         .turn = turn_to(false, of_triangles * smallest_radius),
         .wall_deviation = of_triangles * smallest_radius});
  else
    add({.text = "false", .turn = as_it_is, .wall_deviation = own->deflection.value_or(0)});
  for (const double share : {of_triangles, 4e-3, 8e-4})
    add({.text = fmt::format("true with a deflection of {:.3g}", share * smallest_radius),
         .turn = turn_to(true, share * smallest_radius)});
  if (own->true_surface) {
    knob.own = knob.steps.size();
    add({.text = "true", .turn = as_it_is});
  }
  return knob;
}

/// Whether the scene with its first other value is one; by its text alone where `lightly`.
bool can_be_turned(const Knob& knob, const Subject& subject, bool lightly) {
  try {
    Setting setting{"", subject.scene};
    knob.steps[knob.own == 0 ? 1 : 0].turn(setting);
    lightly ? complete(setting.scene) : static_cast<void>(build(setting.scene));
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// A table of the scene that a knob is of: the stage of that name, counted from 1, or another table.
struct PlaceOfKnob {
  std::string name;
  int number = 0;
};

/// Names that several knobs have become longer ones.
void tell_apart(std::vector<Knob>& knobs, const std::vector<PlaceOfKnob>& places) {
  std::map<std::string, int> uses, uses_at;
  const auto at_place = [&](std::size_t k) { return places[k].name + " " + knobs[k].name; };
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    ++uses[knobs[k].name];
    ++uses_at[at_place(k)];
  }
  std::vector<std::string> names;
  for (std::size_t k = 0; k < knobs.size(); ++k)
    names.push_back(uses[knobs[k].name] == 1    ? knobs[k].name
                    : uses_at[at_place(k)] == 1 ? at_place(k)
                                                : fmt::format("{} ({})", at_place(k), places[k].number));
  for (std::size_t k = 0; k < knobs.size(); ++k) knobs[k].name = std::move(names[k]);
}

}  // namespace

std::size_t Knob::place_of(std::size_t step) const {
  return static_cast<std::size_t>(std::ranges::find(order, step) - order.begin());
}

std::optional<std::size_t> Knob::insert_between(std::size_t cheaper, std::size_t dearer) {
  // Fewer spheres than the scene places are no answer to what accuracy costs.
  if (name == "packing_fraction" && place_of(dearer) <= place_of(own)) return {};
  const auto a = steps[cheaper].number, b = steps[dearer].number;
  if (!step_at || !a || !b || !(*a > 0) || !(*b > 0)) return {};
  const double mean = std::sqrt(*a * *b);
  const double digits = name == "packing_fraction" ? 1e-4 : std::pow(10, std::floor(std::log10(mean)) - 1);
  const double number = is_whole ? std::round(mean) : std::round(mean / digits) * digits;
  const auto [least, most] = std::minmax(*a, *b);
  // Closer steps would measure the scatter of the seeds.
  constexpr double closest = 1.2;
  const bool has_room = name == "packing_fraction" ? most - least > 0.004 : most > closest * closest * least;
  if (!has_room || number <= least || number >= most) return {};
  steps.push_back(step_at(std::stod(fmt::format("{:.6g}", number))));
  order.insert(order.begin() + static_cast<std::ptrdiff_t>(place_of(dearer)), steps.size() - 1);
  return steps.size() - 1;
}

Subject subject_of(const Scene& scene) {
  Plan plan = build(scene);
  Subject subject{.scene = plan.scene,
                  .domain = std::make_shared<const Domain>(plan.domain),
                  .attainable_packing_fraction = plan.attainable_packing_fraction,
                  .mean_radius = plan.radii->moment(1),
                  .smallest_radius = plan.radii->quantile(rare),
                  .places_expected = plan.places_expected,
                  .box_follows = plan.box_follows};
  subject.is_predicted = subject.scene.target.predicted;
  subject.scene.target.predicted = false;  // but the number that it stands for
  for (MeshFile* mesh : subject.scene.meshes())
    for (std::filesystem::path* file : mesh->files())
      if (!mesh->surface_called(*file)) *file = std::filesystem::absolute(*file).lexically_normal();
  return subject;
}

std::vector<Knob> knobs_of(const Subject& subject, const std::filesystem::path& folder, TrialRecord& record) {
  std::vector<Knob> knobs;
  std::vector<PlaceOfKnob> places;
  std::map<std::string_view, int> stages_of_name;
  const auto keep = [&](std::optional<Knob> knob, std::string_view place, int number = 0) {
    const bool lightly = number > 0;
    if (!knob || knob->steps.size() < 2 || !can_be_turned(*knob, subject, lightly)) return;
    knobs.push_back(std::move(*knob));
    places.push_back({std::string(place), number});
  };
  const Scene& scene = subject.scene;
  for (std::size_t i = 0; i < scene.stages.size(); ++i) {
    const StageTable& table = table_of(scene.stages[i]);
    const bool in_bed = table.traits.stands_in_bed(scene);
    const int number = ++stages_of_name[table.name()];
    for (const auto& [key, value] : table.keys.said(table.options(scene.stages[i]))) {
      if (key->ladder.empty() || !key->acts_here(in_bed) || (key->is_limit && !subject.with_limits)) continue;
      const Put put = [i, key = key](Scene& s, const schema::Value& v) {
        key->member.set(table_of(s.stages[i]).options_of(s.stages[i]), v);
      };
      keep(knob_of(*key, value, put), table.name(), number);
    }
  }
  for (const auto& [key, value] : schema::accuracy_entry().said(&scene)) {
    if (key->ladder.empty()) continue;
    keep(knob_of(*key, value, [key = key](Scene& s, const schema::Value& v) { key->member.set(&s, v); }),
         schema::accuracy_entry().name);
  }
  const schema::Entry& container = schema::entry_of(scene.container);
  const auto* mesh = std::get_if<MeshFile>(&scene.container);
  const bool by_formulas = mesh && mesh->true_surface;  // triangles are no wall then
  for (const auto& [key, value] : container.said(schema::options_of(scene.container))) {
    if (key->ladder.empty() || by_formulas) continue;
    const Put put = [key = key](Scene& s, const schema::Value& v) {
      key->member.set(schema::options_of(s.container), v);
    };
    Knob knob = knob_of(*key, value, put);
    knob.step_at = {};
    for (Step& step : knob.steps) {
      step.wall_deviation = step.number.value_or(0);
      step.turn = [turn = step.turn, domain = subject.domain](Setting& setting) {
        turn(setting);
        setting.meant = domain;
      };
    }
    keep(std::move(knob), container.name);
  }
  keep(surface_knob(subject), "container");
  keep(face_knob(subject, folder, record), "container");
  keep(target_knob(subject), "spheres");
  tell_apart(knobs, places);
  return knobs;
}

}  // namespace bernal::cost
