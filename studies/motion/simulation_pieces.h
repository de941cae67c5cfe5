// The pieces of simulate() that judge columns, rows and touches by themselves.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "bentaxis/study/simulation.h"

namespace bentaxis::study {

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

// How far apart two runs are in each group, by name, in as many rows as `allowed` has.
// `turned`: the first one where its shaft is where the second one's is; nullptr where that is the
// same. `scales`: by group, what differences are held to. `allowed`: per row, of the scale.
std::vector<GroupDifference> group_differences(const Trajectory& first, const Trajectory& second,
                                               const Trajectory* turned,
                                               const std::map<std::string, double>& scales,
                                               const std::vector<double>& allowed);
// Judged ones first, of these one that lacks a value, then by what is allowed.
void sort_groups(std::vector<GroupDifference>& groups);

// Touches of both models that belong together, until a time.
EventMatch match_events(const std::vector<ToothEvent>& analytic,
                        const std::vector<ToothEvent>& multibody, double until_s);

}  // namespace bentaxis::study
