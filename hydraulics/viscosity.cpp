#include "viscosity.h"

#include <cmath>

namespace bentaxis::hydraulics {
namespace {

constexpr double kKelvin = 273.15;
constexpr double kSquareMillimetre = 1e-6;
constexpr double kWalther = 0.7;

double walther(double viscosity) {
  return std::log(std::log(viscosity / kSquareMillimetre + kWalther));
}

double at_temperature(const OilData& oil) {
  const double cold = std::log(40 + kKelvin), hot = std::log(100 + kKelvin);
  const double share = (std::log(oil.temperature + kKelvin) - cold) / (hot - cold);
  const double low = walther(oil.viscosity_40), high = walther(oil.viscosity_100);
  return kSquareMillimetre * (std::exp(std::exp(low + share * (high - low))) - kWalther);
}

}  // namespace

Viscosity::Viscosity(const OilData& oil, double density)
    : kinematic_(at_temperature(oil)),
      at_atmosphere_(kinematic_ * density),
      alpha_(oil.pressure_viscosity) {}

double Viscosity::dynamic(double gauge) const { return at_atmosphere_ * std::exp(alpha_ * gauge); }

double Viscosity::drive(double high, double low) const {
  if (alpha_ == 0) return (high - low) / at_atmosphere_;
  return -std::exp(-alpha_ * low) * std::expm1(-alpha_ * (high - low)) / (alpha_ * at_atmosphere_);
}

}  // namespace bentaxis::hydraulics
