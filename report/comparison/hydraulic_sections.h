// What reports say about the hydraulic side: an operating point as a table, and its figures.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/report/document.h"

namespace bentaxis::study {

/// A figure over the shaft angle, still without curves.
report::Figure angle_figure(const std::string& id, const std::string& title,
                            const std::string& paper, const std::string& unit,
                            const std::vector<double>& theta_deg);
/// Adds a curve to it.
void add_series(report::Figure& figure, const std::string& label, std::vector<double> values);

/// The operating point and how it was found.
report::Section hydraulic_section(const Case& the_case, const hydraulics::SteadyState& state);

/// Chamber and delivery pressure (Fig. 10, 17), the pressure as the models get it (Fig. 25), flows
/// through both ports, leakage, openings.
std::vector<report::Figure> hydraulic_figures(const Case& the_case,
                                              const hydraulics::SteadyState& state);

}  // namespace bentaxis::study
