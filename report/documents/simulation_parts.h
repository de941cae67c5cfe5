// What the parts of a simulation's report share. Internal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/simulation.h"

namespace bentaxis::study {

inline constexpr double kMilliseconds = 1e3;

/// The runs there are, with their names.
std::vector<std::pair<std::string, const Trajectory*>> runs_of(const SimulationResult& r);
/// Times of the rows, ms.
report::Values times_of(const Trajectory& run);
inline bool compliant(const SimulationResult& r) {
  return r.ready.the_case.pump.gear.is_compliant();
}
/// What both models need for the wanted error; "" where one of them is not there.
std::string race(const SimulationResult& r);

/// Tables of the report, in their order.
std::vector<report::Section> simulation_sections(const SimulationResult& r);
/// Its pictures: curves over time, force diagrams, teeth, difference and effort.
std::vector<report::Figure> simulation_figures(const SimulationResult& r);

}  // namespace bentaxis::study
