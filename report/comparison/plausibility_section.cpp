#include "bentaxis/study/plausibility_section.h"

#include <utility>

#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/pump_picture.h"
#include "bentaxis/study/pump_scene.h"
#include "document_parts.h"

namespace bentaxis::study {

report::PlausibilitySection plausibility_section(const Plausibility& looked) {
  const auto rows = [](const std::vector<PlausibilityWarning>& doubts) {
    std::vector<report::PlausibilityRow> list;
    for (const PlausibilityWarning& doubt : doubts)
      list.push_back({doubt.code, doubt.text, doubt.reason});
    return list;
  };
  return {looked.summary(), rows(looked.warnings), rows(looked.meant)};
}

void put_description(report::Document& document, const CaseDescription& description,
                     std::optional<report::Scene> scene) {
  document.the_case = case_section(description.the_case);
  document.plausibility = plausibility_section(description.plausibility);
  document.picture = pump_picture(description.the_case);
  document.scene = scene ? std::move(scene) : scene_of(description);
  for (const FailedPoint& failed : description.failed)
    report::append(document.warnings,
                   report::Warning{
                       "description-incomplete",
                       failed.point + " could not be computed and is not shown: " + failed.reason});
}

}  // namespace bentaxis::study
