#include "bentaxis/study/plausibility_section.h"

#include <utility>

#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/pump_picture.h"
#include "bentaxis/study/pump_scene.h"

namespace bentaxis::study {

void describe_case(report::Document& document, const Case& the_case,
                   std::optional<report::Scene> scene) {
  document.the_case = case_section(the_case);
  const Plausibility looked = plausibility(the_case);
  const auto rows = [](const std::vector<PlausibilityWarning>& doubts) {
    std::vector<report::DoubtRow> list;
    for (const PlausibilityWarning& doubt : doubts)
      list.push_back({doubt.code, doubt.text, doubt.reason});
    return list;
  };
  document.plausibility = {looked.summary(), rows(looked.warnings), rows(looked.meant)};
  document.picture = pump_picture(the_case);
  document.scene = scene ? std::move(scene) : analytic_scene(the_case);
}

}  // namespace bentaxis::study
