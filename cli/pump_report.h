// What a comparison report says about the pump beyond the comparison itself: derived quantities,
// what both models share, limits of validity, and which curves belong to which figure of the paper.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::cli {

using Json = nlohmann::json;

Json case_section(const Case& the_case);
Json derived_section(const Case& the_case);
Json common_section(const Case& the_case);
Json validity_section(const std::vector<analytic::ValidityLimit>& limits);
/// Violated limits as named warnings.
Json warnings_section(const std::vector<analytic::ValidityLimit>& limits);

/// Plots grouped as the paper's figures.
/// @param without_viscous  both tables recomputed with Cc = 0, for Fig. 32; empty where not run
Json figures_section(const ResultTable& analytic, const ResultTable& multibody,
                     const std::vector<ResultTable>& without_viscous);

/// The figures that show one of these channels.
Json figures_of(const std::vector<Channel>& channels, const Json& figures);

}  // namespace bentaxis::cli
