#include "communication.h"

#include <algorithm>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::coupled {
namespace {

constexpr double kOnePoint = 1e-9;  // of a step: a point nearer than that to the end is the end

}  // namespace

double PumpOutputs::operator[](const std::string& name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) throw InputError("the pump has no output " + name);
  return values[static_cast<std::size_t>(at - names.begin())];
}

Communication::Communication(const std::string& name, Mechanics& mechanics, Oil& oil,
                             const DriveSpec& drive, const Exchange& exchange, double end)
    : mechanics_(mechanics),
      oil_(oil),
      exchange_(exchange),
      end_(end),
      row_(trajectory_table(name, mechanics.layout(), drive)) {
  if (!(exchange.step > 0))
    throw InputError("communication step " + number_text(exchange.step) + " s: must be > 0");
  names_ = row_.state_names;
  for (const Channel& channel : row_.results.channels) names_.push_back(channel.name);
  if (oil.states() > 0)
    for (const OilColumn& column : oil.columns()) names_.push_back(column.name);
  oil_columns_ = names_.size() - row_.state_names.size() - row_.results.channels.size();
  loads_.chamber_pressure.assign(static_cast<std::size_t>(oil.pistons()), 0.0);
}

Communication::~Communication() {
  if (outside_ == Surroundings{}) return;
  mechanics_.set_inputs({});
  oil_.set_inputs({});
}

double Communication::next() const {
  const double next = exchange_.step * static_cast<double>(points_);
  return next < end_ - kOnePoint * exchange_.step ? next : std::numeric_limits<double>::infinity();
}

void Communication::read(double time, const SystemState& state) {
  const AxisMotion block = mechanics_.block(time, state.motion);
  oil_.loads(time, block, state.oil.data(), loads_);
  reactions_.assign(mechanics_.layout().size(), not_computed());
  motion_.clear();
  MotionChecks checks{};
  mechanics_.row(time, state.motion, loads_, motion_, reactions_, checks);
  row_.states.clear();
  row_.results.theta_deg.clear();
  row_.results.values.clear();
  append_trajectory_row(row_, motion_, reactions_, checks);
  values_ = row_.states;
  values_.insert(values_.end(), row_.results.values.begin(), row_.results.values.end());
  if (oil_columns_ == 0) return;
  values_.resize(names_.size());
  oil_.row(time, mechanics_.shaft(time, state.motion), block, state.oil.data(),
           values_.data() + values_.size() - oil_columns_);
}

// What acts has changed. A speed that jumps takes the bodies along: what they gain is work of what
// turns the shaft.
void Communication::set_inputs(const Surroundings& outside, HybridIntegrator& integrator,
                               const SystemState& state) {
  const double time = integrator.time();
  const double before = mechanics_.kinetic_energy(time, state.motion);
  mechanics_.set_inputs(outside);
  oil_.set_inputs(outside);
  outside_ = outside;
  SystemState after = state;
  after.motion[kWorkOfDrive] += mechanics_.kinetic_energy(time, state.motion) - before;
  integrator.jump(after);
}

void Communication::pass(HybridIntegrator& integrator) {
  const double time = next();
  SystemState state;
  integrator.state_at(time, state);
  read(time, state);
  Surroundings outside = exchange_.partner({time, names_, values_});
  ++points_;
  outside.time = time;
  if (outside.shaft) {
    const AxisMotion now = mechanics_.shaft(time, state.motion);
    outside.shaft->angle = now.angle;
    // The law goes on as it is: the time at which it is said is no change.
    if (outside_.shaft && outside.shaft->speed == now.speed &&
        outside.shaft->acceleration == outside_.shaft->acceleration) {
      outside.shaft = outside_.shaft;
      outside.time = outside_.time;
    }
  } else {
    outside.time = outside_.time;
  }
  if (outside == outside_) return;
  integrator.go_back(time);
  set_inputs(outside, integrator, state);
}

}  // namespace bentaxis::coupled
