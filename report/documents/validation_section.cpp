#include "bentaxis/designs/validation_section.h"

#include "bentaxis/designs/uncertainty_document.h"
#include "document_parts.h"

namespace bentaxis::designs {
namespace {

using report::Section;

report::Row cells(const ComparisonError& e) {
  return report::row_of(e.simulation, e.data, e.error(), e.numerical, e.input, e.data_uncertainty,
                        e.validation(), e.within() ? "could be 0" : "is not 0");
}

const std::vector<std::string> kColumns = {
    "simulation S", "data D", "E = S - D", "u_num",
    "u_input",      "u_D",    "u_val",     "error of the model"};

constexpr const char* kMeaning =
    "After ASME V&V 20: the error of the model lies in E -+ 2 u_val with about 95 %, where u_val^2 "
    "= u_num^2 + u_input^2 + u_D^2. u_num: what both models, which solve the same equations, "
    "differ by; u_input: by the parameters of [uncertainty]; u_D: ";

Section numbers_section(const Validation& v) {
  report::NewSection section(
      "Comparison errors of printed numbers",
      std::string(kMeaning) +
          "a printed number lies anywhere within half of its last digit or its tolerance, and a "
          "window's middle within the window: half width over the root of 3. Only predicted rows "
          "are validation.");
  section.fact("comparable rows that give no E (ranges of curves, one-sided statements, counts)",
               std::to_string(v.without_error));
  section.columns("quantity", "at", "status", "unit", kColumns);
  for (const ValidationRow& row : v.rows)
    section.row(row.row.number.quantity, row.row.at, row.row.number.status, row.row.number.unit,
                cells(row.error));
  return section;
}

Section curves_section(const Validation& v) {
  report::NewSection section(
      "Comparison errors of the curves of " + v.reference,
      std::string(kMeaning) +
          "the reference's tolerance, its tube and what the rounding of its angles allows as half "
          "width, over the root of 3. At the angle where |E| / u_val is largest; of channels that "
          "have a band.");
  section.columns("channel", "unit", "angle, deg", kColumns, "could be 0, % of its angles");
  for (const ValidationCurve& curve : v.curves)
    section.row(curve.channel.name, curve.channel.unit, curve.worst_deg, cells(curve.worst),
                100 * curve.within_share);
  return section;
}

}  // namespace

void add_validation(report::Document& document, const Validation& v) {
  report::append(document.runs,
                 std::vector{parameters_section(v.uncertainty), bands_section(v.uncertainty)});
  add_left_out(document, v.uncertainty);
  if (!v.rows.empty()) document.runs->push_back(numbers_section(v));
  if (!v.curves.empty()) document.runs->push_back(curves_section(v));
  std::vector<report::Figure> figures = band_figures(v.uncertainty);
  for (report::Figure& figure : figures) {
    auto& bands = std::get<report::BandFigure>(figure.content);
    for (const ValidationCurve& curve : v.curves)
      if (figure.id == "band_" + curve.channel.group)
        bands.lines.push_back(
            {curve.channel.name + ", " + v.reference, curve.theta_deg, curve.data});
  }
  report::append(document.figures, std::move(figures));
}

}  // namespace bentaxis::designs
