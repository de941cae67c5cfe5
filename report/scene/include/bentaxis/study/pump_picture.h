// A picture of a pump to scale, from its case alone.
#pragma once

#include <string>

#include "bentaxis/pump/case.h"

namespace bentaxis::study {

/// The pump as SVG: in the plane of the tilt (S1, shaft angle 0, with a piston at either dead
/// centre), along the shaft axis (joints, gear) and along the block axis (bores, ports). All three
/// to one scale: what stands in an element of class "mm" is in mm, in S1 or S2. What the case does
/// not say (outlines of block and shaft, shape of the pistons) is drawn pale. What lies far outside
/// is named at the edge. Colours follow the text colour of the page, or the reader's scheme where
/// the file stands alone.
std::string pump_picture(const Case& the_case);

}  // namespace bentaxis::study
