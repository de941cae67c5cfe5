// Imported Functional Mock-up Units (FMI 2.0, 3.0) for co-simulation: unpacked, read, run.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
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

/// A variable of an FMU, as modelDescription.xml says.
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

/// An instance for co-simulation. It runs in a process of its own. Calls may be made in this order
/// alone: set() of parameters, enter_initialisation(), set() and get(), exit_initialisation(), then
/// set(), get() and step(), at last end(). An instance is used by one thread at a time. Every call
/// throws ComputationError, which names the FMU and its function, where the FMU refuses it (in its
/// own words), ends its process in whatever way, or does not come back in time; and what
/// Limits::while_waiting throws. After that nothing but destruction is left.
class Slave {
 public:
  /// Frees an instance that was not ended within a second, or kills its process.
  virtual ~Slave() = default;
  /// In the variable's own unit. Integers take what is whole, truth values take 0 and 1.
  virtual void set(const UnitVariable& variable, double value) = 0;
  /// @throws ComputationError too where the value is not finite
  virtual double get(const UnitVariable& variable) = 0;
  /// Several of them one after the other: faster, as the processes exchange one message only.
  virtual void set(const std::vector<const UnitVariable*>& variables,
                   const std::vector<double>& values) = 0;
  virtual std::vector<double> get(const std::vector<const UnitVariable*>& variables) = 0;
  /// @param end  s, at which the simulation will end
  virtual void enter_initialisation(double start, double end) = 0;
  virtual void exit_initialisation() = 0;
  /// From a time, s, over a step, s.
  virtual void step(double time, double step) = 0;
  /// Terminates and frees the instance, and lets its process end.
  virtual void end() = 0;
  /// What the FMU has logged so far, a line each: "warning: level low". Up to 1000 lines of up to
  /// 400 bytes, UTF-8 without control characters.
  virtual const std::vector<std::string>& log() const = 0;
};

/// What an FMU is allowed to do.
struct Limits {
  /// s, elapsed: the longest time that one call of an FMI function, or loading the library, may
  /// take; 0: as long as it takes.
  double call_seconds = 60;
  /// Called while an FMU computes, about ten times a second and after every signal, by the thread
  /// that waits for it. What it throws ends the wait and the process of the FMU.
  std::function<void()> while_waiting = nullptr;
};

/// A .fmu, unpacked into a folder of its own, which goes when this and its instances have gone.
/// Code of the FMU runs in processes of its own, one for each instance; these and the folder go
/// also when this program ends in whatever way.
class ImportedUnit {
 public:
  /// @throws InputError where the file is no unit for co-simulation on this machine;
  /// ComputationError
  ///         where its library does not come back from being loaded
  explicit ImportedUnit(const std::filesystem::path& file, const Limits& limits = {});
  ~ImportedUnit();
  ImportedUnit(const ImportedUnit&) = delete;
  ImportedUnit& operator=(const ImportedUnit&) = delete;

  const UnitDescription& description() const;
  const std::filesystem::path& file() const;
  /// Where it is unpacked.
  const std::filesystem::path& folder() const;
  /// @param name  of the instance, for messages
  /// @throws InputError in the FMU's own words where it does not start
  std::unique_ptr<Slave> instantiate(const std::string& name) const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> it_;
};

}  // namespace bentaxis::fmu
