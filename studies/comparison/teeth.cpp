#include "bentaxis/study/teeth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bentaxis/analytic/teeth.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/teeth.h"

namespace bentaxis::study {
namespace {

// The pairs of a table of teeth: the first column of each and the first of its point and direction.
struct PairColumns {
  std::size_t force, point;
};
constexpr std::size_t kOfPoint = 6;  // point and direction

std::vector<PairColumns> pairs_of(const ResultTable& table) {
  std::vector<PairColumns> pairs;
  for (const char* flank : {"plus", "minus"})
    for (const char* which : {"at", "before", "after"})
      pairs.push_back({table.find(fmt::format("{}_{}_force_N", flank, which)),
                       table.find(fmt::format("{}_{}_x1_mm", flank, which))});
  return pairs;
}

// A pair that carries no more than the round-off of a force may carry nothing in the other model:
// then neither has a point of contact. Where it carries more the point is known as well as the
// force is: from one end of the teeth, `reach`, to the other where it is all round-off.
ResultTable point_errors(ResultTable& first, ResultTable& second, double round_off, double reach) {
  ResultTable errors = first;
  std::fill(errors.values.begin(), errors.values.end(), 0.0);
  const auto value = [](ResultTable& table, std::size_t row, std::size_t column) -> double& {
    return table.values[row * table.columns() + column];
  };
  for (const PairColumns& pair : pairs_of(first))
    for (std::size_t row = 0; row < first.rows(); ++row) {
      const double force = std::min(first.at(row, pair.force), second.at(row, pair.force));
      for (std::size_t c = pair.point; c < pair.point + kOfPoint; ++c)
        if (force <= round_off) {
          value(first, row, c) = value(second, row, c) = not_computed();
        } else {
          const double unit = first.channels[c].unit.empty() ? 1 : reach;
          value(errors, row, c) = unit * round_off / force;
        }
    }
  return errors;
}

// How far the lag of every row may be off, urad and um: by what it moves where the torque on the
// block changes by the round-off of a tooth force. Where nearly no torque is carried, that is from
// one flank to the other.
void add_lag_errors(ResultTable& errors, const ResultTable& table,
                    const analytic::BevelTeeth& teeth, const Gear& gear, double round_off) {
  constexpr double kMinTorque = 2e-9;  // Nm: BevelTeeth::rest() takes less for none
  const double radius = gear.pitch_diameter / 2;
  const double change = std::max(round_off * radius, kMinTorque);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::array<double, 3> moment = {};
    for (const PairColumns& pair : pairs_of(table)) {
      const double force = table.at(row, pair.force);
      if (!(force > 0)) continue;
      std::array<double, 6> at = {};  // point, mm, and direction
      for (std::size_t i = 0; i < at.size(); ++i) at[i] = table.at(row, pair.point + i);
      for (std::size_t i = 0; i < 3; ++i)
        moment[i] +=
            1e-3 * force *
            (at[(i + 1) % 3] * at[3 + (i + 2) % 3] - at[(i + 2) % 3] * at[3 + (i + 1) % 3]);
    }
    const double torque = teeth.about_block_axis(moment);
    const std::size_t lag = table.find("lag_urad");
    double error = 0;  // rad
    for (const double side : {-1, 1}) {
      try {
        const ToothLag moved = teeth.rest(radians(table.theta_deg[row]), torque + side * change);
        error = std::max(error, std::abs(moved.angle - 1e-6 * table.at(row, lag)));
      } catch (const ComputationError&) {
        // So much torque is more than the teeth can carry.
      }
    }
    errors.values[row * errors.columns() + lag] = 1e6 * error;
    errors.values[row * errors.columns() + errors.find("transmission_error_um")] =
        1e6 * error * radius * std::cos(gear.pressure_angle);
  }
}

}  // namespace

TeethComparison compare_teeth(ResultTable analytic, ResultTable multibody, double tolerance,
                              compare::ZeroScales scales, const PumpParameters& pump) {
  TeethComparison teeth;
  // Contact is a difference of lengths as long as the way from O2 to the teeth, and of angles.
  const analytic::BevelTeeth shape(pump);
  const double distance = pump.gear.pitch_diameter / 2 / std::sin(kPi / 2 - pump.geometry.tilt / 2);
  for (const auto& [unit, scale] :
       {std::pair{"urad", 1e6}, {"um", 1e6 * distance}, {"mm", 1e3 * distance}, {"", 1.0}})
    scales.emplace(unit, scale);
  scales["N"] = std::max(scales["N"], shape.stiffness() * distance);
  compare::Options options = compare::above_round_off(tolerance, scales);
  ResultTable first = analytic, second = multibody;
  const double round_off = tolerance * compare::kMinScale * scales["N"];
  ResultTable errors = point_errors(first, second, round_off, 1e3 * pump.gear.teeth->face_width);
  add_lag_errors(errors, analytic, shape, pump.gear, round_off);
  options.uncertainty = &errors;
  teeth.comparison = compare::compare_tables(first, second, options);
  // Forces tell, pair by pair; the share of a force that vanishes is round-off over round-off.
  for (auto& line : teeth.comparison.channels)
    if (line.channel.group == "share") line.judged = false;
  teeth.analytic = std::move(analytic);
  teeth.multibody = std::move(multibody);
  return teeth;
}

}  // namespace bentaxis::study
