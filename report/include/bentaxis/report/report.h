// Comparison results as JSON: the numbers of report.json and of the page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/compare/split.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::report {

using Json = nlohmann::json;
using Lines = std::vector<std::pair<std::string, std::string>>;

/// Statistics of every channel, with body, acting body, point and frame.
Json channel_rows(const compare::Comparison& comparison);
Json check_rows(const std::vector<compare::Check>& checks);

/// Contribution of each differing assumption to each channel.
/// @param rows  assumption, its value in the first and in the second table
struct AssumptionRow {
  std::string name, first, second;
};
Json split_section(const compare::Split& split, const std::vector<AssumptionRow>& rows,
                   const std::string& text);

/// How a table was obtained.
Json model_section(const ResultTable& table, const Lines& assumptions);

/// Curves of both tables and their difference, to 9 digits: enough for a plot. Differences are
/// taken before rounding.
Json curve_section(const ResultTable& first, const ResultTable& second);

/// Values of one channel to 9 digits, null where not computed.
Json curve(const ResultTable& table, const std::string& channel_name);

/// The comparison as a plain-text table, one line per scale group, worst first.
std::string text_table(const compare::Comparison& comparison);

}  // namespace bentaxis::report
