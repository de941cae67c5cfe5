#include "leakage.h"

#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::hydraulics {

Leakage::Leakage(const Case& the_case, const Fluid& fluid, const Chamber& chamber)
    : constant_(the_case.hydraulics->leakage),
      case_state_(fluid.state(fluid.log_pressure(the_case.hydraulics->case_pressure))),
      atmosphere_(fluid.atmosphere()) {
  const HydraulicData& h = *the_case.hydraulics;
  if (!h.gaps) return;
  const GapData& gaps = *h.gaps;
  viscosity_.emplace(h.oil.value(), h.density);
  const double bore = the_case.pump.geometry.bore_diameter;
  const auto cube = [](double x) { return x * x * x; };
  if (gaps.piston_gap > 0)
    piston_ =
        kPi * bore * cube(gaps.piston_gap) * (1 + 1.5 * gaps.eccentricity * gaps.eccentricity) / 12;
  length_ = gaps.piston_gap_length;
  if (gaps.engaged) area_ = kPi / 4 * bore * bore;
  largest_volume_ = chamber.dead() + chamber.swept();
  if (gaps.plate_gap > 0) {
    const PortPlate& plate = the_case.pump.port_plate.value();
    double lands = 1 / std::log(plate.r4 / plate.r3);
    if (plate.r1 > 0) lands += 1 / std::log(plate.r2 / plate.r1);
    plate_ = radians(h.kidney_width_deg) * cube(gaps.plate_gap) / 12 * lands;
  }
  if (gaps.ring_slot_height > 0)
    ring_ = gaps.ring_slot_width * cube(gaps.ring_slot_height) / (12 * gaps.ring_slot_length);
}

double Leakage::piston_gap(double volume) const {
  if (piston_ == 0) return 0;
  return piston_ / (area_ > 0 ? length_ + (largest_volume_ - volume) / area_ : length_);
}

double Leakage::gaps(double volume) const { return plate_ + ring_ + piston_gap(volume); }

Leakage::Parts Leakage::parts(const Fluid::State& chamber, double volume) const {
  const double density = (chamber.density + case_state_.density) / 2;
  Parts parts;
  parts.conductance = constant_ * density * (chamber.pressure - case_state_.pressure);
  if (!viscosity_) return parts;
  const double drive = density * viscosity_->drive(chamber.pressure - atmosphere_,
                                                   case_state_.pressure - atmosphere_);
  parts.piston_gap = piston_gap(volume) * drive;
  parts.plate_gap = plate_ * drive;
  parts.ring_slot = ring_ * drive;
  return parts;
}

double Leakage::value(const Fluid::State& chamber, double volume) const {
  const double density = (chamber.density + case_state_.density) / 2;
  double value = constant_ * density * (chamber.pressure - case_state_.pressure);
  if (viscosity_)
    value += gaps(volume) * density *
             viscosity_->drive(chamber.pressure - atmosphere_, case_state_.pressure - atmosphere_);
  return value;
}

MassFlow Leakage::flow(const Fluid::State& chamber, double volume) const {
  const double drop = chamber.pressure - case_state_.pressure;
  const double density = (chamber.density + case_state_.density) / 2;
  MassFlow flow{constant_ * density * drop,
                constant_ * (density * chamber.pressure +
                             drop * chamber.density / chamber.density_stiffness / 2),
                0};
  if (viscosity_) {
    const double conductance = gaps(volume);
    const double gauge = chamber.pressure - atmosphere_;
    const double drive = viscosity_->drive(gauge, case_state_.pressure - atmosphere_);
    flow.value += conductance * density * drive;
    flow.by_first += conductance * (density * chamber.pressure / viscosity_->dynamic(gauge) +
                                    drive * chamber.density / chamber.density_stiffness / 2);
  }
  return flow;
}

}  // namespace bentaxis::hydraulics
