#include "bentaxis/results/surroundings.h"

#include <stdexcept>

#include "bentaxis/pump/error.h"
#include "bentaxis/results/mechanics.h"

namespace bentaxis {

bool operator==(const Surroundings& a, const Surroundings& b) {
  return a.shaft == b.shaft && a.time == b.time && a.torque == b.torque && a.suction == b.suction &&
         a.delivery == b.delivery && a.load_share == b.load_share;
}

AxisMotion Surroundings::shaft_at(double at) const {
  const double since = at - time;
  return {shaft->angle + (shaft->speed + shaft->acceleration / 2 * since) * since,
          shaft->speed + shaft->acceleration * since, shaft->acceleration};
}

void Mechanics::surround(const Surroundings& /*outside*/) {
  throw std::logic_error("this model takes no drive or load from outside");
}

void require_drive(const DriveSpec& drive, const Surroundings& outside) {
  if (outside.shaft && drive.kind != DriveKind::speed)
    throw InputError("[drive] kind: must be \"speed\" where the shaft's motion comes from outside");
  if (outside.torque && drive.kind != DriveKind::torque)
    throw InputError("[drive] kind: must be \"torque\" where a torque comes from outside");
}

}  // namespace bentaxis
