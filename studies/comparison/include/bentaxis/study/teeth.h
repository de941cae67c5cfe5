// Teeth in contact over a turn, by both models.
#pragma once

#include "bentaxis/compare/comparison.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// Teeth by both models: tables of results/teeth.h, and their differences.
struct TeethComparison {
  ResultTable analytic, multibody;
  compare::Comparison comparison;
};

/// What is round-off of the lengths of the gear, and of the forces that teeth as stiff as these
/// make of it, counts as nothing; where a pair carries no more, neither does its point of contact.
/// @param scales  of the case's loads
TeethComparison compare_teeth(ResultTable analytic, ResultTable multibody, double tolerance,
                              compare::ZeroScales scales, const PumpParameters& pump);

}  // namespace bentaxis::study

// Until version 2: programs written for 1.0.0 look for its part of a report here.
#if __has_include("bentaxis/study/teeth_section.h")
#include "bentaxis/study/teeth_section.h"
#endif
