// Co-simulation by FMI 3.0.
#include "calls.h"
#include "interface/fmi3.h"

namespace bentaxis::fmu::process {
namespace {

// Types with one function each to set and to get them: of FMI, of the messages.
#define BENTAXIS_FMI3_NUMBERS(X) \
  X(Float64, float64)            \
  X(Float32, float32)            \
  X(Int8, int8)                  \
  X(UInt8, uint8)                \
  X(Int16, int16)                \
  X(UInt16, uint16)              \
  X(Int32, int32)                \
  X(UInt32, uint32)              \
  X(Int64, int64)                \
  X(UInt64, uint64)              \
  X(Boolean, boolean)

struct Functions {
// NOLINTNEXTLINE(bugprone-macro-parentheses): a name that is declared
#define BENTAXIS_MEMBER(result, name, arguments) name##TYPE* name = nullptr;
  BENTAXIS_FMI3_FUNCTIONS(BENTAXIS_MEMBER)
#undef BENTAXIS_MEMBER
};

bool find_functions(void* library, Functions& f, std::string& missing) {
#define BENTAXIS_FIND(name)            \
  if (!find(library, f.name, #name)) { \
    missing = #name;                   \
    return false;                      \
  }
  BENTAXIS_FIND(fmi3GetVersion)
  BENTAXIS_FIND(fmi3InstantiateCoSimulation)
  BENTAXIS_FIND(fmi3FreeInstance)
  BENTAXIS_FIND(fmi3EnterInitializationMode)
  BENTAXIS_FIND(fmi3ExitInitializationMode)
  BENTAXIS_FIND(fmi3Terminate)
  BENTAXIS_FIND(fmi3DoStep)
#define BENTAXIS_FIND_BOTH(kind, type) \
  BENTAXIS_FIND(fmi3Get##kind)         \
  BENTAXIS_FIND(fmi3Set##kind)
  BENTAXIS_FMI3_NUMBERS(BENTAXIS_FIND_BOTH)
#undef BENTAXIS_FIND_BOTH
#undef BENTAXIS_FIND
  return true;
}

void say(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String, fmi3String message) {
  static_cast<Log*>(environment)->add(status, message);
}

class Fmi3Calls : public Calls {
 public:
  Fmi3Calls(const Functions& functions, Log& log) : call_(functions), log_(log) {}

  std::string version() override { return call_.fmi3GetVersion(); }
  bool instantiate(const char* name, const char* token, const char* resources) override {
    instance_ = call_.fmi3InstantiateCoSimulation(name, token, resources, false, false, false,
                                                  false, nullptr, 0, &log_, say, nullptr);
    return instance_ != nullptr;
  }
  int set(Type type, std::uint32_t reference, double value) override {
    const fmi3ValueReference at = reference;
    switch (type) {
#define BENTAXIS_SET(kind, name)                            \
  case Type::name: {                                        \
    const auto own = static_cast<fmi3##kind>(value);        \
    return call_.fmi3Set##kind(instance_, &at, 1, &own, 1); \
  }
      BENTAXIS_FMI3_NUMBERS(BENTAXIS_SET)
#undef BENTAXIS_SET
    }
    return fmi3Error;
  }
  int get(Type type, std::uint32_t reference, double& value) override {
    const fmi3ValueReference at = reference;
    switch (type) {
#define BENTAXIS_GET(kind, name)                                               \
  case Type::name: {                                                           \
    fmi3##kind own{};                                                          \
    const fmi3Status status = call_.fmi3Get##kind(instance_, &at, 1, &own, 1); \
    value = static_cast<double>(own);                                          \
    return status;                                                             \
  }
      BENTAXIS_FMI3_NUMBERS(BENTAXIS_GET)
#undef BENTAXIS_GET
    }
    return fmi3Error;
  }
  int set_up(double, double) override { return fmi3OK; }
  int enter_initialisation(double start, double end) override {
    return call_.fmi3EnterInitializationMode(instance_, false, 0, start, true, end);
  }
  int exit_initialisation() override { return call_.fmi3ExitInitializationMode(instance_); }
  int step(double time, double step, std::uint32_t& flags) override {
    fmi3Boolean event = false, terminate = false, early = false;
    fmi3Float64 reached = time + step;
    const fmi3Status status =
        call_.fmi3DoStep(instance_, time, step, true, &event, &terminate, &early, &reached);
    if (terminate) flags |= kTerminates;
    if (early) flags |= kReturnedEarly;
    return status;
  }
  int terminate() override { return call_.fmi3Terminate(instance_); }
  void free_instance() override { call_.fmi3FreeInstance(instance_); }

 private:
  Functions call_;
  Log& log_;
  fmi3Instance instance_ = nullptr;
};

}  // namespace

std::unique_ptr<Calls> fmi3_calls(void* library, Log& log, std::string& missing) {
  Functions functions;
  if (!find_functions(library, functions, missing)) return nullptr;
  return std::make_unique<Fmi3Calls>(functions, log);
}

}  // namespace bentaxis::fmu::process
