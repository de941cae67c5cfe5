#include "scene/tooth_contact.h"

#include <algorithm>
#include <cmath>

namespace bentaxis::multibody {

double flank_force(const ToothCompliance& teeth, double approach, double rate) {
  if (!(approach > 0)) return 0;
  const double elastic =
      teeth.stiffness * kToothApproach * std::pow(approach / kToothApproach, teeth.exponent);
  return std::max(0.0, elastic * (1 + teeth.dissipation * rate));
}

double tooth_force(const ToothCompliance& teeth, double advance, double rate) {
  const double play = teeth.backlash / 2;
  return flank_force(teeth, advance - play, rate) - flank_force(teeth, -advance - play, -rate);
}

}  // namespace bentaxis::multibody
