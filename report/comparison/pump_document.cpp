#include "bentaxis/study/pump_document.h"

#include "bentaxis/study/assumptions.h"
#include "bentaxis/study/force_figures.h"
#include "bentaxis/study/pump_scene.h"
#include "bentaxis/study/timing.h"
#include "bentaxis/study/turn_summary.h"
#include "comparison_figures.h"
#include "document_parts.h"
#include "hydraulic_sections.h"
#include "key_figures.h"

namespace bentaxis::study {

report::Document pump_document(const ShownPump& pump, const report::Lines& program) {
  const Case& the_case = pump.ready.the_case;
  const ResultTable& table = pump.run.table;
  const CaseDescription& description = pump.description;
  report::Document document = case_document(
      description, the_case.name, program,
      pump_scene(the_case, {{table, pump.run.loads}}, nullptr, film_path_of(description)));
  document.verdict = {std::nullopt, "The analytic model alone: nothing is compared.", "One model"};
  document.verdict->answers = pump.answers();
  document.verdict->not_valid = not_valid_text(pump.limits);
  document.key_figures = {{table.name}, "deg", turn_figures({&table})};
  append(document.key_figures->rows, transfer_figures({&table}, the_case.pump));
  document.validity = validity_section(pump.limits);
  document.models = {report::model_of(table, in_words(the_case.analytic))};
  document.runs.emplace();
  document.figures = force_figures({the_case, table, &pump.run.loads});
  append(document.figures, channel_figures({&table}));
  if (pump.ready.hydraulics) {
    const hydraulics::SteadyState& state = *pump.ready.hydraulics;
    append(document.key_figures->rows, oil_figures(state.summary, 1));
    document.timing = timing_rows(the_case, state);
    report::append(document.warnings, timing_warnings(*document.timing));
    document.runs->push_back(hydraulic_section(the_case, state));
    append(document.figures, hydraulic_figures(the_case, state));
  }
  return document;
}

report::Curves pump_curves(const ShownPump& pump) { return report::curves_of(pump.run.table); }

}  // namespace bentaxis::study
