#include "bentaxis/results/surroundings.h"

#include <stdexcept>

#include "bentaxis/pump/error.h"
#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"

namespace bentaxis {

bool operator==(const Surroundings& a, const Surroundings& b) {
  return a.shaft == b.shaft && a.time == b.time && a.torque == b.torque && a.suction == b.suction &&
         a.delivery == b.delivery && a.load_share == b.load_share &&
         a.torque_rate == b.torque_rate && a.suction_rate == b.suction_rate &&
         a.delivery_rate == b.delivery_rate && a.load_share_rate == b.load_share_rate;
}

AxisMotion Surroundings::shaft_at(double at) const {
  const double since = at - time;
  return {shaft->angle + (shaft->speed + shaft->acceleration / 2 * since) * since,
          shaft->speed + shaft->acceleration * since, shaft->acceleration};
}

namespace {

// Where nothing changes the value itself, to the last bit.
std::optional<double> along(const std::optional<double>& value, double rate, double since) {
  if (!value || rate == 0) return value;
  return *value + rate * since;
}

}  // namespace

bool Surroundings::pressures_are_held() const { return suction_rate == 0 && delivery_rate == 0; }

std::optional<double> Surroundings::torque_at(double at) const {
  return along(torque, torque_rate, at - time);
}

std::optional<double> Surroundings::suction_at(double at) const {
  return along(suction, suction_rate, at - time);
}

std::optional<double> Surroundings::delivery_at(double at) const {
  return along(delivery, delivery_rate, at - time);
}

std::optional<double> Surroundings::load_share_at(double at) const {
  return along(load_share, load_share_rate, at - time);
}

// Programs of 1.0.0 override surround() and knots(), which these names call; what is of today
// overrides these.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
void Mechanics::set_inputs(const Surroundings& outside) { surround(outside); }
std::vector<double> Mechanics::breakpoints() const { return knots(); }
void Oil::set_inputs(const Surroundings& outside) { surround(outside); }
std::vector<double> Oil::breakpoints() const { return knots(); }
#pragma GCC diagnostic pop

void Mechanics::surround(const Surroundings& /*outside*/) {
  throw std::logic_error("this model takes no drive or load from outside");
}
std::vector<double> Mechanics::knots() const { return breakpoints(); }
void Oil::surround(const Surroundings& /*outside*/) {}
std::vector<double> Oil::knots() const { return breakpoints(); }

void require_drive(const DriveSpec& drive, const Surroundings& outside) {
  if (outside.shaft && drive.kind != DriveKind::speed)
    throw InputError("[drive] kind: must be \"speed\" where the shaft's motion comes from outside");
  if (outside.torque && drive.kind != DriveKind::torque)
    throw InputError("[drive] kind: must be \"torque\" where a torque comes from outside");
}

}  // namespace bentaxis
