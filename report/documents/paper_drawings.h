// The paper's drawings of forces, from a turn of a model.
#pragma once

#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/paper_study.h"

namespace bentaxis::study {

/// The figures that a drawing of the list is shown as.
std::vector<report::Figure> paper_drawings(const PaperTurn& turn);

}  // namespace bentaxis::study
