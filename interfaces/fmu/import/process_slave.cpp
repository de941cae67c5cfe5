#include "process_slave.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::fmu {
namespace {

using process::Item;
using process::Outcome;
using process::Task;

constexpr std::size_t kMaxLines = 1000;

const char* word_of(int status) {
  static const char* words[] = {"OK", "warning", "discard", "error", "fatal"};
  return status >= 0 && status <= 4 ? words[status] : "an unknown status";
}

// Of an integer type or a truth value: what it can hold.
struct WholeRange {
  double low, high;
};

struct TypeFacts {
  process::Type type;
  std::optional<WholeRange> whole;  // none of floating point
};

// By the names of FMI 3; FMI 2 has Real, Integer, Boolean and Enumeration.
const std::map<std::string, TypeFacts, std::less<>>& all_types() {
  using process::Type;
  // What a double counts without gaps.
  constexpr double kGapless = 9007199254740992.0;
  static const std::map<std::string, TypeFacts, std::less<>> types = {
      {"Real", {Type::float64, {}}},
      {"Float64", {Type::float64, {}}},
      {"Float32", {Type::float32, {}}},
      {"Boolean", {Type::boolean, WholeRange{0, 1}}},
      {"Int8", {Type::int8, WholeRange{-128, 127}}},
      {"UInt8", {Type::uint8, WholeRange{0, 255}}},
      {"Int16", {Type::int16, WholeRange{-32768, 32767}}},
      {"UInt16", {Type::uint16, WholeRange{0, 65535}}},
      {"Integer", {Type::int32, WholeRange{-2147483648.0, 2147483647.0}}},
      {"Int32", {Type::int32, WholeRange{-2147483648.0, 2147483647.0}}},
      {"Enumeration", {Type::int64, WholeRange{-2147483648.0, 2147483647.0}}},
      {"UInt32", {Type::uint32, WholeRange{0, 4294967295.0}}},
      {"Int64", {Type::int64, WholeRange{-kGapless, kGapless}}},
      {"UInt64", {Type::uint64, WholeRange{0, kGapless}}},
  };
  return types;
}

// As FMI 2.0 wants it: with the letters of a URI alone.
std::string uri_of(const std::filesystem::path& folder) {
  constexpr std::string_view kPlain = "/-_.~";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const char c : folder.string()) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
        kPlain.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      uri += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return uri;
}

class ProcessSlave : public Slave {
 public:
  explicit ProcessSlave(SlaveOrigin origin)
      : owner_(std::move(origin.owner)),
        unit_(std::move(origin.unit)),
        version_(origin.description.version),
        channel_(std::move(origin.channel)) {
    start(origin);
  }
  ProcessSlave(const ProcessSlave&) = delete;
  ProcessSlave& operator=(const ProcessSlave&) = delete;
  // One that was not ended: may free what it has taken, but not keep anybody waiting.
  ~ProcessSlave() override {
    if (!channel_->idle() || fatal_) return;
    channel_->hurry();
    try {
      if (initialised_ && !failed_) call(simple(Task::terminate, "Terminate"));
      call(simple(Task::free_instance, "FreeInstance"));
      channel_->leave();
    } catch (const std::exception&) {  // Its process is killed.
    }
  }

  void set(const UnitVariable& variable, double value) override { set({&variable}, {value}); }
  double get(const UnitVariable& variable) override { return get({&variable}).front(); }

  void set(const std::vector<const UnitVariable*>& variables,
           const std::vector<double>& values) override {
    for (std::size_t i = 0; i < variables.size(); ++i) check_value(*variables[i], values[i]);
    for_each_part(Task::set, "Set", variables, [&](Call& asked, std::size_t first) {
      for (std::size_t i = 0; i < asked.items.size(); ++i) asked.items[i].value = values[first + i];
      check(asked, call(asked));
    });
  }

  std::vector<double> get(const std::vector<const UnitVariable*>& variables) override {
    std::vector<double> values;
    for (const UnitVariable* variable : variables) check_numeric("reading", *variable);
    for_each_part(Task::get, "Get", variables, [&](Call& asked, std::size_t) {
      const Returned returned = call(asked);
      check(asked, returned);
      if (returned.values.size() != asked.items.size())
        fail(asked.names.front(), "the answer cannot be read");
      values.insert(values.end(), returned.values.begin(), returned.values.end());
    });
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!std::isfinite(values[i]))
        fail("reading \"" + variables[i]->name + "\"", "its value is not finite");
    return values;
  }

  void enter_initialisation(double start, double end) override {
    if (version_ == 2) run(Task::set_up, "SetupExperiment", start, end);
    run(Task::enter_initialisation, "EnterInitializationMode", start, end);
  }
  void exit_initialisation() override {
    run(Task::exit_initialisation, "ExitInitializationMode");
    initialised_ = true;
  }

  void step(double time, double step) override {
    const Call asked{
        Task::step, {name_of("DoStep") + " at " + rounded_text(time) + " s"}, version_, time, step};
    const Returned returned = call(asked);
    const std::string& what = asked.names.front();
    constexpr int kPending = 5;  // of FMI 2
    if (returned.status == kPending)
      fail(what, "the FMU continues the step asynchronously: not supported");
    const bool ends = (returned.flags & process::kTerminates) != 0;
    if (ends && version_ == 2) fail(what, "the FMU ends the simulation");
    check(asked, returned);
    if (ends) fail(what, "the FMU ends the simulation");
    if ((returned.flags & process::kReturnedEarly) != 0)
      fail(what, "the FMU returned early, which it was not allowed to");
  }

  void end() override {
    if (initialised_ && !failed_) run(Task::terminate, "Terminate");
    call(simple(Task::free_instance, "FreeInstance"));
    channel_->leave();
  }

  const std::vector<std::string>& log() const override { return log_; }

 private:
  std::string name_of(const std::string& function) const {
    return "fmi" + std::to_string(version_) + function;
  }
  Call simple(Task task, const std::string& function) const {
    return {task, {name_of(function)}, version_};
  }
  void run(Task task, const std::string& function, double first = 0, double second = 0) {
    Call asked = simple(task, function);
    asked.first = first;
    asked.second = second;
    check(asked, call(asked));
  }

  void start(const SlaveOrigin& origin) {
    const Returned version = call(simple(Task::version, "GetVersion"));
    if (version.outcome == Outcome::no_function)
      throw InputError(unit_ + ": its library has no function " + version.text +
                       ", which the standard requires");
    if (!version.text.starts_with(std::to_string(version_) + "."))
      throw InputError(unit_ + ": its library is of FMI " + version.text + ", its description of " +
                       std::to_string(version_) + ".0");
    const std::string what = name_of(version_ == 2 ? "Instantiate" : "InstantiateCoSimulation");
    const std::string resources =
        version_ == 2 ? uri_of(origin.resources) : origin.resources.string() + "/";
    const Returned returned = call({Task::instantiate,
                                    {what},
                                    version_,
                                    0,
                                    0,
                                    {},
                                    {origin.name, origin.description.token, resources}});
    if (returned.outcome == Outcome::returned) return;
    fatal_ = true;  // There is nothing to be freed.
    throw InputError(unit_ + ": " + what + ": the FMU does not start" + said(returned));
  }

  Returned call(const Call& asked) {
    Returned returned = channel_->call(asked);
    for (const std::string& line : returned.log)
      if (log_.size() < kMaxLines) log_.push_back(line);
    return returned;
  }

  static std::string said(const Returned& returned) {
    const std::string words = said_last(returned.log);
    return words.empty() ? " and gives no reason" : ": " + words;
  }

  [[noreturn]] void fail(const std::string& what, const std::string& why) {
    failed_ = true;
    throw ComputationError(unit_ + ": " + what + ": " + why);
  }

  // Whether it can be gone on from that.
  void check(const Call& asked, const Returned& returned) {
    if (returned.status == 0 || returned.status == 1) return;
    fatal_ = returned.status == 4;
    fail(asked.names[std::min(returned.index, asked.names.size() - 1)],
         std::string("the FMU returns ") + word_of(returned.status) + said(returned));
  }

  void check_numeric(const std::string& doing, const UnitVariable& variable) {
    if (variable.numeric()) return;
    fail(doing + " \"" + variable.name + "\"", "is of type " + variable.type +
                                                   (variable.array ? " with dimensions" : "") +
                                                   ": must be a single number");
  }

  void check_value(const UnitVariable& variable, double value) {
    const std::string what = "setting \"" + variable.name + "\"";
    if (!std::isfinite(value)) fail(what, "its value is not finite");
    check_numeric("setting", variable);
    const auto found = all_types().find(variable.type);
    if (found == all_types().end() || !found->second.whole) return;
    const WholeRange& range = *found->second.whole;
    const bool whole = value == std::round(value) && value >= range.low && value <= range.high;
    if (!whole)
      fail(what, number_text(value) + " is not what its type " + variable.type +
                     " holds: must be whole, in [" + number_text(range.low) + ", " +
                     number_text(range.high) + "]");
  }

  // As many variables at a time as a message has room for.
  template <class Use>
  void for_each_part(Task task, const char* verb, const std::vector<const UnitVariable*>& variables,
                     const Use& use) {
    for (std::size_t first = 0; first < variables.size(); first += process::kMaxItems) {
      Call asked{task, {}, version_};
      const std::size_t end = std::min(variables.size(), first + std::size_t{process::kMaxItems});
      for (std::size_t i = first; i < end; ++i) {
        const UnitVariable& v = *variables[i];
        asked.items.push_back({type_of(v, version_), v.reference, 0});
        asked.names.push_back(name_of(verb + function_type(v)) + " of \"" + v.name + "\"");
      }
      use(asked, first);
    }
  }

  std::string function_type(const UnitVariable& v) const {
    if (version_ == 3) return v.type == "Enumeration" ? "Int64" : v.type;
    return v.type == "Enumeration" ? "Integer" : v.type;
  }

  std::shared_ptr<const void> owner_;
  std::string unit_;
  int version_;
  std::unique_ptr<Channel> channel_;  // goes before the owner
  std::vector<std::string> log_;
  bool initialised_ = false, fatal_ = false, failed_ = false;
};

}  // namespace

process::Type type_of(const UnitVariable& variable, int version) {
  const auto found = all_types().find(variable.type);
  if (found == all_types().end()) return process::Type::int64;  // FMI 3: an enumeration's own type
  return version == 2 && found->second.type == process::Type::int64 ? process::Type::int32
                                                                    : found->second.type;
}

std::unique_ptr<Slave> process_slave(SlaveOrigin origin) {
  return std::make_unique<ProcessSlave>(std::move(origin));
}

}  // namespace bentaxis::fmu
