// A shipped case as mechanics and oil in time, ready to be stepped.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/coupled/system_state.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/pressure.h"
#include "support.h"

namespace bentaxis::test {

inline Case shipped_case(const std::string& name) {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / (name + ".toml"));
}

/// A drive that turns the shaft at the speed of [operation].
inline DriveSpec steady_speed(double duration, int samples) {
  DriveSpec drive;
  drive.duration = duration;
  drive.samples = samples;
  return drive;
}

/// Mechanics of the analytic model and oil, which begin as a simulation of the case does: in the
/// periodic state where `running`, at rest elsewhere.
class PumpInTime {
 public:
  explicit PumpInTime(Case read, bool running = true)
      : the_case(std::move(read)), pressure_(pressure_of(the_case)) {
    mechanics = analytic::mechanics(the_case, the_case.analytic);
    if (the_case.pressure.kind != PressureKind::hydraulic) {
      oil = coupled::prescribed_oil(the_case.pump.geometry.pistons, pressure_,
                                    the_case.pressure.ports);
      return;
    }
    const hydraulics::SteadyState state = hydraulics::steady_state(the_case);
    start_ = running ? hydraulics::running(state) : hydraulics::at_rest(state);
    oil = hydraulics::oil_in_time(the_case, start_);
  }
  /// Another one of a case whose oil begins where that of this one does.
  PumpInTime(Case read, const PumpInTime& other)
      : the_case(std::move(read)), pressure_(pressure_of(the_case)), start_(other.start_) {
    mechanics = analytic::mechanics(the_case, the_case.analytic);
    oil = the_case.pressure.kind == PressureKind::hydraulic
              ? hydraulics::oil_in_time(the_case, start_)
              : coupled::prescribed_oil(the_case.pump.geometry.pistons, pressure_,
                                        the_case.pressure.ports);
  }
  PumpInTime(const PumpInTime&) = delete;
  PumpInTime& operator=(const PumpInTime&) = delete;

  coupled::SystemState start() const { return {mechanics->start(), oil->start()}; }
  Trajectory simulate(const coupled::Options& options = {}) {
    return coupled::simulate("analytic", *mechanics, *oil, *the_case.drive, options);
  }
  /// A row of results there: trajectory columns, reactions, columns of the oil.
  std::vector<double> row(double time, const coupled::SystemState& s) {
    OilLoads loads;
    oil->loads(time, mechanics->block(time, s.motion), s.oil.data(), loads);
    std::vector<double> values, results(mechanics->layout().size());
    MotionChecks checks{};
    MotionTable table = trajectory_table("analytic", mechanics->layout(), *the_case.drive);
    mechanics->row(time, s.motion, loads, values, results, checks);
    append_trajectory_row(table, values, results, checks);
    values = table.states;
    values.insert(values.end(), table.results.values.begin(), table.results.values.end());
    std::vector<double> of_oil(oil->columns().size());
    if (!of_oil.empty())
      oil->row(time, mechanics->shaft(time, s.motion), mechanics->block(time, s.motion),
               s.oil.data(), of_oil.data());
    values.insert(values.end(), of_oil.begin(), of_oil.end());
    return values;
  }

  Case the_case;
  std::unique_ptr<Mechanics> mechanics;
  std::unique_ptr<Oil> oil;

 private:
  static PressureTrace pressure_of(const Case& c) {
    return PressureTrace(c.pressure.kind == PressureKind::hydraulic ? PressureSpec{} : c.pressure);
  }
  PressureTrace pressure_;
  hydraulics::OilStart start_;
};

/// A row of a trajectory as PumpInTime::row() has it.
inline std::vector<double> row_of(const Trajectory& run, std::size_t row) {
  std::vector<double> values;
  for (std::size_t c = 0; c < run.table.state_names.size(); ++c)
    values.push_back(run.table.state(row, c));
  for (std::size_t c = 0; c < run.table.results.columns(); ++c)
    values.push_back(run.table.results.at(row, c));
  for (std::size_t c = 0; run.oil && c < run.oil->columns.size(); ++c)
    values.push_back(run.oil->value(row, c));
  return values;
}

/// Rows as a table: how far two of them are apart, of each column's largest magnitude.
class Rows {
 public:
  void add(const std::vector<double>& row) { rows_.push_back(row); }
  std::size_t size() const { return rows_.size(); }
  const std::vector<double>& operator[](std::size_t i) const { return rows_[i]; }

  double apart(const Rows& other) const {
    if (rows_.size() != other.rows_.size()) return HUGE_VAL;
    double worst = 0;
    for (std::size_t c = 0; c < rows_.front().size(); ++c) {
      double peak = 0, difference = 0;
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const double a = rows_[r][c], b = other.rows_[r][c];
        if (std::isnan(a) != std::isnan(b)) return HUGE_VAL;
        if (std::isnan(a)) continue;
        peak = std::max(peak, std::abs(a));
        difference = std::max(difference, std::abs(a - b));
      }
      // What vanishes but for round-off has no peak.
      if (peak > kNothing) worst = std::max(worst, difference / peak);
    }
    return worst;
  }

 private:
  static constexpr double kNothing = 1e-4;
  std::vector<std::vector<double>> rows_;
};

inline Rows rows_of(const Trajectory& run) {
  Rows rows;
  for (std::size_t row = 0; row < run.lag.size(); ++row) rows.add(row_of(run, row));
  return rows;
}

}  // namespace bentaxis::test
