// What reports say about the hydraulic side: an operating point as a table, and its figures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/report/report.h"

namespace bentaxis::cli {

using report::plot_values;
using Json = nlohmann::json;

/// A figure whose curves are over an axis of their own.
Json own_figure(const std::string& id, const std::string& title, const std::string& paper,
                const std::string& unit, const std::string& axis, const std::vector<double>& x);
void add_series(Json& figure, const std::string& label, Json values);

/// The operating point and how it was found, as a block of the section "runs".
Json hydraulic_block(const Case& the_case, const hydraulics::SteadyState& state);

/// Chamber and delivery pressure (Fig. 10, 17), the pressure as the models get it (Fig. 25), flows
/// through both ports, leakage, openings.
Json hydraulic_figures(const Case& the_case, const hydraulics::SteadyState& state);

}  // namespace bentaxis::cli
