#include "turn_statistics.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::designs {
namespace {

bool consecutive(const std::vector<std::size_t>& columns) {
  for (std::size_t i = 1; i < columns.size(); ++i)
    if (columns[i] != columns[i - 1] + 1) return false;
  return !columns.empty();
}

double value_of(Statistic statistic, const analytic::Statistics& s) {
  switch (statistic) {
    case Statistic::mean:
      return s.mean;
    case Statistic::min:
      return s.min;
    case Statistic::max:
      return s.max;
    case Statistic::peak:
      return std::max(std::abs(s.min), std::abs(s.max));
    case Statistic::rms:
      return std::sqrt(s.mean_square);
    case Statistic::range:
      break;
  }
  return s.max - s.min;
}

// The pressures of an ideal trace that goes from 0 to 1 are shares of the way.
PressureSpec shares_of(PressureSpec spec) {
  if (spec.kind == PressureKind::ideal) spec.ports = {0, 1};
  return spec;
}

}  // namespace

bool stays_in_reach(const Family& family) {
  const Case& base = family.base();
  const auto leaves = [](const Variable& v) { return v.parameter().changes_model; };
  return base.pressure.kind != PressureKind::hydraulic &&
         base.pump.gear.contact != ToothContact::teeth && base.pump.transfer.is_even() &&
         std::none_of(family.variables().begin(), family.variables().end(), leaves);
}

std::optional<TurnOutputs> turn_outputs(const std::vector<Output>& outputs, const Case& base) {
  const ChannelLayout layout(base.pump);
  TurnOutputs result;
  for (const Output& o : outputs) {
    TurnOutputs::Place place{.statistic = o.statistic};
    if (o.source == Source::derived) {
      place.of_geometry = true;
      place.measured = result.geometry.size();
      result.geometry.push_back(o);
    } else if (o.source == Source::curve && consecutive(o.columns) &&
               o.columns.back() < layout.reactions()) {
      place.unit_in_si = layout.channels()[o.columns.front()].unit_in_si;
      const analytic::Measured wanted = {o.columns.front(), o.columns.size()};
      const auto found =
          std::find_if(result.measured.begin(), result.measured.end(), [&](const auto& m) {
            return m.reaction == wanted.reaction && m.components == wanted.components;
          });
      place.measured = static_cast<std::size_t>(found - result.measured.begin());
      if (found == result.measured.end()) result.measured.push_back(wanted);
    } else {
      return {};
    }
    result.places.push_back(place);
  }
  return result;
}

double KernelTurn::degrees(std::size_t sample) const {
  return given_deg_.empty()
             ? 360.0 * static_cast<double>(sample) / static_cast<double>(theta_.size())
             : given_deg_[sample];
}

bool KernelTurn::shifted(int pistons) const {
  return given_deg_.empty() && theta_.size() % static_cast<std::size_t>(pistons) == 0;
}

void KernelTurn::set_samples(std::size_t samples, int pistons) {
  if (!given_deg_.empty()) samples = given_deg_.size();
  if (theta_.size() == samples) return;
  made_for_.reset();
  theta_.resize(samples);
  for (std::size_t i = 0; i < samples; ++i) theta_[i] = radians(degrees(i));
  const auto n = static_cast<std::size_t>(pistons);
  const bool together = shifted(pistons);
  pressures_.resize(samples * (together ? 2 : n));
  chambers_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t start = together ? (samples - k * (samples / n)) % samples : k * samples;
    chambers_[k] = {&pressures_[start], 0};
  }
}

void KernelTurn::set_pressure(const PressureSpec& pressure, int pistons) {
  const bool ideal = pressure.kind == PressureKind::ideal;
  const std::size_t samples = theta_.size();
  const bool same_shape = made_for_ && made_for_->transition_deg == pressure.transition_deg &&
                          made_for_->delivery_start_deg == pressure.delivery_start_deg;
  if (!made_for_ || (ideal && !same_shape)) {
    const PressureTrace trace(shares_of(pressure));
    shares_.resize(pressures_.size());
    const bool together = shifted(pistons);
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      const int piston = together ? 1 : 1 + static_cast<int>(i / samples);
      shares_[i] = together && i >= samples
                       ? shares_[i - samples]
                       : trace(piston_angle_deg(degrees(i % samples), piston, pistons));
    }
  } else if (!ideal || (made_for_->ports.suction == pressure.ports.suction &&
                        made_for_->ports.delivery == pressure.ports.delivery)) {
    return;
  }
  for (std::size_t i = 0; i < pressures_.size(); ++i)
    pressures_[i] = ideal ? pressure.ports.suction +
                                (pressure.ports.delivery - pressure.ports.suction) * shares_[i]
                          : shares_[i];
  if (!made_for_) made_for_.emplace();
  made_for_->transition_deg = pressure.transition_deg;
  made_for_->delivery_start_deg = pressure.delivery_start_deg;
  made_for_->ports = pressure.ports;
}

void KernelTurn::become(const Case& the_case, const Assumptions& assumptions) {
  const int pistons = the_case.pump.geometry.pistons;
  if (model_)
    model_->set_pump(the_case.pump, assumptions);
  else
    model_.emplace(the_case.pump, assumptions);
  set_samples(static_cast<std::size_t>(the_case.operation.samples_per_revolution), pistons);
  set_pressure(the_case.pressure, pistons);
  speed_rpm_ = the_case.operation.speed_rpm;
  ports_ = the_case.pressure.ports;
}

analytic::BatchInstants KernelTurn::instants() const {
  return {.count = theta_.size(),
          .theta = {theta_.data(), 0},
          .omega = {nullptr, rad_per_second(speed_rpm_)},
          .omega_dot = {},
          .chamber_pressure = chambers_,
          .suction = {nullptr, ports_.suction},
          .delivery = {nullptr, ports_.delivery}};
}

TurnStatistics::TurnStatistics(const TurnOutputs& outputs)
    : outputs_(outputs), statistics_(outputs.measured.size()) {}

bool TurnStatistics::find(const Case& the_case, std::span<double> results) {
  // The other flanks are refused, in words of the general way.
  if (the_case.analytic.flanks != FlankShape::involute) return false;
  turn_.become(the_case, the_case.analytic);
  const analytic::BatchModel& model = turn_.model();
  model.statistics(turn_.instants(), outputs_.measured, statistics_);
  const bool tooth = the_case.analytic.gear == BlockDrive::mesh;
  std::optional<analytic::DerivedQuantities> derived;  // once for all outputs of a design
  for (std::size_t i = 0; i < results.size(); ++i) {
    const TurnOutputs::Place& place = outputs_.places[i];
    if (place.of_geometry) {
      if (!derived) derived = analytic::derived_quantities(the_case.pump);
      results[i] = derived_value(outputs_.geometry[place.measured], *derived);
      continue;
    }
    const analytic::Statistics& found = statistics_[place.measured];
    const bool absent =
        !tooth && outputs_.measured[place.measured].reaction == model.layout().Rcs();
    if (!absent && !std::isfinite(found.mean_square)) return false;
    results[i] = value_of(place.statistic, found) / place.unit_in_si;
  }
  return true;
}

}  // namespace bentaxis::designs
