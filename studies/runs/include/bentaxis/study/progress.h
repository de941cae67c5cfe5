// How a study tells how far it is.
#pragma once

#include <functional>
#include <string>

#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// Progress of a named part of the study.
using PartProgress = std::function<Progress(const std::string& part)>;

/// For those who do not want to know.
inline PartProgress silent() {
  return [](const std::string&) { return Progress([](double) {}); };
}

}  // namespace bentaxis::study
