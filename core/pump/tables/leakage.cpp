// [leakage]: gaps from each chamber to the case.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kGaps = part_of_hydraulics<&HydraulicData::gaps>();

std::string oil_refusal(const Case& c) {
  return find(c, &HydraulicData::gaps) == nullptr || find(c, &HydraulicData::oil) != nullptr
             ? ""
             : "needs the table [oil]: leakage through gaps depends on the viscosity";
}

std::string gap_length_refusal(const Case& c) {
  const GapData* gaps = find(c, &HydraulicData::gaps);
  return gaps == nullptr || gaps->piston_gap == 0 || gaps->piston_gap_length > 0
             ? ""
             : "must be > 0 where piston_gap_um is";
}

std::string plate_gap_refusal(const Case& c) {
  const GapData* gaps = find(c, &HydraulicData::gaps);
  return gaps == nullptr || gaps->plate_gap == 0 || c.pump.port_plate
             ? ""
             : "needs the lands of [port_plate]";
}

std::string ring_slot_refusal(const Case& c) {
  const GapData* gaps = find(c, &HydraulicData::gaps);
  return gaps == nullptr || gaps->ring_slot_height == 0 || gaps->ring_slot_length > 0
             ? ""
             : "must be > 0 where ring_slot_um is";
}

}  // namespace

Table leakage_table() {
  return {
      .name = "leakage",
      .meaning =
          "gaps from each chamber to the case, in addition to `leakage_l_per_min_per_bar`; 0: none",
      .part = &kGaps,
      .in_fmu = InFmu::tunable,
      .parameters =
          {number("piston_gap_um", "h", FIELD(c.hydraulics->gaps->piston_gap), kMicrometres,
                  {0, 1000}, {0.0}, "between piston and bore, radial, of the concentric piston",
                  {.practice = "5..20"}),
           number("piston_gap_length_mm", "l", FIELD(c.hydraulics->gaps->piston_gap_length),
                  kMillimetres, kNotNegative, {0.0}, "of that gap, along the bore",
                  {.range_words = "> 0 with a gap"}),
           choice("piston_gap_kind", choice_at(PLACE(c.hydraulics->gaps->engaged)),
                  {"land", "engaged"}, "land",
                  "land: it moves with the piston and has a constant length; engaged: the part of "
                  "the piston inside the bore. The length of an engaged part is then the minimum, "
                  "at the outer dead centre, and increases as the piston moves in"),
           number("eccentricity", "eps", FIELD(c.hydraulics->gaps->eccentricity), kNoUnit, {0, 1},
                  {0.0},
                  "eccentricity of the piston in its bore over the radial gap; 1: it touches"),
           number("plate_gap_um", "h_p", FIELD(c.hydraulics->gaps->plate_gap), kMicrometres,
                  {0, 1000}, {0.0},
                  "between block and port plate, over the lands of `[port_plate]`",
                  {.practice = "5..15"}),
           number("ring_slot_um", "h_r", FIELD(c.hydraulics->gaps->ring_slot_height), kMicrometres,
                  {0, 1000}, {0.0}, "slot at the joint of a piston ring"),
           number("ring_slot_width_mm", "b_r", FIELD(c.hydraulics->gaps->ring_slot_width),
                  kMillimetres, kNotNegative, {0.0}, "of that slot, across the flow"),
           number("ring_slot_length_mm", "l_r", FIELD(c.hydraulics->gaps->ring_slot_length),
                  kMillimetres, kNotNegative, {0.0},
                  "of that slot, along the flow: the width of the ring",
                  {.range_words = "> 0 with a slot"})},
      .rules = {after("piston_gap_um", oil_refusal),
                after("piston_gap_length_mm", gap_length_refusal),
                after("plate_gap_um", plate_gap_refusal),
                after("ring_slot_length_mm", ring_slot_refusal)}};
}

}  // namespace bentaxis::tables
