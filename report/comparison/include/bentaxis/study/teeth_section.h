// Teeth in contact over a turn, for a report.
#pragma once

#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/teeth.h"

namespace bentaxis::study {

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
