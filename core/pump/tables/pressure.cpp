// [pressure] in the chambers.
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
          {{.key = "kind",
            .field = FIELD(c.pressure.kind),
            .words = {"ideal", "curve", "hydraulic"},
            .meaning = "smoothed steps between the port pressures; points of a file; or computed "
                       "from `[hydraulics]`",
            .changes_model = true},
           {.key = "suction_bar",
            .field = FIELD(c.pressure.ports.suction),
            .symbol = "p_s",
            .unit = kBar,
            .meaning = "suction pressure; ideal: in the chambers; always: in the port, where it "
                       "loads the lands",
            .differentiable = always,
            .plausible = {.low = -1.014,
                          .high = 100,
                          .why = "absolute vacuum is at -1.013, charged circuits reach 30",
                          .slips = {slips::kPascals, slips::kKilopascals, slips::kTenth}}},
           {.key = "delivery_bar",
            .field = FIELD(c.pressure.ports.delivery),
            .symbol = "p_d",
            .unit = kBar,
            .range_here = [](const Case& c) -> std::optional<NumberRange> {
              if (c.pressure.kind != PressureKind::hydraulic) return std::nullopt;
              return NumberRange{0, 10000};
            },
            .range_words = "hydraulic: [0, 10000]",
            .meaning = "delivery pressure, likewise; hydraulic: the mean asked for, 0 is an open "
                       "line",
            .differentiable = always},
           {.key = "points",
            .field = FIELD(c.pressure.points),
            .range = {0, 100000},
            .range_words = "0 or [16, 100000]",
            .fallback = {0},
            .meaning = "0: both models get the computed curve, within `curve_error`; otherwise a "
                       "periodic cubic spline through as many of its points per turn, as the paper "
                       "gave ADAMS 800; its error is in the report",
            .active = kHydraulic,
            .plausible = {.low = 90, .why = "a port opens within some degrees"}},
           {.key = "transition_deg",
            .field = FIELD(c.pressure.transition_deg),
            .symbol = "w",
            .unit = kDegrees,
            .range = {0, 180},
            .meaning = "width of each rise and fall; 0 is a step",
            .active = kIdeal,
            .differentiable = moves_with_edges,
            .plausible = {.low = 1,
                          .high = 90,
                          .why = "the pressure changes while a bore passes from port to port",
                          .slips = {slips::kRadians}}},
           {.key = "delivery_start_deg",
            .field = FIELD(c.pressure.delivery_start_deg),
            .unit = kDegrees,
            .fallback = {180.0},
            .meaning = "middle of the rise",
            .active = kIdeal,
            .differentiable = moves_with_edges},
           {.key = "file",
            .field = FIELD(c.pressure.file),
            .meaning = "CSV `theta_deg,pressure_bar`, path relative to the case file",
            .active = kCurve}},
      .rules = {{.key = "points", .after = "points", .broken = too_few_points}}};
}

}  // namespace bentaxis::tables
