#include "fluid.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>

namespace bentaxis::hydraulics {
namespace {

// Widths b of the rounded kinks, in ln of a pressure.
constexpr double kSaturationWidth = 0.02;
constexpr double kVapourWidth = 0.002;
// Beyond as many widths the rounding is below round-off, or exp(t/b) alone is left of it.
constexpr double kBeyond = 40;
// Intervals of s over which the bubbles' volume is summed up by 7 points to round-off: none longer
// than the first, and near vapour pressure, where it grows without bound but for the rounding, in
// proportion to the distance.
constexpr double kLongestInterval = 0.05;
constexpr double kIntervalPerDistance = 0.25;
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
      boils_(data.cavitation != Cavitation::ignored && data.vapour_pressure > 0),
      dissolves_(data.cavitation != Cavitation::ignored && data.dissolved_air > 0),
      air_dissolves_(data.oil_law == OilLaw::dissolving_air),
      dowson_higginson_(data.oil_law == OilLaw::dowson_higginson),
      constant_density_(data.oil_law == OilLaw::constant_density),
      dissolved_pressure_(data.dissolved_pressure),
      compressibility_(data.compressibility),
      compressibility_limited_(data.compressibility + data.compressibility_decrease),
      lowest_pressure_(data.lowest_pressure) {
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
  if (constant_density_) {
    air_share_ = 0;
    reference_density_ = data.density;
  }
  if (boils_ || dissolves_ || air_dissolves_) sum_up_bubbles();
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

Fluid::Smooth Fluid::oil_volume(double pressure) const {
  const double over = pressure - atmosphere_;
  if (dowson_higginson_) {
    const double dense = 1 + compressibility_limited_ * over;
    const double first = (1 - air_share_) * pressure * compressibility_ / (dense * dense);
    return {(1 - air_share_) * (1 - compressibility_ * over / dense), first,
            first * (2 * compressibility_limited_ * pressure / dense - 1)};
  }
  const double modulus = bulk_modulus_ + modulus_slope_ * over;
  const double strain = pressure / modulus;
  const double value = (1 - air_share_) * (modulus_slope_ == 0 ? std::exp(-over / bulk_modulus_)
                                                               : std::pow(modulus / bulk_modulus_,
                                                                          -1 / modulus_slope_));
  return {value, value * strain, value * strain * (strain * (1 + modulus_slope_) - 1)};
}

Fluid::Smooth Fluid::undissolved(double pressure) const {
  const double way = (pressure - atmosphere_) / dissolved_pressure_;
  if (way <= 0) return {1, 0, 0};
  if (way >= 1) return {0, 0, 0};
  const double by_s = pressure / dissolved_pressure_;  // d(way)/ds, and its own derivative
  const double slope = -6 * way * (1 - way);
  return {1 - way * way * (3 - 2 * way), slope * by_s, (slope - 6 * (1 - 2 * way) * by_s) * by_s};
}

void Fluid::add_oil_and_air(double pressure, const Smooth& q, Volumes& v) const {
  v.oil = oil_volume(pressure);
  v.air.value = air_share_ * std::exp(-q.value * inverse_exponent_);
  v.air.first = v.air.value * inverse_exponent_ * q.first;
  v.air.second =
      v.air.value * inverse_exponent_ * (inverse_exponent_ * q.first * q.first - q.second);
  if (!air_dissolves_) return;
  const Smooth left = undissolved(pressure), air = v.air;
  v.air.value = air.value * left.value;
  v.air.first = air.first * left.value - air.value * left.first;
  v.air.second = air.second * left.value - 2 * air.first * left.first + air.value * left.second;
}

Fluid::Volumes Fluid::volumes(double s, double pressure) const {
  Volumes v;
  const Smooth q = air_pressure(s);
  add_oil_and_air(pressure, q, v);
  if (dissolves_) {
    const Smooth w = under_saturation(q);
    const double grown = std::exp(w.value);
    v.released.value = released_scale_ * std::expm1(w.value);
    v.released.first = -released_scale_ * grown * w.first;
    v.released.second = released_scale_ * grown * (w.first * w.first + w.second);
  }
  return v;
}

Fluid::State Fluid::state_of(const Volumes& v, double pressure) const {
  State result;
  result.pressure = pressure;
  const double volume = v.oil.value + v.air.value + v.released.value;
  const double slope = v.oil.first + v.air.first + v.released.first;  // -dv/ds
  const double curvature = v.oil.second + v.air.second + v.released.second;
  result.density = reference_density_ / volume;
  result.stiffness = volume / slope;
  result.d_stiffness = volume * curvature / (slope * slope) - 1;
  result.density_stiffness = result.stiffness;
  return result;
}

Fluid::State Fluid::state(double s) const {
  const double pressure = atmosphere_ * std::exp(s);
  if (constant_density_) {
    const double stiffness = bulk_modulus_ / pressure;
    return {pressure, reference_density_, stiffness, -stiffness,
            std::numeric_limits<double>::infinity()};
  }
  return state_of(volumes(s, pressure), pressure);
}

Fluid::Mixture Fluid::mixture(double s, double air_out) const {
  const double pressure = atmosphere_ * std::exp(s);
  const Smooth q = air_pressure(s);
  Volumes v;
  add_oil_and_air(pressure, q, v);
  const double all = all_released(q);
  v.released.value = all * air_out;
  v.released.first = v.released.value * q.first;
  v.released.second = v.released.value * (q.first * q.first - q.second);
  Mixture result;
  static_cast<State&>(result) = state_of(v, pressure);
  result.swelling = all / (v.oil.value + v.air.value + v.released.value);
  result.d_swelling = result.swelling * (1 / result.stiffness - q.first);
  result.swelling_by_air = -result.swelling * result.swelling;
  result.stiffness_by_air = result.stiffness * result.swelling * (1 - result.stiffness * q.first);
  return result;
}

Fluid::AirOut Fluid::equilibrium(double s) const {
  if (!dissolves_) return {};
  // As much as gives the volume of the law in equilibrium, rounding included.
  const Smooth q = air_pressure(s);
  const Smooth w = under_saturation(q);
  const double pressed = std::exp(q.value - log_saturation_);
  return {std::expm1(w.value) * pressed,
          (std::exp(w.value) * w.first + std::expm1(w.value) * q.first) * pressed};
}

double Fluid::log_pressure(double gauge) const { return std::log1p(gauge / atmosphere_); }

double Fluid::gauge(double s) const { return atmosphere_ * std::expm1(s); }

double Fluid::effective_bulk_modulus(double gauge) const {
  const State at = state(log_pressure(gauge));
  return at.stiffness * at.pressure;
}

double Fluid::oil_potential(double pressure) const {
  if (constant_density_) return pressure - atmosphere_;
  if (dowson_higginson_) {
    const double over = pressure - atmosphere_, limited = compressibility_limited_;
    return (1 - air_share_) * ((1 - compressibility_ / limited) * over +
                               compressibility_ / (limited * limited) * std::log1p(limited * over));
  }
  const double strain = (pressure - atmosphere_) / bulk_modulus_;
  const double oil = (1 - air_share_) * bulk_modulus_;
  if (modulus_slope_ == 0) return -oil * std::expm1(-strain);
  const double grown = std::log1p(modulus_slope_ * strain);
  const double power = 1 - 1 / modulus_slope_;  // of the integral
  return oil / modulus_slope_ * (power == 0 ? grown : std::expm1(power * grown) / power);
}

Fluid::Bubbles Fluid::bubbles_between(double from, double to) const {
  using Rule = boost::math::quadrature::gauss<double, 7>;
  Bubbles sum;
  const double middle = (from + to) / 2, half = (to - from) / 2;
  const auto add = [&](double s, double weight) {
    const double pressure = atmosphere_ * std::exp(s);
    const Volumes v = volumes(s, pressure);
    sum.air += weight * pressure * v.air.value;
    sum.released += weight * pressure * v.released.value;
    sum.all += weight * pressure * all_released(air_pressure(s));
  };
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    const double off = half * Rule::abscissa()[i], weight = half * Rule::weights()[i];
    add(middle + off, weight);
    if (off != 0) add(middle - off, weight);
  }
  return sum;
}

void Fluid::sum_up_bubbles() {
  const double all_dissolved =
      air_dissolves_ ? std::log1p(dissolved_pressure_ / atmosphere_) : kHighest;
  for (double s = boils_ ? log_vapour_ - kBeyond * kVapourWidth : kLowest; s < kHighest;) {
    places_.push_back(s);
    const double distance = boils_ ? std::abs(s - log_vapour_) : kHighest;
    const double next =
        s + std::clamp(kIntervalPerDistance * distance, kVapourWidth / 2, kLongestInterval);
    // Atmospheric pressure, where the potential is exactly 0, and where no air is left.
    if (s < 0 && next > 0)
      s = 0;
    else if (s < all_dissolved && next > all_dissolved)
      s = all_dissolved;
    else
      s = next;
  }
  sums_.resize(places_.size());
  const auto add = [](Bubbles& to, const Bubbles& more, double sign) {
    to.air += sign * more.air;
    to.released += sign * more.released;
    to.all += sign * more.all;
  };
  // Downwards: the last intervals above vapour pressure are the largest by far.
  for (std::size_t i = places_.size() - 1; i > 0; --i) {
    sums_[i - 1] = sums_[i];
    add(sums_[i - 1], bubbles_between(places_[i - 1], places_[i]), -1);
  }
  const Bubbles at_atmosphere = bubble_potential(0);
  for (Bubbles& sum : sums_) add(sum, at_atmosphere, -1);
}

Fluid::Bubbles Fluid::bubble_potential(double s) const {
  if (places_.empty()) {  // entrained air alone
    const double power = 1 - inverse_exponent_;
    return {air_share_ * atmosphere_ * (power == 0 ? s : std::expm1(power * s) / power), 0, 0};
  }
  const auto after = std::upper_bound(places_.begin() + 1, places_.end() - 1, s);
  const auto i = static_cast<std::size_t>(after - places_.begin()) - 1;
  const Bubbles more = bubbles_between(places_[i], s);
  return {sums_[i].air + more.air, sums_[i].released + more.released, sums_[i].all + more.all};
}

double Fluid::potential_at(double s, double pressure) const {
  const Bubbles bubbles = bubble_potential(s);
  return (oil_potential(pressure) + bubbles.air + bubbles.released) / reference_density_;
}

double Fluid::potential(double s) const { return potential_at(s, atmosphere_ * std::exp(s)); }

double Fluid::potential(double s, const State& there) const {
  return potential_at(s, there.pressure);
}

double Fluid::potential(double s, double air_out) const {
  const Bubbles bubbles = bubble_potential(s);
  return (oil_potential(atmosphere_ * std::exp(s)) + bubbles.air + air_out * bubbles.all) /
         reference_density_;
}

double Fluid::potential_by_air(double s) const {
  return bubble_potential(s).all / reference_density_;
}

double Fluid::released_air(double s) const {
  return dissolves_ ? -std::expm1(-under_saturation(air_pressure(s)).value) : 0;
}

double Fluid::bubbles(double s) const {
  if (constant_density_) return 0;
  const Volumes v = volumes(s, atmosphere_ * std::exp(s));
  const double bubbles = v.air.value + v.released.value;
  return bubbles / (v.oil.value + bubbles);
}

}  // namespace bentaxis::hydraulics
