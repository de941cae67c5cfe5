// [pressure] in the chambers.
#include "bentaxis/pump/input_limits.h"
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const When kIdeal{"pressure", "kind", {"ideal"}};
const When kCurve{"pressure", "kind", {"curve"}};

std::string too_few_points(const Case& c) {
  const int points = c.pressure.points;
  return points == 0 || points >= 16 ? "" : "must be 0 or in [16, 100000]";
}

// A step passes samples or does not.
bool moves_with_edges(const Case& c) {
  return c.pressure.kind != PressureKind::ideal || c.pressure.transition_deg > 0;
}

}  // namespace

Table pressure_table() {
  return {
      .name = "pressure",
      .meaning = "gauge pressure in the chambers over their own angle theta_k",
      .parameters =
          {choice("kind", FIELD(c.pressure.kind), {"ideal", "curve", "hydraulic"}, kRequired,
                  "smoothed steps between the port pressures; points of a file; or computed from "
                  "`[hydraulics]`",
                  {.changes_model = true}),
           number("suction_bar", "p_s", FIELD(c.pressure.ports.suction), kBar, kPressureRange,
                  kRequired,
                  "suction pressure; in the port, where it loads the lands; with `ideal` also in "
                  "the chambers",
                  {.also = {"inlet", "inlet_pressure", "low_pressure", "p_low", "p1", "tank",
                            "intake"},
                   .differentiable = always,
                   .plausible = {-1.014,
                                 100,
                                 "absolute vacuum is at -1.013, charged circuits reach 30",
                                 {slips::kPascals, slips::kKilopascals, slips::kTenth}}}),
           number("delivery_bar", "p_d", FIELD(c.pressure.ports.delivery), kBar, kPressureRange,
                  kRequired,
                  "delivery pressure, likewise; hydraulic: the wanted mean, 0 is an open line",
                  {.also = {"outlet", "outlet_pressure", "discharge", "discharge_pressure",
                            "high_pressure", "p_high", "p2", "load_pressure"},
                   .range_here = [](const Case& c) -> std::optional<NumberRange> {
                     if (c.pressure.kind != PressureKind::hydraulic) return std::nullopt;
                     return NumberRange{0, 10000};
                   },
                   .range_words = "[-1e+09, 1e+09]; hydraulic: [0, 10000]",
                   .differentiable = always}),
           number("points", "", FIELD(c.pressure.points), kNoUnit, {0, 100000}, {0},
                  "0: both models use the computed curve, within `curve_error`; otherwise a "
                  "periodic cubic spline through this number of points per turn (800 in the paper "
                  "for ADAMS); its error is in the report",
                  {.range_words = "0 or [16, 100000]",
                   .active = kHydraulic,
                   .plausible = {.low = 90, .why = "a port opens within a few degrees"}}),
           number("transition_deg", "w_t", FIELD(c.pressure.transition_deg), kDegrees, {0, 180},
                  kRequired, "width of each rise and fall; 0 is a step",
                  {.active = kIdeal,
                   .differentiable = moves_with_edges,
                   .plausible = {1,
                                 90,
                                 "the pressure changes while a bore passes from port to port",
                                 {slips::kRadians}}}),
           number("delivery_start_deg", "", FIELD(c.pressure.delivery_start_deg), kDegrees, kAny,
                  {180.0}, "middle of the rise",
                  {.active = kIdeal, .differentiable = moves_with_edges}),
           required_text("file", FIELD(c.pressure.file),
                         "CSV `theta_deg,pressure_bar`, path relative to the case file",
                         {.active = kCurve})},
      .rules = {after("points", too_few_points)}};
}

}  // namespace bentaxis::tables
