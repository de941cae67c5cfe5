#include "bentaxis/study/achieved_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/pump/number.h"
#include "bentaxis/results/load_scale.h"
#include "bentaxis/results/max_abs.h"
#include "bentaxis/study/comparison.h"

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
                             const ResultTable& reference, const ResultTable& table) {
  compare::Options options;
  options.zero_scales = zero_scales(the_case, samples);
  const compare::Comparison comparison = compare::compare_tables(reference, table, options);
  AchievedError error;
  const auto keep = [](double& worst, double value) {
    if (is_computed(worst))
      update_max_abs(worst, value);
    else
      worst = value;
  };
  for (const compare::ChannelComparison& c : comparison.channels) {
    if (c.channel.kind != ChannelKind::reaction || !c.compared()) continue;
    const double value = c.largest_over_peak();
    const std::string& quantity = c.channel.quantity;
    if (quantity == "Rs") keep(error.rs, value);
    if (quantity == "Rc") keep(error.rc, value);
    if (quantity == "Rb1" || quantity == "Rb2") keep(error.bearings, value);
    if (quantity == "Rcs") keep(error.rcs, value);
    if (quantity == "Td") keep(error.td, value);
    if (error.worst_channel.empty() || value > error.worst || std::isnan(value)) {
      error.worst = value;
      error.worst_channel = c.channel.name;
    }
  }
  return error;
}

}  // namespace bentaxis::study
