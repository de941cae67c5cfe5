#include "integration/time_run.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/max_abs.h"
#include "integration/integrators.h"
#include "placement/placement.h"
#include "reactions/channels.h"
#include "reactions/solver_guard.h"

namespace bentaxis::multibody {

using SimTK::Stage;

namespace {

// Within a segment between edges the pressure is evaluated at least this far inside, degrees:
// beyond the tolerance within which an angle counts as on an edge.
constexpr double kInsideEdge = 2e-9;

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

}  // namespace

TimeRun::TimeRun(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
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
  Placement placement(system_);
  const AxisMotion start{0, samples.omega, 0};
  placement.assemble(start, start);
  placement.copy_assembly_to_dynamics();
  start_ = system_.dynamics().getTime();
  enter_segment(0);
  integrator_ = make_integrator(system_.system(), options);
  integrator_->setReturnEveryInternalStep(true);  // so that every step asks whether to go on
  integrator_->initialize(system_.dynamics());
  energy_at_start_ = system_.system().calcKineticEnergy(integrator_->getState());
}

double TimeRun::angle_in_segment(double theta) const {
  const double middle = direction_ * (low_ + high_) / 2;
  const double angle = middle + std::remainder(theta / kRadPerDegree - middle, 360.0);
  return direction_ * std::clamp(direction_ * angle, low_, high_);
}

void TimeRun::run(const Progress& progress, const std::function<void(std::size_t row)>& at_sample) {
  const auto rows = static_cast<double>(samples_.theta_deg.size());
  for (std::size_t row = 0; row < samples_.theta_deg.size(); ++row) {
    alive_ = [&] {
      if (progress) progress(static_cast<double>(row) / rows);
    };
    advance_to(std::abs(samples_.theta_deg[row]));
    note(row);
    if (at_sample) at_sample(row);
  }
  if (progress) progress(1);
  const SimTK::State& state = integrator_->getState();
  system_.system().realize(state, Stage::Acceleration);
  record_.work_of_loads = system_.work().of_loads(state);
  record_.work_of_drives = system_.work().of_drives(state);
  record_.kinetic_energy_gained = system_.system().calcKineticEnergy(state) - energy_at_start_;
  record_.steps += integrator_->getNumStepsTaken();
  record_.evaluations += integrator_->getNumRealizations();
}

void TimeRun::read(std::size_t row, const ChannelLayout& layout, std::vector<double>& values) {
  std::vector<double> pressure(samples_.chamber_pressure.begin() + row * samples_.pistons,
                               samples_.chamber_pressure.begin() + (row + 1) * samples_.pistons);
  SimTK::State& state = system_.dynamics();
  state.setTime(integrator_->getState().getTime());
  state.updQ() = integrator_->getState().getQ();
  state.updU() = integrator_->getState().getU();
  auto in_segment = std::move(system_.inputs().chamber_pressure);
  system_.inputs().chamber_pressure = [&](double, double, std::vector<double>& p) { p = pressure; };
  realize_with_flank(system_, state);
  system_.inputs().chamber_pressure = std::move(in_segment);
  require_accurate_forces(estimated_force_error(system_, state), radians(samples_.theta_deg[row]));
  // The block is locked to the shaft; how far it drifts is told apart.
  const AxisMotion turning{0, state.getU()[system_.bodies().shaft.getFirstUIndex(state) + 2], 0};
  read_channels(system_, state, {state, samples_.omega}, {turning, turning}, pressure, layout,
                values);
  if (system_.has_gear()) system_.gear().setting().negative = false;
}

void TimeRun::advance_to(double distance) {
  while (next_edge_ < edges_.size() && edges_[next_edge_] <= distance) {
    step_to(edges_[next_edge_]);
    enter_segment(edges_[next_edge_]);
    integrator_->updAdvancedState().invalidateAllCacheAtOrAbove(Stage::Dynamics);
    integrator_->reinitialize(Stage::Dynamics, false);
  }
  step_to(distance);
}

void TimeRun::step_to(double distance) {
  const double time = start_ + radians(distance) / std::abs(samples_.omega);
  try {
    while (integrator_->getTime() < time) {
      alive_();
      integrator_->stepTo(time);
    }
  } catch (const SimTK::Exception::Base& error) {
    std::string why = error.getMessageText();
    std::replace(why.begin(), why.end(), '\n', ' ');
    throw ComputationError("multibody model: integration stopped near theta = " +
                           number_text(direction_ * distance) + " deg: " + why);
  }
}

// From here to the next edge the pressure is one smooth branch.
void TimeRun::enter_segment(double from) {
  low_ = from + kInsideEdge;
  while (next_edge_ < edges_.size() && edges_[next_edge_] <= from + kInsideEdge) ++next_edge_;
  high_ = (next_edge_ < edges_.size() ? edges_[next_edge_] : from + 360.0) - kInsideEdge;
  system_.inputs().chamber_pressure = [this](double theta, double, std::vector<double>& p) {
    const double angle = angle_in_segment(theta);
    for (int k = 1; k <= samples_.pistons; ++k)
      p[k - 1] = pressure_(piston_angle_deg(angle, k, samples_.pistons));
  };
}

// Errors of the state at a sample, and the work lost until there.
WorstErrors TimeRun::errors_at(std::size_t row, const SimTK::State& state) const {
  WorstErrors errors;
  for (int i = 0; i < state.getNQErr(); ++i)
    update_max_abs(errors.position_error, state.getQErr()[i]);
  for (int i = 0; i < state.getNUErr(); ++i)
    update_max_abs(errors.velocity_error, state.getUErr()[i]);
  update_max_abs(errors.gear_phase, system_.gear_phase(state));
  const SimTK::MobilizedBody& shaft = system_.bodies().shaft;
  const double angle = turn_angle(shaft.getBodyRotation(state), SimTK::Rotation());
  update_max_abs(
      errors.shaft_angle,
      std::remainder(angle - radians(std::fmod(samples_.theta_deg[row], 360.0)), 2 * kPi));
  update_max_abs(errors.speed_error, shaft.getBodyAngularVelocity(state)[2] / samples_.omega - 1);
  if (system_.pistons_free_to_spin())
    for (const auto& piston : system_.bodies().pistons)
      update_max_abs(errors.spin_error, SimTK::dot(piston.getBodyAngularVelocity(state),
                                                   SimTK::Vec3(piston.getBodyRotation(state).z())) -
                                            system_.pump().piston.real->spin);
  errors.work_residual = system_.work().of_loads(state) + system_.work().of_drives(state) -
                         (system_.system().calcKineticEnergy(state) - energy_at_start_);
  return errors;
}

void TimeRun::note(std::size_t row) {
  const SimTK::State& state = integrator_->getState();
  system_.system().realize(state, Stage::Velocity);
  const WorstErrors errors = errors_at(row, state);
  const auto turn = static_cast<std::size_t>(std::abs(samples_.theta_deg[row]) / 360);
  record_.turns.resize(std::max(record_.turns.size(), turn + 1));
  record_.turns[turn].keep(errors);
  record_.whole.keep(errors);
  if (!errors.is_finite())
    throw ComputationError("multibody model: integration stopped near theta = " +
                           number_text(samples_.theta_deg[row]) +
                           " deg: the state is no longer finite");
}

}  // namespace bentaxis::multibody
