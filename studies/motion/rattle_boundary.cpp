// The criterion of the rattle map: rigid teeth keep the sign of their force as long as the drag on
// the block exceeds what the pistons turn it on by. Of pistons that carry the block it is the force
// of one that alone carries what a constant-velocity joint would.
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/rattle.h"
#include "rattle_pieces.h"

namespace bentaxis::study {

std::pair<double, double> rigid_extremes(const PreparedCase& ready) {
  const Case& c = ready.the_case;
  PumpParameters pump = c.pump;
  pump.gear.contact = ToothContact::rigid;
  pump.gear.compliance.reset();
  pump.gear.teeth.reset();
  double arm = 0;  // m, of a wall's force
  if (pump.transfer.kind == TransferKind::pistons) {
    arm = pump.geometry.bore_circle_radius *
          (1 - pump.transfer.wall->from_joint / pump.geometry.piston_length);
    pump.transfer.kind = TransferKind::constant_velocity;
  }
  const analytic::Model model(pump, ready.assumptions(Model::analytic));
  const int pistons = pump.geometry.pistons;
  const double omega = rad_per_second(c.operation.speed_rpm);
  Instant instant;
  instant.ports = c.pressure.ports;
  instant.chamber_pressure.resize(static_cast<std::size_t>(pistons));
  std::vector<double> values(model.layout().size());
  const auto force = [&](double degrees) {
    instant.turn(radians(degrees), omega);
    for (int k = 0; k < pistons; ++k)
      instant.chamber_pressure[static_cast<std::size_t>(k)] =
          ready.pressure(piston_angle_deg(degrees, k + 1, pistons));
    model.reactions(instant, values);
    return arm > 0 ? values[model.layout().carrying()] / arm : values[model.layout().Rcs()];
  };
  // All pistons do the same: an N-th of a turn is all there is.
  constexpr int kAngles = 144;
  const double step = 360.0 / pistons / kAngles;
  std::pair<double, double> at{0, 0}, extremes{INFINITY, -INFINITY};
  for (int i = 0; i < kAngles; ++i) {
    const double value = force(i * step);
    if (value < extremes.first) extremes.first = value, at.first = i * step;
    if (value > extremes.second) extremes.second = value, at.second = i * step;
  }
  constexpr int kBits = 20;
  const auto refine = [&](double middle, double sign, double& extreme) {
    const double found =
        boost::math::tools::brent_find_minima([&](double a) { return sign * force(a); },
                                              middle - step, middle + step, kBits)
            .second;
    extreme = sign * std::min(found, sign * extreme);
  };
  refine(at.first, 1, extremes.first);
  refine(at.second, -1, extremes.second);
  return extremes;
}

BoundaryAgreement boundary_agreement(const RattleMap& map) {
  BoundaryAgreement found;
  const std::vector<double>& speeds = map.options.speed_rpm;
  for (const RattleRow& row : map.rows) {
    const auto carries = [&](std::size_t j) { return row.up[j].kind == RattleClass::carries; };
    for (std::size_t j = 0; j < row.up.size(); ++j) {
      if (!row.up[j].done()) continue;
      ++found.points;
      if (carries(j) == carries_rigidly(row.least[j], row.greatest[j])) ++found.same;
    }
    for (const double criterion : row.boundary_rpm) {
      BoundaryAgreement::Place place{row.delivery_bar, criterion, not_computed(), not_computed()};
      for (std::size_t j = 0; j + 1 < row.up.size(); ++j) {
        if (!row.up[j].done() || !row.up[j + 1].done() || carries(j) == carries(j + 1)) continue;
        const double middle = (speeds[j] + speeds[j + 1]) / 2;
        if (is_computed(place.simulated_rpm) &&
            std::abs(middle - criterion) >= std::abs(place.simulated_rpm - criterion))
          continue;
        place.simulated_rpm = middle;
        place.spacing_rpm = speeds[j + 1] - speeds[j];
      }
      found.places.push_back(place);
    }
  }
  return found;
}

}  // namespace bentaxis::study
