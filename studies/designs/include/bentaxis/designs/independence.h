// Which outputs both models compute independently, so that their agreement verifies something.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/designs/output.h"

namespace bentaxis::designs {

/// Why both models agreeing in an output shows nothing, or "" where each model computes it
/// independently of the other: "follows from the case alone".
std::string why_not_independent(const Output& output, const Case& base);
/// The outputs of which that is so, with the reason: "stroke_mm (follows from the case alone)".
std::vector<std::string> not_independent(const std::vector<Output>& outputs, const Case& base);
/// @param option  that asks for the comparison: "--check"
/// @throws InputError where that is so of all outputs
void require_independent(const std::vector<Output>& outputs, const Case& base,
                         const std::string& option);

}  // namespace bentaxis::designs
