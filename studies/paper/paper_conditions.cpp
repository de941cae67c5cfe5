#include "paper_conditions.h"

#include <cmath>

#include "bentaxis/study/published_section.h"

namespace bentaxis::study {

std::string off_rated_condition(const Case& the_case) {
  // As reference_data/published/bap63/numbers.toml has them.
  static const compare::PublishedCondition rated{"rated",
                                                 "",
                                                 {{"pistons", {5, 5}},
                                                  {"displacement_cm3", {63.06, 64.34}},
                                                  {"speed_rpm", {1499, 1501}},
                                                  {"delivery_bar", {274, 276}}}};
  compare::Facts facts = facts_of(the_case, the_case.analytic);
  facts["speed_rpm"] = std::abs(facts["speed_rpm"]);
  return rated.mismatch(facts);
}

}  // namespace bentaxis::study
