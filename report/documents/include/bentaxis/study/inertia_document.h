// The study of lumped and real pistons as a report, as CSV files and as text.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "bentaxis/compare/published.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/inertia_study.h"

namespace bentaxis::study {

struct InertiaReport {
  report::Document document;
  report::Curves curves;  ///< that its figures name
};

/// @param published  judge_inertia of the numbers printed for this pump, where there are any
/// @param program    names and versions
InertiaReport inertia_report(const InertiaStudy& study,
                             std::optional<compare::PublishedSection> published,
                             const report::Lines& program, const CaseDescription& description);
[[deprecated("use judge_inertia, and pass describe(..)")]] inline InertiaReport inertia_report(
    const InertiaStudy& study, const compare::Published* published, const report::Lines& program) {
  std::optional<compare::PublishedSection> section;
  if (published != nullptr) section = judge_inertia(study, *published);
  return inertia_report(study, std::move(section), program, describe(study.the_case));
}

/// Rs and Rc of piston 1 of every run: components and magnitude.
std::string inertia_curves_csv(const InertiaStudy& study);
/// What lumping changes in every reaction.
std::string inertia_errors_csv(const InertiaStudy& study);
std::string inertia_map_csv(const ErrorMap& map);

/// The result in words and short tables, for a terminal.
std::string inertia_text(const InertiaStudy& study);

}  // namespace bentaxis::study
