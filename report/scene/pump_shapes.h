// What the bodies of a pump look like in space.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/report/scene.h"
#include "pump_outline.h"

namespace bentaxis::study {

/// Shapes by body, each in its own coordinates, m: those of the shaft in S1 and of the block in S2
/// as they stand at 0 degrees, of a piston from A along its axis, of the plate from its face to the
/// block, of the housing in S1.
struct PumpShapes {
  std::vector<report::Shape> shaft, piston, block, plate, housing;
  std::string note;  ///< what the case gives no dimension of, and what is beyond the picture
};

PumpShapes pump_shapes(const Case& the_case, const PumpOutline& outline);

}  // namespace bentaxis::study
