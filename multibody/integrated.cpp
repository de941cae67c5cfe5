#include "bentaxis/multibody/integrated.h"

#include <SimTKsimbody.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"
#include "pump_system.h"
#include "reactions.h"
#include "solver_guard.h"

namespace bentaxis::multibody {

using SimTK::Stage;

namespace {

// Within a segment between edges the pressure is evaluated at least this far inside, degrees:
// beyond the tolerance within which an angle counts as on an edge.
constexpr double kInsideEdge = 2e-9;

std::unique_ptr<SimTK::Integrator> make_integrator(const SimTK::MultibodySystem& system,
                                                   const IntegrationOptions& options) {
  std::unique_ptr<SimTK::Integrator> integrator;
  switch (options.integrator) {
    case Integrator::runge_kutta_merson:
      integrator = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system);
      break;
    case Integrator::runge_kutta_feldberg:
      integrator = std::make_unique<SimTK::RungeKuttaFeldbergIntegrator>(system);
      break;
    case Integrator::runge_kutta_3:
      integrator = std::make_unique<SimTK::RungeKutta3Integrator>(system);
      break;
    case Integrator::verlet:
      integrator = std::make_unique<SimTK::VerletIntegrator>(system);
      break;
    case Integrator::semi_explicit_euler:
      integrator = std::make_unique<SimTK::SemiExplicitEuler2Integrator>(system);
      break;
    case Integrator::cpodes:
      integrator = std::make_unique<SimTK::CPodesIntegrator>(system, SimTK::CPodes::BDF);
      break;
  }
  integrator->setAccuracy(options.accuracy);
  integrator->setConstraintTolerance(options.accuracy / 10);
  // Reports between steps would be interpolated, at the cost of far larger errors.
  integrator->setAllowInterpolation(false);
  return integrator;
}

// Distances |theta| at which the loads have an edge: pressure edges of every piston, and its dead
// centres where dry friction changes sign without a transition.
std::vector<double> edge_distances(const Case& the_case, const Assumptions& assumptions,
                                   const PressureTrace& pressure, double end) {
  const int n = the_case.pump.geometry.pistons;
  const Friction& friction = the_case.pump.friction;
  std::vector<double> chamber = pressure.edges_deg();
  if (assumptions.piston_friction && friction.regularization == 0 && friction.piston_coulomb > 0)
    chamber.insert(chamber.end(), {0.0, 180.0});
  const double direction = the_case.operation.speed_rpm < 0 ? -1 : 1;
  std::vector<double> distances;
  for (int k = 1; k <= n; ++k) {
    for (const double edge : chamber) {
      double first = std::fmod(direction * (edge - piston_angle_deg(0, k, n)), 360.0);
      if (first < 0) first += 360.0;
      for (double at = first; at < end; at += 360.0) distances.push_back(at);
    }
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

// Carries a run from sample to sample, landing on edges.
class Runner {
 public:
  Runner(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
         const PressureTrace& pressure, const IntegrationOptions& options, Drive drive)
      : samples_(samples),
        pressure_(pressure),
        system_(the_case.pump, assumptions, samples.omega, drive),
        direction_(samples.omega < 0 ? -1 : 1) {
    system_.inputs().ports = samples.ports;
    // A piston slower than what the integration resolves is at rest: at a dead centre the sign of
    // its velocity would be that of the error.
    system_.inputs().rest_speed =
        std::max(system_.inputs().rest_speed, options.accuracy * std::abs(samples.omega) *
                                                  the_case.pump.geometry.joint_circle_radius);
    const double end = samples.theta_deg.empty() ? 0 : std::abs(samples.theta_deg.back());
    edges_ = edge_distances(the_case, assumptions, pressure, end);
    system_.require_piston_inertia();
    system_.assemble(0, samples.omega);
    system_.copy_assembly_to_dynamics();
    start_ = system_.dynamics().getTime();
    enter_segment(0);
    integrator_ = make_integrator(system_.system(), options);
    integrator_->initialize(system_.dynamics());
    energy_at_start_ = system_.system().calcKineticEnergy(integrator_->getState());
  }

  PumpSystem& system() { return system_; }

  // Angle (degrees) inside the present segment that belongs to a shaft angle in (-pi, pi].
  double angle_in_segment(double theta) const {
    const double middle = direction_ * (low_ + high_) / 2;
    const double angle = middle + std::remainder(theta / kRadPerDegree - middle, 360.0);
    return direction_ * std::clamp(direction_ * angle, low_, high_);
  }

  void run(const Progress& progress, const std::function<void(std::size_t row)>& at_sample) {
    for (std::size_t row = 0; row < samples_.theta_deg.size(); ++row) {
      advance_to(std::abs(samples_.theta_deg[row]));
      note(row);
      if (at_sample) at_sample(row);
      if (progress)
        progress(static_cast<double>(row + 1) / static_cast<double>(samples_.theta_deg.size()));
    }
    const SimTK::State& state = integrator_->getState();
    system_.system().realize(state, Stage::Acceleration);
    record_.work_of_loads = system_.work_of_loads(state);
    record_.work_of_drives = system_.work_of_drives(state);
    record_.kinetic_energy_gained = system_.system().calcKineticEnergy(state) - energy_at_start_;
    record_.steps += integrator_->getNumStepsTaken();
    record_.evaluations += integrator_->getNumRealizations();
  }

  // Reads all channels at a sample, with that sample's pressures.
  void read(std::size_t row, const ChannelLayout& layout, std::vector<double>& values) {
    std::vector<double> pressure(samples_.chamber_pressure.begin() + row * samples_.pistons,
                                 samples_.chamber_pressure.begin() + (row + 1) * samples_.pistons);
    SimTK::State& state = system_.dynamics();
    state.setTime(integrator_->getState().getTime());
    state.updQ() = integrator_->getState().getQ();
    state.updU() = integrator_->getState().getU();
    auto in_segment = std::move(system_.inputs().chamber_pressure);
    system_.inputs().chamber_pressure = [&](double, std::vector<double>& p) { p = pressure; };
    system_.system().realize(state, Stage::Acceleration);
    system_.inputs().chamber_pressure = std::move(in_segment);
    require_accurate_forces(estimated_force_error(system_, state),
                            radians(samples_.theta_deg[row]));
    read_channels(system_, state, {state, samples_.omega}, 0, pressure, layout, values);
  }

  const IntegrationRecord& record() const { return record_; }
  IntegrationRecord& record() { return record_; }

 private:
  void advance_to(double distance) {
    while (next_edge_ < edges_.size() && edges_[next_edge_] <= distance) {
      step_to(edges_[next_edge_]);
      enter_segment(edges_[next_edge_]);
      integrator_->updAdvancedState().invalidateAllCacheAtOrAbove(Stage::Dynamics);
      integrator_->reinitialize(Stage::Dynamics, false);
    }
    step_to(distance);
  }

  void step_to(double distance) {
    const double time = start_ + radians(distance) / std::abs(samples_.omega);
    try {
      while (integrator_->getTime() < time) integrator_->stepTo(time);
    } catch (const SimTK::Exception::Base& error) {
      std::string why = error.getMessageText();
      std::replace(why.begin(), why.end(), '\n', ' ');
      throw ComputationError("multibody model: integration stopped near theta = " +
                             number_text(direction_ * distance) + " deg: " + why);
    }
  }

  // From here to the next edge the pressure is one smooth branch.
  void enter_segment(double from) {
    low_ = from + kInsideEdge;
    while (next_edge_ < edges_.size() && edges_[next_edge_] <= from + kInsideEdge) ++next_edge_;
    high_ = (next_edge_ < edges_.size() ? edges_[next_edge_] : from + 360.0) - kInsideEdge;
    system_.inputs().chamber_pressure = [this](double theta, std::vector<double>& p) {
      const double angle = angle_in_segment(theta);
      for (int k = 1; k <= samples_.pistons; ++k)
        p[k - 1] = pressure_(piston_angle_deg(angle, k, samples_.pistons));
    };
  }

  void note_turn(std::size_t row, const SimTK::State& state) {
    const auto turn = static_cast<std::size_t>(std::abs(samples_.theta_deg[row]) / 360);
    record_.turns.resize(std::max(record_.turns.size(), turn + 1));
    TurnRecord& record = record_.turns[turn];
    const auto keep = [](double& worst, double value) { worst = std::max(worst, std::abs(value)); };
    if (state.getNQErr() > 0) keep(record.position_error, state.getQErr().normInf());
    if (state.getNUErr() > 0) keep(record.velocity_error, state.getUErr().normInf());
    keep(record.gear_phase, system_.gear_phase(state));
    if (system_.pistons_free_to_spin())
      for (const auto& piston : system_.bodies().pistons)
        keep(record.spin_error, SimTK::dot(piston.getBodyAngularVelocity(state),
                                           SimTK::Vec3(piston.getBodyRotation(state).z())) -
                                    system_.pump().piston.real->spin);
    record.work_residual = system_.work_of_loads(state) + system_.work_of_drives(state) -
                           (system_.system().calcKineticEnergy(state) - energy_at_start_);
  }

  void note(std::size_t row) {
    const SimTK::State& state = integrator_->getState();
    system_.system().realize(state, Stage::Velocity);
    note_turn(row, state);
    const auto keep = [](double& worst, double value) { worst = std::max(worst, std::abs(value)); };
    if (state.getNQErr() > 0) keep(record_.worst_position_error, state.getQErr().normInf());
    if (state.getNUErr() > 0) keep(record_.worst_velocity_error, state.getUErr().normInf());
    keep(record_.worst_gear_phase, system_.gear_phase(state));
    const SimTK::MobilizedBody& shaft = system_.bodies().shaft;
    const double angle = turn_angle(shaft.getBodyRotation(state), SimTK::Rotation());
    keep(record_.worst_shaft_angle,
         std::remainder(angle - radians(std::fmod(samples_.theta_deg[row], 360.0)), 2 * kPi));
    if (system_.pistons_free_to_spin())
      for (const auto& piston : system_.bodies().pistons)
        keep(record_.worst_spin, SimTK::dot(piston.getBodyAngularVelocity(state),
                                            SimTK::Vec3(piston.getBodyRotation(state).z())) -
                                     system_.pump().piston.real->spin);
    keep(record_.worst_speed, shaft.getBodyAngularVelocity(state)[2] / samples_.omega - 1);
  }

  const Samples& samples_;
  const PressureTrace& pressure_;
  PumpSystem system_;
  double direction_;
  std::vector<double> edges_;
  std::size_t next_edge_ = 0;
  double low_ = 0, high_ = 0;  // of the present segment, |theta| in degrees
  double start_ = 0;           // s
  double energy_at_start_ = 0;
  std::unique_ptr<SimTK::Integrator> integrator_;
  IntegrationRecord record_;
};

void check(const Case& the_case, const Samples& samples) {
  validate(the_case);
  if (samples.pistons != the_case.pump.geometry.pistons)
    throw InputError("integrated run: samples of " + std::to_string(samples.pistons) +
                     " pistons for a pump with " + std::to_string(the_case.pump.geometry.pistons));
  if (the_case.operation.speed_rpm == 0)
    throw InputError(the_case.file.string() +
                     ": [operation] speed_rpm = 0: an integrated run needs a speed other than 0 "
                     "(use the driven way at standstill)");
}

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

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
    Runner runner(the_case, assumptions, samples, pressure, options, Drive::constant_speed);
    const ChannelLayout layout(samples.pistons);
    std::vector<std::vector<double>> rows;
    runner.run(progress, [&](std::size_t row) {
      rows.emplace_back(layout.size(), not_computed());
      runner.read(row, layout, rows.back());
    });
    std::size_t next = 0;
    result.table = tabulate("multibody", layout, samples,
                            [&](const Instant&, std::vector<double>& row) { row = rows[next++]; });
    result.record = runner.record();
    result.record.seconds = stopwatch.seconds();
    result.table.provenance.seconds = result.record.seconds;
    const PumpSystem::Rank rank = runner.system().constraint_rank(runner.system().dynamics());
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
    Runner runner(the_case, assumptions, samples, pressure, options, Drive::torque);
    // (38): of the drive torque the share Ct turns the shaft; the viscous loss is a load of its
    // own.
    runner.system().inputs().shaft_torque = [&](double theta) {
      return the_case.pump.friction.shaft_torque_factor *
             drive_torque(runner.angle_in_segment(theta));
    };
    runner.run(progress, {});
    record = runner.record();
  });
  record.seconds = stopwatch.seconds();
  return record;
}

}  // namespace bentaxis::multibody
