// How a study tells how far it is.
#pragma once

#include <functional>
#include <string>

#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// Progress of a named part of the study.
using PartProgress = std::function<Progress(const std::string& part)>;

}  // namespace bentaxis::study
