// What an operating point of the hydraulic side comes to beyond pressures and flows: power by
// place, orders, the p-V diagram, stiffness, backflow, parts of the openings.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/operating_points.h"

namespace bentaxis::study {

/// Mean power by place, its balance, and the p-V diagram's area against it.
report::Section power_section(const Case& the_case, const hydraulics::SteadyState& state,
                              const hydraulics::PowerBudget& power);

/// Power of the drive and of the oil and the efficiencies, of both models: what `compare` states of
/// the same case under the same names.
report::Section efficiency_section(const OperatingPoint& point,
                                   const hydraulics::PowerBudget& power);

/// Multiples of N in outlet flow and pressures, and the same orders of dp/dtheta of a chamber.
report::Section orders_section(const Case& the_case, const hydraulics::SteadyState& state);

/// p-V diagram, dp/dtheta, effective bulk modulus over the turn and over pressure, parts of the
/// openings, backflow, power over the turn, orders.
std::vector<report::Figure> result_figures(const Case& the_case,
                                           const hydraulics::SteadyState& state,
                                           const hydraulics::PowerBudget& power);

/// CSV files with a header line: place, what it is, W; and every order up to the last multiple of N
/// (0 where the outlet has none).
std::string power_csv(const hydraulics::SteadyState& state, const hydraulics::PowerBudget& power);
std::string orders_csv(const Case& the_case, const hydraulics::SteadyState& state);

}  // namespace bentaxis::study
