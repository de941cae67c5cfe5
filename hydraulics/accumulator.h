// A gas spring.
#pragma once

#include <cmath>

#include "bentaxis/pump/hydraulic_data.h"
#include "fluid.h"

namespace bentaxis::hydraulics {

/// Oil beside a gas of p V^n = const at the same pressure P, over s = ln(P/P0). Below the precharge
/// the gas fills its volume and expands no further; a hundredth of that volume is oil that always
/// stays.
class Accumulator {
 public:
  Accumulator(const AccumulatorData& data, const Fluid& fluid)
      : volume_(data.gas_volume),
        exponent_(data.exponent),
        atmosphere_(fluid.atmosphere()),
        precharge_(fluid.log_pressure(data.precharge)) {}

  struct Oil {
    double volume = 0;             ///< m3
    double first = 0, second = 0;  ///< its derivatives with respect to s
  };
  Oil oil(double s) const {
    const double compressed = s - precharge_;
    if (!(compressed > 0)) return {kResidual * volume_, 0, 0};
    const double gas = volume_ * std::exp(-compressed / exponent_);
    return {kResidual * volume_ + volume_ - gas, gas / exponent_, -gas / exponent_ / exponent_};
  }
  /// Of the gas, J: the integral of gauge pressure x oil volume from the precharge.
  double energy(double s) const {
    const double compressed = s - precharge_;
    if (!(compressed > 0)) return 0;
    const double power = 1 - 1 / exponent_;
    const double absolute = atmosphere_ * std::exp(precharge_) * volume_ / exponent_ *
                            (power == 0 ? compressed : std::expm1(power * compressed) / power);
    return absolute - atmosphere_ * (oil(s).volume - kResidual * volume_);
  }

 private:
  static constexpr double kResidual = 0.01;
  double volume_, exponent_, atmosphere_, precharge_;
};

}  // namespace bentaxis::hydraulics
