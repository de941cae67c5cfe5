// Case files from cases in memory: the counterpart of read_case.
#pragma once

#include <string>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/validate.h"

namespace bentaxis {

/// The text of a case file (TOML, schema 1) that reads back as the same case: every number as the
/// shortest text that gives the same SI value, or, where no double of the file's unit does, one
/// that is off by one unit in the last place. A curve is named as `the_case.pressure.file`; the
/// file itself is not written.
std::string case_text(const Case& the_case, const Registry& registry = standard_registry());

}  // namespace bentaxis
