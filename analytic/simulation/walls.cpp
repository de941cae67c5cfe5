#include "simulation/walls.h"

#include <cmath>

#include "turning.h"

namespace bentaxis::analytic::simulation {

void Walls::find(const Instant& instant, std::vector<WallPath>& paths) const {
  const closed_form::Pump<double>& p = pump_.numbers;
  paths.resize(pump_.phase_sin.size());
  with_state<double>(TransferKind::pistons, p, instant, [&](const auto& state) {
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const double sine = pump_.phase_sin[k], cosine = pump_.phase_cos[k];
      const auto m = closed_form::piston_motion(p.frame, p.piston, state,
                                                state.sine * cosine - state.cosine * sine,
                                                state.cosine * cosine + state.sine * sine);
      const double clearance = pump_.clearance(k);
      const auto at = closed_form::wall_approach(p.wall, m, clearance);
      const double off = (at.distance + clearance) / p.wall.share;
      const double off_rate = at.rate / p.wall.share;
      // off^2 = x^2 + y^2, twice.
      const double speeds = m.axis_first.x * m.axis_first.x + m.axis_first.y * m.axis_first.y;
      const double along = at.x * m.axis_second.x + at.y * m.axis_second.y;
      const double across = off > 0 ? (speeds - off_rate * off_rate) / off : 0;
      paths[k] = {at.distance, at.rate, p.wall.share * (along + across)};
    }
  });
}

double Walls::torsional_stiffness(double torque) const {
  const closed_form::Pump<double>& p = pump_.numbers;
  const double force = torque / arm();
  const double distance = kWallApproach * std::pow(force / p.wall.stiffness, 1 / p.wall.exponent);
  return p.wall.exponent * force / distance * arm() * arm();
}

}  // namespace bentaxis::analytic::simulation
