// Functional Mock-up Units of others (FMI 2.0, 3.0) for co-simulation: unpacked, read, run.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bentaxis::fmu {

/// A unit of measure over SI's base units: value in SI = factor x value + offset.
struct Measure {
  std::array<int, 8> exponents{};  ///< of kg, m, s, A, K, mol, cd, rad
  double factor = 1, offset = 0;
};
/// Whether a value of one can be had in the other. Radians count: 1/s is no speed of rotation.
bool same_quantity(const Measure& a, const Measure& b);
double converted(double value, const Measure& from, const Measure& to);
/// By its usual name ("rad/s", "rpm", "N.m", "Nm", "bar", "L/min", ..; "", "-", "1": none).
std::optional<Measure> measure_named(std::string_view name);

/// A variable of a unit, as modelDescription.xml says.
struct UnitVariable {
  std::string name, description;
  std::uint32_t reference = 0;
  std::string type;       ///< "Real", "Integer", ..; of FMI 3 "Float64", "Int32", ..
  std::string causality;  ///< "input", "output", "parameter", "local", ..
  std::string variability;
  std::string unit;                ///< "": none is declared
  std::optional<Measure> measure;  ///< of `unit`: its BaseUnit, or by its usual name
  std::string start;               ///< as written; "": none
  bool array = false;              ///< FMI 3: has dimensions
  bool numeric() const;            ///< a single number or truth value
};

/// What modelDescription.xml says. Of model exchange only what is needed to refuse it.
struct UnitDescription {
  int version = 2;  ///< of FMI: 2 or 3
  std::string model_name, tool, token;
  std::string identifier;           ///< of co-simulation: name of the library; "": none
  std::string exchange_identifier;  ///< of model exchange
  std::optional<double> start_time, stop_time, tolerance, step_size;  ///< of the default experiment
  std::vector<UnitVariable> variables;
  const UnitVariable* find(std::string_view name) const;
};
/// @param place  of the text, for messages
/// @throws InputError naming place, element and attribute
UnitDescription read_description(const std::string& xml, const std::string& place);

/// An instance for co-simulation. Calls may be made in this order alone: set() of parameters,
/// enter_initialisation(), set() and get(), exit_initialisation(), then set(), get() and step().
/// An instance is used by one thread at a time.
class Slave {
 public:
  virtual ~Slave() = default;
  /// In the variable's own unit. Integers take what is whole, truth values take 0 and 1.
  /// @throws ComputationError where the unit refuses it, in its own words
  virtual void set(const UnitVariable& variable, double value) = 0;
  /// @throws ComputationError too where the value is not finite
  virtual double get(const UnitVariable& variable) = 0;
  /// @param end  s, at which the simulation will end
  virtual void enter_initialisation(double start, double end) = 0;
  virtual void exit_initialisation() = 0;
  /// From a time, s, over a step, s.
  virtual void step(double time, double step) = 0;
  /// What the unit has said so far, a line each: "warning: level low".
  virtual const std::vector<std::string>& log() const = 0;
};

/// A .fmu, unpacked into a folder of its own, which goes when this and its instances have gone.
class ImportedUnit {
 public:
  /// @throws InputError where the file is no unit for co-simulation on this machine
  explicit ImportedUnit(const std::filesystem::path& file);
  ~ImportedUnit();
  ImportedUnit(const ImportedUnit&) = delete;
  ImportedUnit& operator=(const ImportedUnit&) = delete;

  const UnitDescription& description() const;
  const std::filesystem::path& file() const;
  /// Where it is unpacked.
  const std::filesystem::path& folder() const;
  /// @param name  of the instance, for messages
  /// @throws InputError in the unit's own words where it does not start
  std::unique_ptr<Slave> instantiate(const std::string& name) const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> it_;
};

}  // namespace bentaxis::fmu
