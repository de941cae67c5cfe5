// Curves of a reference beside those of the models, for a report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/report/curves.h"
#include "bentaxis/study/regression.h"

namespace bentaxis::study {

/// The reference's curves with what is allowed and each model's difference. At angles of a page
/// (deg) that it has no points at, they are on the straight lines between its points.
std::optional<report::Curves::Reference> reference_curves(const Outcome& outcome,
                                                          const std::vector<std::string>& channels,
                                                          const std::vector<double>& theta_deg);

}  // namespace bentaxis::study
