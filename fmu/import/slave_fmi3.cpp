// Co-simulation by FMI 3.0.
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "interface/fmi3.h"
#include "slave_base.h"
#include "slave_kinds.h"

namespace bentaxis::fmu {
namespace {

// Types with one function each to set and to get them.
#define BENTAXIS_FMI3_NUMBERS(X) \
  X(Float64)                     \
  X(Float32)                     \
  X(Int8)                        \
  X(UInt8)                       \
  X(Int16)                       \
  X(UInt16)                      \
  X(Int32)                       \
  X(UInt32)                      \
  X(Int64)                       \
  X(UInt64)                      \
  X(Boolean)

struct Functions {
// NOLINTNEXTLINE(bugprone-macro-parentheses): a name that is declared
#define BENTAXIS_MEMBER(name) name##TYPE* name = nullptr;
  BENTAXIS_FMI3_FUNCTIONS(BENTAXIS_MEMBER)
#undef BENTAXIS_MEMBER
};

Functions functions_of(const SharedLibrary& library) {
  Functions f;
#define BENTAXIS_FIND(name) library.find(f.name, #name);
  BENTAXIS_FIND(fmi3GetVersion)
  BENTAXIS_FIND(fmi3InstantiateCoSimulation)
  BENTAXIS_FIND(fmi3FreeInstance)
  BENTAXIS_FIND(fmi3EnterInitializationMode)
  BENTAXIS_FIND(fmi3ExitInitializationMode)
  BENTAXIS_FIND(fmi3Terminate)
  BENTAXIS_FIND(fmi3DoStep)
#undef BENTAXIS_FIND
#define BENTAXIS_FIND(type)                       \
  library.find(f.fmi3Get##type, "fmi3Get" #type); \
  library.find(f.fmi3Set##type, "fmi3Set" #type);
  BENTAXIS_FMI3_NUMBERS(BENTAXIS_FIND)
#undef BENTAXIS_FIND
  return f;
}

void say(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String, fmi3String message) {
  static_cast<UnitLog*>(environment)->add(status, message);
}

class Fmi3Slave : public SlaveBase {
 public:
  explicit Fmi3Slave(const SlaveOrigin& origin)
      : SlaveBase(origin.unit), call_(functions_of(origin.library)) {
    if (const std::string version = call_.fmi3GetVersion(); version.rfind("3.", 0) != 0)
      throw InputError(unit_ + ": its library is of FMI " + version + ", its description of 3.0");
    const std::string resources = origin.resources.string() + "/";
    instance_ = call_.fmi3InstantiateCoSimulation(
        origin.name.c_str(), origin.description.token.c_str(), resources.c_str(), false, false,
        false, false, nullptr, 0, &log_, say, nullptr);
    if (instance_ != nullptr) return;
    const std::string said = log_.news();
    throw InputError(unit_ + ": fmi3InstantiateCoSimulation: the unit does not start" +
                     (said.empty() ? " and says nothing" : ", it says: " + said));
  }
  Fmi3Slave(const Fmi3Slave&) = delete;
  Fmi3Slave& operator=(const Fmi3Slave&) = delete;
  ~Fmi3Slave() override {
    if (!usable()) return;
    if (initialised_ && !failed()) call_.fmi3Terminate(instance_);
    call_.fmi3FreeInstance(instance_);
  }

  void enter_initialisation(double start, double end) override {
    check("fmi3EnterInitializationMode",
          call_.fmi3EnterInitializationMode(instance_, false, 0, start, true, end));
  }
  void exit_initialisation() override {
    check("fmi3ExitInitializationMode", call_.fmi3ExitInitializationMode(instance_));
    initialised_ = true;
  }

  void step(double time, double step) override {
    fmi3Boolean event = false, terminate = false, early = false;
    fmi3Float64 reached = time + step;
    const std::string what = "fmi3DoStep at " + rounded_text(time) + " s";
    check(what,
          call_.fmi3DoStep(instance_, time, step, true, &event, &terminate, &early, &reached));
    if (terminate) fail(what, "the unit ends the simulation");
    if (early) fail(what, "the unit returned early, which it was not allowed to");
  }

 protected:
  int set_value(const UnitVariable& variable, double value) override {
    const fmi3ValueReference reference = variable.reference;
#define BENTAXIS_SET(kind)                                         \
  if (variable.type == #kind) {                                    \
    const auto own = static_cast<fmi3##kind>(value);               \
    return call_.fmi3Set##kind(instance_, &reference, 1, &own, 1); \
  }
    BENTAXIS_FMI3_NUMBERS(BENTAXIS_SET)
#undef BENTAXIS_SET
    const auto own = static_cast<fmi3Int64>(value);  // enumerations
    return call_.fmi3SetInt64(instance_, &reference, 1, &own, 1);
  }
  int get_value(const UnitVariable& variable, double& value) override {
    const fmi3ValueReference reference = variable.reference;
#define BENTAXIS_GET(kind)                                                            \
  if (variable.type == #kind) {                                                       \
    fmi3##kind own{};                                                                 \
    const fmi3Status status = call_.fmi3Get##kind(instance_, &reference, 1, &own, 1); \
    value = static_cast<double>(own);                                                 \
    return status;                                                                    \
  }
    BENTAXIS_FMI3_NUMBERS(BENTAXIS_GET)
#undef BENTAXIS_GET
    fmi3Int64 own = 0;
    const fmi3Status status = call_.fmi3GetInt64(instance_, &reference, 1, &own, 1);
    value = static_cast<double>(own);
    return status;
  }

 private:
  Functions call_;
  fmi3Instance instance_ = nullptr;
  bool initialised_ = false;
};

}  // namespace

std::unique_ptr<Slave> fmi3_slave(const SlaveOrigin& origin) {
  return std::make_unique<Fmi3Slave>(origin);
}

}  // namespace bentaxis::fmu
