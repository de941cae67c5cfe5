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
      .meaning = "load of the pump; an orifice where there is no such table",
      .part = &kLoad,
      .in_fmu = InFmu::tunable,
      .parameters =
          {choice("kind", FIELD(c.hydraulics->load->kind),
                  {"orifice", "laminar", "relief_valve", "constant_pressure", "flow"}, "orifice",
                  "orifice and laminar: sized for the mean `delivery_bar`; or of the given size, "
                  "then the pressure follows; relief_valve: likewise by its cracking pressure; "
                  "constant_pressure: a line held at `delivery_bar`; flow: takes a given flow"),
           number("cracking_bar", "p_c", FIELD(c.hydraulics->load->cracking_pressure), kBar,
                  {0, 10000}, {0.0},
                  "pressure at which the valve begins to open; 0: computed from `delivery_bar`",
                  {.active = kReliefValve}),
           number("opening_mm2_per_bar", "k_v", FIELD(c.hydraulics->load->opening),
                  kAreaPerPressure, kPositive, {1.0},
                  "area that a relief valve opens per pressure above its cracking pressure",
                  {.practice = "95 l/min at 275 bar take about 9 mm2", .active = kAnyRelief}),
           number("full_area_mm2", "", FIELD(c.hydraulics->load->full_area), kSquareMillimetres,
                  kPositive, {100.0}, "area of the valve fully open", {.active = kAnyRelief}),
           number("area_mm2", "a", FIELD(c.hydraulics->load->area), kSquareMillimetres,
                  kNotNegative, {0.0}, "of the orifice; 0: computed from `delivery_bar`",
                  {.active = kOrifice}),
           number("conductance_l_per_min_per_bar", "G_L", FIELD(c.hydraulics->load->conductance),
                  kLeakage, kNotNegative, {0.0},
                  "of the laminar load; 0: computed from `delivery_bar`", {.active = kLaminar}),
           number("relief_bar", "p_r", FIELD(c.hydraulics->load->relief_pressure), kBar, {0, 10000},
                  {0.0}, "cracking pressure of a relief valve in parallel to the load; 0: none",
                  {.active = kBesideRelief}),
           text("file",
                curve_at(PLACE(c.hydraulics->load->share.file),
                         {.share = [](Case& c) { return &c.hydraulics->load->share; }}),
                "CSV `time_s,share`, path relative to the case file: in `bentaxis simulate` the "
                "load's size (of a relief valve its cracking pressure) is multiplied by it. At "
                "least 4 points, the first at a time <= 0. Other commands do not use it. Empty: "
                "none",
                {.active = kAnyRelief}),
           number("flow_l_per_min", "Q", FIELD(c.hydraulics->load->flow), kLitresPerMinute,
                  kNotNegative, kRequired,
                  "taken at any pressure, at the density in the tank; the pressure follows, and "
                  "its computation starts at `delivery_bar`",
                  {.range_words = "> 0, below displacement x speed", .active = kGivenFlow})},
      .rules = {after("file", share_refusal)}};
}

}  // namespace bentaxis::tables
