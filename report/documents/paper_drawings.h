// The paper's drawings of forces, from a turn of a model.
#pragma once

#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/paper_study.h"

namespace bentaxis::study {

/// The figures that a drawing of the list is shown as.
std::vector<report::Figure> paper_drawings(const PaperTurn& turn);

/// The block from the front (z2 towards the eye): the pistons' forces on it, with their torque
/// about z2, at angles (deg) between samples too.
report::DrawingFigure block_from_the_front(const PumpParameters& pump, const ResultTable& turn,
                                           const std::vector<double>& angles);

/// Each piston's share of that torque at an angle (deg).
report::BarsFigure pistons_shares(const PumpParameters& pump, const ResultTable& turn,
                                  double angle);

/// Fp, Rs and Rc on piston 1 tip to tail in the plane x2-z2.
/// @param turn  without inertia and friction of the piston, and without weight: they close then
report::DrawingFigure force_triangle(const PumpParameters& pump, const ResultTable& turn,
                                     const std::vector<double>& angles);

/// Piston 1 from A to B with Rs in the planes x2-z2 and y2-z2.
report::DrawingFigure piston_in_two_planes(const PumpParameters& pump, const ResultTable& turn,
                                           const std::vector<double>& angles);

}  // namespace bentaxis::study
