// What instances of both versions have in common: what the unit says, and how its refusals are
// told. Internal.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "bentaxis/fmu/slave.h"

namespace bentaxis::fmu {

/// What a unit says, from any of its threads. Nothing is thrown: C code calls it.
class UnitLog {
 public:
  /// @param status  of FMI: 0 OK, 1 warning, 2 discard, 3 error, 4 fatal
  void add(int status, const char* message) noexcept;
  const std::vector<std::string>& lines() const { return lines_; }
  /// What has been said since this was last asked, in one line.
  std::string news();

 private:
  std::mutex busy_;
  std::vector<std::string> lines_;
  std::size_t told_ = 0;
};

class SlaveBase : public Slave {
 public:
  void set(const UnitVariable& variable, double value) final;
  double get(const UnitVariable& variable) final;
  const std::vector<std::string>& log() const final { return log_.lines(); }

 protected:
  /// @param unit  for messages: file and instance
  explicit SlaveBase(std::string unit) : unit_(std::move(unit)) {}

  // By the function of the variable's type; of integers and truth values `value` fits the type.
  // Status of FMI.
  virtual int set_value(const UnitVariable& variable, double value) = 0;
  virtual int get_value(const UnitVariable& variable, double& value) = 0;

  /// @param what    what was asked: "fmi2DoStep at 0.5 s"
  /// @param status  of FMI
  /// @throws ComputationError where it is none that can be gone on from
  void check(const std::string& what, int status);
  [[noreturn]] void fail(const std::string& what, const std::string& why);
  /// The unit may still be asked to free itself.
  bool usable() const { return !fatal_; }
  bool failed() const { return failed_; }

  std::string unit_;
  UnitLog log_;

 private:
  bool fatal_ = false, failed_ = false;
};

/// Of an integer type or a truth value: what it can hold; none of floating point.
struct WholeRange {
  double low, high;
};
std::optional<WholeRange> whole_range(const std::string& type);

}  // namespace bentaxis::fmu
