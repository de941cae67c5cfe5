// Co-simulation by FMI 2.0.
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "calls.h"
#include "interface/fmi2.h"

namespace bentaxis::fmu::process {
namespace {

struct Functions {
// NOLINTNEXTLINE(bugprone-macro-parentheses): a name that is declared
#define BENTAXIS_MEMBER(result, name, arguments) name##TYPE* name = nullptr;
  BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_MEMBER)
#undef BENTAXIS_MEMBER
};

bool find_functions(void* library, Functions& f, std::string& missing) {
#define BENTAXIS_FIND(result, name, arguments) find(library, f.name, #name);
  BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_FIND)
#undef BENTAXIS_FIND
  // Those that are called here are needed; an FMU may lack the others.
#define BENTAXIS_FIND(name) \
  if (f.name == nullptr) {  \
    missing = #name;        \
    return false;           \
  }
  BENTAXIS_FIND(fmi2GetVersion)
  BENTAXIS_FIND(fmi2Instantiate)
  BENTAXIS_FIND(fmi2FreeInstance)
  BENTAXIS_FIND(fmi2SetupExperiment)
  BENTAXIS_FIND(fmi2EnterInitializationMode)
  BENTAXIS_FIND(fmi2ExitInitializationMode)
  BENTAXIS_FIND(fmi2Terminate)
  BENTAXIS_FIND(fmi2GetReal)
  BENTAXIS_FIND(fmi2GetInteger)
  BENTAXIS_FIND(fmi2GetBoolean)
  BENTAXIS_FIND(fmi2SetReal)
  BENTAXIS_FIND(fmi2SetInteger)
  BENTAXIS_FIND(fmi2SetBoolean)
  BENTAXIS_FIND(fmi2DoStep)
#undef BENTAXIS_FIND
  return true;
}

void say(fmi2ComponentEnvironment environment, fmi2String, fmi2Status status, fmi2String,
         fmi2String message, ...) {
  char text[2 * kLongestLine] = "";
  if (message != nullptr) {
    va_list values;
    va_start(values, message);
    std::vsnprintf(text, sizeof text, message, values);
    va_end(values);
  }
  static_cast<Log*>(environment)->add(status, text);
}

class Fmi2Calls : public Calls {
 public:
  Fmi2Calls(const Functions& functions, Log& log) : call_(functions) {
    callbacks_ = {say, std::calloc, std::free, nullptr, &log};
  }

  std::string version() override { return call_.fmi2GetVersion(); }
  bool instantiate(const char* name, const char* token, const char* resources) override {
    instance_ = call_.fmi2Instantiate(name, fmi2CoSimulation, token, resources, &callbacks_,
                                      fmi2False, fmi2False);
    return instance_ != nullptr;
  }
  int set(Type type, std::uint32_t reference, double value) override {
    const fmi2ValueReference at = reference;
    if (type == Type::float64) return call_.fmi2SetReal(instance_, &at, 1, &value);
    const int whole = static_cast<int>(value);
    if (type == Type::boolean) return call_.fmi2SetBoolean(instance_, &at, 1, &whole);
    return call_.fmi2SetInteger(instance_, &at, 1, &whole);
  }
  int get(Type type, std::uint32_t reference, double& value) override {
    const fmi2ValueReference at = reference;
    if (type == Type::float64) return call_.fmi2GetReal(instance_, &at, 1, &value);
    int whole = 0;
    const fmi2Status status = type == Type::boolean
                                  ? call_.fmi2GetBoolean(instance_, &at, 1, &whole)
                                  : call_.fmi2GetInteger(instance_, &at, 1, &whole);
    value = whole;
    return status;
  }
  int set_up(double start, double end) override {
    return call_.fmi2SetupExperiment(instance_, fmi2False, 0, start, fmi2True, end);
  }
  int enter_initialisation(double, double) override {
    return call_.fmi2EnterInitializationMode(instance_);
  }
  int exit_initialisation() override { return call_.fmi2ExitInitializationMode(instance_); }
  int step(double time, double step, std::uint32_t& flags) override {
    const fmi2Status status = call_.fmi2DoStep(instance_, time, step, fmi2True);
    fmi2Boolean terminated = fmi2False;
    if (status == fmi2Discard && call_.fmi2GetBooleanStatus != nullptr &&
        call_.fmi2GetBooleanStatus(instance_, fmi2Terminated, &terminated) == fmi2OK &&
        terminated == fmi2True)
      flags |= kTerminates;
    return status;
  }
  int terminate() override { return call_.fmi2Terminate(instance_); }
  void free_instance() override { call_.fmi2FreeInstance(instance_); }

 private:
  Functions call_;
  fmi2CallbackFunctions callbacks_{};
  fmi2Component instance_ = nullptr;
};

}  // namespace

std::unique_ptr<Calls> fmi2_calls(void* library, Log& log, std::string& missing) {
  Functions functions;
  if (!find_functions(library, functions, missing)) return nullptr;
  return std::make_unique<Fmi2Calls>(functions, log);
}

}  // namespace bentaxis::fmu::process
