// Ball bearings of MASTA's results, and lives that textbooks print.
#include <cmath>
#include <string>

#include "bentaxis/pump/units.h"
#include "bentaxis/study/ball_bearing.h"
#include "bentaxis/study/bearing_life.h"
#include "numbers.h"

namespace bentaxis::external {

Numbers bearings() {
  constexpr double kMillimetre = 1e-3, kMicro = 1e-6, kMilli = 1e-3;
  Numbers numbers;
  const auto put = [&](const std::string& name, int balls, double diameter_mm, double clearance_mm,
                       const study::BallBearingLoad& load) {
    study::BallBearing bearing;
    bearing.balls = balls;
    bearing.ball_diameter = diameter_mm * kMillimetre;
    bearing.pitch_diameter = 43.5 * kMillimetre;
    bearing.radial_clearance = clearance_mm * kMillimetre;
    bearing.dynamic_rating = 23400;
    const study::BallBearingState found = study::equilibrium(bearing, load);
    if (load.radial > 0) numbers.push_back({name + ".radial", found.radial / kMicro});
    if (load.axial > 0) numbers.push_back({name + ".axial", found.axial / kMicro});
    if (load.moment > 0 || (load.radial > 0 && load.axial > 0))
      numbers.push_back({name + ".tilt", std::abs(found.tilt) / kMilli});
    numbers.push_back({name + ".life", found.reference_life});
    if (balls == 6 && clearance_mm == 0)
      numbers.push_back({name + ".life.program", found.reference_life});
  };
  for (const bool seven : {false, true}) {
    const int balls = seven ? 7 : 6;
    const double diameter = seven ? 11.5 : 11.1;
    const std::string name = "iso16281." + std::to_string(balls) + "_balls.";
    put(name + "radial_load", balls, diameter, 0, {1000, 0, 0, 0});
    put(name + "axial_load", balls, diameter, 0, {0, 1000, 0, 0});
    put(name + "radial_load_clearance", balls, diameter, 0.01, {1000, 0, 0, 0});
    put(name + "axial_load_clearance", balls, diameter, 0.01, {0, 1000, 0, 0});
    put(name + "both_clearance", balls, diameter, 0.01, {1000, 1000, 0, 0});
  }
  put("iso16281.7_balls.moment", 7, 11.5, 0, {0, 0, 1, -kPi / 2});

  // C and P in kN.
  const double ball = study::rating_life(22.4, 3.2, study::kBallLifeExponent);
  numbers.push_back({"iso281.ball.revolutions", ball});
  numbers.push_back({"iso281.ball.hours", ball * 1e6 / 60 / 650});
  numbers.push_back({"iso281.roller.revolutions", study::rating_life(53.98, 1.3 * 5) * 0.6});
  const double skf = study::rating_life(55.3, 10, study::kBallLifeExponent);
  numbers.push_back({"iso281.6309.revolutions", skf});
  numbers.push_back({"iso281.6309.hours", skf * 1e6 / 60 / 3000});
  numbers.push_back({"iso281.6309.hours_at_4_kN",
                     study::rating_life(55.3, 4, study::kBallLifeExponent) * 1e6 / 60 / 1800});
  return numbers;
}

}  // namespace bentaxis::external
