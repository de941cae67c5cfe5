// How far is the frozen lag of a block that pistons carry from the lag of its motion? Simulates a
// case at constant speed until the block has settled, and compares its last turn with the frozen
// lag. Prints a Markdown table (docs/transfer.md).
//
//   lag_over_speed [CASE [axial inertia of the block, kg mm2 [turns]]]     the inertia: the case's
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/trajectory.h"

namespace {

using namespace bentaxis;

constexpr int kRows = 180;  // of a turn

// Largest wall force of a row, N.
double wall_force(const ChannelLayout& at, const auto& value) {
  double largest = 0;
  for (int k = 0; k < at.pistons(); ++k)
    largest = std::max(largest, std::hypot(value(at.Rw(k, 0)), value(at.Rw(k, 1))));
  return largest;
}

void compare(const char* file, const std::string& inertia, int speed_rpm, int turns) {
  const double turn_s = 60.0 / speed_rpm;
  std::vector<std::string> changes = {"operation.speed_rpm=" + std::to_string(speed_rpm),
                                      "drive.kind=speed",
                                      "drive.duration_s=" + number_text(turns * turn_s),
                                      "drive.samples=" + std::to_string(turns * kRows)};
  if (!inertia.empty()) changes.push_back("block.axial_inertia_kg_mm2=" + inertia);
  const Case the_case = read_case(file, changes);
  const PressureTrace pressure(the_case.pressure);
  const Trajectory run = analytic::simulate(the_case, the_case.analytic, pressure, {});
  const ResultTable& moved = run.table.results;
  const analytic::Model model(the_case.pump, the_case.analytic);
  const ChannelLayout& at = model.layout();
  std::vector<double> values(at.size());
  double worst = 0, square = 0, mean = 0, repeats = 0, frozen_force = 0, moved_force = 0;
  int loose = 0;
  const std::size_t last = moved.rows() - 1;
  for (std::size_t row = last - kRows; row < last; ++row) {
    Instant instant;
    instant.ports = the_case.pressure.ports;
    instant.chamber_pressure.resize(static_cast<std::size_t>(at.pistons()));
    const double theta = radians(run.state(row, StateColumn::theta));
    instant.turn(std::remainder(theta, 2 * kPi), rad_per_second(speed_rpm));
    model.place_at_constant_speed(instant, pressure);
    model.evaluate(instant, values);
    const double lag = instant.lag->angle / kRadPerDegree, moving = moved.at(row, at.lag());
    worst = std::max(worst, std::abs(moving - lag));
    square += (moving - lag) * (moving - lag) / kRows;
    mean += lag / kRows;
    repeats = std::max(repeats, std::abs(moving - moved.at(row - kRows, at.lag())));
    frozen_force = std::max(frozen_force, wall_force(at, [&](std::size_t c) { return values[c]; }));
    const double force = wall_force(
        at, [&](std::size_t c) { return moved.at(row, c) * moved.channels[c].unit_in_si; });
    moved_force = std::max(moved_force, force);
    loose += force == 0;
  }
  std::printf("| %d | %.4f | %.1e | %.1e | %.0f | %.0f | %+.1f | %.1f | %.0e |\n", speed_rpm, mean,
              worst, std::sqrt(square), frozen_force, moved_force,
              100 * (moved_force / frozen_force - 1), 100.0 * loose / kRows, repeats);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const char* const file =
        count > 1 ? arguments[1] : BENTAXIS_SOURCE_DIR "/cases/bap63_tapered_pistons.toml";
    const std::string inertia = count > 2 ? arguments[2] : "";
    const int turns = count > 3 ? std::atoi(arguments[3]) : 20;
    std::puts(
        "| speed, rpm | frozen lag, mean, deg | largest difference, deg | rms, deg | largest wall "
        "force, frozen, N | moving, N | moving, % | without contact, % | last two turns differ by, "
        "deg |\n|---|---|---|---|---|---|---|---|---|");
    for (const int speed : {250, 500, 1000, 1500, 2000, 3000, 4000, 6000})
      compare(file, inertia, speed, turns);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "lag_over_speed: %s\n", e.what());
    return 1;
  }
}
