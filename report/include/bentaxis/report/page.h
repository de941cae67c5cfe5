// The report as one HTML file that opens offline.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "bentaxis/report/document.h"

namespace bentaxis::report {

/// Fixed parts of the page by file name (template.html, report.css, report.js, plot library).
const std::map<std::string, std::string>& page_parts();

/// The page of a document. `curves` are those that its figures name.
std::string render_page(const Document& document, const Curves& curves = {});

/// Fills the template. `report` and `curves` are what report.js draws from (docs/report_json.md).
std::string render_page(const std::string& title, const nlohmann::json& report,
                        const nlohmann::json& curves);

}  // namespace bentaxis::report
