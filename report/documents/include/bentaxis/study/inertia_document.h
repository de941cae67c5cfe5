// The study of lumped and real pistons as a report, as CSV files and as text.
#pragma once

#include <string>

#include "bentaxis/compare/published.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/inertia_study.h"

namespace bentaxis::study {

struct InertiaReport {
  report::Document document;
  report::Curves curves;  ///< that its figures name
};

/// @param published  numbers printed for this pump; nullptr where there are none
/// @param program    names and versions
InertiaReport inertia_report(const InertiaStudy& study, const compare::Published* published,
                             const report::Lines& program);

/// Rs and Rc of piston 1 of every run: components and magnitude.
std::string inertia_curves_csv(const InertiaStudy& study);
/// What lumping changes in every reaction.
std::string inertia_errors_csv(const InertiaStudy& study);
std::string inertia_map_csv(const ErrorMap& map);

/// The result in words and short tables, for a terminal.
std::string inertia_text(const InertiaStudy& study);

}  // namespace bentaxis::study
