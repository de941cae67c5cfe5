// The head of every report on a case: the pump in one line, what is doubtful, its picture.
#pragma once

#include <optional>
#include <utility>

#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"

namespace bentaxis::study {

report::PlausibilitySection plausibility_section(const Plausibility& looked);

/// Puts the case, its plausibility warnings and its pictures into a report, and a warning for each
/// part of the description that could not be computed.
/// @param scene  the pump in space; otherwise that of the description's turn, where there is one
void put_description(report::Document& document, const CaseDescription& description,
                     std::optional<report::Scene> scene = std::nullopt);

[[deprecated("use describe and put_description")]] inline void describe_case(
    report::Document& document, const Case& the_case,
    std::optional<report::Scene> scene = std::nullopt) {
  const Described what = scene ? Described::inputs : Described::all;
  put_description(document, describe(the_case, silent(), what), std::move(scene));
}

}  // namespace bentaxis::study
