// Operating points as the document of pressure.json and of its page.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/case_description.h"
#include "bentaxis/study/operating_points.h"
#include "bentaxis/study/published_section.h"
#include "bentaxis/study/timing.h"

namespace bentaxis::study {

/// One operating point: its hydraulic state, pressures, flows, torque, timing, power by place,
/// orders.
/// @param power    hydraulics::power_by_place of its state
/// @param program  what computed it: names and versions
report::Document pressure_document(const OperatingPoint& point,
                                   const hydraulics::PowerBudget& power,
                                   const report::Lines& program,
                                   const CaseDescription& description);
[[deprecated("pass describe(..)")]] inline report::Document pressure_document(
    const OperatingPoint& point, const hydraulics::PowerBudget& power,
    const report::Lines& program) {
  return pressure_document(point, power, program, describe(point.the_case()));
}

/// Adds torque and flow against delivery pressure (Fig. 18).
void add_curve(report::Document& document, const TorqueCurve& curve);
/// Adds the reactions of two operating points in the same figures, over three turns (Fig. 19-24).
/// @throws InputError where their samples differ
void add_overlay(report::Document& document, const OperatingPoint& first,
                 const OperatingPoint& second);
/// Adds how the operating point stands against printed numbers (judge_point).
void add_published(report::Document& document, compare::PublishedSection section);
[[deprecated("use judge_point")]] inline void add_published(
    report::Document& document, const compare::Published& published, const OperatingPoint& point,
    const PartProgress& progress_of = silent()) {
  add_published(document, judge_point(published, point, progress_of));
}
/// Its rows that the case can be held to, for a terminal.
std::string text_of(const compare::PublishedSection& section);
/// Adds pressures from rest (hydraulics::transient_from_rest).
void add_transient(report::Document& document, const ResultTable& transient);

/// The files that go with it, name and content: pressure.csv, power.csv, orders.csv.
std::vector<std::pair<std::string, std::string>> pressure_csv(const OperatingPoint& point,
                                                              const hydraulics::PowerBudget& power);

/// Adds the speed up to which suction follows to the verdicts on timing.
void add_suction_speed(report::Document& document, const OperatingPoint& point,
                       const SuctionSpeed& found);

/// The operating point in words, for a terminal.
/// @param document  of it
std::string pressure_text(const OperatingPoint& point, const hydraulics::PowerBudget& power,
                          const report::Document& document);

}  // namespace bentaxis::study
