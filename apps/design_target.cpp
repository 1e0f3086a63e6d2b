#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/predict/design.hpp"
#include "commands.hpp"
#include "design.hpp"
#include "design_families.hpp"
#include "say.hpp"

using namespace bernal;

namespace {

struct TargetCall {
  double phi = 0;
  std::string family;
  std::optional<double> min, max, ratio;
  double exponent = 0.5;
  int rods = 16000;
  bool json = false;
};

struct TargetAnswer {
  Match match{};
  SizeFamily::Member member{};
  std::string what;
  std::optional<double> cut_off{};  ///< of the volume, by the limits of lognormal sizes
  bool can_be_wider = false;        ///< limits keep the family from its widest
  double seconds = 0;
};

Match match_member(const std::function<SizeFamily::Member(double)>& member, double from, double to,
                   const TargetCall& call) {
  return match_packing_fraction([&](double t) { return sizes_of_table(member(t).table); }, from, to, call.phi,
                                call.rods);
}

/// The part of the volume of lognormal sizes that lies beyond limits of this ratio about their median.
double beyond(double ratio, double sigma) {
  return std::erfc(0.5 * std::log(ratio) / (sigma * std::sqrt(2.0)));
}

TargetAnswer find(const TargetCall& call) {
  if (!(call.phi > 0 && call.phi < 1))
    throw Error(ErrorCode::bad_argument,
                fmt::format("--phi: a packing fraction lies between 0 and 1, not at {}", call.phi));
  if (!(call.exponent > 0 && call.exponent <= 10))
    throw Error(ErrorCode::bad_argument,
                fmt::format("--exponent must lie above 0 and not above 10, not at {}", call.exponent));
  const SizeLimits limits = limits_of(call.min, call.max, call.ratio);
  const SizeFamily family = family_of(call.family, limits, call.exponent, call.rods);

  const Stopwatch watch;
  TargetAnswer answer{.what = family.what};
  answer.match = match_member(family.member, family.from, family.to, call);
  if (family.held && (answer.match.found || answer.match.most > call.phi)) {
    // The best share is known near the root. With that share held fixed phi is continuous and has a root
    // there.
    const double t = answer.match.found ? answer.match.parameter : answer.match.at_most;
    const auto member = family.held(t);
    const Match held =
        match_member(member, std::max(family.from, t - 0.2), std::min(family.to, t + 0.2), call);
    if (held.found) answer.match = held;
    answer.member = member(answer.match.parameter);
  } else {
    answer.member = family.member(answer.match.parameter);
  }
  if (answer.match.found && call.family == "lognormal" && limits.min)
    answer.cut_off = beyond(*limits.max / *limits.min, answer.match.parameter);
  answer.can_be_wider = limits.min || call.family != "lognormal";
  answer.seconds = watch.seconds();
  return answer;
}

void print(const TargetAnswer& answer) {
  fmt::print("packing fraction  {:.6f}, random close packing without walls\n", answer.match.prediction.phi);
  fmt::print("{:<18}{:.6g}; the narrowest of {}\n", answer.member.name, answer.member.value, answer.what);
  if (answer.cut_off)
    fmt::print("cut off           {:.2g} % of the volume would lie beyond these limits\n",
               100 * *answer.cut_off);
  print_error_and_table(answer.match.prediction, answer.member.table);
}

nlohmann::ordered_json as_json(const TargetCall& call, const TargetAnswer& answer) {
  nlohmann::ordered_json json;
  if (answer.match.found)
    json = table_as_json(answer.match.prediction, answer.member.table);
  else
    json = {{"phi", nullptr}, {"diameter", nullptr}, {"reachable", {answer.match.least, answer.match.most}}};
  json["found"] = answer.match.found;
  json["target"] = call.phi;
  json["family"] = call.family;
  if (answer.match.found) json["parameter"] = {{"name", answer.member.name}, {"value", answer.member.value}};
  if (answer.cut_off) json["cut_off"] = *answer.cut_off;
  json["seconds"] = answer.seconds;
  return json;
}

int target(const TargetCall& call) {
  const TargetAnswer answer = find(call);
  if (call.json)
    fmt::print("{}\n", as_json(call, answer).dump(2));
  else if (answer.match.found)
    print(answer);
  if (answer.match.found) return exit_code::done;
  say(stderr, "bernal: no {} pack to {}: they reach from {:.6f} to {:.6f}{}\n", answer.what, call.phi,
      answer.match.least, answer.match.most,
      call.phi > answer.match.most && answer.can_be_wider ? "; wider limits reach farther" : "");
  return exit_code::not_reached;
}

Explanation target_explanation() {
  return {
      .text =
          "Limits: no sphere is smaller or larger. --max-ratio R alone is from 1 to R; with --min or --max "
          "from "
          "or to there; --min and --max say both. Without any, lognormal sizes are not cut off and have a "
          "median of 1, the others have 1 : 100. Sizes that need less than the limits allow begin at the "
          "smallest, or, where --max is given, end at the largest.",
      .lists =
          {{.title = "Families",
            .text = "each by volume and from narrow to wide by one number; the narrowest that will do is "
                    "taken.",
            .entries = {{"lognormal",
                         "sigma, about the middle of the limits (on a logarithmic axis), cut off at both"},
                        {"rosin_rammler", "the slope n, with d63 at that middle, cut off at both limits"},
                        {"uniform", "max/min"},
                        {"fuller", "max/min, of the exponent given"},
                        {"two_sizes", "max/min, each ratio with the composition that packs densest"}}}},
      .examples = {{"bernal design target --phi 0.7 --family lognormal", "sigma = 0.4619"},
                   {"bernal design target --phi 0.7 --family lognormal --max-ratio 10",
                    "cut off at both ends"},
                   {"bernal design target --phi 0.75 --family fuller --max 16 --max-ratio 30 --json",
                    "a grading, for programs"}},
      .exit_codes = {{"0", "done"},
                     {"2", "bad input"},
                     {"3", "no member of the family packs so, and what the family reaches"}}};
}

}  // namespace

Command target_command() {
  const auto call = std::make_shared<TargetCall>();
  return {"target",
          "The sizes of a family that pack to a given packing fraction",
          {required({"--phi", &call->phi, "The packing fraction asked for", "P"}),
           one_of(required({"--family", &call->family, "One of the families below", "NAME"}), family_names()),
           {"--max-ratio", &call->ratio, "The largest over the smallest diameter, at most", "R"},
           {"--min", &call->min, "No diameter is smaller than this, in any unit", "D"},
           {"--max", &call->max, "No diameter is larger, in the same unit", "D"},
           {"--exponent", &call->exponent, "Of fuller; 0.5 if absent", "Q"},
           rods_option(call->rods, 100, 10'000'000),
           json_option(call->json)},
          target_explanation(),
          [call] { return target(*call); }};
}
