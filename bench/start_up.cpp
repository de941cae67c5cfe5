// What does motion that follows cost beside motion that is given? A start-up with oil: by a motor,
// and again with the shaft's speed prescribed as it came out. Prints a Markdown table of processor
// time (docs/motion.md).
//
//   start_up [CASE] [tolerance per step]
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/pump/units.h"

namespace {

using namespace bentaxis;

Trajectory run(const Case& the_case, const hydraulics::OilStart& start, double tolerance) {
  const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
  const auto oil = hydraulics::oil_in_time(the_case, start);
  coupled::Options options;
  options.tolerance = tolerance;
  const std::clock_t from = std::clock();
  Trajectory trajectory = coupled::simulate("analytic", *mechanics, *oil, *the_case.drive, options);
  trajectory.record.seconds = static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC;
  return trajectory;
}

void print(const char* what, const Case& the_case, const Trajectory& run) {
  const TrajectoryRecord& r = run.record;
  std::printf("| %s | %.2f s | %.2f | %ld | %ld |\n", what, r.seconds,
              the_case.drive->duration / r.seconds, r.steps, r.evaluations);
}

int measure(const char* file, double tolerance) {
  Case the_case = read_case(file);
  const hydraulics::OilStart start = hydraulics::at_rest(hydraulics::steady_state(the_case));
  const Trajectory free = run(the_case, start, tolerance);
  std::printf("| %g s, %g per step | processor time | simulated over it | steps | evaluations |\n",
              the_case.drive->duration, tolerance);
  std::puts("|---|---|---|---|---|");
  print("driven by its motor", the_case, free);
  Case given = the_case;
  given.drive->kind = DriveKind::speed;
  given.drive->start_speed.reset();
  given.drive->motor.reset();
  given.drive->curve = {};
  constexpr std::size_t kEvery = 20;  // rows
  for (std::size_t row = 0; row < free.lag.size(); row += kEvery) {
    given.drive->curve.time.push_back(free.table.state(row, 0));
    given.drive->curve.value.push_back(free.table.state(row, 3) * kRadPerSecondPerRpm);
  }
  const Trajectory prescribed = run(given, start, tolerance);
  print("its speed prescribed", given, prescribed);
  std::printf("\nmotion that follows: %.2f times as long as motion that is given\n",
              free.record.seconds / prescribed.record.seconds);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    constexpr double kTolerance = 1e-8;
    return measure(count > 1 ? arguments[1] : BENTAXIS_SOURCE_DIR "/cases/bap63_start_up.toml",
                   count > 2 ? std::atof(arguments[2]) : kTolerance);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "start_up: %s\n", e.what());
    return 1;
  }
}
