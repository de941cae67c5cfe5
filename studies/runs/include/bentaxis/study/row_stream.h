// Runs of the analytic model that are written row by row and not kept, with what is seen of them.
#pragma once

#include <functional>

#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// Gets the angle and all values of a row, in the order of the layout's channels.
using RowVisitor = std::function<void(double theta_deg, const double* values)>;

/// As stream_analytic() of run.h; every row is visited too.
void stream_analytic(const PreparedCase& ready, const Assumptions& assumptions,
                     const std::function<bool(const Channel&)>& wanted, OutputFolder::Stream& out,
                     const RowVisitor& visit, const PartProgress& progress_of);

}  // namespace bentaxis::study
