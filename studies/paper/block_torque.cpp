#include "bentaxis/study/block_torque.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/fixed_text.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/inertia_study.h"
#include "paper_conditions.h"

namespace bentaxis::study {
namespace {

constexpr double kFittedCoulomb = 25;  // N: gives the paper's two mean torques

double bar_of(const Case& the_case) { return the_case.pressure.ports.delivery / kPascalPerBar; }

// A delivery pressure that falls linearly by so many bar from 200 to 340 deg, `mean` in the middle.
PressureCurve sagging(double bar, double mean) {
  const auto clamped = [](double share) { return std::clamp(share, 0.0, 1.0); };
  PressureCurve curve;
  for (int angle = 0; angle < 360; angle += 2) {
    const double share = clamped(angle < 270 ? (angle - 172) / 16.0 : (368 - angle) / 16.0);
    const double level = mean + bar * (0.5 - clamped((angle - 200) / 140.0));
    curve.theta_deg.push_back(angle);
    curve.pressure.push_back(
        pascals(angle > 170 ? level * share : mean / 2 * std::max(0.0, 1 - angle / 8.0)));
  }
  return curve;
}

// Tcs at theta = 0. The models that assume as the case does see the first sample only.
double torque_at_start(const PreparedCase& ready, Model model, const PartProgress& progress_of) {
  const ResultTable table = run_turn(ready, model, progress_of);
  return table.at(0, table.find("Tcs_z2_Nm"));
}

class Rows {
 public:
  explicit Rows(const PartProgress& progress_of) : progress_of_(progress_of) {}

  double add(const std::string& what, Case the_case) {
    the_case.operation.samples_per_revolution = 36;
    const PreparedCase ready = prepare(std::move(the_case), progress_of_);
    BlockTorque row;
    row.group = group;
    row.what = what;
    row.analytic = torque_at_start(ready, Model::analytic, progress_of_);
    row.multibody = torque_at_start(ready, Model::multibody, progress_of_);
    row.change = row.analytic - (rows.empty() ? row.analytic : rows.front().analytic);
    rows.push_back(row);
    return row.analytic;
  }

  std::vector<BlockTorque> rows;
  int group = 0;

 private:
  const PartProgress& progress_of_;
};

// Refuses cases that the changes of this study mean nothing for.
void require_meaning(const Case& ideal, const Case& hydraulic) {
  const auto refuse = [](const Case& the_case, const std::string& text) {
    throw InputError(the_case.file.string() + ": " + text + " in a study of the block's torque");
  };
  for (const auto& [the_case, kind, word] :
       {std::tuple{&ideal, PressureKind::ideal, "ideal"},
        std::tuple{&hydraulic, PressureKind::hydraulic, "hydraulic"}}) {
    const auto of = [&one = *the_case](const char* table, const char* key) {
      return "[" + std::string(table) + "] " + key + " = " +
             to_text(*value_of(parameter_of(standard_registry(), table, key), one));
    };
    if (the_case->pressure.kind != kind)
      refuse(*the_case, of("pressure", "kind") + ": must be \"" + word + "\"");
    require_even_transfer(*the_case, "a study of the block's torque");
    if (the_case->operation.speed_rpm == 0)
      refuse(*the_case, of("operation", "speed_rpm") + ": must not be 0");
    if (the_case->pump.geometry.tilt == 0)
      refuse(*the_case, of("pump", "tilt_deg") + ": must not be 0");
  }
}

}  // namespace

std::vector<BlockTorque> block_torques(const Case& ideal, const Case& hydraulic,
                                       const PartProgress& progress_of) {
  require_meaning(ideal, hydraulic);
  const bool has_gap = off_rated_condition(ideal).empty();
  Rows rows(progress_of);
  const auto with_coulomb = [](Case the_case, double force) {
    the_case.pump.friction.piston_coulomb = force;
    return the_case;
  };
  const Case still = with_coulomb(ideal, 0);
  const double without = rows.add(
      fmt::format("no piston friction, ideal trace of {:g} deg", ideal.pressure.transition_deg),
      still);
  const double one = rows.add("piston friction 25 N, calibrated for the shipped case",
                              with_coulomb(ideal, kFittedCoulomb));
  rows.add("piston friction 250 N", with_coulomb(ideal, 250));
  if (has_gap) {
    const double needed = std::round(1e3 * kFittedCoulomb *
                                     (kPaperBlockTorque - kAdamsBlockTorque) / (one - without)) /
                          1e3;
    rows.add(fmt::format("piston friction {:.0f} N, which would fill the gap", needed),
             with_coulomb(ideal, needed));
  }

  rows.group = 1;
  Case changed = still;
  for (const double width : {0.0, 40.0, 80.0}) {
    changed.pressure.transition_deg = width;
    rows.add(fmt::format("no friction, transition of {:g} deg", width), changed);
  }
  changed = still;
  for (const double shift : {-10.0, 10.0}) {
    changed.pressure.delivery_start_deg = still.pressure.delivery_start_deg + shift;
    rows.add(fmt::format("no friction, pressure rises and falls at {:g} and {:g} deg",
                         wrap_degrees(changed.pressure.delivery_start_deg),
                         wrap_degrees(changed.pressure.delivery_start_deg + 180)),
             changed);
  }
  changed = still;
  for (const double more : {5.0, 105.0}) {
    const double level = bar_of(still) + more;
    changed.pressure.ports.delivery = pascals(level);
    rows.add(fmt::format("no friction, delivery at {:g} bar", level), changed);
  }
  changed = still;
  changed.pressure.kind = PressureKind::curve;
  for (const double bar : {10.0, -10.0, 92.0}) {
    changed.pressure.curve = sagging(bar, bar_of(still));
    rows.add(fmt::format("no friction, delivery {} by {:g} bar from 200 to 340 deg",
                         bar > 0 ? "falling" : "rising", std::abs(bar)),
             changed);
  }
  rows.add("no friction, hydraulic model", with_coulomb(hydraulic, 0));
  rows.add(fmt::format("piston friction {:.3g} N as in the case, hydraulic model",
                       hydraulic.pump.friction.piston_coulomb),
           hydraulic);

  rows.group = 2;
  changed = still;
  double& offset = changed.pump.geometry.axis_offset;
  offset += metres(0.1);
  rows.add(fmt::format("no friction, axis offset b {:g} instead of {:g} mm", 1e3 * offset,
                       1e3 * still.pump.geometry.axis_offset),
           changed);
  changed = still;
  changed.pump.piston.mass *= 2;
  rows.add(fmt::format("no friction, piston mass {:g} instead of {:g} kg", changed.pump.piston.mass,
                       still.pump.piston.mass),
           changed);
  for (BlockTorque& row : rows.rows) row.has_gap = has_gap;
  return std::move(rows.rows);
}

std::string block_torque_text(const std::vector<BlockTorque>& rows) {
  const bool has_gap = !rows.empty() && rows.front().has_gap;
  std::string text =
      "Torque from shaft to block at theta = 0, in Nm. Change: of the analytic model, against the "
      "first row.\n" +
      (has_gap
           ? fmt::format("Gap: {:.2f} Nm by the paper's model less {:.2f} Nm by its ADAMS model, "
                         "{:.2f} Nm.\n",
                         kPaperBlockTorque, kAdamsBlockTorque,
                         kPaperBlockTorque - kAdamsBlockTorque)
           : std::string("The gap of the paper does not apply: it is of the paper's pump at 275 "
                         "bar and 1500 rpm.\n")) +
      fmt::format("\n{:<62}{:>10}{:>11}{:>9}{:>12}\n", "pump and pressure", "analytic", "multibody",
                  "change", has_gap ? "of the gap" : "");
  int group = 0;
  for (const BlockTorque& row : rows) {
    if (row.group != group) text += "\n";
    group = row.group;
    text += fmt::format("{:<62}{:>10}{:>11}{:>9}{:>12}\n", row.what, fixed_text(row.analytic, 4),
                        fixed_text(row.multibody, 4), fixed_text(row.change, 3),
                        has_gap ? fixed_text(100 * row.share(), 1) + " %" : "");
  }
  return text;
}

}  // namespace bentaxis::study
