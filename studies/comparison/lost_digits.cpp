#include "bentaxis/study/lost_digits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bentaxis/analytic/rounding.h"
#include "bentaxis/compare/comparison.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/rounding_spread.h"

namespace bentaxis::study {
namespace {

constexpr int kAngles = 24;
constexpr double kWorthAWarning = 1e-9;   // of peak: the tolerance of a comparison
constexpr double kMoreThanEstimated = 3;  // an estimate of the first order is no closer than that

// A loss that could not be estimated, NaN, is one too.
bool is_worth_a_warning(double loss) { return !(loss <= kWorthAWarning); }
std::string loss_text(double loss) {
  return std::isfinite(loss) ? fmt::format("{:.1e}", loss) : "an unknown share";
}

// The gear's forces come of a torque by the arm of its pitch point, a difference of places: it has
// the round-off of the way between the axes, which a small gear's arm does not dwarf.
void add_gear_arm(const PumpParameters& pump, const Assumptions& assumptions,
                  std::map<std::string, double>& groups) {
  if (assumptions.gear == BlockDrive::imposed || pump.transfer.kind != TransferKind::gear) return;
  const double loss = std::numeric_limits<double>::epsilon() *
                      (1 + std::abs(pump.geometry.axis_offset) / (pump.gear.pitch_diameter / 2));
  for (const char* group : {"Rcs", "Rcn", "Fh", "Th", "Rb1", "Rb2", "Td"}) {
    const auto known = groups.find(group);
    if (known != groups.end()) known->second = std::max(known->second, loss);
  }
}

Case at_few_angles(const Case& the_case) {
  Case thin = the_case;
  thin.operation.samples_per_revolution =
      std::min(kAngles, the_case.operation.samples_per_revolution);
  return thin;
}

}  // namespace

std::vector<RoundingLine> rounding_lines(const Case& the_case, const Assumptions& assumptions) {
  const Case thin = at_few_angles(the_case);
  const PressureTrace pressure(thin.pressure);
  const Samples samples = sample_case(thin, pressure);
  const ResultTable table = analytic::run(thin, assumptions, samples);
  const compare::ZeroScales scales = zero_scales(thin, samples);
  std::vector<RoundingLine> lines;
  for (const auto& g : analytic::estimate_rounding(thin, assumptions, samples, pressure, kAngles)) {
    const auto channel = std::find_if(table.channels.begin(), table.channels.end(),
                                      [&](const Channel& c) { return c.group == g.group; });
    const double peak = compare::scale_of(table, *channel, scales);
    if (peak == 0) continue;
    lines.push_back({g.group, g.inputs / peak, g.arithmetic / peak, g.theta_deg, g.input});
  }
  return lines;
}

std::vector<std::string> rounding_warnings(const std::vector<RoundingLine>& lines) {
  std::vector<std::string> warnings;
  for (const RoundingLine& line : lines)
    if (is_worth_a_warning(line.total()))
      warnings.push_back(fmt::format(
          "{} is accurate to {} of its peak only: rounding of {} to double, at {:g} deg",
          line.group, loss_text(line.total()),
          line.arithmetic > line.inputs || line.input.empty() ? "intermediate results" : line.input,
          line.theta_deg));
  return warnings;
}

MultibodyLosses multibody_losses(const Case& the_case, const Assumptions& assumptions,
                                 const multibody::SceneChoice& scene) {
  const Case thin = at_few_angles(the_case);
  const PressureTrace pressure(thin.pressure);
  const Samples samples = sample_case(thin, pressure);
  const auto run = [&](const Case& c) {
    return multibody::run_driven(c, assumptions, samples, {}, scene.scene, scene.method);
  };
  MultibodyLosses losses;
  try {
    compare::Options options;
    options.zero_scales = zero_scales(thin, samples);
    const ResultTable table = run(thin);
    losses.groups = rounding_spread(thin, table, options, run);
    add_gear_arm(thin.pump, assumptions, losses.groups);
  } catch (const NoEstimate& none) {
    losses.no_estimate = none.what();
  } catch (const ComputationError&) {
    // The run itself will say why.
  }
  return losses;
}

std::vector<std::string> multibody_warnings(const Case& the_case,
                                            const multibody::SceneChoice& scene,
                                            const std::vector<RoundingLine>& lines,
                                            const MultibodyLosses& losses) {
  if (!losses.no_estimate.empty()) return {"the multibody model: " + losses.no_estimate};
  std::map<std::string, double> lost = losses.groups;
  for (const RoundingLine& line : lines)
    if (lost[line.group] < kMoreThanEstimated * line.total()) lost.erase(line.group);
  std::vector<std::string> groups;
  for (const auto& [group, loss] : lost)
    if (is_worth_a_warning(loss)) groups.push_back(group + " " + loss_text(loss));
  if (groups.empty()) return {};
  return {fmt::format(
      "the reactions of the multibody model are accurate to these shares of their peaks only: {} "
      "(changes when every input changes by one unit in the last place); {}",
      joined(groups),
      multibody::method_for(the_case.pump, scene.method) == multibody::Method::multipliers
          ? "Simbody's constraint multipliers may be the cause: try --reactions residual"
          : "the analytic model is more accurate here")};
}

std::vector<std::string> multibody_warnings(const Case& the_case, const Assumptions& assumptions,
                                            const multibody::SceneChoice& scene,
                                            const std::vector<RoundingLine>& lines) {
  return multibody_warnings(the_case, scene, lines, multibody_losses(the_case, assumptions, scene));
}

}  // namespace bentaxis::study
