// The head of every report on a case: the pump in one line, what is doubtful, its picture.
#pragma once

#include <optional>

#include "bentaxis/pump/case.h"
#include "bentaxis/report/document.h"

namespace bentaxis::study {

/// Puts the case, what is doubtful about it and its pictures into a report.
/// @param scene  the pump in space; otherwise that of the analytic model alone, where its chamber
///               pressure is there
void describe_case(report::Document& document, const Case& the_case,
                   std::optional<report::Scene> scene = std::nullopt);

}  // namespace bentaxis::study
