// How far apart two runs of a motion are. Internal.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "bentaxis/results/load_scale.h"
#include "bentaxis/study/simulation.h"
#include "pressure_steps.h"

namespace bentaxis::study {

/// A disturbance of the wanted error that has grown to this share of peak leaves nothing to be
/// judged; runs of one motion differ by less.
inline constexpr double kNothingToJudge = 0.1;

// What is compared: reactions, and of the oil that follows the motion its pressures and flows.
// Flows are shown and not judged: through an open port they are what a pressure difference of
// nearly nothing makes of them, errors of the pressures a thousand times larger.
struct Compared {
  std::string group, unit;
  bool judged = true;
};
// Of a column of the oil; no group where it is not compared.
Compared compared_column(const Column& column);

// Rows before the first in which a disturbance of the wanted error, or the one that growth was
// found by, has grown too large for anything to be judged.
std::size_t judged_rows(const std::vector<double>& growth, double error, double disturbance);

// Of the faster body at a row, rad/s.
double fastest_speed(const Trajectory& run, std::size_t row);
// Largest loads of a run: those of the case under the pressures and at the speeds that it came to.
LoadScale loads_of(const Case& the_case, const Trajectory& run);

// What differences are held to, by group: as compare::scale_of().
using Scales = std::map<std::string, double>;
Scales scales_of(const Case& the_case, const Trajectory& run, double error);

// Of everything that is judged in a row, over its scale; NaN where a value is missing.
double largest_difference(const Trajectory& a, const Trajectory& b, const Scales& scales,
                          std::size_t row);

// How far apart two runs are in each group, by name, in as many rows as `allowed` has, but for
// those between steps of the pressure.
// `turned`: the first one where its shaft is where the second one's is; nullptr where that is the
// same. `allowed`: per row, of the scale.
std::vector<GroupDifference> group_differences(const Trajectory& first, const Trajectory& second,
                                               const Trajectory* turned, const Scales& scales,
                                               const std::vector<double>& allowed,
                                               const PressureSteps& steps = {});
// Judged ones first, of these one that lacks a value, then by what is allowed.
void sort_groups(std::vector<GroupDifference>& groups);

}  // namespace bentaxis::study
