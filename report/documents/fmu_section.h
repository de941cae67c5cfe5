// What a report says of a unit that acts on the pump. Internal.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/simulation.h"

namespace bentaxis::study {

/// Connections, communication step, and what half of it changes.
report::Section coupling_section(const SimulationResult& r);
/// Where that is much.
std::vector<report::Warning> coupling_warnings(const SimulationResult& r);
/// For the console: a few lines.
std::string coupling_text(const SimulationResult& r);

}  // namespace bentaxis::study
