#include <utility>
#include <vector>

#include "jam/polish.hpp"
#include "scene/layers_of_scene.hpp"
#include "scene/repetition.hpp"
#include "soft/ground.hpp"
#include "soft/relax.hpp"
#include "soft/size_exchange.hpp"
#include "work/stage_entry.hpp"

namespace bernal {
namespace {

constexpr StageTraits traits = {.in_bed = true,
                                .in_box = true,
                                .in_plane = true,
                                .box_between_walls = true,
                                .in_tilted_box = true,
                                .in_repeated_mesh = true,
                                .prefers_bed = true,
                                .keeps_sizes = true,
                                .places_expected = true,
                                .leaves_overlap = true,
                                .frees_bed = true,
                                .frees_box = true,
                                .joins_start = true,
                                .is_default = true,
                                .reaches = Reaches::close_packing};

/// What comes first from a start, or from an engine, begins at the packing fraction that it has there.
void complete_relax(Relax& relax, Scene& scene, const schema::Section& section) {
  if (schema::is_tilted(scene))
    for (const auto& [key, is_asked] :
         {std::pair("polish", relax.polish > 0), std::pair("method", relax.method != RelaxMethod::fast),
          std::pair("device", relax.device != RelaxDevice::processor)})
      if (is_asked) section.refuse(key, "knows upright boxes only; leave it out, or \"tilt\" in [container]");
  if (relax.polish > 0 && traits.stands_in_bed(scene)) require_layers_that_stretch(scene);
  if ((scene.start.file || scene.engine) && scene.stages.front().as<Relax>() == &relax) return;
  if (!relax.phi0 && !traits.stands_in_bed(scene)) relax.phi0 = dense_start(scene.dimension());
}

/// By exchange, of a thousand of the sizes.
double gain_of_relaxation(const Relax& options, const SizeDistribution& radii, int dimension,
                          const WallsAround& around) {
  if (!options.exchange || dimension == 1) return 1;
  constexpr int sizes = 1000;
  std::vector<double> some;
  for (int k = 0; k < sizes; ++k) some.push_back(radii.quantile((k + 0.5) / sizes));
  return SizeExchange(some, dimension).gain(around);
}

}  // namespace

template <>
const StageEntry& entry_of<Relax>() {
  using namespace schema;
  static const StageEntry entry = {
      .table = stage_table<Relax>(
          {.name = "relax",
           .help =
               "start with overlaps; push spheres apart, in a periodic box while it grows, in a container "
               "off the walls too, and stir what is stuck",
           .keys = joined(
               joined(
                   acting(
                       Acts::in_box,
                       {buys_accuracy({1, 2, 5, 17, 60, 200},
                                      number(&Relax::alpha, "alpha",
                                             "sweeps between two growths of the box, in units of (log10 N)^2",
                                             above(0, 1e6))),
                        buys_accuracy(
                            {10, 20, 50, 150, 500, 2000},
                            integer(&Relax::period, "period",
                                    "sweeps between two growths of the box, however many spheres, in place "
                                    "of alpha",
                                    {1, 1e6})),
                        buys_accuracy({3, 10, 30, 100},
                                      number(&Relax::beta, "beta",
                                             "the box grows by the largest overlap ratio divided by this",
                                             {0.01, 1e6})),
                        number(&Relax::phi0, "phi0",
                               "packing fraction of the overlapping spheres at the start; if absent 0.86, in "
                               "other than three dimensions 1.34 of random close packing, of wide sizes 1.06 "
                               "of what is expected, also if it is 0.86; of spheres that come dense from a "
                               "file what they have there",
                               {least_packing_fraction, 10}),
                        buys_accuracy(
                            {1e-2, 1e-3, 2e-4, 1e-5, 1e-6},
                            number(&Relax::stop, "stop",
                                   "largest overlap ratio that counts as none; the box then grows by it",
                                   {1e-12, 0.5})),
                        word(&Relax::method, "method",
                             "fast; reference: the published loop as it stands, on linked lists, a hundred "
                             "times slower",
                             {"fast", "reference"}),
                        unless("\"processor\"",
                               word(&Relax::device, "device",
                                    "where spheres push each other in a periodic box: "
                                    "processor; gpu: an NVIDIA GPU, "
                                    "where bernal was built for it: another packing of the same "
                                    "kind, the same on "
                                    "every GPU",
                                    {"processor", "gpu"})),
                        flag(&Relax::settle, "settle",
                             "reference: what touches nothing moves to touch its nearest neighbour")}),
                   acting(
                       Acts::in_bed,
                       {buys_accuracy(
                            {0, 1, 3, 12, 40, 120},
                            integer(&Relax::patience, "patience",
                                    "how often what is stuck is stirred before some spheres are taken out",
                                    {0, 1e6})),
                        buys_accuracy_as_limit({10000, 40000, 160000, 640000},
                                               integer(&Relax::sweeps, "sweeps",
                                                       "of all spheres, after which it stops", {1, 1e9})),
                        number(
                            &Relax::seconds, "seconds",
                            "after which it stops, and then one seed need not give one packing; 0: any time",
                            {0, 1e9})})),
               {flag(&Relax::exchange, "exchange",
                     "spheres exchange their sizes on the way: some 7 % denser, disordered but optimised, "
                     "not what pouring makes"),
                polish_key<Relax>()}),
           .choices = {{{"alpha"}, {"period"}}},
           .complete = completion(complete_relax)},
          traits),
      .act_in_bed = of_options(relax_in_container),
      .act_in_box = of_options(relax),
      .may_bring = {"insertion", "neighbour lists", "relaxation", "exchange", "polish"},
      .effects = of_options(effects_of_relaxation),
      .require =
          [](const void*, const Domain& container, double smallest_radius, const FillTask& task) {
            const bool is_dilute =
                task.packing_fraction > 0 && task.packing_fraction <= dilute * task.attainable;
            if (!is_dilute)
              require_resolution(0x1p-32 * bounds_of<3>(container).size().maxCoeff() / smallest_radius);
          },
      .reached = of_options(+[](const Relax& options) {
        return options.polish > 0 || options.exchange ? 1 : options.phi0.value_or(1);
      }),
      .gain = of_options(gain_of_relaxation)};
  return entry;
}

}  // namespace bernal
