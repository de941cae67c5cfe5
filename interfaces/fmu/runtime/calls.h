// What the functions of FMI 2 and 3 do alike. A version instantiates Calls with its status, and
// defines by the lists at the end the functions that differ from the other version's in their names
// alone. Internal.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "bentaxis/pump/lists.h"
#include "instance.h"

namespace bentaxis::fmu {

inline constexpr unsigned kGet =
    kInstantiated | kKnown;  // what is not known yet is refused one by one
inline constexpr unsigned kSet = kInstantiated | kInitialization | kRunning;
inline constexpr unsigned kSetDiscrete = kInstantiated | kInitialization | kEvent | kStep;

/// @throws Refused where there are values and one of the places is null
inline void require_places(std::size_t count, std::initializer_list<const void*> places) {
  if (count > 0 && contains(places, nullptr))
    throw Refused("a null pointer where values should be");
}
inline void require_place(const void* place) { require_places(1, {place}); }

/// All variables are scalars.
inline void require_scalars(std::size_t count, std::size_t value_count) {
  if (count != value_count)
    throw Refused("there must be one value per variable: " + std::to_string(count) + ", not " +
                  std::to_string(value_count));
}

/// Calls of an instance that is given as a pointer; `error` is the status of one that is null.
template <class AnyStatus, AnyStatus error>
struct Calls {
  using Kind = Instance::Kind;

  template <class Body>
  static AnyStatus call(void* c, const char* function, unsigned modes, Body body) noexcept {
    if (c == nullptr) return error;
    Instance& it = *static_cast<Instance*>(c);
    return static_cast<AnyStatus>(it.call(function, modes, [&] { return body(it); }));
  }

  /// Of one kind only.
  template <class Body>
  static AnyStatus call(void* c, const char* function, Kind kind, unsigned modes,
                        Body body) noexcept {
    if (c == nullptr) return error;
    Instance& it = *static_cast<Instance*>(c);
    if (it.call(function, kAny, [&] { it.require(kind); }) != Status::ok) return error;
    return call(c, function, modes, body);
  }

  /// `does` the values of variables, to or from the importer.
  template <class Value, class Does>
  static AnyStatus values(void* c, const char* function, unsigned modes,
                          const Instance::Reference vr[], std::size_t count, Value* values,
                          std::size_t value_count, Does does) noexcept {
    return call(c, function, modes, [&](Instance& it) {
      require_places(count, {vr, values});
      require_scalars(count, value_count);
      (it.*does)(vr, count, values);
    });
  }

  /// Of types that no variable has.
  static AnyStatus no_values(void* c, const char* function, unsigned modes,
                             const Instance::Reference vr[], std::size_t count,
                             const char* type) noexcept {
    return call(c, function, modes, [&](Instance& it) {
      require_places(count, {vr});
      it.refuse_values(vr, count, type);
    });
  }

  static AnyStatus set_debug_logging(void* c, const char* function, bool on, std::size_t count,
                                     const char* const categories[]) noexcept {
    return call(c, function, kAny, [&](Instance& it) {
      require_places(count, {categories});
      std::vector<std::string> names;
      for (std::size_t i = 0; i < count; ++i) {
        require_place(categories[i]);
        names.emplace_back(categories[i]);
      }
      if (!it.log().set_debug(on, names)) throw Refused("there is no such category");
    });
  }

  /// Model exchange: `does` an array of numbers, to or from the importer.
  template <class Number, class Does>
  static AnyStatus numbers(void* c, const char* function, unsigned modes, Number* values,
                           std::size_t count, Does does) noexcept {
    return call(c, function, Kind::model_exchange, modes, [&](Instance& it) {
      require_places(count, {values});
      (it.*does)(values, count);
    });
  }
};

}  // namespace bentaxis::fmu

// The functions of a version by the types of its header, and its `call` and `numbers`.
#define BENTAXIS_DECLARE(result, name, arguments) result name arguments;
#define BENTAXIS_CALLS(fmi, FUNCTIONS)                          \
  extern "C" {                                                  \
  FUNCTIONS(BENTAXIS_DECLARE)                                   \
  }                                                             \
  using Fmi = bentaxis::fmu::Calls<fmi##Status, fmi##Error>;    \
  template <class... Arguments>                                 \
  static fmi##Status call(Arguments... arguments) noexcept {    \
    return Fmi::call(arguments...);                             \
  }                                                             \
  template <class... Arguments>                                 \
  static fmi##Status numbers(Arguments... arguments) noexcept { \
    return Fmi::numbers(arguments...);                          \
  }

// The functions that both versions have under the same names behind `fmi2` and `fmi3`. They use
// `call` and `numbers` of the version.
#define BENTAXIS_COMMON_FUNCTIONS(fmi)                                                         \
  fmi##Status fmi##ExitInitializationMode(void* c) {                                           \
    return call(c, __func__, kInitialization, [](Instance& it) { it.exit_initialization(); }); \
  }                                                                                            \
  fmi##Status fmi##Terminate(void* c) {                                                        \
    return call(c, __func__, kRunning, [](Instance& it) { it.terminate(); });                  \
  }                                                                                            \
  fmi##Status fmi##Reset(void* c) {                                                            \
    return call(c, __func__, kAny, [](Instance& it) { it.reset(); });                          \
  }                                                                                            \
  fmi##Status fmi##EnterContinuousTimeMode(void* c) {                                          \
    return call(c, __func__, Kind::model_exchange, kEvent,                                     \
                [](Instance& it) { it.enter_continuous_mode(); });                             \
  }                                                                                            \
  fmi##Status fmi##CompletedIntegratorStep(void* c, fmi##Boolean /*no_set_state_before*/,      \
                                           fmi##Boolean* enter_event_mode,                     \
                                           fmi##Boolean* terminate) {                          \
    return call(c, __func__, Kind::model_exchange, kContinuous, [&](Instance& it) {            \
      require_places(1, {enter_event_mode, terminate});                                        \
      *enter_event_mode = it.step_completed();                                                 \
      *terminate = false;                                                                      \
    });                                                                                        \
  }                                                                                            \
  fmi##Status fmi##SetTime(void* c, double time) {                                             \
    return call(c, __func__, Kind::model_exchange, kEvent | kContinuous,                       \
                [&](Instance& it) { it.set_time(time); });                                     \
  }                                                                                            \
  fmi##Status fmi##SetContinuousStates(void* c, const double x[], size_t count) {              \
    return numbers(c, __func__, kContinuous, x, count, &Instance::set_states);                 \
  }                                                                                            \
  fmi##Status fmi##GetContinuousStates(void* c, double x[], size_t count) {                    \
    return numbers(c, __func__, kKnown, x, count, &Instance::states);                          \
  }                                                                                            \
  fmi##Status fmi##GetEventIndicators(void* c, double indicators[], size_t count) {            \
    return numbers(c, __func__, kKnown, indicators, count, &Instance::indicators);             \
  }                                                                                            \
  fmi##Status fmi##GetNominalsOfContinuousStates(void* c, double nominals[], size_t count) {   \
    return numbers(c, __func__, kAny, nominals, count, &Instance::nominals);                   \
  }

// Saved states; the versions spell three words differently, and have bytes of their own types.
#define BENTAXIS_STATE_FUNCTIONS(fmi, State, DeSerialize)                                   \
  fmi##Status fmi##Get##State(void* c, void** state) {                                      \
    return call(c, __func__, kAny, [&](Instance& it) { it.save(state); });                  \
  }                                                                                         \
  fmi##Status fmi##Set##State(void* c, void* state) {                                       \
    return call(c, __func__, kAny, [&](Instance& it) { it.restore(state); });               \
  }                                                                                         \
  fmi##Status fmi##Free##State(void* c, void** state) {                                     \
    return call(c, __func__, kAny, [&](Instance& it) { it.free_state(state); });            \
  }                                                                                         \
  fmi##Status fmi##Serialized##State##Size(void* c, void* state, size_t* size) {            \
    return call(c, __func__, kAny, [&](Instance& it) {                                      \
      require_place(size);                                                                  \
      *size = it.serialized_size(state);                                                    \
    });                                                                                     \
  }                                                                                         \
  fmi##Status fmi##Serialize##State(void* c, void* state, fmi##Byte bytes[], size_t size) { \
    return call(c, __func__, kAny, [&](Instance& it) {                                      \
      require_place(bytes);                                                                 \
      it.serialize(state, reinterpret_cast<char*>(bytes), size);                            \
    });                                                                                     \
  }                                                                                         \
  fmi##Status fmi##DeSerialize##State(void* c, const fmi##Byte bytes[], size_t size,        \
                                      void** state) {                                       \
    return call(c, __func__, kAny, [&](Instance& it) {                                      \
      require_place(bytes);                                                                 \
      it.deserialize(reinterpret_cast<const char*>(bytes), size, state);                    \
    });                                                                                     \
  }
