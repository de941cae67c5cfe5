#include "bentaxis/study/plausibility_section.h"

#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/pump_picture.h"

namespace bentaxis::study {

void describe_case(report::Document& document, const Case& the_case) {
  document.the_case = case_section(the_case);
  const Plausibility looked = plausibility(the_case);
  const auto rows = [](const std::vector<Doubt>& doubts) {
    std::vector<report::DoubtRow> list;
    for (const Doubt& doubt : doubts) list.push_back({doubt.code, doubt.text, doubt.reason});
    return list;
  };
  document.plausibility = {looked.summary(), rows(looked.warnings), rows(looked.meant)};
  document.picture = pump_picture(the_case);
}

}  // namespace bentaxis::study
