// Where hydraulic power comes from and where it goes.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "bentaxis/results/oil.h"

namespace bentaxis::hydraulics {

/// Places of the circuit. Oil that flows from one pressure to another loses the mass flow times the
/// difference of the oil's pressure potential, the integral of dP/density; what it carries over a
/// border is the mass flow times the potential there, 0 at atmospheric pressure. docs/hydraulics.md
/// has the equations.
enum class Place {
  pistons,            ///< what the pistons do on the oil, gauge pressure
  tank,               ///< what the oil taken in carries: none at a suction pressure of 0
  load,               ///< what goes into the load; in a closed loop less what comes out of it
  drain,              ///< what leakage carries into the case: none at a case pressure of 0
  suction_line,       ///< loss of the pipe to the suction port
  suction_port,       ///< loss of what flows from the suction port into the chambers
  suction_backflow,   ///< loss of what flows back
  delivery_port,      ///< loss of what flows from the chambers into the delivery port
  delivery_backflow,  ///< loss of what flows back
  conductance,        ///< loss of leakage through the constant conductance
  piston_gap,         ///< loss of leakage between piston and bore
  plate_gap,          ///< loss of leakage between block and port plate
  ring_slot,          ///< loss of leakage through the joint of the piston ring
  delivery_line,      ///< loss by friction in the delivery line
  damped_waves,       ///< what the delivery line's model takes out of waves above its bandwidth
  air,                ///< of dissolved air that comes out and dissolves late (cavitation = "rate")
  line_density,       ///< no loss: oil in the lines has one density there, another at their ends
  relief_valve,       ///< loss over the relief valve beside the load
  accumulator_inlet,  ///< loss of what flows into the accumulator and out of it
  charge_valves,      ///< loss of what a charge supply feeds into a closed loop
};
constexpr int kPlaces = 20;

/// By place, W or J.
class PowerBudget {
 public:
  double& operator[](Place place) { return values_[static_cast<int>(place)]; }
  double operator[](Place place) const { return values_[static_cast<int>(place)]; }

 private:
  std::array<double, kPlaces> values_ = {};
};

using bentaxis::PowerUse;
PowerUse use_of(Place place);
const char* name_of(PowerUse use);
/// For readers: "delivery port, backflow"; and as a part of a column's name: "delivery_backflow".
const char* name_of(Place place);
const char* key_of(Place place);
/// The place of a key; none where no place has it.
std::optional<Place> place_of(std::string_view key);

/// Sources less everything else: 0 but for what is stored, over a period that repeats itself 0.
double left_over(const PowerBudget& budget);
/// Sum of all losses.
double losses(const PowerBudget& budget);

/// The energy balance of the pump between its pistons and its two ports, without the lines, valves
/// and volumes that the ports lead to. W, or J where the budget is in J; the mean over a period.
///
///   pistons = useful + to_case + dissipated
///
/// Every statement of hydraulic power and of efficiency stands on it (docs/budgets.md).
struct PumpPower {
  double pistons = 0;  ///< what the pistons do on the oil, gauge pressure
  /// What the oil carries out through the delivery port less what it carries in through the suction
  /// port, mass flow times pressure potential h: sum(m_d) h(P_d) - sum(m_s) h(P_s). For one
  /// constant density it is flow times pressure; h contains the work of compression as well.
  double useful = 0;
  double to_case = 0;     ///< what leakage carries into the case: none at a case pressure of 0
  double dissipated = 0;  ///< losses in ports, gaps and by air that dissolves late: not negative

  double lost() const { return pistons - useful; }
};
/// From a budget over a period that repeats itself.
PumpPower pump_power(const PowerBudget& budget);

}  // namespace bentaxis::hydraulics
