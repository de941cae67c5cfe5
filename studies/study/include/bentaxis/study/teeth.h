// Teeth in contact over a turn, by both models.
#pragma once

#include "bentaxis/compare/comparison.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/report/document.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// What teeth do by both models: tables of results/teeth.h, and how far they are apart.
struct TeethComparison {
  ResultTable analytic, multibody;
  compare::Comparison comparison;
};

/// What is round-off of the lengths of the gear, and of the forces that teeth as stiff as these
/// make of it, counts as nothing; where a pair carries no more, neither does its point of contact.
/// @param scales  of the case's loads
TeethComparison compare_teeth(ResultTable analytic, ResultTable multibody, double tolerance,
                              compare::ZeroScales scales, const PumpParameters& pump);

/// The teeth for a report: transmission error, share of the pairs, largest force, and the
/// comparison line by line.
report::Section teeth_section(const TeethComparison& teeth, const PumpParameters& pump);

/// Forces of the flanks and of the pairs, and the transmission error, over the shaft's angle; the
/// paths of contact of both models.
std::vector<report::Figure> teeth_figures(const TeethComparison& teeth, const PumpParameters& pump);

/// The teeth in mesh with lines of contact and forces, at angles over a turn: seen from outside on
/// O4 towards O2, and the lines over the face width.
/// @param table  of results/teeth.h
report::Figure teeth_picture(const PumpParameters& pump, const ResultTable& table);

}  // namespace bentaxis::study
