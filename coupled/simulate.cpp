// A motion from its start, row by row.
#include <algorithm>
#include <cmath>

#include "bentaxis/coupled/simulation.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/max_abs.h"
#include "bentaxis/results/stopwatch.h"
#include "communication.h"
#include "hybrid_integrator.h"
#include "table.h"

namespace bentaxis::coupled {
namespace {

// Fills the rows of a trajectory, and the balances up to each of them.
class Rows {
 public:
  Rows(Mechanics& mechanics, const Oil& oil, const System& system, const SystemState& start,
       Trajectory& trajectory, std::size_t rows, bool balances, const Options& options)
      : mechanics_(mechanics),
        oil_(oil),
        system_(system),
        trajectory_(trajectory),
        body_loads_(options.body_loads),
        balances_(balances) {
    if (options.of_pump_alone) keep_pump_alone();
    ResultTable& results = trajectory.table.results;
    results.values.reserve(rows * results.columns());
    trajectory.table.states.reserve(rows * trajectory.table.state_names.size());
    kinetic_ = mechanics.kinetic_energy(0, start.motion);
    potential_ = mechanics.elastic_energy(0, start.motion);
    work_of_loads_ = start.motion[kWorkOfLoads];
    work_of_drive_ = start.motion[kWorkOfDrive];
    loads_.chamber_pressure.assign(static_cast<std::size_t>(oil.pistons()), 0.0);
    if (oil.states() == 0) return;
    OilHistory& history = trajectory.oil.emplace();
    history.columns = oil.columns();
    history.values.reserve(rows * history.columns.size());
    for (const OilPlace& place : oil.places()) history.energies.push_back({place, 0});
    stored(0, start, energy_, mass_);
  }

  void add(double time, const SystemState& s, const std::vector<double>& integrals) {
    const AxisMotion block = mechanics_.block(time, s.motion);
    oil_.loads(time, block, s.oil.data(), loads_);
    state_.clear();
    row_.assign(mechanics_.layout().size(), not_computed());
    MotionChecks checks{};
    mechanics_.row(time, s.motion, loads_, state_, row_, checks);
    if (!kept_.empty()) {
      for (std::size_t i = 0; i < kept_.size(); ++i) row_[i] = row_[kept_[i]];
      row_.resize(kept_.size());
    }
    append_trajectory_row(trajectory_.table, state_, row_, checks);
    trajectory_.lag.push_back(s.motion[kLag]);
    if (TeethAction action; mechanics_.teeth(time, s.motion, action))
      trajectory_.teeth.push_back(action);
    if (body_loads_) trajectory_.loads.append(mechanics_.body_loads(time, s.motion, loads_));

    if (trajectory_.oil) add_oil(time, s, integrals);
    if (!balances_) return;
    TrajectoryRecord& record = trajectory_.record;
    record.work_of_loads = s.motion[kWorkOfLoads] - work_of_loads_;
    record.work_of_drives = s.motion[kWorkOfDrive] - work_of_drive_;
    record.kinetic_energy_gained = mechanics_.kinetic_energy(time, s.motion) - kinetic_;
    record.potential_energy_gained = mechanics_.elastic_energy(time, s.motion) - potential_;
    record.work_residual = record.work_of_loads + record.work_of_drives -
                           record.kinetic_energy_gained - record.potential_energy_gained;
    update_max_abs(record.worst_work_residual, record.work_residual);
  }

 private:
  void keep_pump_alone() {
    std::vector<Channel>& channels = trajectory_.table.results.channels;
    std::vector<Channel> some;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const bool of_row = c < mechanics_.layout().size();
      if (of_row && !(channels[c].kind == ChannelKind::reaction && channels[c].of_pump)) continue;
      if (of_row) kept_.push_back(c);
      some.push_back(std::move(channels[c]));
    }
    channels = std::move(some);
  }

  void stored(double time, const SystemState& s, double& energy, double& mass) const {
    oil_.stored(time, mechanics_.shaft(time, s.motion), mechanics_.block(time, s.motion),
                s.oil.data(), energy, mass);
  }

  void add_oil(double time, const SystemState& s, const std::vector<double>& integrals) {
    OilHistory& history = *trajectory_.oil;
    const std::size_t columns = history.columns.size();
    history.values.resize(history.values.size() + columns);
    oil_.row(time, mechanics_.shaft(time, s.motion), mechanics_.block(time, s.motion), s.oil.data(),
             history.values.data() + history.values.size() - columns);
    if (integrals.empty()) return;
    double energy = 0, mass = 0;
    stored(time, s, energy, mass);
    history.energy_gained = energy - energy_;
    history.energy_residual = -history.energy_gained;
    for (std::size_t i = 0; i < history.energies.size(); ++i) {
      OilEnergy& by = history.energies[i];
      by.energy = integrals[i];
      history.energy_residual += by.place.use == PowerUse::source ? by.energy : -by.energy;
    }
    history.mass_in = integrals[static_cast<std::size_t>(system_.mass_in())];
    history.mass_out = integrals[static_cast<std::size_t>(system_.mass_out())];
    history.mass_gained = mass - mass_;
    history.mass_residual = history.mass_in - history.mass_out - history.mass_gained;
    history.pressure_work = integrals[static_cast<std::size_t>(system_.pressure_work())];
    if (!history.energies.empty())
      history.exchange_residual = history.pressure_work + history.energies.front().energy;
    update_max_abs(history.worst_energy_residual, history.energy_residual);
    update_max_abs(history.worst_mass_residual, history.mass_residual);
    update_max_abs(history.worst_exchange_residual, history.exchange_residual);
  }

  Mechanics& mechanics_;
  const Oil& oil_;
  const System& system_;
  Trajectory& trajectory_;
  bool body_loads_, balances_;
  double kinetic_ = 0, potential_ = 0, work_of_loads_ = 0, work_of_drive_ = 0;
  double energy_ = 0, mass_ = 0;
  OilLoads loads_;
  std::vector<std::size_t> kept_;  // channels of a row; empty: all
  std::vector<double> state_, row_;
};

}  // namespace

std::string method_text(double tolerance, bool has_oil) {
  return std::string("BDF of variable order with Newton's method (CVODES), ") +
         (has_oil ? "motion and oil together, " : "of shaft, block and rotor, ") +
         rounded_text(tolerance) + " per step relative to the scale of each state";
}

Trajectory tabulate(const std::string& name, Mechanics& mechanics, Oil& oil, const DriveSpec& drive,
                    const SystemState& start, const std::vector<double>& times,
                    const Options& options, const Progress& progress) {
  const double tolerance = options.tolerance;
  const Stopwatch watch;
  Trajectory trajectory;
  trajectory.table = trajectory_table(name, mechanics.layout(), drive);
  trajectory.loads = BodyLoadTable::of(times.size());
  // A given motion without oil has no states but its balances.
  const bool balances = options.balances || System(mechanics, oil, false).scale().empty();
  HybridIntegrator integrator(name, mechanics, oil, tolerance, balances);
  integrator.start(0, start);
  integrator.foresee(times.back());
  Rows rows(mechanics, oil, integrator.system(), start, trajectory, times.size(), balances,
            options);
  SystemState at = start;
  std::vector<double> integrals;
  const double end = times.back();
  std::optional<Communication> points;
  if (options.exchange) points.emplace(name, mechanics, oil, drive, *options.exchange, end);
  constexpr long kStepsBetweenSigns = 64;
  const auto go_to = [&](double time) {
    while (integrator.time() < time) {
      if (progress && integrator.steps() % kStepsBetweenSigns == 0)
        progress(integrator.time() / end);
      integrator.advance(end);
    }
  };
  for (const double time : times) {
    while (points && points->next() <= time) {
      go_to(points->next());
      points->pass(integrator);
    }
    go_to(time);
    integrator.state_at(time, at);
    integrator.integrals_at(time, integrals);
    rows.add(time, at, integrals);
  }
  integrator.close_contacts();
  TrajectoryRecord& record = trajectory.record;
  record.steps = integrator.steps();
  record.evaluations = integrator.evaluations();
  record.seconds = watch.seconds();
  record.share_out_of_contact =
      mechanics.compliant() && end > 0 ? integrator.time_apart() / end : 0;
  record.events = integrator.events();
  record.choice = method_text(tolerance, oil.states() > 0);
  return trajectory;
}

Trajectory simulate(const std::string& name, Mechanics& mechanics, Oil& oil, const DriveSpec& drive,
                    const Options& options, const Progress& progress) {
  SystemState start{mechanics.start(), oil.start()};
  if (options.disturbance != 0) {
    const MotionVector scales = mechanics.scales();
    const auto move = [&](std::size_t angle, std::size_t rate) {
      for (const std::size_t index : {angle, rate})
        start.motion[index] += options.disturbance * scales[index];
    };
    if (mechanics.shaft_is_free()) move(kTurn, kTurnRate);
    if (mechanics.compliant()) move(kLag, kLagRate);
    if (mechanics.has_motor()) move(kTwist, kTwistRate);
    const std::vector<double> of_oil = oil.scales();
    for (std::size_t i = 0; i < of_oil.size(); ++i) start.oil[i] += options.disturbance * of_oil[i];
  }
  const std::vector<double> times = options.times.empty() ? trajectory_times(drive) : options.times;
  return tabulate(name, mechanics, oil, drive, start, times, options, progress);
}

}  // namespace bentaxis::coupled
