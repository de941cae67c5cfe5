// The report as one HTML file that opens offline.
#pragma once

#include <map>
#include <string>

#include "bentaxis/report/document.h"

namespace bentaxis::report {

/// Fixed parts of the page by file name (template.html, report.css, the modules of the script, plot
/// library).
const std::map<std::string, std::string>& page_parts();

/// The page of a document, which the script draws from its JSON (docs/report_json.md). `curves` are
/// those that its figures name.
std::string render_page(const Document& document, const Curves& curves = {});

}  // namespace bentaxis::report
