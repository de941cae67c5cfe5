// Curves of a reference beside those of the models, for a report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/report/curves.h"
#include "bentaxis/study/regression.h"

namespace bentaxis::study {

/// The reference's curves at the result's angles, with what is allowed and each model's difference.
std::optional<report::Curves::Reference> reference_curves(const Outcome& outcome,
                                                          const std::vector<std::string>& channels);

}  // namespace bentaxis::study
