#include "bentaxis/study/reference_curves.h"

#include <utility>

#include "bentaxis/pump/number.h"
#include "bentaxis/report/document.h"

namespace bentaxis::study {

std::optional<report::Curves::Reference> reference_curves(
    const Outcome& outcome, const std::vector<std::string>& channels) {
  report::Curves::Reference reference{outcome.name, {}};
  for (const std::string& channel : channels) {
    report::Curves::Held one{channel, {}, 0, {}, {}};
    for (const auto& [model, held] : outcome.held) {
      const compare::ReferenceChannel* found = outcome.find(model, channel);
      const std::size_t theirs = held.reference.find(channel), ours = held.result.find(channel);
      if (found == nullptr || theirs == held.reference.columns()) continue;
      if (one.values.empty()) {
        one.values = report::values_of(held.reference, channel);
        one.allowed = found->comparison.allowed;
        if (held.low.rows() > 0) {
          one.low = report::values_of(held.low, channel);
          one.high = report::values_of(held.high, channel);
        }
      }
      report::Values difference;
      for (std::size_t row = 0; row < held.result.rows(); ++row) {
        const double theirs_now = held.reference.at(row, theirs);
        difference.push_back(is_computed(theirs_now) ? held.result.at(row, ours) - theirs_now
                                                     : not_computed());
      }
      one.differences.emplace_back(model, std::move(difference));
    }
    if (!one.values.empty()) reference.held.push_back(std::move(one));
  }
  if (reference.held.empty()) return std::nullopt;
  return reference;
}

}  // namespace bentaxis::study
