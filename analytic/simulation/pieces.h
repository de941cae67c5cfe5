// The smooth pieces that a motion consists of: for judging integrators. Internal.
#pragma once

#include <vector>

#include "simulation/equations.h"

namespace bentaxis::analytic::simulation {

/// Where a piece begins, and under which law: touches and edges of the pressure lie between pieces.
struct Piece {
  double time = 0;
  State state = {};
  Teeth teeth;
  double from_angle = 0, to_angle = 0;
};

/// As analytic::simulate(), with the pieces and, as the last of them, the end.
Trajectory simulate(const Case& the_case, const Assumptions& assumptions,
                    const PressureTrace& pressure, const SimulationOptions& options,
                    std::vector<Piece>& pieces);

}  // namespace bentaxis::analytic::simulation
