#include "fluid.h"

#include <cmath>

namespace bentaxis::hydraulics {

Fluid::Fluid(const HydraulicData& data)
    : atmosphere_(data.atmosphere),
      bulk_modulus_(data.bulk_modulus),
      air_share_(data.air_share),
      inverse_exponent_(1 / data.air_exponent),
      reference_density_(data.density * (1 - data.air_share)) {}

Fluid::State Fluid::state(double s) const {
  State result;
  result.pressure = atmosphere_ * std::exp(s);
  const double strain = result.pressure / bulk_modulus_;
  const double oil = (1 - air_share_) * std::exp(-(result.pressure - atmosphere_) / bulk_modulus_);
  const double air = air_share_ * std::exp(-s * inverse_exponent_);
  const double volume = oil + air;
  const double slope = oil * strain + air * inverse_exponent_;  // -dv/ds
  const double curvature =
      oil * strain * (strain - 1) + air * inverse_exponent_ * inverse_exponent_;
  result.density = reference_density_ / volume;
  result.stiffness = volume / slope;
  result.d_stiffness = volume * curvature / (slope * slope) - 1;
  return result;
}

double Fluid::log_pressure(double gauge) const { return std::log1p(gauge / atmosphere_); }

double Fluid::gauge(double s) const { return atmosphere_ * std::expm1(s); }

double Fluid::effective_bulk_modulus(double gauge) const {
  const State at = state(log_pressure(gauge));
  return at.stiffness * at.pressure;
}

}  // namespace bentaxis::hydraulics
