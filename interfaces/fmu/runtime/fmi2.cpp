// The functions of FMI 2.0: each checks its pointers and hands over to the instance.
#include "interface/fmi2.h"

#include <cstring>
#include <memory>

#include "calls.h"
#include "instance.h"

BENTAXIS_CALLS(fmi2, BENTAXIS_FMI2_FUNCTIONS)

namespace {

using namespace bentaxis::fmu;
using Kind = Instance::Kind;

// Messages are formats, in which #r3# is a variable.
std::string as_format(const std::string& text) {
  std::string format;
  for (const char c : text) {
    format += c;
    if (c == '%' || c == '#') format += c;
  }
  return format;
}

Log::Sink sink_of(const fmi2CallbackFunctions& functions, const std::string& name) {
  if (functions.logger == nullptr) return {};
  return
      [logger = functions.logger, environment = functions.componentEnvironment,
       name = shown(name, 1000)](Status status, const char* category, const std::string& message) {
        logger(environment, name.c_str(), static_cast<fmi2Status>(status), category,
               as_format(message).c_str());
      };
}

}  // namespace

const char* fmi2GetTypesPlatform() { return fmi2TypesPlatform; }
const char* fmi2GetVersion() { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String instance_name, fmi2Type type, fmi2String guid,
                              fmi2String resource_location, const fmi2CallbackFunctions* functions,
                              fmi2Boolean /*visible*/, fmi2Boolean logging_on) {
  if (functions == nullptr) return nullptr;
  try {
    const std::string name = instance_name == nullptr ? "" : instance_name;
    const Log log(sink_of(*functions, name), logging_on != fmi2False);
    try {
      if (name.empty()) throw Refused("the instance needs a name");
      if (guid == nullptr) throw Refused("the GUID is missing");
      if (resource_location == nullptr) throw Refused("the location of resources is missing");
      if (type != fmi2ModelExchange && type != fmi2CoSimulation)
        throw Refused("the kind must be model exchange or co-simulation");
      return new Instance(path_of_uri(resource_location), guid,
                          type == fmi2CoSimulation ? Kind::co_simulation : Kind::model_exchange,
                          log);
    } catch (const std::exception& error) {
      log.say(Status::error, std::string("fmi2Instantiate: ") + error.what());
    }
  } catch (...) {  // nothing is left to say it with
  }
  return nullptr;
}

void fmi2FreeInstance(fmi2Component c) { delete static_cast<Instance*>(c); }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count,
                               const fmi2String categories[]) {
  return Fmi::set_debug_logging(c, __func__, on != fmi2False, count, categories);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                               fmi2Real start_time, fmi2Boolean stop_time_defined,
                               fmi2Real stop_time) {
  return call(c, __func__, kInstantiated, [&](Instance& it) {
    const auto given = [](fmi2Boolean defined, fmi2Real value) {
      return defined != fmi2False ? std::optional<double>(value) : std::nullopt;
    };
    it.set_up(given(tolerance_defined, tolerance), start_time, given(stop_time_defined, stop_time));
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  return call(c, __func__, kInstantiated, [](Instance& it) { it.enter_initialization(); });
}

// Values of the types that variables have, and of those that none has.
#define BENTAXIS_VALUES(name, Value, modes, does)                                                 \
  fmi2Status name(fmi2Component c, const fmi2ValueReference vr[], size_t count, Value values[]) { \
    return Fmi::values(c, __func__, modes, vr, count, values, count, does);                       \
  }
BENTAXIS_VALUES(fmi2GetReal, fmi2Real, kGet, &Instance::numbers)
BENTAXIS_VALUES(fmi2SetReal, const fmi2Real, kSet, &Instance::set_numbers)
BENTAXIS_VALUES(fmi2GetBoolean, fmi2Boolean, kGet, &Instance::flags<fmi2Boolean>)
BENTAXIS_VALUES(fmi2SetBoolean, const fmi2Boolean, kSetDiscrete, &Instance::set_flags<fmi2Boolean>)
#undef BENTAXIS_VALUES
#define BENTAXIS_NO_VALUES(name, Value, modes, type)                                       \
  fmi2Status name(fmi2Component c, const fmi2ValueReference vr[], size_t count, Value[]) { \
    return Fmi::no_values(c, __func__, modes, vr, count, type);                            \
  }
BENTAXIS_NO_VALUES(fmi2GetInteger, fmi2Integer, kGet, "Integer")
BENTAXIS_NO_VALUES(fmi2SetInteger, const fmi2Integer, kSetDiscrete, "Integer")
BENTAXIS_NO_VALUES(fmi2GetString, fmi2String, kGet, "String")
BENTAXIS_NO_VALUES(fmi2SetString, const fmi2String, kSetDiscrete, "String")
#undef BENTAXIS_NO_VALUES

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[],
                                        size_t unknowns, const fmi2ValueReference known[],
                                        size_t knowns, const fmi2Real known_seed[],
                                        fmi2Real unknown_sensitivity[]) {
  return call(c, __func__, kKnown, [&](Instance& it) {
    require_places(unknowns, {unknown, unknown_sensitivity});
    require_places(knowns, {known, known_seed});
    it.derivative(unknown, unknowns, known, knowns, known_seed, unknown_sensitivity);
  });
}

BENTAXIS_STATE_FUNCTIONS(fmi2, FMUstate, DeSerialize)

BENTAXIS_COMMON_FUNCTIONS(fmi2)

// Model exchange.

fmi2Status fmi2EnterEventMode(fmi2Component c) {
  return call(c, __func__, Kind::model_exchange, kEvent | kContinuous,
              [](Instance& it) { it.enter_event_mode(); });
}
fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* info) {
  return call(c, __func__, Kind::model_exchange, kEvent, [&](Instance& it) {
    require_place(info);
    const Instance::Event event = it.update_discrete_states();
    *info = {};
    info->valuesOfContinuousStatesChanged = event.states_changed ? fmi2True : fmi2False;
    info->nextEventTimeDefined = event.next_time ? fmi2True : fmi2False;
    info->nextEventTime = event.next_time.value_or(0);
  });
}
fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t count) {
  return numbers(c, __func__, kKnown, derivatives, count, &Instance::rates);
}

// Co-simulation.

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                       const fmi2Integer order[], const fmi2Real value[]) {
  return call(c, __func__, Kind::co_simulation, kSet, [&](Instance& it) {
    require_places(count, {vr, order, value});
    it.set_rates(vr, count, order, value);
  });
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference /*vr*/[],
                                        size_t count, const fmi2Integer /*order*/[],
                                        fmi2Real /*value*/[]) {
  return call(c, __func__, Kind::co_simulation, kKnown, [&](Instance& /*it*/) {
    if (count > 0)
      throw Refused("outputs have no derivatives over time: maxOutputDerivativeOrder is 0");
  });
}
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step,
                      fmi2Boolean /*no_set_state_before*/) {
  return call(c, __func__, Kind::co_simulation, kStep,
              [&](Instance& it) { return it.step(time, step); });
}
fmi2Status fmi2CancelStep(fmi2Component c) {
  return call(c, __func__, Kind::co_simulation, kAny, [](Instance& /*it*/) {
    throw Refused("no step is under way: a step has ended when its call returns");
  });
}
fmi2Status fmi2GetStatus(fmi2Component c, fmi2StatusKind kind, fmi2Status* value) {
  return call(c, __func__, Kind::co_simulation, kStep | kTerminated, [&](Instance& /*it*/) {
    require_place(value);
    if (kind != fmi2DoStepStatus) throw Refused("of this kind there is no status");
    *value = fmi2OK;
  });
}
fmi2Status fmi2GetRealStatus(fmi2Component c, fmi2StatusKind kind, fmi2Real* value) {
  return call(c, __func__, Kind::co_simulation, kStep | kTerminated | kFailed, [&](Instance& it) {
    require_place(value);
    if (kind != fmi2LastSuccessfulTime) throw Refused("of this kind there is no real");
    *value = it.last_time();
  });
}
fmi2Status fmi2GetIntegerStatus(fmi2Component c, fmi2StatusKind /*kind*/, fmi2Integer* /*value*/) {
  return call(c, __func__, Kind::co_simulation, kAny,
              [](Instance& /*it*/) { throw Refused("there is no integer status"); });
}
fmi2Status fmi2GetBooleanStatus(fmi2Component c, fmi2StatusKind kind, fmi2Boolean* value) {
  return call(c, __func__, Kind::co_simulation, kStep | kTerminated, [&](Instance& /*it*/) {
    require_place(value);
    if (kind != fmi2Terminated) throw Refused("of this kind there is no Boolean");
    *value = fmi2False;  // a pump does not ask for the end
  });
}
fmi2Status fmi2GetStringStatus(fmi2Component c, fmi2StatusKind kind, fmi2String* value) {
  return call(c, __func__, Kind::co_simulation, kStep | kTerminated, [&](Instance& /*it*/) {
    require_place(value);
    if (kind != fmi2PendingStatus) throw Refused("of this kind there is no text");
    *value = "";
  });
}
