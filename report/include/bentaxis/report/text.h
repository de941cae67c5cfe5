// The comparison in words, for a terminal.
#pragma once

#include <string>

#include "bentaxis/compare/comparison.h"

namespace bentaxis::report {

/// The comparison as a plain-text table, one line per scale group, worst first.
std::string text_table(const compare::Comparison& comparison);

}  // namespace bentaxis::report
