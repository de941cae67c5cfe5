// Co-simulation by FMI 2.0.
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "interface/fmi2.h"
#include "slave_base.h"
#include "slave_kinds.h"

namespace bentaxis::fmu {
namespace {

struct Functions {
// NOLINTNEXTLINE(bugprone-macro-parentheses): a name that is declared
#define BENTAXIS_MEMBER(name) name##TYPE* name = nullptr;
  BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_MEMBER)
#undef BENTAXIS_MEMBER
};

Functions functions_of(const SharedLibrary& library) {
  Functions f;
#define BENTAXIS_FIND(name) library.find_optional(f.name, #name);
  BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_FIND)
#undef BENTAXIS_FIND
  // What is called here; a unit may leave others out.
#define BENTAXIS_FIND(name) library.find(f.name, #name);
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
  return f;
}

// As FMI 2.0 wants it: with the letters of a URI alone.
std::string uri_of(const std::filesystem::path& folder) {
  constexpr std::string_view kPlain = "/-_.~";
  std::string uri = "file://";
  for (const char c : folder.string()) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
        kPlain.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      char escaped[4];
      std::snprintf(escaped, sizeof escaped, "%%%02X", static_cast<unsigned>(c) & 0xFFU);
      uri += escaped;
    }
  }
  return uri;
}

void say(fmi2ComponentEnvironment environment, fmi2String, fmi2Status status, fmi2String,
         fmi2String message, ...) {
  char text[1024] = "";
  if (message != nullptr) {
    va_list values;
    va_start(values, message);
    std::vsnprintf(text, sizeof text, message, values);
    va_end(values);
  }
  static_cast<UnitLog*>(environment)->add(status, text);
}

class Fmi2Slave : public SlaveBase {
 public:
  explicit Fmi2Slave(const SlaveOrigin& origin)
      : SlaveBase(origin.unit), call_(functions_of(origin.library)) {
    if (const std::string version = call_.fmi2GetVersion(); version.rfind("2.", 0) != 0)
      throw InputError(unit_ + ": its library is of FMI " + version + ", its description of 2.0");
    callbacks_ = {say, std::calloc, std::free, nullptr, &log_};
    const std::string resources = uri_of(origin.resources);
    instance_ = call_.fmi2Instantiate(origin.name.c_str(), fmi2CoSimulation,
                                      origin.description.token.c_str(), resources.c_str(),
                                      &callbacks_, fmi2False, fmi2False);
    if (instance_ != nullptr) return;
    const std::string said = log_.news();
    throw InputError(unit_ + ": fmi2Instantiate: the unit does not start" +
                     (said.empty() ? " and says nothing" : ", it says: " + said));
  }
  Fmi2Slave(const Fmi2Slave&) = delete;
  Fmi2Slave& operator=(const Fmi2Slave&) = delete;
  ~Fmi2Slave() override {
    if (!usable()) return;
    if (initialised_ && !failed()) call_.fmi2Terminate(instance_);
    call_.fmi2FreeInstance(instance_);
  }

  void enter_initialisation(double start, double end) override {
    check("fmi2SetupExperiment",
          call_.fmi2SetupExperiment(instance_, fmi2False, 0, start, fmi2True, end));
    check("fmi2EnterInitializationMode", call_.fmi2EnterInitializationMode(instance_));
  }
  void exit_initialisation() override {
    check("fmi2ExitInitializationMode", call_.fmi2ExitInitializationMode(instance_));
    initialised_ = true;
  }

  void step(double time, double step) override {
    const fmi2Status status = call_.fmi2DoStep(instance_, time, step, fmi2True);
    const std::string what = "fmi2DoStep at " + rounded_text(time) + " s";
    if (status == fmi2Pending) fail(what, "the unit steps on by itself: that is not supported");
    fmi2Boolean terminated = fmi2False;
    if (status == fmi2Discard && call_.fmi2GetBooleanStatus != nullptr &&
        call_.fmi2GetBooleanStatus(instance_, fmi2Terminated, &terminated) == fmi2OK &&
        terminated == fmi2True)
      fail(what, "the unit ends the simulation");
    check(what, status);
  }

 protected:
  int set_value(const UnitVariable& variable, double value) override {
    const fmi2ValueReference reference = variable.reference;
    if (variable.type == "Real") return call_.fmi2SetReal(instance_, &reference, 1, &value);
    const int whole = static_cast<int>(value);
    if (variable.type == "Boolean") return call_.fmi2SetBoolean(instance_, &reference, 1, &whole);
    return call_.fmi2SetInteger(instance_, &reference, 1, &whole);
  }
  int get_value(const UnitVariable& variable, double& value) override {
    const fmi2ValueReference reference = variable.reference;
    if (variable.type == "Real") return call_.fmi2GetReal(instance_, &reference, 1, &value);
    int whole = 0;
    const fmi2Status status = variable.type == "Boolean"
                                  ? call_.fmi2GetBoolean(instance_, &reference, 1, &whole)
                                  : call_.fmi2GetInteger(instance_, &reference, 1, &whole);
    value = whole;
    return status;
  }

 private:
  Functions call_;
  fmi2CallbackFunctions callbacks_{};
  fmi2Component instance_ = nullptr;
  bool initialised_ = false;
};

}  // namespace

std::unique_ptr<Slave> fmi2_slave(const SlaveOrigin& origin) {
  return std::make_unique<Fmi2Slave>(origin);
}

}  // namespace bentaxis::fmu
