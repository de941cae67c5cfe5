#include "bentaxis/study/achieved_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/load_scale.h"

namespace bentaxis::study {

compare::ZeroScales zero_scales(const Case& the_case, const Samples& samples) {
  const LoadScale scale = load_scale(the_case, samples);
  const double radius = std::max(the_case.pump.geometry.joint_circle_radius,
                                 the_case.pump.geometry.bore_circle_radius);
  // The power of a piston's loads at its spin, over omega: round-off of the loads is multiplied by
  // spin over omega there.
  double power = scale.moment;
  constexpr double kOperations = 16;  // whose round-off adds up
  if (the_case.pump.piston.real && samples.omega != 0)
    power *= std::max(1.0, kOperations * std::numeric_limits<double>::epsilon() / kDrivenTolerance *
                               std::abs(the_case.pump.piston.real->spin / samples.omega));
  return {
      {"N", scale.force}, {"Nm", scale.moment}, {"mm", radius * 1e3}, {"power_residual", power}};
}

AchievedError achieved_error(const Case& the_case, const Samples& samples,
                             const ResultTable& reference, const ResultTable& table,
                             multibody::Scene scene) {
  compare::Options options;
  options.zero_scales = zero_scales(the_case, samples);
  const compare::Comparison comparison = compare::compare_tables(reference, table, options);
  const auto furthest = [&](std::initializer_list<std::string> quantities) {
    return comparison.furthest([&](const Channel& channel) {
      return channel.kind == ChannelKind::reaction && multibody::computes(scene, channel) &&
             (quantities.size() == 0 || contains(quantities, channel.quantity));
    });
  };
  const auto error_of = [&](std::initializer_list<std::string> quantities) {
    const compare::ChannelComparison* const found = furthest(quantities);
    return found == nullptr ? not_computed() : found->largest_over_peak();
  };
  const compare::ChannelComparison* const worst = furthest({});
  return {error_of({"Rs"}),
          error_of({"Rc"}),
          error_of({"Rb1", "Rb2"}),
          error_of({"Rcs"}),
          error_of({"Td"}),
          error_of({}),
          worst == nullptr ? "" : worst->channel.name};
}

}  // namespace bentaxis::study
