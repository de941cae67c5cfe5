// The rattle map as the document of report.json and of its page.
#pragma once

#include <string>

#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/rattle.h"

namespace bentaxis::study {

/// @param program  what computed it: names and versions
report::Document rattle_document(const RattleMap& map, const report::Lines& program,
                                 const CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document rattle_document(
    const RattleMap& map, const report::Lines& program) {
  return rattle_document(map, program, study::describe(map.the_case));
}

/// In words, for a terminal.
std::string rattle_text(const RattleMap& map);

}  // namespace bentaxis::study
