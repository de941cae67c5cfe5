#include "fluid.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace bentaxis::hydraulics {
namespace {

// Widths b of the rounded kinks, in ln of a pressure.
constexpr double kSaturationWidth = 0.02;
constexpr double kVapourWidth = 0.002;
// Beyond as many widths the rounding is below round-off, or exp(t/b) alone is left of it.
constexpr double kBeyond = 40;
// Stretches of s over which the bubbles' volume is summed up by 7 points to round-off: none longer
// than the first, and near vapour pressure, where it grows without bound but for the rounding, in
// proportion to the distance.
constexpr double kLongestStretch = 0.05;
constexpr double kStretchPerDistance = 0.25;
// ln of the lowest and highest pressure over P0 that sums are kept for; beyond, they go on.
constexpr double kLowest = -40, kHighest = 12;

// b ln(1 + exp(t/b)) and its derivatives with respect to t.
struct Ramp {
  double value, first, second;
};
Ramp ramp(double t, double width) {
  const double u = t / width;
  if (u > kBeyond) return {t, 1, 0};
  const double e = std::exp(u);
  const double share = e / (1 + e);
  return {width * std::log1p(e), share, share / (1 + e) / width};
}

}  // namespace

Fluid::Fluid(const HydraulicData& data)
    : atmosphere_(data.atmosphere),
      bulk_modulus_(data.bulk_modulus),
      modulus_slope_(data.bulk_modulus_slope),
      air_share_(data.air_share),
      inverse_exponent_(1 / data.air_exponent),
      reference_density_(data.density * (1 - data.air_share)),
      saturation_(data.saturation_pressure),
      vapour_(data.vapour_pressure),
      boils_(data.cavitation == Cavitation::equilibrium && data.vapour_pressure > 0),
      dissolves_(data.cavitation == Cavitation::equilibrium && data.dissolved_air > 0) {
  const double vapour = boils_ ? vapour_ : 0;
  const double air_at_saturation = saturation_ + atmosphere_ - vapour;
  if (boils_) {
    log_vapour_ = std::log(vapour / atmosphere_);
    vapour_over_air_ = std::log(vapour / (atmosphere_ - vapour));
  }
  if (dissolves_) {
    log_saturation_ = std::log(air_at_saturation / (atmosphere_ - vapour));
    released_scale_ = (1 - air_share_) * data.dissolved_air * atmosphere_ / air_at_saturation;
  }
  if (boils_ || dissolves_) sum_up_bubbles();
}

Fluid::Smooth Fluid::air_pressure(double s) const {
  if (!boils_) return {s, 1, 0};
  // P - Pv = Pv (exp(w) - 1) with w = ln(P/Pv), rounded off where that gets small.
  const double over = s - log_vapour_;
  if (over < -kBeyond * kVapourWidth)
    return {vapour_over_air_ + std::log(kVapourWidth) + over / kVapourWidth, 1 / kVapourWidth, 0};
  const Ramp w = ramp(over, kVapourWidth);
  const double above = std::expm1(w.value);
  const double factor = (1 + above) / above;  // d ln(exp(w) - 1)/dw
  return {vapour_over_air_ + std::log(above), factor * w.first,
          factor * (w.second - (factor - 1) * w.first * w.first)};
}

Fluid::Smooth Fluid::under_saturation(const Smooth& q) const {
  const Ramp w = ramp(log_saturation_ - q.value, kSaturationWidth);
  return {w.value, -w.first * q.first, w.second * q.first * q.first - w.first * q.second};
}

Fluid::Volumes Fluid::volumes(double s, double pressure) const {
  Volumes v;
  const double over = pressure - atmosphere_;
  const double modulus = bulk_modulus_ + modulus_slope_ * over;
  const double strain = pressure / modulus;
  v.oil.value = (1 - air_share_) * (modulus_slope_ == 0
                                        ? std::exp(-over / bulk_modulus_)
                                        : std::pow(modulus / bulk_modulus_, -1 / modulus_slope_));
  v.oil.first = v.oil.value * strain;
  v.oil.second = v.oil.value * strain * (strain * (1 + modulus_slope_) - 1);
  const Smooth q = air_pressure(s);
  v.air.value = air_share_ * std::exp(-q.value * inverse_exponent_);
  v.air.first = v.air.value * inverse_exponent_ * q.first;
  v.air.second =
      v.air.value * inverse_exponent_ * (inverse_exponent_ * q.first * q.first - q.second);
  if (dissolves_) {
    const Smooth w = under_saturation(q);
    const double grown = std::exp(w.value);
    v.released.value = released_scale_ * std::expm1(w.value);
    v.released.first = -released_scale_ * grown * w.first;
    v.released.second = released_scale_ * grown * (w.first * w.first + w.second);
  }
  return v;
}

Fluid::State Fluid::state(double s) const {
  State result;
  result.pressure = atmosphere_ * std::exp(s);
  const Volumes v = volumes(s, result.pressure);
  const double volume = v.oil.value + v.air.value + v.released.value;
  const double slope = v.oil.first + v.air.first + v.released.first;  // -dv/ds
  const double curvature = v.oil.second + v.air.second + v.released.second;
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

double Fluid::oil_potential(double pressure) const {
  const double strain = (pressure - atmosphere_) / bulk_modulus_;
  const double oil = (1 - air_share_) * bulk_modulus_;
  if (modulus_slope_ == 0) return -oil * std::expm1(-strain);
  const double grown = std::log1p(modulus_slope_ * strain);
  const double power = 1 - 1 / modulus_slope_;  // of the integral
  return oil / modulus_slope_ * (power == 0 ? grown : std::expm1(power * grown) / power);
}

double Fluid::bubbles_between(double from, double to) const {
  const auto integrand = [&](double s) {
    const double pressure = atmosphere_ * std::exp(s);
    const Volumes v = volumes(s, pressure);
    return pressure * (v.air.value + v.released.value);
  };
  return boost::math::quadrature::gauss<double, 7>::integrate(integrand, from, to);
}

void Fluid::sum_up_bubbles() {
  for (double s = boils_ ? log_vapour_ - kBeyond * kVapourWidth : kLowest; s < kHighest;) {
    places_.push_back(s);
    const double distance = boils_ ? std::abs(s - log_vapour_) : kHighest;
    const double next =
        s + std::clamp(kStretchPerDistance * distance, kVapourWidth / 2, kLongestStretch);
    s = s < 0 && next > 0 ? 0 : next;  // atmospheric pressure, where the potential is exactly 0
  }
  sums_.resize(places_.size());
  // Downwards: the last stretches above vapour pressure are the largest by far.
  for (std::size_t i = places_.size() - 1; i > 0; --i)
    sums_[i - 1] = sums_[i] - bubbles_between(places_[i - 1], places_[i]);
  const double at_atmosphere = bubble_potential(0);
  for (double& sum : sums_) sum -= at_atmosphere;
}

double Fluid::bubble_potential(double s) const {
  if (places_.empty()) {  // entrained air alone
    const double power = 1 - inverse_exponent_;
    return air_share_ * atmosphere_ * (power == 0 ? s : std::expm1(power * s) / power);
  }
  const auto after = std::upper_bound(places_.begin() + 1, places_.end() - 1, s);
  const auto i = static_cast<std::size_t>(after - places_.begin()) - 1;
  return sums_[i] + bubbles_between(places_[i], s);
}

double Fluid::potential(double s) const {
  return (oil_potential(atmosphere_ * std::exp(s)) + bubble_potential(s)) / reference_density_;
}

double Fluid::released_air(double s) const {
  return dissolves_ ? -std::expm1(-under_saturation(air_pressure(s)).value) : 0;
}

double Fluid::bubbles(double s) const {
  const Volumes v = volumes(s, atmosphere_ * std::exp(s));
  const double bubbles = v.air.value + v.released.value;
  return bubbles / (v.oil.value + bubbles);
}

}  // namespace bentaxis::hydraulics
