// The condition of the paper's figures and footnotes on the rated pump.
#pragma once

#include <string>

#include "bentaxis/pump/case.h"

namespace bentaxis::study {

/// What a case differs in from the paper's pump at 275 bar and 1500 rpm, in words: "delivery_bar is
/// 200, there 274 to 276"; "" where it is that pump. Its friction and suction pressure are free.
std::string off_rated_condition(const Case& the_case);

}  // namespace bentaxis::study
