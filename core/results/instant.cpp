#include "bentaxis/results/instant.h"

#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {

void require_locked(const Instant& instant, const char* model) {
  if (instant.locked()) return;
  const auto text = [](const AxisMotion& m) {
    return number_text(m.angle) + " rad, " + number_text(m.speed) + " rad/s, " +
           number_text(m.acceleration) + " rad/s2";
  };
  throw InputError(std::string(model) + " model: the block is not locked to the shaft (block at " +
                   text(instant.block) + "; shaft at " + text(instant.shaft) +
                   "): only a block locked to the shaft is modelled");
}

}  // namespace bentaxis
