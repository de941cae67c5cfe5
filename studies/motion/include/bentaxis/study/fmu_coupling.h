// A drive or load from an imported FMU (FMI 2.0, 3.0), coupled to the pump in a simulation.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/coupled/simulation.h"
#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::study {

struct UnitChoice {
  std::filesystem::path file;                ///< the .fmu
  std::vector<std::string> connect;          ///< "A=B": A gets B; equal names need none
  std::optional<double> step;                ///< s, between communication points
  std::vector<std::string> parameters = {};  ///< of the FMU: "NAME=VALUE", in its own units
  fmu::Limits limits = {};                   ///< of what the FMU may do
};

/// A value that goes from the FMU to the pump or back.
struct Connection {
  bool to_pump = true;
  std::string pump;        ///< its input ("drive_torque", ..) or a column of its tables
  std::string pump_unit;   ///< "rad/s", "bar"; "": none
  fmu::UnitVariable unit;  ///< output or input
  fmu::Measure from, to;   ///< of the value before and after
  bool automatic = true;   ///< by equal names
};

/// What the FMU can act on: names and units, SI.
struct PumpInput {
  const char* name;
  const char* unit;
};
const std::vector<PumpInput>& pump_inputs();

/// What was exchanged at the communication points of a simulation, in the FMU's own units.
struct UnitRecord {
  std::vector<std::string> columns;  ///< "time_s", then variables of the FMU: "level (m)"
  std::vector<double> values;        ///< row by row
  std::string csv() const;
};

/// An FMU and how it is connected to the pump of a case. Each simulation gets an instance of its
/// own.
class UnitCoupling {
 public:
  /// @param the_case     as its file has it
  /// @param oil_follows  whether its oil is simulated too
  /// @throws InputError where the FMU cannot be run, and naming the connection where the pump or
  ///         the FMU has no such variable, units do not fit, or it is not clear what is meant
  UnitCoupling(const UnitChoice& choice, const Case& the_case, bool oil_follows);
  ~UnitCoupling();

  /// The case as the FMU drives it: [drive] kind as the FMU's outputs want it, its start
  /// likewise.
  const Case& driven() const { return driven_; }
  /// s, between communication points: a whole part of the duration, at most what was chosen.
  double step() const { return step_; }
  const std::vector<Connection>& connections() const { return connections_; }
  const fmu::ImportedUnit& unit() const { return *unit_; }
  /// Parameters of the FMU that were set, with their values in its own units.
  const std::vector<std::pair<fmu::UnitVariable, double>>& parameters() const {
    return parameters_;
  }
  /// Inputs and outputs of the FMU that are not connected.
  std::vector<std::string> loose_inputs() const;
  std::vector<std::string> loose_outputs() const;

  /// A new instance of the FMU as the partner of a simulation. What it says is added to log().
  /// @param parts   of the communication step that are stepped one by one
  /// @param record  if given: filled as the simulation goes on
  coupled::Exchange exchange(int parts = 1, std::shared_ptr<UnitRecord> record = nullptr) const;
  /// Terminates and frees the instances of the exchanges so far, whose simulations are done.
  /// @throws ComputationError where an instance does not come back from that
  void end_instances() const;
  /// What instances have said, without repetition.
  std::vector<std::string> log() const;

 private:
  class Said;
  class Partner;
  struct Instances;
  bool drives(const char* input) const;
  void find_parameters(const std::vector<std::string>& wanted);
  std::unique_ptr<fmu::Slave> instance(const std::string& name) const;
  void find_step(const UnitChoice& choice);
  void find_drive();

  std::shared_ptr<fmu::ImportedUnit> unit_;
  std::vector<Connection> connections_;
  std::vector<std::pair<fmu::UnitVariable, double>> parameters_;
  Case driven_;
  double step_ = 0;
  std::shared_ptr<Instances> instances_;
};

}  // namespace bentaxis::study
