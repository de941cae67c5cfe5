// One turn of a case, evaluated angle by angle.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/results/stopwatch.h"

namespace bentaxis::multibody {

namespace {

// Row of the samples at which piston 1 stands where piston k + 1 stands in `row`.
std::size_t row_of_piston_one(std::size_t row, int k, std::size_t rows, int pistons) {
  return (row + rows - rows / pistons * k) % rows;
}

// Pressures that differ by less than this share of the largest are equal but for the rounding of
// the angle they were evaluated at.
constexpr double kSamePressure = 1e-13;

// An angle this near to one of an even division of the turn, degrees, is that one: the tolerance
// within which an angle counts as on an edge of the pressure.
constexpr double kSameAngle = 1e-9;

// Does every piston see, at each of its angles, the pressure that piston 1 sees there? Then piston
// 1 stands for all.
bool one_stands_for_all(const Samples& samples) {
  const std::size_t rows = samples.theta_deg.size();
  const int n = samples.pistons;
  if (rows == 0 || rows % n != 0) return false;
  double largest = 0;
  for (const double pressure : samples.chamber_pressure)
    largest = std::max(largest, std::abs(pressure));
  for (std::size_t row = 0; row < rows; ++row) {
    const double angle = 360.0 * static_cast<double>(row) / static_cast<double>(rows);
    if (std::abs(samples.theta_deg[row] - angle) > kSameAngle) return false;
    for (int k = 1; k < n; ++k)
      if (std::abs(samples.chamber_pressure[row * n + k] -
                   samples.chamber_pressure[row_of_piston_one(row, k, rows, n) * n]) >
          kSamePressure * largest)
        return false;
  }
  return true;
}

std::string rows_by_rule_text(const std::array<long, kLagRules>& rows) {
  static const char* const names[] = {"in the middle of the free play, without load",
                                      "pushed to the driving side", "pushed to the trailing side",
                                      "in balance within the free play"};
  std::string text;
  for (std::size_t rule = 0; rule < kLagRules; ++rule)
    if (rows[rule] > 0)
      text += (text.empty() ? "" : ", ") + std::to_string(rows[rule]) + " rows " + names[rule];
  return text;
}

}  // namespace

ResultTable run_driven(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                       const Progress& progress, Scene scene, std::optional<Method> method,
                       ResultTable* budget, ResultTable* teeth, BodyLoadTable* loads) {
  validate(the_case);
  if (samples.pistons != the_case.pump.geometry.pistons)
    throw InputError("driven run: samples of " + std::to_string(samples.pistons) +
                     " pistons for a pump with " + std::to_string(the_case.pump.geometry.pistons));
  const Stopwatch stopwatch;
  Model model(the_case.pump, assumptions, samples.omega, scene, method);
  // With a universal joint each piston has a trajectory of its own.
  const TransferKind transfer = the_case.pump.transfer.kind;
  const bool shared =
      scene == Scene::piston && the_case.pump.transfer.is_even() && one_stands_for_all(samples);
  // Where the block is not locked to the shaft, chambers are at the pressures of its own angle.
  std::optional<PressureTrace> pressure;
  if (!the_case.pump.transfer.is_even()) pressure.emplace(the_case.pressure);
  std::array<long, kLagRules> rows_by_rule = {};
  Instant moved;
  std::vector<std::vector<double>> of_one;
  if (shared) {
    Instant instant;
    for (std::size_t row = 0; row < samples.theta_deg.size(); ++row) {
      samples.instant(row, instant);
      of_one.emplace_back(model.layout().size(), not_computed());
      model.evaluate_one(instant, of_one.back());
    }
  }
  std::size_t next = 0;
  if (loads != nullptr) *loads = BodyLoadTable::of(samples.theta_deg.size());
  if (budget != nullptr) {
    *budget = budget_table("multibody", has_ring_off_b(the_case.pump), model.has_teeth());
    budget->reserve_rows(samples.theta_deg.size());
  }
  if (teeth != nullptr) {
    *teeth = teeth_table("multibody");
    if (!model.has_teeth()) teeth = nullptr;
  }
  const ChannelLayout& at = model.layout();
  const auto evaluate = [&](const Instant& instant, std::vector<double>& row) {
    if (!shared) {
      const double angle = samples.theta_deg[next++];
      if (transfer == TransferKind::pistons) {
        const LagRule rule =
            model.evaluate_at_frozen_lag(angle, samples.omega, *pressure, samples.ports, row);
        ++rows_by_rule[static_cast<std::size_t>(rule)];
      } else if (the_case.pump.transfer.is_uneven_joint()) {
        moved = instant;
        const double lead = model.block_beside(instant.shaft).angle - instant.shaft.angle;
        for (int k = 1; k <= at.pistons(); ++k)
          moved.chamber_pressure[k - 1] =
              (*pressure)(piston_angle_deg(angle + lead / kRadPerDegree, k, at.pistons()));
        model.evaluate(moved, row);
      } else {
        model.evaluate(instant, row);
      }
      if (budget != nullptr) append_budget(*budget, angle, model.budget());
      if (teeth != nullptr) append_teeth(*teeth, angle, the_case.pump.gear, model.teeth());
      if (loads != nullptr) loads->append(model.body_loads());
      return;
    }
    for (int k = 0; k < at.pistons(); ++k) {
      const auto& one = of_one[row_of_piston_one(next, k, samples.theta_deg.size(), at.pistons())];
      for (int axis = 0; axis < 3; ++axis) row[at.Rs(k, axis)] = one[at.Rs(0, axis)];
      for (int axis = 0; axis < 2; ++axis) row[at.Rc(k, axis)] = one[at.Rc(0, axis)];
      for (int axis = 0; axis < 3; ++axis) row[at.Rs3(k, axis)] = one[at.Rs3(0, axis)];
      row[at.pressure(k)] = instant.chamber_pressure[k];
      row[at.zB(k)] = one[at.zB(0)];
      row[at.Tc(k)] = one[at.Tc(0)];
      row[at.axis_moment(k)] = one[at.axis_moment(0)];
    }
    ++next;
  };
  ResultTable table = tabulate("multibody", at, samples, evaluate, progress);
  table.provenance = model.provenance();
  if (transfer == TransferKind::pistons)
    table.provenance.facts.emplace_back("lag", rows_by_rule_text(rows_by_rule));
  if (scene == Scene::piston)
    table.provenance.facts.emplace_back(
        "pistons", shared ? "one piston represents all" : "evaluated one by one");
  table.provenance.seconds = stopwatch.seconds();
  return table;
}

}  // namespace bentaxis::multibody
