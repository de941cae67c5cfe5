// Properties of oil that are printed somewhere.
#include "bentaxis/pump/hydraulic_data.h"
#include "numbers.h"
#include "viscosity.h"

namespace bentaxis::external {

Numbers oil() {
  // The paper's oil at rated pressure; a density cancels out of a kinematic viscosity.
  constexpr double kDensity = 850, kRated = 275e5, kSquareMillimetresPerSecond = 1e6;
  OilData oil;
  oil.temperature = 60;
  const hydraulics::Viscosity viscosity(oil, kDensity);
  return {{"paper.viscosity", viscosity.dynamic(kRated) / kDensity * kSquareMillimetresPerSecond}};
}

}  // namespace bentaxis::external
