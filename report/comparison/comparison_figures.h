// Which curves of a comparison belong to which figure of the paper.
#pragma once

#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/comparison.h"

namespace bentaxis::study {

/// Curves of channels, grouped as the paper's figures, but for Rcs where no table has it.
/// @param tables           one or two, which the page's curves are made of
/// @param without_viscous  the same without the block's viscous friction, for Rcs and Tcs
std::vector<report::Figure> channel_figures(const std::vector<const ResultTable*>& tables,
                                            const std::vector<ResultTable>& without_viscous = {});

/// The figures that show a channel that was asked for.
std::vector<report::Figure> comparison_figures(const ComparisonResult& result);

}  // namespace bentaxis::study
