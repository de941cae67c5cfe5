// The comparison in words, and parts of a document as JSON for commands that still put their report
// together from JSON.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/report/document.h"

namespace bentaxis::report {

Json channel_rows(const compare::Comparison& comparison);
Json check_rows(const std::vector<compare::Check>& checks);
Json split_section(const compare::Split& split, const std::vector<AssumptionRow>& rows,
                   const std::string& text);
Json published_section(const PublishedTable& published);
Json model_section(const ResultTable& table, const Lines& assumptions);
Json curve_section(const ResultTable& first, const ResultTable& second);
Json curve(const ResultTable& table, const std::string& channel_name);
Json plot_values(const Values& values, double unit_in_si = 1);

/// The comparison as a plain-text table, one line per scale group, worst first.
std::string text_table(const compare::Comparison& comparison);

}  // namespace bentaxis::report
