#include "bentaxis/study/reference_curves.h"

#include "bentaxis/results/periodic_lines.h"
#include "document_parts.h"

namespace bentaxis::study {

namespace {

// Values of a reference's column, or of the difference from it, at the angles of a page.
report::Values drawn_at(const std::vector<double>& theta_deg, const Outcome::Held& held,
                        const report::Values& values) {
  const std::vector<double>& own = held.reference.theta_deg;
  if (own == theta_deg) return values;
  report::Values drawn = on_lines(own, values, theta_deg);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    for (const auto& gap : held.gaps)
      if (const double past = wrap_degrees(theta_deg[i] - gap.from_deg);
          past > 0 && past < gap.to_deg - gap.from_deg)
        drawn[i] = not_computed();
  return drawn;
}

}  // namespace

std::optional<report::Curves::Reference> reference_curves(const Outcome& outcome,
                                                          const std::vector<std::string>& channels,
                                                          const std::vector<double>& theta_deg) {
  report::Curves::Reference reference{outcome.name, {}};
  for (const std::string& channel : channels) {
    report::Curves::Held one{channel, {}, 0, {}, {}};
    for (const auto& [model, held] : outcome.held) {
      const compare::ReferenceChannel* found = outcome.find(model, channel);
      const std::size_t theirs = held.reference.find(channel), ours = held.result.find(channel);
      if (found == nullptr || theirs == held.reference.columns()) continue;
      if (one.values.empty()) {
        one.values = drawn_at(theta_deg, held, report::values_of(held.reference, channel));
        one.allowed = found->comparison.allowed;
        if (held.low.rows() > 0) {
          one.low = drawn_at(theta_deg, held, report::values_of(held.low, channel));
          one.high = drawn_at(theta_deg, held, report::values_of(held.high, channel));
        }
      }
      report::Values difference;
      for (std::size_t row = 0; row < held.result.rows(); ++row) {
        const double theirs_now = held.reference.at(row, theirs);
        difference.push_back(is_computed(theirs_now) ? held.result.at(row, ours) - theirs_now
                                                     : not_computed());
      }
      one.differences.emplace_back(model, drawn_at(theta_deg, held, difference));
    }
    if (!one.values.empty()) reference.held.push_back(std::move(one));
  }
  if (reference.held.empty()) return std::nullopt;
  return reference;
}

}  // namespace bentaxis::study
