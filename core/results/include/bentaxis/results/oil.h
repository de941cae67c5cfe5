// Oil in the chambers of a moving pump: what an integration carries along with the motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/column.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/surroundings.h"

namespace bentaxis {

/// What the oil does to the pump.
struct OilLoads {
  std::vector<double> chamber_pressure;  ///< Pa gauge, one per piston
  PortPressures ports;                   ///< Pa gauge, load the port-plate lands
};

/// Pressures of an oil below which something comes out of it, Pa gauge.
struct OilLimits {
  double saturation = 0;  ///< dissolved air
  double vapour = 0;      ///< vapour
};

/// What a place of the hydraulic circuit does with power.
enum class PowerUse { source, delivered, loss, approximation };

/// A place of the hydraulic circuit, for a balance of energy.
struct OilPlace {
  std::string key, name;  ///< "delivery_port"; "delivery port"
  PowerUse use;
};

/// A value of the oil over time.
using OilColumn = Column;

/// Oil whose state changes with time and with the motion of shaft and block. Rates are per second
/// and finite at any speed, standstill and both directions among them. Both mechanical models are
/// coupled to the same one.
class Oil {
 public:
  virtual ~Oil() = default;

  virtual int pistons() const = 0;
  virtual int states() const = 0;
  /// Which pressures and loads from outside it takes, and from now on those.
  virtual TakesFromOutside takes() const { return {}; }
  virtual void set_inputs(const Surroundings& outside);
  /// The name of 1.0.0.
  [[deprecated("use set_inputs")]] virtual void surround(const Surroundings& outside);
  /// States at time 0, shaft and block at angle 0.
  virtual std::vector<double> start() const = 0;
  /// What the states are: names without blanks, and their meaning; those of no unit have none.
  virtual std::vector<OilColumn> state_columns() const { return {}; }
  /// What each state is measured by: an error of one part in this scale changes pressures by about
  /// the same part of their peak.
  virtual std::vector<double> scales() const = 0;
  /// Block angles in [0, 360), degrees, rising, at which the rates have a kink.
  virtual std::vector<double> edges_deg() const = 0;
  /// Times at which what the pump is connected to changes its law, s.
  virtual std::vector<double> breakpoints() const;
  /// The name of 1.0.0.
  [[deprecated("use breakpoints")]] virtual std::vector<double> knots() const;
  /// States after the block has turned by +360/N degrees and pistons are numbered again, so that
  /// piston k is where piston k was: next[i] = y[order[i]].
  virtual std::vector<int> order_after_period() const = 0;

  /// dy/dt. Uses angles and speeds of both bodies. @return false where a value is not finite
  virtual bool rates(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
                     double* dy) const = 0;
  /// d(dy/dt)/dy, column-major, states() x states().
  virtual void jacobian(double time, const AxisMotion& shaft, const AxisMotion& block,
                        const double* y, double* by_state) const = 0;
  /// What it does to the pump at a state.
  virtual void loads(double time, const AxisMotion& block, const double* y,
                     OilLoads& loads) const = 0;

  // Balances. Oil without states of its own has none of them: places() is empty.
  /// Places through which energy enters, leaves or is lost; the pistons, whose power is what they
  /// do on the oil, are the first.
  virtual std::vector<OilPlace> places() const = 0;
  /// Power at each place, W, then mass flows into the circuit and out of it, kg/s.
  virtual void powers(double time, const AxisMotion& shaft, const AxisMotion& block,
                      const double* y, double* power, double& mass_in, double& mass_out) const = 0;
  /// Energy, J, and mass, kg, that the circuit holds.
  virtual void stored(double time, const AxisMotion& shaft, const AxisMotion& block,
                      const double* y, double& energy, double& mass) const = 0;

  /// None where the oil is no oil but a curve.
  virtual std::optional<OilLimits> limits() const { return std::nullopt; }

  /// What a table over time has of it, and its values.
  virtual std::vector<OilColumn> columns() const = 0;
  virtual void row(double time, const AxisMotion& shaft, const AxisMotion& block, const double* y,
                   double* values) const = 0;
};

}  // namespace bentaxis
