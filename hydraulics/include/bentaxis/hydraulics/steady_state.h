// Pressures in the chambers and in the delivery line of a running pump.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/hydraulics/power.h"
#include "bentaxis/hydraulics/timing.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::hydraulics {

class Network;

/// What an engineer reads off a turn. SI, pressures gauge.
struct Summary {
  /// Whether the oil drives the pump, backwards: a motor. Over the mirror image of its port plate a
  /// pump delivers backwards.
  bool motors() const { return ideal_flow < 0 && flow < 0; }

  double displacement = 0;  ///< m3 per revolution, N A stroke
  double ideal_flow = 0;    ///< m3/s, displacement x speed, below 0 backwards
  double density = 0;       ///< kg/m3, in the suction port: that of all volume flows here
  double mass_flow = 0;     ///< kg/s, mean, to the load
  double flow = 0;          ///< m3/s, the same / density
  /// flow / ideal_flow by magnitude, below 0 where more leaks than is delivered; of a motor
  /// ideal_flow / flow.
  double volumetric_efficiency = 0;
  double leakage = 0;  ///< m3/s, mean, of all chambers
  double delivery_mean = 0, delivery_least = 0,
         delivery_greatest = 0;  ///< Pa, of the delivery volume
  /// (max - min)/mean of a flow averaged over a quarter of a degree, so that what passes in
  /// the instant at which a port opens does not decide it.
  double flow_ripple = 0;  ///< of the flow to the load, what the user's line sees
  double port_flow_ripple =
      0;  ///< of the flow through the delivery port, into the volume behind it
  double chamber_least = 0, chamber_least_deg = 0;        ///< Pa; angle of the chamber
  double chamber_greatest = 0, chamber_greatest_deg = 0;  ///< Pa
  double overshoot = 0;                                   ///< Pa, chamber_greatest - delivery_mean
  double undershoot = 0;                                  ///< Pa, suction pressure - chamber_least
  /// J per turn forwards, of the pistons on the oil at gauge pressure: sum of -p dV; times the
  /// speed it is their power.
  double work = 0;
  double mass_in = 0, mass_out = 0;  ///< kg per turn: suction port; delivery port and leakage
  /// Degrees of a turn in which a chamber is open to both ports (negative overlap), or to neither.
  double both_open_deg = 0, both_closed_deg = 0;
  /// Degrees of a turn in which the pressure of a chamber is below that at which dissolved air
  /// comes out, and below that at which oil boils, whether or not the oil's law has air and vapour.
  double below_saturation_deg = 0, below_vapour_deg = 0;
  double saturation = 0, vapour = 0;  ///< Pa gauge, these two pressures
  LoadKind load = LoadKind::orifice;
  /// Of an orifice its area, m2; of a laminar load its conductance, m3/(s Pa); of a relief valve
  /// its absolute cracking pressure, Pa; 0 for a line held at a pressure and for a given flow.
  double load_size = 0;
  double atmosphere = 0;  ///< Pa absolute
};

/// A harmonic of the shaft's angle, as amplitudes. In the periodic state the outlet has multiples
/// of N only.
struct Order {
  int order = 0;             ///< per turn of the shaft
  double flow = 0;           ///< kg/s, to the load
  double delivery = 0;       ///< Pa, in the delivery volume
  double load_pressure = 0;  ///< Pa, in front of the load: the same without a delivery line
};

/// How the periodic state was found.
struct Convergence {
  int iterations = 0;    ///< Newton steps
  double residual = 0;   ///< largest difference of s = ln P between end and start, and of the mean
  double tolerance = 0;  ///< error of s allowed per step in the end
  std::size_t pieces = 0;           ///< cubic ones of the curve, per turn
  long steps = 0, evaluations = 0;  ///< of all time integrations
  double seconds = 0;
};

/// The periodic steady state: every chamber has one and the same curve, shifted by 360/N degrees.
struct SteadyState {
  std::shared_ptr<const ComputedPressure> computed;  ///< of a chamber, with its error
  PressureCurve chamber;   ///< the same at the angles of the table; Pa gauge
  PressureCurve delivery;  ///< of the delivery volume, at the same angles
  ResultTable table;       ///< pressures, flows, volume and openings at the same angles
  Summary summary;
  std::vector<Place> places;  ///< that the circuit has
  /// J per turn of a chamber: area of its p-V diagram, the integral of -p dV, of the curve.
  double indicated_work = 0;
  std::vector<Order> orders;  ///< kOrders multiples of N
  Timing timing;              ///< of the ports
  Convergence convergence;
  /// Pa, of a spline through the `points` of the case from the computed curve; 0 without.
  double spline_error = 0;
  /// At theta = 0: ln(P/P0) of chambers 1..N and of the delivery volume, then what the lines have.
  std::vector<double> states;
  /// What power_by_place starts from: the equations, and the states and the load's size after one
  /// correction more, with which stored energy returns more closely.
  std::shared_ptr<const Network> equations;
  std::vector<double> corrected_states;
  double corrected_load_size = 0;
};

/// Multiples of N.
constexpr int kOrders = 20;

/// Where the search starts; the answer must not depend on it.
struct Start {
  double chambers = 0;   ///< Pa gauge, in all chambers
  double line = 0;       ///< Pa gauge
  double load_size = 0;  ///< as in Summary
};

/// Finds the periodic state directly: Newton's method on the map of one N-th of a turn, after which
/// chamber k must have the pressure chamber k-1 began with. Unknowns are the pressures at theta = 0
/// and the size of the load where that is sought; the last equation is the mean delivery pressure
/// asked for. Derivatives are the forward sensitivities of the same integration.
/// @throws InputError at standstill, backwards (motoring) where neither a supply nor a load of
/// given size is at the delivery port, without stroke, or if the case has no
///         [hydraulics]
/// Where this finds nothing it is tried at other tolerances and from states of neighbouring speeds
/// and delivery pressures.
/// @throws ComputationError naming the operating point where no state is found, e.g. because
///         leakage takes all of the flow
SteadyState steady_state(const Case& the_case, const std::optional<Start>& start = {},
                         const Progress& progress = {});

/// From rest: at theta = 0 all chambers have the suction pressure and the line that of the
/// surroundings; the shaft turns at full speed at once. Columns theta_deg (falls through all
/// turns), p_1_bar, p_delivery_bar; `samples` rows per 360/N degrees.
/// @param load_size  as in Summary; that of the periodic state, say
ResultTable transient_from_rest(const Case& the_case, double load_size, int revolutions,
                                int samples = 72, const Progress& progress = {});

/// Estimated error of the computed chamber pressure, over its peak.
double pressure_error(const SteadyState& state);
/// Whether that is within `curve_error` of the case. Where it is not, steady_state() has noted the
/// state in the AccuracyLog.
bool is_accurate(const Case& the_case, const SteadyState& state);

/// Puts the computed curve into the case's pressure, where both mechanical models find it; where
/// the load sets the delivery pressure its mean too, which loads the lands of the port plate.
void give_to(Case& the_case, const SteadyState& state);

/// Mean power by place, W, with one period more of integration. Sources and the rest are equal to
/// about 1e-10 of the pistons' power at the default tolerance.
/// @throws ComputationError
PowerBudget power_by_place(const SteadyState& state, const Progress& progress = {});

/// Amplitudes of orders 1..count of dp/dtheta over the turn of a chamber, Pa per rad.
std::vector<double> orders_of_rate(const ComputedPressure& chamber, int count);

/// Density of the oil, kg/m3, at a gauge pressure, Pa.
double density(const SteadyState& state, double gauge);

/// Effective bulk modulus of the oil, Pa, at a gauge pressure, Pa.
double effective_bulk_modulus(const SteadyState& state, double gauge);

/// The summary as lines.
struct Line {
  std::string name;
  double value = 0;
  std::string unit;
  std::string key;    ///< one word with its unit: "flow_l_per_min"
  bool mean = false;  ///< NeighbourMeans have it
};
std::vector<Line> lines(const SteadyState& state);

}  // namespace bentaxis::hydraulics
