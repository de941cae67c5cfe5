// A figure of a report as a file of its own, drawn without a browser.
#pragma once

#include <string>

#include "bentaxis/report/document.h"

namespace bentaxis::report {

/// The figure as SVG that stands alone, dark on white. The page shows, prints and hands out the
/// same text.
/// @param curves  those of the page, which the figure may name
std::string svg_of(const Figure& figure, const Curves& curves = {});

/// Name of its files, without ending: its id, behind the figures of the paper that it answers:
/// "fig12_rs", "fig10_25_pressure".
std::string file_name_of(const Figure& figure);

/// Its numbers as CSV, all digits. Curves: a column each over the angle. Points and maps: a row
/// each. What was not computed is an empty field.
std::string csv_of(const Figure& figure, const Curves& curves = {});

/// SVG in pixels, twice its size. @throws std::runtime_error where librsvg refuses it
std::string png_of(const std::string& svg);

}  // namespace bentaxis::report
