#include "bentaxis/designs/timing_advice_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "document_parts.h"

namespace bentaxis::designs {

std::vector<std::string> advice_texts(const TimingStudy& study) {
  if (study.advice.empty())
    return {"No change advised: every timing verdict is within its limit, or has a stated reason."};
  std::vector<std::string> texts;
  for (const TimingAdvice& advice : study.advice)
    texts.push_back(advice.row.quantity + ": " +
                    (advice.change ? "change " + advice.change->text(advice.row) + "."
                                   : "no single key of plate, notches, kidneys or suction pressure "
                                     "improves it by a tenth."));
  return texts;
}

void add_advice(report::Document& document, const TimingStudy& study) {
  if (document.verdict) report::append(document.verdict->answers, advice_texts(study));
  report::Section section{
      "What to change in the timing",
      "Each quantity that exceeds its limit, with the smallest change of one key that brings it "
      "within the limit without exceeding another limit. The pump is computed again for each "
      "change; where there is no such change, the one that helps most is given. Several keys at "
      "once: bentaxis optimise.",
      {{"trials", fmt::format("{}", study.trials)},
       {"that could not be computed", fmt::format("{}", study.failed)}},
      {{"verdict", "key", "from", "to", "value before", "value after", "unit", "within its limit",
        "volumetric efficiency, %", "then exceeded"},
       {}}};
  for (const TimingAdvice& advice : study.advice) {
    if (!advice.change) {
      section.table.rows.push_back({advice.row.quantity, "none helps"});
      section.table.rows.back().resize(section.table.columns.size());
      continue;
    }
    const TimingChange& c = *advice.change;
    section.table.rows.push_back(
        {advice.row.quantity, c.variable.name(), c.from, c.to, c.value_before, c.value_after,
         advice.row.unit, c.within ? "yes" : "no", c.efficiency_change, report::joined(c.worse)});
  }
  report::append(document.runs, std::move(section));
}

}  // namespace bentaxis::designs
