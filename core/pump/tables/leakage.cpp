// [leakage]: gaps from each chamber to the case.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kGaps = part_of_hydraulics<&HydraulicData::gaps>();

std::string oil_refusal(const Case& c) {
  return find(c, &HydraulicData::gaps) == nullptr || find(c, &HydraulicData::oil) != nullptr
             ? ""
             : "needs the table [oil]: gaps leak by viscosity";
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
      .meaning = "gaps from each chamber to the case, beside `leakage_l_per_min_per_bar`; 0: none",
      .part = &kGaps,
      .in_fmu = InFmu::tunable,
      .parameters =
          {{.key = "piston_gap_um",
            .field = FIELD(c.hydraulics->gaps->piston_gap),
            .symbol = "h",
            .unit = kMicrometres,
            .range = {0, 1000},
            .fallback = {0.0},
            .meaning = "between piston and bore, radial, of the concentric piston",
            .practice = "5..20"},
           {.key = "piston_gap_length_mm",
            .field = FIELD(c.hydraulics->gaps->piston_gap_length),
            .symbol = "l",
            .unit = kMillimetres,
            .range = kNotNegative,
            .range_words = "> 0 with a gap",
            .fallback = {0.0},
            .meaning = "of that gap, along the bore"},
           {.key = "piston_gap_kind",
            .field = choice_at(PLACE(c.hydraulics->gaps->engaged)),
            .words = {"land", "engaged"},
            .fallback = {std::string("land")},
            .meaning = "a land that moves with the piston, of the same length always; or what of "
                       "the piston is in the bore: the length is then the least, at the outer "
                       "dead centre, and grows by the piston's way in"},
           {.key = "eccentricity",
            .field = FIELD(c.hydraulics->gaps->eccentricity),
            .symbol = "e",
            .range = {0, 1},
            .fallback = {0.0},
            .meaning = "of the piston in its bore, over the radial gap; 1: it touches"},
           {.key = "plate_gap_um",
            .field = FIELD(c.hydraulics->gaps->plate_gap),
            .symbol = "h_p",
            .unit = kMicrometres,
            .range = {0, 1000},
            .fallback = {0.0},
            .meaning = "between block and port plate, over the lands of `[port_plate]`",
            .practice = "5..15"},
           {.key = "ring_slot_um",
            .field = FIELD(c.hydraulics->gaps->ring_slot_height),
            .symbol = "h_r",
            .unit = kMicrometres,
            .range = {0, 1000},
            .fallback = {0.0},
            .meaning = "slot that a piston ring leaves at its joint"},
           {.key = "ring_slot_width_mm",
            .field = FIELD(c.hydraulics->gaps->ring_slot_width),
            .symbol = "b_r",
            .unit = kMillimetres,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "of that slot, across the flow"},
           {.key = "ring_slot_length_mm",
            .field = FIELD(c.hydraulics->gaps->ring_slot_length),
            .symbol = "l_r",
            .unit = kMillimetres,
            .range = kNotNegative,
            .range_words = "> 0 with a slot",
            .fallback = {0.0},
            .meaning = "of that slot, along the flow: the width of the ring"}},
      .rules = {{.key = "piston_gap_um", .after = "piston_gap_um", .broken = oil_refusal},
                {.key = "piston_gap_length_mm",
                 .after = "piston_gap_length_mm",
                 .broken = gap_length_refusal},
                {.key = "plate_gap_um", .after = "plate_gap_um", .broken = plate_gap_refusal},
                {.key = "ring_slot_length_mm",
                 .after = "ring_slot_length_mm",
                 .broken = ring_slot_refusal}}};
}

}  // namespace bentaxis::tables
