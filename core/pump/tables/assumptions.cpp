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
      .parameters =
          {{.key = "piston_friction",
            .field = FIELD((c.*kModel).piston_friction),
            .fallback = {true},
            .meaning = model + " model: whether friction acts on the pistons"},
           {.key = "inertia",
            .field = FIELD((c.*kModel).inertia),
            .words = piston_inertia_names(),
            .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                           return to_string(c.pump.piston.inertia);
                         },
                         .words = "that of `[piston]`"},
            .meaning = model + " model: inertia of the pistons, as in `[piston]`"},
           {.key = "gear",
            .field = FIELD((c.*kModel).gear),
            .words = {"mesh", "imposed"},
            .fallback = {std::string("mesh")},
            .meaning = model +
                       " model: how the block is carried round: by the tooth force, or by a speed "
                       "imposed on its own joint, as in the paper's ADAMS run"}},
      .rules = {{.key = "inertia", .after = "gear", .broken = [](const Case& c) {
                   return piston_inertia_refusal((c.*kModel).inertia, c.pump);
                 }}}};
}

}  // namespace

Table analytic_assumptions_table() { return assumptions_table<&Case::analytic>("analytic"); }

Table multibody_assumptions_table() {
  Table table = assumptions_table<&Case::multibody>("multibody");
  table.parameters.push_back(
      {.key = "flank_shape",
       .field = FIELD(c.multibody.flanks),
       .words = {"involute", "octoid"},
       .fallback = {std::string("involute")},
       .meaning = "of [gear] contact = \"teeth\": spherical involutes, as the analytic model has "
                  "them, or octoids, which a plane flank of a crown gear envelops",
       .active = kTeeth});
  return table;
}

}  // namespace bentaxis::tables
