// The functions of FMI 3.0: each checks its pointers and hands over to the instance.
#include "interface/fmi3.h"

#include <memory>

#include "calls.h"
#include "instance.h"

BENTAXIS_CALLS(fmi3, BENTAXIS_FMI3_FUNCTIONS)

namespace {

using namespace bentaxis::fmu;
using Kind = Instance::Kind;

Log log_to(fmi3LogMessageCallback callback, fmi3InstanceEnvironment environment, bool debug) {
  if (callback == nullptr) return Log({}, debug);
  return Log(
      [callback, environment](Status status, const char* category, const std::string& message) {
        callback(environment, static_cast<fmi3Status>(status), category, message.c_str());
      },
      debug);
}

fmi3Instance instantiate(const char* function, fmi3String name, fmi3String token, fmi3String path,
                         Kind kind, const Log& log,
                         const std::function<Stepping()>& stepping = {}) noexcept {
  try {
    try {
      if (name == nullptr || *name == 0) throw Refused("the instance needs a name");
      if (token == nullptr) throw Refused("the instantiation token is missing");
      if (path == nullptr) throw Refused("the path of resources is missing");
      return new Instance(path_of_text(path), token, kind, log, stepping ? stepping() : Stepping{});
    } catch (const std::exception& error) {
      log.say(Status::error, std::string(function) + ": " + error.what());
    }
  } catch (...) {  // nothing is left to say it with
  }
  return nullptr;
}

}  // namespace

const char* fmi3GetVersion() { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t count,
                               const fmi3String categories[]) {
  return Fmi::set_debug_logging(instance, __func__, on, count, categories);
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token,
                                          fmi3String resource_path, fmi3Boolean /*visible*/,
                                          fmi3Boolean logging_on,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log) {
  return instantiate(__func__, name, token, resource_path, Kind::model_exchange,
                     log_to(log, environment, logging_on));
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token,
                                         fmi3String resource_path, fmi3Boolean /*visible*/,
                                         fmi3Boolean logging_on, fmi3Boolean event_mode_used,
                                         fmi3Boolean early_return_allowed,
                                         const fmi3ValueReference intermediate[],
                                         size_t intermediates, fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update) {
  const auto stepping = [&] {
    require_places(intermediates, {intermediate});
    if (intermediates > 0 && update == nullptr)
      throw Refused("there are intermediate variables, but no function to call for them");
    Stepping it{event_mode_used, early_return_allowed, {}, {}};
    if (intermediates > 0) it.intermediate.assign(intermediate, intermediate + intermediates);
    if (update != nullptr)
      it.update = [=](double time, bool may_set) -> std::optional<double> {
        bool returns = false;
        double when = time;
        update(environment, time, may_set && intermediates > 0, intermediates > 0, true,
               early_return_allowed, &returns, &when);
        return returns ? std::optional<double>(when) : std::nullopt;
      };
    return it;
  };
  return instantiate(__func__, name, token, resource_path, Kind::co_simulation,
                     log_to(log, environment, logging_on), stepping);
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String /*name*/, fmi3String /*token*/, fmi3String /*resource_path*/,
    fmi3Boolean /*visible*/, fmi3Boolean logging_on, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, fmi3ClockUpdateCallback /*clock_update*/,
    fmi3LockPreemptionCallback /*lock*/, fmi3UnlockPreemptionCallback /*unlock*/) {
  log_to(log, environment, logging_on)
      .say(Status::error, std::string(__func__) + ": this FMU has no scheduled execution");
  return nullptr;
}

void fmi3FreeInstance(fmi3Instance instance) { delete static_cast<Instance*>(instance); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean tolerance_defined,
                                       fmi3Float64 tolerance, fmi3Float64 start_time,
                                       fmi3Boolean stop_time_defined, fmi3Float64 stop_time) {
  return call(instance, __func__, kInstantiated, [&](Instance& it) {
    const auto given = [](bool defined, double value) {
      return defined ? std::optional<double>(value) : std::nullopt;
    };
    it.set_up(given(tolerance_defined, tolerance), start_time, given(stop_time_defined, stop_time));
    it.enter_initialization();
  });
}
fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
  return call(instance, __func__, kContinuous | kStep, [](Instance& it) { it.enter_event_mode(); });
}

// Values of the types that variables have.
#define BENTAXIS_VALUES(name, Value, modes, does)                                        \
  fmi3Status name(fmi3Instance instance, const fmi3ValueReference vr[], size_t count,    \
                  Value values[], size_t value_count) {                                  \
    return Fmi::values(instance, __func__, modes, vr, count, values, value_count, does); \
  }
BENTAXIS_VALUES(fmi3GetFloat64, fmi3Float64, kGet | kIntermediate, &Instance::numbers)
BENTAXIS_VALUES(fmi3SetFloat64, const fmi3Float64, kSet | kIntermediate, &Instance::set_numbers)
BENTAXIS_VALUES(fmi3GetBoolean, fmi3Boolean, kGet, &Instance::flags<fmi3Boolean>)
BENTAXIS_VALUES(fmi3SetBoolean, const fmi3Boolean, kSetDiscrete, &Instance::set_flags<fmi3Boolean>)
#undef BENTAXIS_VALUES

// Types that no variable has.
#define BENTAXIS_NO_VALUES(name, modes, type, ...)                                    \
  fmi3Status name(fmi3Instance instance, const fmi3ValueReference vr[], size_t count, \
                  __VA_ARGS__) {                                                      \
    return Fmi::no_values(instance, __func__, modes, vr, count, type);                \
  }
#define BENTAXIS_NO_TYPE(Type)                                         \
  BENTAXIS_NO_VALUES(fmi3Get##Type, kGet, #Type, fmi3##Type[], size_t) \
  BENTAXIS_NO_VALUES(fmi3Set##Type, kSetDiscrete, #Type, const fmi3##Type[], size_t)
BENTAXIS_NO_TYPE(Float32)
BENTAXIS_NO_TYPE(Int8)
BENTAXIS_NO_TYPE(UInt8)
BENTAXIS_NO_TYPE(Int16)
BENTAXIS_NO_TYPE(UInt16)
BENTAXIS_NO_TYPE(Int32)
BENTAXIS_NO_TYPE(UInt32)
BENTAXIS_NO_TYPE(Int64)
BENTAXIS_NO_TYPE(UInt64)
BENTAXIS_NO_TYPE(String)
BENTAXIS_NO_VALUES(fmi3GetBinary, kGet, "Binary", size_t[], fmi3Binary[], size_t)
BENTAXIS_NO_VALUES(fmi3SetBinary, kSetDiscrete, "Binary", const size_t[], const fmi3Binary[],
                   size_t)
BENTAXIS_NO_VALUES(fmi3GetClock, kGet, "Clock", fmi3Clock[])
BENTAXIS_NO_VALUES(fmi3SetClock, kSetDiscrete, "Clock", const fmi3Clock[])
#undef BENTAXIS_NO_TYPE
#undef BENTAXIS_NO_VALUES

// What this FMU has not, with the arguments behind the instance. Whoever asks is told why.
#define BENTAXIS_REFUSED(name, why, ...)                                                 \
  fmi3Status name(fmi3Instance instance __VA_OPT__(, ) __VA_ARGS__) {                    \
    return call(instance, __func__, kAny, [](Instance& /*it*/) { throw Refused(why); }); \
  }
constexpr const char* kNoElements =
    "dependencies of elements are not given: providesPerElementDependencies is false";
BENTAXIS_REFUSED(fmi3GetNumberOfVariableDependencies, kNoElements, fmi3ValueReference, size_t*)
BENTAXIS_REFUSED(fmi3GetVariableDependencies, kNoElements, fmi3ValueReference, size_t[],
                 fmi3ValueReference[], size_t[], fmi3DependencyKind[], size_t)
BENTAXIS_REFUSED(fmi3GetAdjointDerivative,
                 "there are no adjoint derivatives: providesAdjointDerivatives is false",
                 const fmi3ValueReference[], size_t, const fmi3ValueReference[], size_t,
                 const fmi3Float64[], size_t, fmi3Float64[], size_t)
BENTAXIS_REFUSED(fmi3EnterConfigurationMode, "there are no structural parameters to configure")
BENTAXIS_REFUSED(fmi3ExitConfigurationMode, "there are no structural parameters to configure")
BENTAXIS_REFUSED(fmi3ActivateModelPartition, "this FMU has no scheduled execution",
                 fmi3ValueReference, fmi3Float64)
#undef BENTAXIS_REFUSED

// Of clocks, of which there are none.
#define BENTAXIS_OF_CLOCKS(name, ...)                                                             \
  fmi3Status name(fmi3Instance instance, const fmi3ValueReference[], size_t count, __VA_ARGS__) { \
    return call(instance, __func__, kAny, [&](Instance& /*it*/) {                                 \
      if (count > 0) throw Refused("there are no clocks");                                        \
    });                                                                                           \
  }
BENTAXIS_OF_CLOCKS(fmi3GetIntervalDecimal, fmi3Float64[], fmi3IntervalQualifier[])
BENTAXIS_OF_CLOCKS(fmi3GetIntervalFraction, fmi3UInt64[], fmi3UInt64[], fmi3IntervalQualifier[])
BENTAXIS_OF_CLOCKS(fmi3GetShiftDecimal, fmi3Float64[])
BENTAXIS_OF_CLOCKS(fmi3GetShiftFraction, fmi3UInt64[], fmi3UInt64[])
BENTAXIS_OF_CLOCKS(fmi3SetIntervalDecimal, const fmi3Float64[])
BENTAXIS_OF_CLOCKS(fmi3SetIntervalFraction, const fmi3UInt64[], const fmi3UInt64[])
BENTAXIS_OF_CLOCKS(fmi3SetShiftDecimal, const fmi3Float64[])
BENTAXIS_OF_CLOCKS(fmi3SetShiftFraction, const fmi3UInt64[], const fmi3UInt64[])
#undef BENTAXIS_OF_CLOCKS

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                        size_t unknown_count, const fmi3ValueReference knowns[],
                                        size_t known_count, const fmi3Float64 seed[],
                                        size_t seed_count, fmi3Float64 sensitivity[],
                                        size_t sensitivity_count) {
  return call(instance, __func__, kKnown, [&](Instance& it) {
    require_places(unknown_count, {unknowns, sensitivity});
    require_places(known_count, {knowns, seed});
    require_scalars(known_count, seed_count);
    require_scalars(unknown_count, sensitivity_count);
    it.derivative(unknowns, unknown_count, knowns, known_count, seed, sensitivity);
  });
}
fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance) {
  return call(instance, __func__, kInitialization | kEvent, [](Instance& /*it*/) {});
}
fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean* again,
                                    fmi3Boolean* terminate, fmi3Boolean* nominals_changed,
                                    fmi3Boolean* states_changed,
                                    fmi3Boolean* next_event_time_defined,
                                    fmi3Float64* next_event_time) {
  return call(instance, __func__, kEvent, [&](Instance& it) {
    require_places(1, {again, terminate, nominals_changed, states_changed, next_event_time_defined,
                       next_event_time});
    const Instance::Event event = it.update_discrete_states();
    *again = *terminate = *nominals_changed = false;
    *states_changed = event.states_changed;
    *next_event_time_defined = event.next_time.has_value();
    *next_event_time = event.next_time.value_or(0);
  });
}

BENTAXIS_STATE_FUNCTIONS(fmi3, FMUState, Deserialize)

BENTAXIS_COMMON_FUNCTIONS(fmi3)

// Model exchange.

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[],
                                             size_t count) {
  return numbers(instance, __func__, kKnown, derivatives, count, &Instance::rates);
}
fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t* count) {
  return call(instance, __func__, Kind::model_exchange, kAny, [&](Instance& it) {
    require_places(1, {count});
    *count = it.indicator_count();
  });
}
fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t* count) {
  return call(instance, __func__, Kind::model_exchange, kAny, [&](Instance& it) {
    require_places(1, {count});
    *count = it.state_count();
  });
}

// Co-simulation.

fmi3Status fmi3EnterStepMode(fmi3Instance instance) {
  return call(instance, __func__, Kind::co_simulation, kEvent,
              [](Instance& it) { it.enter_step_mode(); });
}
fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance, const fmi3ValueReference /*vr*/[],
                                    size_t count, const fmi3Int32 /*orders*/[],
                                    fmi3Float64 /*values*/[], size_t /*value_count*/) {
  return call(instance, __func__, Kind::co_simulation, kKnown, [&](Instance& /*it*/) {
    if (count > 0)
      throw Refused("outputs have no derivatives over time: maxOutputDerivativeOrder is 0");
  });
}
fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 time, fmi3Float64 step,
                      fmi3Boolean /*no_set_state_before*/, fmi3Boolean* event_handling_needed,
                      fmi3Boolean* terminate, fmi3Boolean* early_return,
                      fmi3Float64* last_successful_time) {
  return call(instance, __func__, Kind::co_simulation, kStep, [&](Instance& it) {
    require_places(1, {event_handling_needed, terminate, early_return, last_successful_time});
    *event_handling_needed = *terminate = *early_return = false;
    *last_successful_time = it.last_time();
    const Status status = it.step(time, step);
    *last_successful_time = it.last_time();
    *event_handling_needed = status == Status::ok && it.at_event();
    *early_return = status == Status::ok && it.stopped_early();
    return status;
  });
}
