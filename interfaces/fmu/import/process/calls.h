// FMI's functions for co-simulation, whatever the version. Runs in the process of the FMU.
// Internal.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "messages.h"

namespace bentaxis::fmu::process {

/// What an FMU logs, from any of its threads. C code calls it: nothing is thrown.
class Log {
 public:
  explicit Log(Shared& shared) : shared_(shared) {}
  /// Long messages are cut; where there is no room for one, those before it are dropped.
  /// @param status  of FMI: 0 OK, 1 warning, 2 discard, 3 error, 4 fatal
  void add(int status, const char* message) noexcept;
  /// What has been logged since this was last called: lines of a Reply.
  std::string take();

 private:
  std::mutex busy_;
  Shared& shared_;
};

/// An instance for co-simulation. Statuses are those of FMI.
class Calls {
 public:
  virtual ~Calls() = default;
  virtual std::string version() = 0;
  /// @return whether there is an instance
  virtual bool instantiate(const char* name, const char* token, const char* resources) = 0;
  virtual int set(Type type, std::uint32_t reference, double value) = 0;
  virtual int get(Type type, std::uint32_t reference, double& value) = 0;
  virtual int set_up(double start, double end) = 0;
  virtual int enter_initialisation(double start, double end) = 0;
  virtual int exit_initialisation() = 0;
  virtual int step(double time, double step, std::uint32_t& flags) = 0;
  virtual int terminate() = 0;
  virtual void free_instance() = 0;
};

/// @param library  handle of dlopen()
/// @param missing  receives the name of a function that the library lacks; then there are no calls
std::unique_ptr<Calls> fmi2_calls(void* library, Log& log, std::string& missing);
std::unique_ptr<Calls> fmi3_calls(void* library, Log& log, std::string& missing);

/// Finds a function of a library. @return whether there is one
template <class Function>
bool find(void* library, Function*& function, const char* name);

void* symbol(void* library, const char* name);

template <class Function>
bool find(void* library, Function*& function, const char* name) {
  function = reinterpret_cast<Function*>(symbol(library, name));
  return function != nullptr;
}

}  // namespace bentaxis::fmu::process
