#include <algorithm>
#include <cmath>

#include "bentaxis/study/achieved_error.h"
#include "coupled_pump.h"
#include "differences.h"
#include "simulation_study.h"

namespace bentaxis::study {
namespace {

// Of shaft, block and pistons at the largest speed of a run, J.
double kinetic_energy(const Case& the_case, const Trajectory& run) {
  const PumpParameters& pump = the_case.pump;
  double speed = 0;
  for (std::size_t row = 0; row < run.lag.size(); ++row)
    speed = std::max(speed, fastest_speed(run, row));
  const double pistons = pump.geometry.pistons * pump.piston.mass *
                         pump.geometry.joint_circle_radius * pump.geometry.joint_circle_radius;
  return 0.5 * (pump.shaft.axial_inertia + pump.block.axial_inertia + pistons) * speed * speed;
}

// Work less change of energy. Simbody's work is integrated with its motion, to the same error.
// @return what it is held to, J
double check_work(SimulationResult& r, Model model, const Trajectory& t, double largest_moment,
                  bool one_integrator) {
  const TrajectoryRecord& record = t.record;
  // Where nothing moves there is no work: then that of the largest torque over 1e-6 rad. Loads
  // that cancel leave the round-off of theirs.
  constexpr double kMinTurn = 1e-6;
  constexpr double kMinWork = 1e-12;  // J: nor is there a torque
  // A speed that is off by some share of itself leaves twice that share of the kinetic energy.
  const double kinetic = kinetic_energy(r.ready.the_case, t);
  const double work =
      std::max({kinetic, std::abs(record.work_of_loads), std::abs(record.work_of_drives),
                std::abs(record.kinetic_energy_gained),
                kMinTurn * std::max(t.table.results.peak("Td"), largest_moment), kMinWork});
  const double tolerance = model == Model::analytic && !one_integrator
                               ? kAnalyticError
                               : std::max(r.choice.error, r.choice.accuracy.value_or(0));
  r.checks.push_back({to_string(model), "work less change of energy", "J",
                      record.worst_work_residual, 0, work, tolerance});
  return work;
}

void check_power(SimulationResult& r, Model model, const Trajectory& t, double largest_moment) {
  const ResultTable& table = t.table.results;
  constexpr double kPowerTolerance = 1e-8;
  const std::size_t balance = table.find("power_balance_W");
  const std::size_t drive_torque = table.find("Td_z1_Nm");
  double worst = 0, angle = 0, scale = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double value = std::abs(table.at(row, balance));
    if (std::isnan(value) || value > worst) {
      worst = value;
      angle = table.theta_deg[row];
    }
    // Of the torque, at the faster body's speed; at rest at 1 rad/s, as in virtual work. At
    // least what a comparison holds the same power to: its tolerance of the loads.
    const double speed = std::max(1.0, fastest_speed(t, row));
    const double torque = std::max(std::abs(table.at(row, drive_torque)),
                                   kDrivenTolerance / kPowerTolerance * largest_moment);
    scale = std::max(scale, torque * speed);
  }
  r.checks.push_back({to_string(model), "power of all loads less the change of kinetic energy", "W",
                      worst, angle, std::max(scale, 1e-3), kPowerTolerance});
}

// Held to the error that the integration was asked for.
void check_oil(SimulationResult& r, Model model, const Trajectory& t, double work) {
  const OilHistory& oil = *t.oil;
  constexpr double kMinEnergy = 1e-6;  // J: where nothing moves
  double passed = std::max(work, kMinEnergy);
  for (const OilEnergy& energy : oil.energies) passed = std::max(passed, std::abs(energy.energy));
  const double mass = std::max(mass_passed(t), 1e-9);
  const double tolerance = r.choice.error;
  const auto add = [&](const char* name, const char* unit, double worst, double scale) {
    r.checks.push_back({to_string(model), name, unit, worst, 0, scale, tolerance});
  };
  add("energy of the oil: sources less what is delivered, lost and stored", "J",
      oil.worst_energy_residual, passed);
  add("mass of the oil: in less out and stored", "kg", oil.worst_mass_residual, mass);
  add("work of the pressures on the pistons and of the pistons on the oil", "J",
      oil.worst_exchange_residual, passed);
}

}  // namespace

void add_checks(SimulationResult& r, bool one_integrator) {
  for (const auto& [model, run] :
       {std::pair{Model::analytic, &r.analytic}, std::pair{Model::multibody, &r.multibody}}) {
    if (!*run) continue;
    const double largest_moment = loads_of(r.ready.the_case, **run).moment;
    const double work = check_work(r, model, **run, largest_moment, one_integrator);
    check_power(r, model, **run, largest_moment);
    if ((*run)->oil) check_oil(r, model, **run, work);
  }
}

}  // namespace bentaxis::study
