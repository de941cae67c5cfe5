// An importer for model exchange, written from the standards for these tests: instances of either
// version behind one interface, and an integrator that asks nothing but FMI's calls.
#pragma once

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bentaxis/fmu/slave.h"
#include "interface/fmi2.h"
#include "interface/fmi3.h"

namespace bentaxis::test {

/// An instance for model exchange, which begins in event mode. Every call must be answered by OK.
class Exchange {
 public:
  virtual ~Exchange() = default;
  virtual std::size_t states() = 0;
  virtual std::size_t indicators() = 0;
  virtual void set_time(double time) = 0;
  virtual void set_states(const std::vector<double>& x) = 0;
  virtual void get_states(std::vector<double>& x) = 0;
  virtual void rates(std::vector<double>& rates) = 0;
  virtual void nominals(std::vector<double>& nominals) = 0;
  virtual void indicators(std::vector<double>& values) = 0;
  /// @return whether event mode is wanted
  virtual bool completed() = 0;
  virtual void enter_event_mode() = 0;
  struct Update {
    bool again = false, states_changed = false;
    double next = 0;  ///< time of the next event; 0: none
  };
  virtual Update update() = 0;
  virtual void enter_continuous_time() = 0;
  virtual double get(unsigned reference) = 0;
  virtual void set(unsigned reference, double value) = 0;

 protected:
  static void need_ok(int status, const char* call) {
    if (status != 0)
      throw std::runtime_error(std::string(call) + ": status " + std::to_string(status));
  }
};

inline void* function_of(void* library, const char* name) {
  void* function = dlsym(library, name);
  if (function == nullptr) throw std::runtime_error(std::string("no function ") + name);
  return function;
}

#define BENTAXIS_CALL(name, ...) \
  need_ok(reinterpret_cast<name##TYPE*>(function_of(library_, #name))(__VA_ARGS__), #name)

inline void say2(fmi2ComponentEnvironment, fmi2String, fmi2Status status, fmi2String,
                 fmi2String message, ...) {
  std::fprintf(stderr, "unit: status %d: %s\n", status, message);
}

class Exchange2 : public Exchange {
 public:
  Exchange2(void* library, const fmu::ImportedUnit& unit, std::size_t indicators, double end)
      : library_(library), indicators_(indicators) {
    for (const auto& v : unit.description().variables)
      if (v.name.rfind("der(", 0) == 0) ++states_;
    callbacks_ = {say2, std::calloc, std::free, nullptr, nullptr};
    const std::string resources = "file://" + (unit.folder() / "resources").string();
    it_ = reinterpret_cast<fmi2InstantiateTYPE*>(function_of(library, "fmi2Instantiate"))(
        "test", fmi2ModelExchange, unit.description().token.c_str(), resources.c_str(), &callbacks_,
        0, 0);
    if (it_ == nullptr) throw std::runtime_error("fmi2Instantiate");
    BENTAXIS_CALL(fmi2SetupExperiment, it_, 0, 0, 0, 1, end);
    BENTAXIS_CALL(fmi2EnterInitializationMode, it_);
    BENTAXIS_CALL(fmi2ExitInitializationMode, it_);
  }
  Exchange2(const Exchange2&) = delete;
  Exchange2& operator=(const Exchange2&) = delete;
  ~Exchange2() override {
    reinterpret_cast<fmi2FreeInstanceTYPE*>(dlsym(library_, "fmi2FreeInstance"))(it_);
  }
  std::size_t states() override { return states_; }
  std::size_t indicators() override { return indicators_; }
  void set_time(double time) override { BENTAXIS_CALL(fmi2SetTime, it_, time); }
  void set_states(const std::vector<double>& x) override {
    BENTAXIS_CALL(fmi2SetContinuousStates, it_, x.data(), x.size());
  }
  void get_states(std::vector<double>& x) override {
    x.resize(states_);
    BENTAXIS_CALL(fmi2GetContinuousStates, it_, x.data(), x.size());
  }
  void rates(std::vector<double>& rates) override {
    rates.resize(states_);
    BENTAXIS_CALL(fmi2GetDerivatives, it_, rates.data(), rates.size());
  }
  void nominals(std::vector<double>& nominals) override {
    nominals.resize(states_);
    BENTAXIS_CALL(fmi2GetNominalsOfContinuousStates, it_, nominals.data(), nominals.size());
  }
  void indicators(std::vector<double>& values) override {
    values.resize(indicators_);
    BENTAXIS_CALL(fmi2GetEventIndicators, it_, values.data(), values.size());
  }
  bool completed() override {
    fmi2Boolean event = 0, terminate = 0;
    BENTAXIS_CALL(fmi2CompletedIntegratorStep, it_, 1, &event, &terminate);
    return event != 0;
  }
  void enter_event_mode() override { BENTAXIS_CALL(fmi2EnterEventMode, it_); }
  Update update() override {
    fmi2EventInfo info{};
    BENTAXIS_CALL(fmi2NewDiscreteStates, it_, &info);
    return {info.newDiscreteStatesNeeded != 0, info.valuesOfContinuousStatesChanged != 0,
            info.nextEventTimeDefined != 0 ? info.nextEventTime : 0};
  }
  void enter_continuous_time() override { BENTAXIS_CALL(fmi2EnterContinuousTimeMode, it_); }
  double get(unsigned reference) override {
    double value = 0;
    BENTAXIS_CALL(fmi2GetReal, it_, &reference, 1, &value);
    return value;
  }
  void set(unsigned reference, double value) override {
    BENTAXIS_CALL(fmi2SetReal, it_, &reference, 1, &value);
  }

 private:
  void* library_;
  std::size_t states_ = 0, indicators_;
  fmi2CallbackFunctions callbacks_{};
  fmi2Component it_ = nullptr;
};

class Exchange3 : public Exchange {
 public:
  Exchange3(void* library, const fmu::ImportedUnit& unit, double end) : library_(library) {
    const auto say = [](fmi3InstanceEnvironment, fmi3Status status, fmi3String,
                        fmi3String message) {
      std::fprintf(stderr, "unit: status %d: %s\n", status, message);
    };
    const std::string resources = (unit.folder() / "resources").string() + "/";
    it_ = reinterpret_cast<fmi3InstantiateModelExchangeTYPE*>(
        function_of(library, "fmi3InstantiateModelExchange"))(
        "test", unit.description().token.c_str(), resources.c_str(), false, false, nullptr, say);
    if (it_ == nullptr) throw std::runtime_error("fmi3InstantiateModelExchange");
    BENTAXIS_CALL(fmi3EnterInitializationMode, it_, false, 0, 0, true, end);
    BENTAXIS_CALL(fmi3ExitInitializationMode, it_);
    BENTAXIS_CALL(fmi3GetNumberOfContinuousStates, it_, &states_);
    BENTAXIS_CALL(fmi3GetNumberOfEventIndicators, it_, &indicators_);
  }
  Exchange3(const Exchange3&) = delete;
  Exchange3& operator=(const Exchange3&) = delete;
  ~Exchange3() override {
    reinterpret_cast<fmi3FreeInstanceTYPE*>(dlsym(library_, "fmi3FreeInstance"))(it_);
  }
  std::size_t states() override { return states_; }
  std::size_t indicators() override { return indicators_; }
  void set_time(double time) override { BENTAXIS_CALL(fmi3SetTime, it_, time); }
  void set_states(const std::vector<double>& x) override {
    BENTAXIS_CALL(fmi3SetContinuousStates, it_, x.data(), x.size());
  }
  void get_states(std::vector<double>& x) override {
    x.resize(states_);
    BENTAXIS_CALL(fmi3GetContinuousStates, it_, x.data(), x.size());
  }
  void rates(std::vector<double>& rates) override {
    rates.resize(states_);
    BENTAXIS_CALL(fmi3GetContinuousStateDerivatives, it_, rates.data(), rates.size());
  }
  void nominals(std::vector<double>& nominals) override {
    nominals.resize(states_);
    BENTAXIS_CALL(fmi3GetNominalsOfContinuousStates, it_, nominals.data(), nominals.size());
  }
  void indicators(std::vector<double>& values) override {
    values.resize(indicators_);
    BENTAXIS_CALL(fmi3GetEventIndicators, it_, values.data(), values.size());
  }
  bool completed() override {
    bool event = false, terminate = false;
    BENTAXIS_CALL(fmi3CompletedIntegratorStep, it_, true, &event, &terminate);
    return event;
  }
  void enter_event_mode() override { BENTAXIS_CALL(fmi3EnterEventMode, it_); }
  Update update() override {
    bool again = false, terminate = false, nominals = false, states = false, defined = false;
    double next = 0;
    BENTAXIS_CALL(fmi3UpdateDiscreteStates, it_, &again, &terminate, &nominals, &states, &defined,
                  &next);
    return {again, states, defined ? next : 0};
  }
  void enter_continuous_time() override { BENTAXIS_CALL(fmi3EnterContinuousTimeMode, it_); }
  double get(unsigned reference) override {
    double value = 0;
    BENTAXIS_CALL(fmi3GetFloat64, it_, &reference, 1, &value, 1);
    return value;
  }
  void set(unsigned reference, double value) override {
    BENTAXIS_CALL(fmi3SetFloat64, it_, &reference, 1, &value, 1);
  }

 private:
  void* library_;
  std::size_t states_ = 0, indicators_ = 0;
  fmi3Instance it_ = nullptr;
};
#undef BENTAXIS_CALL

/// Integrates an instance by Dormand's and Prince's method of order 5 with control of the error and
/// of events, knowing nothing of what it integrates.
class Solver {
 public:
  Solver(Exchange& unit, double tolerance) : unit_(unit), tolerance_(tolerance) {
    unit_.nominals(nominals_);
    unit_.get_states(x_);
    handle_events();
  }

  void go_to(double end) {
    while (time_ < end) {
      const double stop = next_ > time_ ? std::min(end, next_) : end;
      const bool last = h_ >= stop - time_;
      const double h = last ? stop - time_ : h_;
      if (!try_step(h)) continue;
      double taken = h;
      const bool passed = changed();
      if (passed) taken = locate(h);
      time_ = last && taken == h ? stop : time_ + taken;
      x_ = to_;
      unit_.set_time(time_);
      unit_.set_states(x_);
      ++steps;
      const bool wanted = unit_.completed();
      if (passed || wanted || time_ == next_) {
        unit_.enter_event_mode();
        handle_events();
        ++events;
      }
    }
  }

  double time() const { return time_; }
  long steps = 0, events = 0;

 private:
  void handle_events() {
    bool moved = false;
    for (Exchange::Update update{true, false, 0}; update.again;) {
      update = unit_.update();
      moved = moved || update.states_changed;
      next_ = update.next;
    }
    if (moved) unit_.get_states(x_);
    unit_.enter_continuous_time();
    unit_.indicators(signs_);
    h_ = std::min(h_, 1e-6);
  }

  void rates(double time, const std::vector<double>& x, std::vector<double>& k) {
    unit_.set_time(time);
    unit_.set_states(x);
    unit_.rates(k);
  }

  // From time_, x_ to to_; error of the nominals.
  double step(double h) {
    static constexpr double kNodes[] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
    static constexpr double kWeights[7][6] = {
        {},
        {1.0 / 5},
        {3.0 / 40, 9.0 / 40},
        {44.0 / 45, -56.0 / 15, 32.0 / 9},
        {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
        {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
        {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static constexpr double kErrors[] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                         -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    for (int stage = 0; stage < 7; ++stage) {
      to_ = x_;
      for (int j = 0; j < stage; ++j)
        for (std::size_t i = 0; i < x_.size(); ++i) to_[i] += h * kWeights[stage][j] * k_[j][i];
      rates(time_ + kNodes[stage] * h, to_, k_[stage]);
    }
    double error = 0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      double sum = 0;
      for (int j = 0; j < 7; ++j) sum += kErrors[j] * k_[j][i];
      error = std::max(error, std::abs(h * sum) / nominals_[i]);
    }
    return error / tolerance_;
  }

  bool try_step(double h) {
    const double error = step(h);
    h_ = h * std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 3.0);
    return error <= 1;
  }

  bool changed() {
    unit_.indicators(now_);  // the last stage stands at the end of the step
    for (std::size_t i = 0; i < now_.size(); ++i)
      if ((now_[i] > 0) != (signs_[i] > 0)) return true;
    return false;
  }

  // The step that ends just beyond the first event.
  double locate(double h) {
    double low = 0, high = h;
    while (high - low > 1e-14) {
      const double middle = (low + high) / 2;
      step(middle);
      (changed() ? high : low) = middle;
    }
    step(high);
    return high;
  }

  Exchange& unit_;
  double tolerance_, time_ = 0, h_ = 1e-6, next_ = 0;
  std::vector<double> x_, to_, nominals_, signs_, now_;
  std::array<std::vector<double>, 7> k_;
};

}  // namespace bentaxis::test
