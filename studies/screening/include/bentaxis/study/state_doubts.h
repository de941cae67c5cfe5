// Plausibility checks of given states.
#pragma once

#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/remarks.h"

namespace bentaxis::study {

/// Looks at states as a file gave them; each warning is about the first implausible state and
/// says how many are:
/// - "states-vacuum": a chamber or port below absolute zero
/// - "states-teeth-apart": block and shaft further apart than teeth let them be
/// - "states-against-time": an angle that moves otherwise than its speed says, where times are
/// given
std::vector<Warning> state_doubts(const Case& the_case, const States& states);

}  // namespace bentaxis::study
