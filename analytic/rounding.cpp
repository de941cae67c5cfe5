#include "bentaxis/analytic/rounding.h"

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>

#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/inputs.h"
#include "bentaxis/pump/units.h"

#if defined(__GNUC__) && !defined(__clang__) && !defined(__ROUNDING_MATH__)
#error "this file and the closed form need -frounding-math: see analytic/CMakeLists.txt"
#endif

namespace bentaxis::analytic {
namespace {

// What an input may be off by, relative: half a unit in the last place for the number of the case
// file and again for its conversion to SI.
constexpr double kInputRounding = std::numeric_limits<double>::epsilon();
// Relative change by which effects are measured: large against round-off, and small enough for
// amplifications of up to 1e11 to be linear.
constexpr double kChange = 0x1p-40;

constexpr std::array<int, 3> kModes = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

class RoundingMode {
 public:
  explicit RoundingMode(int mode) : before_(std::fegetround()) { std::fesetround(mode); }
  RoundingMode(const RoundingMode&) = delete;
  RoundingMode& operator=(const RoundingMode&) = delete;
  ~RoundingMode() { std::fesetround(before_); }

 private:
  int before_;
};

}  // namespace

RoundingEstimate::RoundingEstimate(const PumpParameters& pump, const Assumptions& assumptions)
    : pump_(pump), model_(pump, assumptions) {
  PumpParameters changed = pump;
  for (const PumpInput& input : continuous_inputs(changed)) {
    const double before = *input.value;
    if (before == 0) continue;
    *input.value = before * (1 + kChange);
    const double change = *input.value - before;
    perturbed_.push_back({input.name, Model(changed, assumptions, Model::Unchecked{}),
                          kInputRounding * std::abs(before) / std::abs(change)});
    *input.value = before;
  }
  for (const int mode : kModes) {
    const RoundingMode scope(mode);
    directed_.push_back(Model(pump, assumptions, Model::Unchecked{}));
  }
}

void RoundingEstimate::estimate(const Instant& instant,
                                const std::vector<double>& pressure_rounding, Parts& parts,
                                const PressureTrace* trace) const {
  const std::size_t count = layout().size();
  std::vector<double> base(layout().size());
  std::vector<double> other(layout().size());
  std::vector<double> largest(count, 0.0);
  parts.inputs.assign(count, 0.0);
  parts.arithmetic.assign(count, 0.0);
  parts.worst_input.assign(count, "");
  Instant placed;
  const auto evaluate = [&](const Model& model, const Instant& at, std::vector<double>& values) {
    if (trace == nullptr) return model.reactions(at, values);
    placed = at;
    model.place_at_constant_speed(placed, *trace);
    model.reactions(placed, values);
  };
  // The torque from outside is what the lag makes 0.
  const auto is_estimated = [&](std::size_t c) {
    return layout().channels()[c].kind == ChannelKind::reaction &&
           !(layout().has(Quantity::Tb) && c == layout().Tb());
  };
  evaluate(model_, instant, base);

  const auto add = [&](const std::string& name, double factor) {
    for (std::size_t c = 0; c < count; ++c) {
      if (!is_estimated(c)) continue;
      const double effect = std::abs(other[c] - base[c]) * factor;
      if (!(effect > 0)) continue;  // not computed, or no effect
      parts.inputs[c] += effect;
      if (effect > largest[c]) {
        largest[c] = effect;
        parts.worst_input[c] = name;
      }
    }
  };
  for (const Perturbed& p : perturbed_) {
    evaluate(p.model, instant, other);
    add(p.input, p.per_change);
  }
  Instant changed = instant;
  const bool locked = instant.locked();
  const auto vary = [&](const std::string& name, double& value, double rounding, double step = 0) {
    if (rounding == 0) return;
    const double before = value;
    if (step == 0) step = std::max(std::abs(before), rounding / kInputRounding) * kChange;
    value = before + step;
    if (locked) changed.block = changed.shaft;
    evaluate(model_, changed, other);
    add(name, rounding / (value - before));
    value = before;
    if (locked) changed.block = changed.shaft;
  };
  // The angle of a piston is the shaft's and its phase. The step leaves a piston at a dead centre
  // at rest in the sign law of friction (kRestShare).
  vary("theta", changed.shaft.angle,
       kInputRounding * std::max(std::abs(instant.shaft.angle), 2 * kPi), 0x1p-41);
  vary("speed", changed.shaft.speed, kInputRounding * std::abs(instant.shaft.speed));
  if (!locked && trace == nullptr) {
    vary("psi", changed.block.angle,
         kInputRounding * std::max(std::abs(instant.block.angle), 2 * kPi), 0x1p-41);
    vary("block speed", changed.block.speed, kInputRounding * std::abs(instant.block.speed));
    vary("acceleration", changed.shaft.acceleration,
         kInputRounding * std::abs(instant.shaft.acceleration));
    vary("block acceleration", changed.block.acceleration,
         kInputRounding * std::abs(instant.block.acceleration));
  }
  vary("ports.delivery", changed.ports.delivery, kInputRounding * std::abs(instant.ports.delivery));
  vary("ports.suction", changed.ports.suction, kInputRounding * std::abs(instant.ports.suction));
  // Pressures that follow the lag are those of the trace.
  for (std::size_t k = 0; k < pressure_rounding.size() && trace == nullptr; ++k)
    vary("pressure", changed.chamber_pressure[k], pressure_rounding[k]);

  for (std::size_t m = 0; m < kModes.size(); ++m) {
    {
      const RoundingMode scope(kModes[m]);
      evaluate(directed_[m], instant, other);
    }
    for (std::size_t c = 0; c < count; ++c) {
      if (!is_estimated(c)) continue;
      const double change = std::abs(other[c] - base[c]);
      if (change > parts.arithmetic[c]) parts.arithmetic[c] = change;
    }
  }
}

namespace {

// @param computed  by the hydraulic model: the curve closes at 0 deg as well as the search for the
//                  periodic state ended; that jump is no rounding
double pressure_rounding(const PressureTrace& trace, double theta_k_deg, bool computed) {
  const double step = kInputRounding * 360;
  const double at = wrap_degrees(theta_k_deg), here = trace(at);
  const auto change = [&](double there) {
    return computed && (there < 0 || there >= 360) ? 0.0 : std::abs(trace(there) - here);
  };
  return kInputRounding * std::abs(here) + std::max(change(at + step), change(at - step));
}

}  // namespace

double pressure_rounding(const PressureTrace& trace, double theta_k_deg) {
  return pressure_rounding(trace, theta_k_deg, false);
}

std::vector<GroupRounding> estimate_rounding(const Case& the_case, const Assumptions& assumptions,
                                             const Samples& samples, const PressureTrace& trace,
                                             std::size_t most_angles) {
  const RoundingEstimate estimate(the_case.pump, assumptions);
  const bool computed =
      the_case.pressure.kind == PressureKind::hydraulic && the_case.pressure.points == 0;
  const Model model(the_case.pump, assumptions);
  PlacedSamples placed(model, the_case);
  const ChannelLayout& layout = estimate.layout();
  std::vector<GroupRounding> groups;
  Instant instant;
  RoundingEstimate::Parts parts;
  std::vector<double> pressure(samples.pistons);
  const std::size_t rows = samples.theta_deg.size();
  const std::size_t stride = std::max<std::size_t>(1, (rows + most_angles - 1) / most_angles);
  for (std::size_t row = 0; row < rows; row += stride) {
    samples.instant(row, instant);
    for (int k = 1; k <= samples.pistons; ++k)
      pressure[k - 1] = pressure_rounding(
          trace, piston_angle_deg(samples.theta_deg[row], k, samples.pistons), computed);
    // Where pistons carry the block their lag is a root, found anew under every change.
    if (the_case.pump.transfer.kind == TransferKind::pistons)
      estimate.estimate(instant, pressure, parts, &trace);
    else
      estimate.estimate(placed.at(instant), pressure, parts);
    for (std::size_t c = 0; c < layout.size(); ++c) {
      if (parts.inputs[c] + parts.arithmetic[c] == 0 && c >= layout.reactions()) continue;
      const std::string& name = layout.channels()[c].group;
      auto group = std::find_if(groups.begin(), groups.end(),
                                [&](const GroupRounding& g) { return g.group == name; });
      if (group == groups.end())
        group = groups.insert(groups.end(), GroupRounding{name, 0, 0, 0, ""});
      if (parts.inputs[c] + parts.arithmetic[c] > group->total()) {
        group->theta_deg = samples.theta_deg[row];
        group->input = parts.worst_input[c];
        group->inputs = parts.inputs[c];
        group->arithmetic = parts.arithmetic[c];
      }
    }
  }
  return groups;
}

}  // namespace bentaxis::analytic
