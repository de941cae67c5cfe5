// The rattle map as the document of report.json and of its page.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/rattle.h"

namespace bentaxis::study {

/// How the simulated boundary stands to the criterion of rigid teeth, of the upward sweep.
struct BoundaryAgreement {
  std::size_t points = 0, same = 0;  ///< of those, the criterion says the same whether teeth carry
  /// Per row and boundary of the criterion: where the simulated class changes, half way between two
  /// speeds; not_computed() where it does not.
  struct Place {
    double delivery_bar, criterion_rpm, simulated_rpm, spacing_rpm;
  };
  std::vector<Place> places;
};
BoundaryAgreement boundary_agreement(const RattleMap& map);

/// @param program  what computed it: names and versions
report::Document rattle_document(const RattleMap& map, const report::Lines& program);

/// In words, for a terminal.
std::string rattle_text(const RattleMap& map);

}  // namespace bentaxis::study
