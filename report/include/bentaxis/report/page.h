// The report as one HTML file that opens offline.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/report/document.h"

namespace bentaxis::report {

/// Fixed parts of the page by file name (template.html, report.css, the modules of the script, plot
/// library).
const std::map<std::string, std::string>& page_parts();

/// What stands where a template has a marker.
using Fillings = std::vector<std::pair<std::string, std::string>>;
/// A template of the fixed parts, each marker replaced once, in this order: what comes last is not
/// searched for the others. @throws std::logic_error where a marker is missing
std::string filled_template(const std::string& part, const Fillings& fillings);

/// The page of a document, which the script draws from its JSON (docs/report_json.md). `curves` are
/// those that its figures name.
std::string render_page(const Document& document, const Curves& curves = {});

}  // namespace bentaxis::report
