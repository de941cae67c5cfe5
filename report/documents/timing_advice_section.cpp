#include "bentaxis/designs/timing_advice_section.h"

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
  report::NewSection section(
      "What to change in the timing",
      "Each quantity that exceeds its limit, with the smallest change of one key that brings it "
      "within the limit without exceeding another limit. The pump is computed again for each "
      "change; where there is no such change, the one that helps most is given. Several keys at "
      "once: bentaxis optimise.");
  section.fact("trials", "{}", study.trials);
  section.fact("that could not be computed", "{}", study.failed);
  section.columns("verdict", "key", "from", "to", "value before", "value after", "unit",
                  "within its limit", "volumetric efficiency, %", "then exceeded");
  for (const auto& [row, change] : study.advice) {
    if (change)
      section.row(row.quantity, change->variable.name(), change->from, change->to,
                  change->value_before, change->value_after, row.unit,
                  change->within ? "yes" : "no", change->efficiency_change, joined(change->worse));
    else
      section.row(row.quantity, "none helps");
  }
  report::append<report::Section>(document.runs, std::move(section));
}

}  // namespace bentaxis::designs
