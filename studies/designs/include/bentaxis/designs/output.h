// What is asked of a design: numbers of a turn, by name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/run.h"

namespace bentaxis::designs {

/// How a curve over the turn becomes a number.
enum class Statistic {
  mean,
  min,
  max,
  peak,   ///< largest magnitude
  rms,    ///< root of the mean square
  range,  ///< max - min
};
inline constexpr int kStatistics = 6;
std::string to_string(Statistic statistic);

/// Where the number is taken from.
enum class Source {
  curve,         ///< statistic of a reaction or derived channel; of a vector its magnitude
  budget,        ///< statistic of a column of the torque budget (results/budget.h)
  derived,       ///< displacement, stroke, ..: follows from the geometry
  validity,      ///< a limit of validity (analytic/validity.h): its worst value, or how long it is
                 ///< violated
  hydraulics,    ///< a line of the hydraulic model's summary
  efficiency,    ///< study::Efficiencies, %
  life,          ///< of the bearings, h (study/bearing_life.h)
  timing,        ///< a verdict on the timing of the ports (study/timing.h)
  plausibility,  ///< number of plausibility warnings
  motion,        ///< what `simulate` answers with (study/motion_answers.h), by one model
};

/// A number asked for. Names:
///   STAT:CHANNEL           "max:Rb1_z1_N", also without its unit "max:Rb1_z1"; of a piston's
///                          channel without the piston's number that of piston 1: "min:Rs_z2"
///   STAT:QUANTITY          magnitude of a vector: "peak:Rb1", "peak:Rs", "peak:Rs_3"
///   STAT:budget.COLUMN     "mean:budget.Td_inertia", likewise without unit
///   displacement_cm3, stroke_mm, ..      geometry (Source::derived)
///   validity.NAME          worst value of the limit of that name; validity.NAME.share of the turn
///   hydraulics.NAME        of the summary: "hydraulics.flow_l_per_min"
///   efficiency.NAME        overall, volumetric, mechanical_mass by energy and mass; overall_iso,
///                          volumetric_iso, mechanical of ISO 4409
///   timing.CODE            value of a verdict on the timing of the ports: "timing.backflow";
///   timing.CODE.excess     the same above its limit, <= 0 where the limit holds
///   timing.warnings        number of these verdicts beyond their limits, without a stated reason
///   plausibility.warnings  number of plausibility warnings without a stated reason
///   life.NAME              of the bearings: life.system_h, life.tapered_P_N, ..
///   motion.NAME            of the simulation of a case with [drive]: motion.reached_s, ..
struct Output {
  std::string name;  ///< as asked for, complete: "max:Rb1_z1_N"
  std::string unit;
  std::string meaning;  ///< for people: what, on which body, by which, where, in which frame
  Source source = Source::curve;
  Statistic statistic = Statistic::mean;  ///< of curve and budget
  std::vector<std::size_t> columns = {};  ///< of a curve: of the row of a ChannelLayout
  std::string item = {};                  ///< of the others: what of it
  bool share = false;                     ///< of validity: of the turn, instead of the worst
  bool excess = false;                    ///< of timing: above its limit, instead of the value

  bool operator==(const Output& other) const { return name == other.name; }
};

/// @throws InputError where there is no such output in this case, naming what there is
Output output(const std::string& name, const Case& base);

/// All outputs of a case that a name can be made of without a statistic, and the channels that
/// statistics can be of: for help texts and completion.
std::vector<std::string> output_names(const Case& base);

/// A statistic of the values of a turn.
double statistic_of(Statistic statistic, const std::vector<double>& values);

/// A number that follows from the geometry and the transfer alone: of Source::derived.
double derived_value(const Output& output, const PumpParameters& pump);
/// The same from quantities that are known already: once for all outputs of a design.
double derived_value(const Output& output, const analytic::DerivedQuantities& derived);
[[deprecated("pass the pump: a universal joint changes the strokes")]] double derived_value(
    const Output& output, const Geometry& geometry);

/// The numbers of one design from the tables of one of its models.
/// @return one per output; not_computed() where the model does not give it
/// @throws InputError, ComputationError
std::vector<double> outputs_of(const std::vector<Output>& outputs, const study::PreparedCase& ready,
                               study::Model model);
/// The same of a case.
/// @param ready  of it; prepared here where an output needs that and it is empty
std::vector<double> outputs_of(const std::vector<Output>& outputs, const Case& the_case,
                               std::optional<study::PreparedCase>& ready, study::Model model);

}  // namespace bentaxis::designs
