// [load]: what the pump delivers against.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kLoad = part_of_hydraulics<&HydraulicData::load>();

const When kReliefValve{"load", "kind", {"relief_valve"}};
const When kGivenFlow{"load", "kind", {"flow"}};
const When kOrifice{"load", "kind", {"orifice"}};
const When kLaminar{"load", "kind", {"laminar"}};
const When kBesideRelief{"load", "kind", {"orifice", "laminar", "flow"}};
const When kAnyRelief{"load", "kind", {"relief_valve", "orifice", "laminar", "flow"}};

std::string share_refusal(const Case& c) {
  const LoadData* load = find(c, &HydraulicData::load);
  if (load == nullptr || load->share.time.empty()) return "";
  const TimeCurve& share = load->share;
  return share.time.size() >= 4 && share.time.size() == share.value.size()
             ? ""
             : "must have at least 4 points";
}

}  // namespace

Table load_table() {
  return {
      .name = "load",
      .meaning = "what the pump delivers against; an orifice where there is no such table",
      .part = &kLoad,
      .in_fmu = InFmu::tunable,
      .parameters =
          {{.key = "kind",
            .field = FIELD(c.hydraulics->load->kind),
            .words = {"orifice", "laminar", "relief_valve", "constant_pressure", "flow"},
            .fallback = {std::string("orifice")},
            .meaning =
                "orifice and laminar: of the size that gives the mean `delivery_bar`, or of "
                "that given, then the pressure follows; "
                "relief_valve: likewise by its cracking pressure; "
                "constant_pressure: a line held at `delivery_bar`; flow: takes a given flow"},
           {.key = "cracking_bar",
            .field = FIELD(c.hydraulics->load->cracking_pressure),
            .symbol = "p_c",
            .unit = kBar,
            .range = {0, 10000},
            .fallback = {0.0},
            .meaning = "pressure at which the valve begins to open; 0: sought",
            .active = kReliefValve},
           {.key = "opening_mm2_per_bar",
            .field = FIELD(c.hydraulics->load->opening),
            .symbol = "k",
            .unit = kAreaPerPressure,
            .range = kPositive,
            .fallback = {1.0},
            .meaning = "area that a relief valve opens per pressure above its cracking pressure",
            .practice = "95 l/min at 275 bar take about 9 mm2",
            .active = kAnyRelief},
           {.key = "full_area_mm2",
            .field = FIELD(c.hydraulics->load->full_area),
            .unit = kSquareMillimetres,
            .range = kPositive,
            .fallback = {100.0},
            .meaning = "area of the valve fully open",
            .active = kAnyRelief},
           {.key = "area_mm2",
            .field = FIELD(c.hydraulics->load->area),
            .symbol = "a",
            .unit = kSquareMillimetres,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "of the orifice; 0: sought",
            .active = kOrifice},
           {.key = "conductance_l_per_min_per_bar",
            .field = FIELD(c.hydraulics->load->conductance),
            .symbol = "G_L",
            .unit = kLeakage,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "of the laminar load; 0: sought",
            .active = kLaminar},
           {.key = "relief_bar",
            .field = FIELD(c.hydraulics->load->relief_pressure),
            .symbol = "p_r",
            .unit = kBar,
            .range = {0, 10000},
            .fallback = {0.0},
            .meaning = "cracking pressure of a relief valve beside the load; 0: none",
            .active = kBesideRelief},
           {.key = "file",
            .field = curve_at(PLACE(c.hydraulics->load->share.file),
                              {.share = [](Case& c) { return &c.hydraulics->load->share; }}),
            .fallback = {std::string()},
            .meaning =
                "CSV `time_s,share`, path relative to the case file, at least 4 points from a "
                "time <= 0 on: in `bentaxis simulate` the load's size (of a relief valve its "
                "cracking pressure) is times that; other commands leave it aside; empty: none",
            .active = kAnyRelief},
           {.key = "flow_l_per_min",
            .field = FIELD(c.hydraulics->load->flow),
            .symbol = "Q",
            .unit = kLitresPerMinute,
            .range = kNotNegative,
            .range_words = "> 0, below displacement x speed",
            .meaning = "taken whatever the pressure, at the density in the tank; the pressure "
                       "follows, and `delivery_bar` is where its search starts",
            .active = kGivenFlow}},
      .rules = {{.key = "file", .after = "file", .broken = share_refusal}}};
}

}  // namespace bentaxis::tables
