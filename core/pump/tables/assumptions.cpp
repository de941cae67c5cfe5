// [assumptions.analytic] and [assumptions.multibody].
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

template <auto kModel>
Table assumptions_table(const std::string& model) {
  return {
      .name = "assumptions." + model,
      .meaning = "what the " + model + " model assumes in this case",
      .presence = Presence::silent,
      .parameters = {flag("piston_friction", FIELD((c.*kModel).piston_friction), true,
                          model + " model: whether friction acts on the pistons"),
                     choice("inertia", FIELD((c.*kModel).inertia), piston_inertia_names(),
                            {.computed = [](const Case& c) -> std::optional<Value> {
                               return to_string(c.pump.piston.inertia);
                             },
                             .words = "that of `[piston]`"},
                            model + " model: inertia of the pistons, as in `[piston]`"),
                     choice(
                         "gear", FIELD((c.*kModel).gear), {"mesh", "imposed"}, "mesh",
                         model +
                             " model: how the block is driven: by the tooth force, or by "
                             "a speed imposed on the block's joint, as in the paper's ADAMS run")},
      .rules = {
          {.key = "inertia",
           .after = "gear",
           .broken =
               [](const Case& c) { return piston_inertia_refusal((c.*kModel).inertia, c.pump); }},
          {.key = "gear", .after = "gear", .broken = [](const Case& c) {
             return imposed_refusal((c.*kModel).gear, c.pump);
           }}}};
}

}  // namespace

Table analytic_assumptions_table() { return assumptions_table<&Case::analytic>("analytic"); }

Table multibody_assumptions_table() {
  Table table = assumptions_table<&Case::multibody>("multibody");
  table.parameters.push_back(
      choice("flank_shape", FIELD(c.multibody.flanks), {"involute", "octoid"}, "involute",
             "of [gear] contact = \"teeth\": spherical involutes, as in the analytic model, or "
             "octoids, which a plane flank of a crown gear generates",
             {.active = kTeeth}));
  return table;
}

}  // namespace bentaxis::tables
