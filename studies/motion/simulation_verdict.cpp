#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "simulation_study.h"

namespace bentaxis::study {
namespace {

// The check that is furthest beyond its tolerance; "" where all hold.
std::string failed_check_text(const SimulationResult& r) {
  const compare::Check* const check = compare::failed_check(r.checks);
  if (check == nullptr) return "";
  return fmt::format("A check fails: {}: {} is {:.1e} of its scale, {:g} allowed", check->table,
                     check->name, check->relative(), check->tolerance);
}

// Rows in which the pressure jumps; "" where there are none.
std::string between_steps(const SimulationResult& r) {
  if (r.rows_at_steps == 0) return "";
  return fmt::format(
      ". Not compared: {} of {} rows, at which the models stand on different sides of a step of "
      "the pressure",
      r.rows_at_steps, r.analytic->lag.size());
}

std::string periodic_headline(const SimulationResult& r) {
  const auto of = [&](Model model) -> const std::optional<PeriodicMotion>& {
    return r.periodic[static_cast<int>(model)];
  };
  const PeriodicMotion& motion = of(Model::analytic) ? *of(Model::analytic) : *of(Model::multibody);
  const std::string about =
      fmt::format("{:.6g} rpm, {}", motion.speed / kRadPerSecondPerRpm,
                  motion.multipliers.empty()
                      ? "without states that could be disturbed"
                      : fmt::format("{}: a disturbance is multiplied by {:.3g} per N-th of a turn",
                                    motion.stable() ? "stable" : "unstable",
                                    std::abs(motion.multipliers.front())));
  if (r.choice.only)
    return fmt::format("periodic motion of the {} model found: {}", to_string(*r.choice.only),
                       about);
  const GroupDifference& w = *r.worst();
  if (w.of_allowed <= 1 && !r.agrees()) return failed_check_text(r) + "; " + about;
  return fmt::format(
      "{}: largest difference {:.1e} of peak ({}), {:g} allowed; {}{}",
      r.agrees() ? "Both models find the same periodic motion" : "The periodic motions differ",
      w.in_time, w.group, r.choice.error, about, between_steps(r));
}

}  // namespace

bool PeriodicMotion::stable() const {
  return multipliers.empty() || std::abs(multipliers.front()) < 1;
}

const GroupDifference* SimulationResult::worst() const {
  return groups.empty() ? nullptr : &groups.front();
}

const GroupDifference* SimulationResult::largest() const {
  const GroupDifference* largest = nullptr;
  for (const GroupDifference& group : groups)
    if (group.judged && (largest == nullptr || group.in_time > largest->in_time)) largest = &group;
  return largest;
}

double SimulationResult::seconds_for(Model model, double error) const {
  // The slowest that is not good enough, the fastest that is.
  const Effort* poor = nullptr;
  const Effort* good = nullptr;
  for (const Effort& e : effort) {
    if (e.model != model || !(e.error > 0)) continue;
    if (e.error <= error && (good == nullptr || e.seconds < good->seconds)) good = &e;
    if (e.error > error && (poor == nullptr || e.error < poor->error)) poor = &e;
  }
  if (good == nullptr) return not_computed();
  if (poor == nullptr || poor->seconds >= good->seconds) return good->seconds;
  const double share = std::log(poor->error / error) / std::log(poor->error / good->error);
  return poor->seconds * std::pow(good->seconds / poor->seconds, share);
}

bool SimulationResult::agrees() const {
  const bool hold = std::all_of(checks.begin(), checks.end(),
                                [](const compare::Check& check) { return check.holds(); });
  if (choice.only) return hold;
  return hold && worst() != nullptr && worst()->of_allowed <= 1;
}

std::string SimulationResult::headline() const {
  if (!choice.only && worst() != nullptr && !is_computed(worst()->in_time))
    return fmt::format(
        "The models cannot be compared: at {:.4g} s a value of {} is missing or not "
        "finite",
        worst()->time_s, worst()->group);
  if (choice.steady && (choice.only || worst() != nullptr)) return periodic_headline(*this);
  if (choice.only)
    return fmt::format("{} s simulated by the {} model; work and power {}",
                       number_text(ready.the_case.drive->duration), to_string(*choice.only),
                       agrees() ? "balance" : "do not balance. " + failed_check_text(*this));
  if (worst() == nullptr && rows_at_steps > 0)
    return "The models cannot be compared" + between_steps(*this);
  if (worst() == nullptr)
    return "The models cannot be compared: a disturbance of the size of the wanted error changes "
           "the motion completely from the start";
  const GroupDifference& w = *worst();
  const GroupDifference& l = *largest();
  const std::string tolerance =
      fmt::format("{:g} of peak times the measured amplification of disturbances", choice.error);
  // Disturbances grow: the largest difference need not be that which exceeds its tolerance most.
  const bool one = &w == &l && w.time_s == w.allowed_s;
  const std::string of_tolerance =
      one ? fmt::format("{:.2g} of the tolerance ({})", w.of_allowed, tolerance)
          : fmt::format("at most {:.2g} of the tolerance ({}, at {:.4g} s; {})", w.of_allowed,
                        w.group, w.allowed_s, tolerance);
  const std::string sensitive =
      judged_until_s < (1 - kOneTime) * ready.the_case.drive->duration
          ? fmt::format(
                ". Results after {:.4g} s are not compared: disturbances are amplified {:.0e} "
                "times by the end",
                judged_until_s, growth.back())
          : fmt::format("; disturbances of the initial state are amplified {:.3g} times",
                        growth.back());
  const bool check_fails = w.of_allowed <= 1 && !agrees();
  std::string text =
      fmt::format("{}: largest difference {:.1e} of peak ({}, at {:.4g} s), {}{}{}",
                  check_fails ? failed_check_text(*this) + ". The motions agree"
                  : agrees()  ? "The trajectories agree"
                              : "The models differ",
                  l.in_time, l.group, l.time_s, of_tolerance, sensitive, between_steps(*this));
  if (!agrees() && !check_fails && compare::failed_check(checks) != nullptr)
    text += ". " + failed_check_text(*this);
  return text;
}

}  // namespace bentaxis::study
