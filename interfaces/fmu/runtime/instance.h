// An instance of a unit: what FMI 2 and 3 share. Which call may come when, values by reference,
// parameters that are set, steps, events, saved states. Knows nothing of either version's types.
// Internal.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "log.h"
#include "plant.h"
#include "resources.h"
#include "saved_state.h"

namespace bentaxis::fmu {

/// Where an instance stands; sets of them are sums.
enum Mode : unsigned {
  kInstantiated = 1,
  kInitialization = 2,
  kEvent = 4,       ///< of model exchange, and of co-simulation where it is used
  kContinuous = 8,  ///< of model exchange
  kStep = 16,       ///< of co-simulation, between two steps
  kTerminated = 32,
  kFailed = 64,         ///< a computation failed: only a saved state or a reset lead on
  kIntermediate = 128,  ///< within a step of co-simulation, while the importer is called
};
inline constexpr unsigned kRunning = kEvent | kContinuous | kStep;
inline constexpr unsigned kKnown = kInitialization | kRunning | kTerminated | kFailed;
inline constexpr unsigned kAny = kInstantiated | kKnown;

/// A call that is not followed; nothing has changed.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// How co-simulation steps, by what FMI 3 offers beyond FMI 2.
struct Stepping {
  bool event_mode = false;                  ///< events are passed in event mode
  bool early_return = false;                ///< a step may end before its end
  std::vector<std::uint32_t> intermediate;  ///< what may be read and set while a step is computed
  /// The importer's, called where the integrator has got to: its time, and whether inputs may be
  /// set. Returns the time at which it wants the step to end early, if it does.
  std::function<std::optional<double>(double time, bool may_set)> update;
};

class Instance {
 public:
  using Kind = Plant::Kind;
  using Reference = std::uint32_t;

  /// @throws InputError where the case cannot be simulated, Refused where the token is another or a
  /// variable has no intermediate values
  Instance(const std::filesystem::path& resources, const std::string& token, Kind kind, Log log,
           Stepping stepping = {});

  /// Runs one call. What it throws is said and made a status; nothing is thrown.
  /// @param function  its name, for messages
  /// @param modes     in which it may come
  /// @param body      returns nothing, or a Status
  template <class Body>
  Status call(const char* function, unsigned modes, Body body) noexcept {
    try {
      require_mode(modes);
      if constexpr (std::is_void_v<decltype(body())>) {
        body();
        return Status::ok;
      } else {
        return body();
      }
    } catch (...) {
      return failed(function);
    }
  }

  Kind kind() const { return kind_; }
  Log& log() { return log_; }
  /// @throws Refused where it is of the other kind
  void require(Kind kind) const;

  // From the start to the end.
  /// @throws Refused where a number makes no sense
  void set_up(std::optional<double> tolerance, double start_time, std::optional<double> stop_time);
  void enter_initialization();
  void exit_initialization();
  void terminate();
  void reset();

  // Values. Nothing is set where one of them is refused.
  void numbers(const Reference* references, std::size_t count, double* values);
  template <class Boolean>
  void flags(const Reference* references, std::size_t count, Boolean* values) {
    for (std::size_t i = 0; i < count; ++i) values[i] = flag(references[i]);
  }
  void set_numbers(const Reference* references, std::size_t count, const double* values);
  /// Derivatives of inputs over time, from the present time on: of order 1. That of the speed is
  /// the acceleration.
  void set_rates(const Reference* references, std::size_t count, const int* orders,
                 const double* values);
  template <class Boolean>
  void set_flags(const Reference* references, std::size_t count, const Boolean* values) {
    for (std::size_t i = 0; i < count; ++i) require_settable_flag(references[i]);
    for (std::size_t i = 0; i < count; ++i) set_flag(references[i], values[i] != Boolean{});
  }
  /// @throws Refused where there is a variable among them: of types that have none to be set
  void refuse_values(const Reference* references, std::size_t count, const char* type) const;
  void derivative(const Reference* unknowns, std::size_t unknown_count, const Reference* knowns,
                  std::size_t known_count, const double* seed, double* sensitivity);

  // Co-simulation.
  /// @return ok, or discard where the pump cannot be followed so far: it then stands where it stood
  Status step(double time, double size);
  double last_time() const { return run_.now; }
  /// Of the last step, where event mode is used: whether it has ended at an event.
  bool at_event() const { return at_event_; }
  /// Whether it has ended before its end, in which case last_time() says when.
  bool stopped_early() const { return stopped_early_; }
  void enter_step_mode();

  // Events, of model exchange and of co-simulation with event mode.
  struct Event {
    bool states_changed = false;
    std::optional<double> next_time;  ///< of the importer
  };
  void enter_event_mode();
  Event update_discrete_states();

  // Model exchange.
  void enter_continuous_mode();
  bool step_completed();  ///< whether event mode should be entered
  void set_time(double time);
  void set_states(const double* values, std::size_t count);
  void states(double* values, std::size_t count);
  void rates(double* values, std::size_t count);
  void indicators(double* values, std::size_t count);
  void nominals(double* values, std::size_t count) const;
  std::size_t state_count() const { return count_of(Role::state); }
  std::size_t indicator_count() const { return count_of(Role::indicator); }

  // Saved states. A pointer that this instance has not given is refused.
  void save(void** state);
  void restore(void* state_given);
  void free_state(void** state);
  std::size_t serialized_size(void* state) const;
  void serialize(void* state, char* bytes, std::size_t size) const;
  void deserialize(const char* bytes, std::size_t size, void** state);

 private:
  void require_mode(unsigned modes) const;
  Status failed(const char* function) noexcept;
  void find_rates();  ///< of the continuous states, into scratch_

  const Variable& variable(Reference reference) const;
  std::size_t count_of(Role role) const;
  double number(Reference reference);
  bool flag(Reference reference);
  void require_settable(const Variable& it, double value) const;
  void require_settable_flag(Reference reference) const;
  void set_flag(Reference reference, bool value);
  /// The least value of an input, as parameters are set; none where it has no bound.
  std::optional<double> least_of(const Variable& input) const;
  void require_inputs_until(double end) const;
  /// @throws Refused where an intermediate update may not read, or set, the variable
  void require_intermediate(const Variable& it, bool set) const;

  /// The case with the parameters as they are set.
  /// @throws InputError where a file that says the same would be refused
  Case case_as_set(const std::vector<double>& parameters) const;
  UnitChoice present_choice() const;
  /// What has been set takes effect.
  void settle();
  void start();
  Plant& open_plant();
  void step_whole(double end);
  void step_by_step(double start, double end);
  /// The importer's intermediate update. @return where the step is to end, s of the plant
  double intermediate_update(double end, bool may_set);
  void note_events();
  const SavedState& known_state(void* state) const;
  SavedState present() const;
  void put_state(void** place, SavedState state);

  Kind kind_;
  Log log_;
  Stepping stepping_;
  Resources resources_;
  std::vector<Variable> variables_;
  std::vector<double> first_parameters_;
  Inputs first_inputs_;

  Standing run_;
  // By reference, in the variable's unit; those that have taken effect, and those that are set.
  std::vector<double> parameters_, wanted_;
  Inputs inputs_;
  bool inputs_changed_ = false;
  bool at_event_ = false, stopped_early_ = false, may_set_ = false;
  std::unique_ptr<Plant> plant_;
  // The equations at the present state, of co-simulation: made where someone asks for them.
  std::unique_ptr<Plant> open_;
  std::vector<double> scratch_;

  std::map<const void*, std::unique_ptr<SavedState>> saved_;  // those that are given out
};

}  // namespace bentaxis::fmu
