// A motion with oil as a table. Internal.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/coupled/simulation.h"
#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/trajectory.h"
#include "system.h"

namespace bentaxis::coupled {

/// Integrates from a state at time 0 and reads rows at `times`, s, rising.
/// @param options  its tolerance, whether loads are wanted, and its exchange
Trajectory tabulate(const std::string& name, Mechanics& mechanics, Oil& oil, const DriveSpec& drive,
                    const SystemState& start, const std::vector<double>& times,
                    const Options& options, const Progress& progress);

/// "BDF of variable order ..", for records.
std::string method_text(double tolerance, bool has_oil);

}  // namespace bentaxis::coupled
