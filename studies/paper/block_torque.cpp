#include "bentaxis/study/block_torque.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/fixed_text.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study {
namespace {

// Of the ideal trace that sags: its mean level, where it rises and falls, and where it sags.
constexpr double kLevelBar = 275;
constexpr double kFittedCoulomb = 25;  // N: gives the paper's two mean torques

// A delivery pressure that falls linearly by so many bar from 200 to 340 deg, 275 in the middle.
PressureCurve sagging(double bar) {
  const auto clamped = [](double share) { return std::clamp(share, 0.0, 1.0); };
  PressureCurve curve;
  for (int angle = 0; angle < 360; angle += 2) {
    const double share = clamped(angle < 270 ? (angle - 172) / 16.0 : (368 - angle) / 16.0);
    const double level = kLevelBar + bar * (0.5 - clamped((angle - 200) / 140.0));
    curve.theta_deg.push_back(angle);
    curve.pressure.push_back(
        pascals(angle > 170 ? level * share : kLevelBar / 2 * std::max(0.0, 1 - angle / 8.0)));
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

}  // namespace

std::vector<BlockTorque> block_torques(const Case& ideal, const Case& hydraulic,
                                       const PartProgress& progress_of) {
  Rows rows(progress_of);
  const auto with_coulomb = [](Case the_case, double force) {
    the_case.pump.friction.piston_coulomb = force;
    return the_case;
  };
  const Case still = with_coulomb(ideal, 0);
  const double without = rows.add("no piston friction, ideal trace of 20 deg", still);
  const double one = rows.add("piston friction 25 N, calibrated for the shipped case",
                              with_coulomb(ideal, kFittedCoulomb));
  rows.add("piston friction 250 N", with_coulomb(ideal, 250));
  const double needed =
      std::round(1e3 * kFittedCoulomb * (kPaperBlockTorque - kAdamsBlockTorque) / (one - without)) /
      1e3;
  rows.add(fmt::format("piston friction {:.0f} N, which would fill the gap", needed),
           with_coulomb(ideal, needed));

  rows.group = 1;
  Case changed = still;
  for (const double width : {0.0, 40.0, 80.0}) {
    changed.pressure.transition_deg = width;
    rows.add(fmt::format("no friction, transition of {:g} deg", width), changed);
  }
  changed = still;
  for (const double start : {170.0, 190.0}) {
    changed.pressure.delivery_start_deg = start;
    rows.add(fmt::format("no friction, pressure rises and falls at {:g} and {:g} deg", start,
                         start + 180),
             changed);
  }
  changed = still;
  for (const double level : {280.0, 380.0}) {
    changed.pressure.ports.delivery = pascals(level);
    rows.add(fmt::format("no friction, delivery at {:g} bar", level), changed);
  }
  changed = still;
  changed.pressure.kind = PressureKind::curve;
  for (const double bar : {10.0, -10.0, 92.0}) {
    changed.pressure.curve = sagging(bar);
    rows.add(fmt::format("no friction, delivery falling by {:g} bar over 200..340 deg", bar),
             changed);
  }
  rows.add("no friction, hydraulic model", with_coulomb(hydraulic, 0));
  rows.add("calibrated friction of 25.2 N, hydraulic model", hydraulic);

  rows.group = 2;
  changed = still;
  changed.pump.geometry.axis_offset = metres(0.2);
  rows.add("no friction, axis offset b 0.2 instead of 0.1 mm", changed);
  changed = still;
  changed.pump.piston.mass = 0.18;
  rows.add("no friction, piston mass 0.18 instead of 0.09 kg", changed);
  return std::move(rows.rows);
}

std::string block_torque_text(const std::vector<BlockTorque>& rows) {
  std::string text = fmt::format(
      "torque from shaft to block at theta = 0, Nm; paper's model minus ADAMS: "
      "{:.2f}\n\n{:<62}{:>10}{:>11}{:>9}{:>9}\n",
      kPaperBlockTorque - kAdamsBlockTorque, "pump and pressure", "analytic", "multibody", "change",
      "of gap");
  int group = 0;
  for (const BlockTorque& row : rows) {
    if (row.group != group) text += "\n";
    group = row.group;
    text += fmt::format("{:<62}{:>10}{:>11}{:>9}{:>7}%\n", row.what, fixed_text(row.analytic, 4),
                        fixed_text(row.multibody, 4), fixed_text(row.change, 3),
                        fixed_text(100 * row.share(), 1));
  }
  return text;
}

}  // namespace bentaxis::study
