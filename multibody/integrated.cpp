#include "bentaxis/multibody/integrated.h"

#include <cmath>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/results/max_abs.h"
#include "bentaxis/results/stopwatch.h"
#include "integration/time_run.h"
#include "reactions/solver_guard.h"
#include "scene_facts.h"

namespace bentaxis::multibody {

namespace {

void check(const Case& the_case, const Samples& samples) {
  validate(the_case);
  if (samples.pistons != the_case.pump.geometry.pistons)
    throw InputError("integrated run: samples of " + std::to_string(samples.pistons) +
                     " pistons for a pump with " + std::to_string(the_case.pump.geometry.pistons));
  refuse_ring_off_b(the_case.pump);
  refuse_teeth(the_case);
  if (!the_case.pump.transfer.is_even())
    throw InputError((the_case.file.empty() ? "" : the_case.file.string() + ": ") +
                     "[transfer] kind = \"" + to_string(the_case.pump.transfer.kind) +
                     "\": not integrated by run --way integrated, where the block turns as the "
                     "shaft does; use the driven way, or simulate");
  if (the_case.operation.speed_rpm == 0)
    throw InputError(the_case.file.string() +
                     ": [operation] speed_rpm = 0: an integrated run needs a speed other than 0 "
                     "(at rest use --way driven)");
}

}  // namespace

void WorstErrors::keep(const WorstErrors& later) {
  for (const auto error :
       {&WorstErrors::position_error, &WorstErrors::velocity_error, &WorstErrors::gear_phase,
        &WorstErrors::shaft_angle, &WorstErrors::speed_error, &WorstErrors::spin_error})
    update_max_abs(this->*error, later.*error);
  work_residual = later.work_residual;
}

bool WorstErrors::is_finite() const {
  return std::isfinite(position_error + velocity_error + gear_phase + shaft_angle + speed_error +
                       spin_error + work_residual);
}

const std::vector<std::string>& integrator_names() {
  static const std::vector<std::string> names = {"rk-merson", "rk-feldberg",         "rk3",
                                                 "verlet",    "semi-explicit-euler", "cpodes"};
  return names;
}

IntegratedRun run_integrated(const Case& the_case, const Assumptions& assumptions,
                             const Samples& samples, const PressureTrace& pressure,
                             const IntegrationOptions& options, const Progress& progress) {
  check(the_case, samples);
  const Stopwatch stopwatch;
  IntegratedRun result;
  translate_simbody_errors([&] {
    TimeRun run(the_case, assumptions, samples, pressure, options, Drive::constant_speed);
    const ChannelLayout layout(the_case.pump);
    std::vector<std::vector<double>> rows;
    run.run(progress, [&](std::size_t row) {
      rows.emplace_back(layout.size(), not_computed());
      run.read(row, layout, rows.back());
    });
    std::size_t next = 0;
    result.table = tabulate("multibody", layout, samples,
                            [&](const Instant&, std::vector<double>& row) { row = rows[next++]; });
    result.record = run.record();
    result.record.seconds = stopwatch.seconds();
    result.table.provenance.seconds = result.record.seconds;
    const Rank rank = constraint_rank(run.system(), run.system().dynamics());
    result.table.provenance.facts = scene_facts(the_case.pump, assumptions);
    auto& facts = result.table.provenance.facts;
    facts.insert(facts.begin() + 1,
                 {"way", "integrated in time from an assembled start, " +
                             integrator_names()[static_cast<std::size_t>(options.integrator)] +
                             ", accuracy " + number_text(options.accuracy)});
    facts.emplace_back("constraint equations", std::to_string(rank.equations));
    facts.emplace_back("rank of the constraint matrix", std::to_string(rank.rank));
  });
  return result;
}

IntegrationRecord run_torque_driven(const Case& the_case, const Assumptions& assumptions,
                                    const Samples& samples, const PressureTrace& pressure,
                                    const std::function<double(double)>& drive_torque,
                                    const IntegrationOptions& options, const Progress& progress) {
  check(the_case, samples);
  const Stopwatch stopwatch;
  IntegrationRecord record;
  translate_simbody_errors([&] {
    TimeRun run(the_case, assumptions, samples, pressure, options, Drive::torque);
    // (38): of the drive torque the share Ct turns the shaft; the viscous loss is a load of its
    // own.
    run.system().inputs().shaft_torque = [&](double theta) {
      return the_case.pump.friction.shaft_torque_factor * drive_torque(run.angle_in_segment(theta));
    };
    run.run(progress, {});
    record = run.record();
  });
  record.seconds = stopwatch.seconds();
  return record;
}

}  // namespace bentaxis::multibody
