#include "bentaxis/study/motion_answers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::study {
namespace {

std::size_t rows_of(const Trajectory& run) { return run.lag.size(); }
double time_of(const Trajectory& run, std::size_t row) { return run.state(row, StateColumn::time); }

// Mean speed over the N-th of a turn that ends with a row, by the time that it takes; that of the
// row where the shaft has not turned so far.
double mean_speed(const Trajectory& run, std::size_t end, int pistons) {
  const auto turned = [&](std::size_t row) {
    return run.state(end, StateColumn::theta) - run.state(row, StateColumn::theta);
  };
  const double pitch = 360.0 / pistons;
  std::size_t row = end;
  while (row > 0 && std::abs(turned(row)) < pitch) --row;
  if (std::abs(turned(row)) < pitch) return run.state(end, StateColumn::shaft_speed);
  const double part = (std::abs(turned(row)) - pitch) / std::abs(turned(row) - turned(row + 1));
  const double start = time_of(run, row) + part * (time_of(run, row + 1) - time_of(run, row));
  return std::copysign(pitch, turned(row)) / 6 / (time_of(run, end) - start);  // deg/s in rpm
}

// Whether the speed, at the end of its change, has come to it.
bool is_settled(const Trajectory& run, double first, double end, int pistons) {
  const double until = time_of(run, 0) + 0.9 * (time_of(run, rows_of(run) - 1) - time_of(run, 0));
  std::size_t row = rows_of(run) - 1;
  while (row > 0 && time_of(run, row) > until) --row;
  return std::abs(end - mean_speed(run, row, pistons)) <=
         MotionAnswers::kSettled * std::abs(end - first);
}

// From when on the speed has made its change, for good.
std::optional<double> reached(const Trajectory& run, double first, double last) {
  double fastest = 0;
  const auto speed = [&](std::size_t row) { return run.state(row, StateColumn::shaft_speed); };
  for (std::size_t row = 0; row < rows_of(run); ++row)
    fastest = std::max(fastest, std::abs(speed(row)));
  if (!(std::abs(last - first) >= MotionAnswers::kLeastChange * fastest) || last == first)
    return std::nullopt;
  const auto made = [&](std::size_t row) { return (speed(row) - first) / (last - first); };
  std::size_t row = rows_of(run) - 1;
  if (!(made(row) >= MotionAnswers::kReached)) return std::nullopt;
  while (row > 0 && made(row - 1) >= MotionAnswers::kReached) --row;
  if (row == 0) return time_of(run, 0);
  const double part = (MotionAnswers::kReached - made(row - 1)) / (made(row) - made(row - 1));
  return time_of(run, row - 1) + part * (time_of(run, row) - time_of(run, row - 1));
}

std::optional<MotionAnswers::Backwards> backwards(const Trajectory& run, double first,
                                                  double last) {
  if (last == 0 || first * last < 0) return std::nullopt;
  MotionAnswers::Backwards found;
  double fastest = 0;
  for (std::size_t row = 0; row < rows_of(run); ++row) {
    const double speed = run.state(row, StateColumn::shaft_speed);
    fastest = std::max(fastest, std::abs(speed));
    if (speed * last < 0 && std::abs(speed) > std::abs(found.rpm))
      found = {speed, time_of(run, row)};
  }
  if (!(std::abs(found.rpm) > MotionAnswers::kLeastChange * fastest)) return std::nullopt;
  return found;
}

constexpr double kWholeTurn = 360 * (1 - 1e-9);  // deg

std::optional<MotionAnswers::Delivery> delivery_of(const Trajectory& run) {
  if (!run.oil) return std::nullopt;
  const auto& columns = run.oil->columns;
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [](const OilColumn& c) { return c.name == "p_delivery_bar"; });
  if (found == columns.end()) return std::nullopt;
  const auto column = static_cast<std::size_t>(found - columns.begin());
  MotionAnswers::Delivery delivery;
  const std::size_t rows = rows_of(run);
  // A tenth of less than ten turns is part of a ripple, whose mean is another.
  const auto before_end = [&](std::size_t row) {
    return std::abs(run.state(rows - 1, StateColumn::theta) - run.state(row, StateColumn::theta));
  };
  std::size_t from = rows - std::max<std::size_t>(1, rows / 10), turn = rows - 1;
  while (turn > 0 && before_end(turn) < kWholeTurn) --turn;
  if (before_end(turn) >= kWholeTurn && turn < from) {
    from = turn;
    delivery.end_is_turn = true;
  }
  const double time = time_of(run, rows - 1) - time_of(run, from);
  for (std::size_t row = 0; row < rows; ++row) {
    const double pressure = run.oil->value(row, column);
    if (row == 0 || pressure > delivery.highest_bar) {
      delivery.highest_bar = pressure;
      delivery.highest_s = time_of(run, row);
    }
    if (row > from)
      delivery.end_bar += (pressure + run.oil->value(row - 1, column)) / 2 *
                          (time_of(run, row) - time_of(run, row - 1)) / time;
  }
  if (!(time > 0)) delivery.end_bar = run.oil->value(rows - 1, column);
  return delivery;
}

std::optional<MotionAnswers::BeyondPlate> beyond_plate(
    const std::vector<analytic::ValidityLimit>& limits, const Trajectory& run,
    const Case& the_case) {
  for (const analytic::ValidityLimit& limit : limits)
    if (limit.key == "point" && limit.applicable && limit.violated_share > 0)
      return MotionAnswers::BeyondPlate{limit.violated_share, limit.worst, time_of(run, limit.row),
                                        the_case.pump.port_plate->r4 * 1e3};
  return std::nullopt;
}

std::optional<MotionAnswers::Walls> walls_of(const Trajectory& run, const Case& the_case) {
  const ResultTable& results = run.table.results;
  const ChannelLayout at(the_case.pump);
  if (!at.has(Quantity::Rw)) return std::nullopt;
  std::vector<std::array<std::size_t, 2>> columns;
  for (int k = 0; k < at.pistons(); ++k) {
    columns.push_back({results.find(at.channels()[at.Rw(k, 0)].name),
                       results.find(at.channels()[at.Rw(k, 1)].name)});
    if (std::max(columns.back()[0], columns.back()[1]) >= results.columns()) return std::nullopt;
  }
  MotionAnswers::Walls walls;
  const auto [least, largest] = std::minmax_element(run.lag.begin(), run.lag.end());
  walls.lag_deg[0] = *least / kRadPerDegree;
  walls.lag_deg[1] = *largest / kRadPerDegree;
  std::size_t loose = 0;
  for (std::size_t row = 0; row < rows_of(run); ++row) {
    bool pushes = false;
    for (int k = 0; k < at.pistons(); ++k) {
      const auto& [x, y] = columns[static_cast<std::size_t>(k)];
      const double force = std::hypot(results.at(row, x), results.at(row, y));
      pushes = pushes || force > 0;
      if (!(force > walls.largest_N)) continue;
      walls.largest_N = force;
      walls.largest_s = time_of(run, row);
      walls.piston = k + 1;
    }
    if (!pushes) ++loose;
  }
  walls.loose = static_cast<double>(loose) / static_cast<double>(rows_of(run));
  return walls;
}

}  // namespace

MotionAnswers motion_answers(const Trajectory& run, const Case& the_case) {
  MotionAnswers answers;
  if (rows_of(run) == 0) return answers;
  answers.first_rpm = run.state(0, StateColumn::shaft_speed);
  answers.last_rpm = run.state(rows_of(run) - 1, StateColumn::shaft_speed);
  const int pistons = the_case.pump.geometry.pistons;
  answers.end_rpm = mean_speed(run, rows_of(run) - 1, pistons);
  answers.reached_s = reached(run, answers.first_rpm, answers.end_rpm);
  answers.settled = is_settled(run, answers.first_rpm, answers.end_rpm, pistons);
  answers.backwards = backwards(run, answers.first_rpm, answers.last_rpm);
  const ResultTable& results = run.table.results;
  if (const std::size_t torque = results.find("Td_z1_Nm"); torque < results.columns())
    for (std::size_t row = 0; row < rows_of(run); ++row)
      if (const double here = results.at(row, torque);
          is_computed(here) && std::abs(here) > std::abs(answers.largest_torque)) {
        answers.largest_torque = here;
        answers.largest_torque_s = time_of(run, row);
      }
  answers.drive_work = run.record.work_of_drives;
  answers.drive_has_inertia = the_case.drive && the_case.drive->motor;
  answers.delivery = delivery_of(run);
  if (results.rows() > 0)
    answers.limits = analytic::limits_in_time(the_case, the_case.analytic, run);
  answers.beyond_plate = beyond_plate(answers.limits, run, the_case);
  answers.walls = walls_of(run, the_case);
  return answers;
}

}  // namespace bentaxis::study
