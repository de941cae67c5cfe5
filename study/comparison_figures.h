// Which curves of a comparison belong to which figure of the paper.
#pragma once

#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/comparison.h"

namespace bentaxis::study {

/// The figures that show a channel that was asked for.
std::vector<report::Figure> comparison_figures(const ComparisonResult& result);

}  // namespace bentaxis::study
