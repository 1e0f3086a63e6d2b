#include "contact_text.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "say.hpp"

namespace bernal {
namespace {

/// In words, from which gap on contacts tell which spheres hold which.
std::string where_contacts_tell(const Measurements& measured) {
  if (measured.held_from) return fmt::format("of what holds what from a gap of {:g} on", *measured.held_from);
  return "of what holds what at none of these gaps";
}

/// How many spheres have how many contacts, and in which directions these are.
void print_neighbours(const ContactSums& sums, std::size_t spheres) {
  const std::vector<std::uint64_t> by_contacts = sums.spheres_by_contacts();
  std::vector<std::string> shares;
  for (std::size_t k = 0; k < by_contacts.size(); ++k)
    if (by_contacts[k] > 0)
      shares.push_back(fmt::format("{}: {:.3g} %", k,
                                   100 * static_cast<double>(by_contacts[k]) / static_cast<double>(spheres)));
  constexpr std::size_t in_a_line = 8;
  for (std::size_t k = 0; k < shares.size(); k += in_a_line)
    fmt::print("{:<18}{}\n", k == 0 ? "of a sphere" : "",
               fmt::join(shares.begin() + static_cast<std::ptrdiff_t>(k),
                         shares.begin() + static_cast<std::ptrdiff_t>(std::min(shares.size(), k + in_a_line)),
                         ", "));
  for (std::size_t k = 0; k < sums.fabric.size(); ++k)
    fmt::print("{:<18}{:>8.4f}\n", k == 0 ? "fabric tensor" : "", fmt::join(sums.fabric[k], " "));
}

/// "5.9107 contacts of each of 2,345 spheres", at the gap that counts.
std::string contacts_of_some_text(const ContactsOfSome& some) {
  return fmt::format("{:.4f} contacts of each of {} spheres", some.by_gap.back().coordination,
                     grouped(some.spheres));
}

/// The counts at every gap, and those in the core and in a slab.
void print_by_gap(const Measurements& measured) {
  const auto& core = measured.core_contacts;
  const auto& slab = measured.slab;
  fmt::print("\n{:>8} {:>12} {:>13} {:>10} {:>18} {:>13}{}{}\n", "gap", "contacts", "coordination",
             "rattlers", "backbone contacts", "of isostatic", core ? "  in the core" : "",
             slab ? "  in the slab" : "");
  for (std::size_t k = 0; k < measured.by_gap.size(); ++k) {
    const Contacts& at = measured.by_gap[k];
    const bool holds = measured.holds(at);
    fmt::print("{:>8.0e} {:>12} {:>13.4f} {:>10} {:>18} {:>13}", at.contact_gap, grouped(at.pairs),
               at.coordination, holds ? grouped(at.rattlers) : "-",
               holds ? grouped(at.backbone_contacts()) : "-",
               holds ? fmt::format("{:.4f}", static_cast<double>(at.backbone_contacts()) /
                                                 static_cast<double>(*at.isostatic))
                     : "-");
    for (const ContactsOfSome* some : {core ? &*core : nullptr, slab ? &slab->contacts : nullptr})
      if (some) fmt::print(" {:>12.4f}", some->by_gap[k].coordination);
    fmt::print("\n");
  }
}

}  // namespace

void print_contacts(const Packing& packing, const Measurements& measured) {
  const Contacts& c = measured.contacts;
  const bool walls = has_walls(packing.domain);
  fmt::print("contacts          {} pairs", grouped(c.pairs));
  if (walls) fmt::print(", {} with the wall", grouped(c.walls));
  fmt::print(
      ", at a gap below {:g} of the sum of the radii{}\n", c.contact_gap,
      packing.scene.asks_for_gaps() ? ", beyond the gap that is asked for, which counts as theirs" : "");
  fmt::print("coordination      {:.4f}\n", c.coordination);
  if (measured.core_contacts)
    say(stdout, "in the core       {}, {}\n", contacts_of_some_text(*measured.core_contacts),
        measured.walls->has_core
            ? fmt::format("{:g} mean diameters or more from the walls", WallProfile::core_depth)
            : "the deeper half: it is too narrow for a core");
  if (measured.slab)
    say(stdout, "in the slab       {}, whose centres lie in it\n",
        contacts_of_some_text(measured.slab->contacts));
  if (measured.holds(c)) {
    fmt::print("rattlers          {} ({:.2f} %), held by fewer than {} contacts\n", grouped(c.rattlers),
               100.0 * static_cast<double>(c.rattlers) / static_cast<double>(packing.spheres.size()),
               packing.spheres.dimension() + 1);
    say(stdout, "backbone          {} spheres, {} contacts, coordination {:.4f}{}\n", grouped(c.backbone),
        grouped(c.backbone_pairs), c.backbone_coordination,
        walls ? fmt::format("; {} with the wall", grouped(c.backbone_walls)) : "");
    const double ratio = static_cast<double>(c.backbone_contacts()) / static_cast<double>(*c.isostatic);
    fmt::print("isostatic         {} contacts would just hold the backbone; there are {:.3g} % {}\n",
               grouped(*c.isostatic), 100 * std::abs(ratio - 1), ratio < 1 ? "fewer" : "more");
  }
  print_neighbours(measured.of_contacts, packing.spheres.size());
  const bool can_polish = packing.spheres.dimension() != 2 || is_periodic(packing.domain);
  if (!packing.spheres.empty())
    fmt::print("contacts tell     {}{}{}\n", where_contacts_tell(measured),
               measured.holds(c) ? "" : ", so not at this one",
               measured.holds(c) || !can_polish ? "" : "; \"polish\" of relax and grow closes them");

  print_by_gap(measured);
}

}  // namespace bernal
