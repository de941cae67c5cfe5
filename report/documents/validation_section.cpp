#include "bentaxis/designs/validation_section.h"

#include <fmt/format.h>

#include "bentaxis/designs/uncertainty_document.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::designs {
namespace {

using report::Cell;
using report::Section;

std::vector<Cell> cells(const ComparisonError& e) {
  return {e.simulation,   e.data,
          e.error(),      e.numerical,
          e.input,        e.data_uncertainty,
          e.validation(), e.within() ? "could be 0" : "is not 0"};
}

std::vector<std::string> columns(std::vector<std::string> first) {
  first.insert(first.end(), {"simulation S", "data D", "E = S - D", "u_num", "u_input", "u_D",
                             "u_val", "error of the model"});
  return first;
}

constexpr const char* kMeaning =
    "After ASME V&V 20: the error of the model lies in E -+ 2 u_val with about 95 %, where u_val^2 "
    "= u_num^2 + u_input^2 + u_D^2. u_num: what both models, which solve the same equations, "
    "differ by; u_input: by the parameters of [uncertainty]; u_D: ";

Section numbers_section(const Validation& v) {
  Section section{
      "Comparison errors of printed numbers",
      std::string(kMeaning) +
          "a printed number lies anywhere within half of its last digit or its tolerance, and a "
          "window's middle within the window: half width over the root of 3. Only predicted rows "
          "are validation.",
      {{"comparable rows that give no E (ranges of curves, one-sided statements, counts)",
        std::to_string(v.without_error)}},
      {columns({"quantity", "at", "status", "unit"}), {}}};
  for (const ValidationRow& row : v.rows) {
    std::vector<Cell> line = {row.row.number.quantity, row.row.at, row.row.number.status,
                              row.row.number.unit};
    for (Cell& cell : cells(row.error)) line.push_back(std::move(cell));
    section.table.rows.push_back(std::move(line));
  }
  return section;
}

Section curves_section(const Validation& v) {
  Section section{"Comparison errors of the curves of " + v.reference,
                  std::string(kMeaning) +
                      "the reference's tolerance, its tube and what the rounding of its angles "
                      "allows as half width, over the root of "
                      "3. At the angle where |E| / u_val is largest; of channels that have a band.",
                  {},
                  {columns({"channel", "unit", "angle, deg"}), {}}};
  section.table.columns.emplace_back("could be 0, % of its angles");
  for (const ValidationCurve& curve : v.curves) {
    std::vector<Cell> line = {curve.channel.name, curve.channel.unit, curve.worst_deg};
    for (Cell& cell : cells(curve.worst)) line.push_back(std::move(cell));
    line.emplace_back(100 * curve.within_share);
    section.table.rows.push_back(std::move(line));
  }
  return section;
}

}  // namespace

void add_validation(report::Document& document, const Validation& v) {
  if (!document.runs) document.runs.emplace();
  if (!document.figures) document.figures.emplace();
  document.runs->push_back(parameters_section(v.uncertainty));
  document.runs->push_back(bands_section(v.uncertainty));
  add_left_out(document, v.uncertainty);
  if (!v.rows.empty()) document.runs->push_back(numbers_section(v));
  if (!v.curves.empty()) document.runs->push_back(curves_section(v));
  for (report::Figure& figure : band_figures(v.uncertainty)) {
    auto& bands = std::get<report::BandFigure>(figure.content);
    for (const ValidationCurve& curve : v.curves)
      if (figure.id == "band_" + curve.channel.group)
        bands.lines.push_back(
            {curve.channel.name + ", " + v.reference, curve.theta_deg, curve.data});
    document.figures->push_back(std::move(figure));
  }
}

}  // namespace bentaxis::designs
