// What the description of a unit says of dependencies, against its library: nothing moves that is
// not said to, and all that is said to does somewhere.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "dependencies.h"
#include "fmu_support.h"

namespace bentaxis::fmu {
namespace {

// Of what is of the same unit there: above it a number has moved, below it is round-off.
constexpr double kMoved = 1e-9;
constexpr double kRounding = 1e-11;

struct Kind {
  std::string name, drive;
  std::vector<std::pair<std::string, std::string>> changes;  // of the text of the case
};
std::ostream& operator<<(std::ostream& to, const Kind& kind) {
  return to << kind.name << ", " << kind.drive;
}

class Dependency : public testing::TestWithParam<Kind> {
 protected:
  Dependency() : resources_(GetParam().name + ".toml", GetParam().drive) {
    for (const auto& [from, to] : GetParam().changes) resources_.replace(from, to);
    if (!GetParam().changes.empty()) resources_.read_again();
    UnitChoice choice;
    choice.drive = resources_.drive();
    said_ =
        dependencies_of(read_case(resources_.path() / "case.toml"), choice, resources_.variables());
  }

  bool says(const DependencesOf& all, unsigned unknown, unsigned known) const {
    const auto& list = all.at(unknown);
    return std::any_of(list.begin(), list.end(),
                       [&](const Dependence& one) { return one.known == known; });
  }

  // Identities that vanish are round-off, whatever moves.
  static bool is_residual(const Variable& it) {
    return it.name.find("residual") != std::string::npos ||
           it.name.find("axis_moment") != std::string::npos || it.name == "power_balance_W";
  }

  Resources resources_;
  Dependencies said_;
};

// Numbers of the unknowns of an instance that has been started.
class Reader {
 public:
  Reader(const Resources& resources, bool with_indicators) {
    for (const Variable& it : resources.variables())
      if (it.role == Role::output || it.role == Role::derivative || it.role == Role::state ||
          (with_indicators && it.role == Role::indicator)) {
        references_.push_back(it.reference);
        variables_.push_back(&it);
      }
  }
  bool read(const Unit2& unit, std::vector<double>& values) const {
    values.resize(references_.size());
    return unit.f.fmi2GetReal(unit.it, references_.data(), references_.size(), values.data()) ==
           fmi2OK;
  }
  const std::vector<const Variable*>& variables() const { return variables_; }

  // Largest change of each, of the largest number of its unit.
  void compare(const std::vector<double>& a, const std::vector<double>& b,
               std::vector<double>& moved) const {
    std::map<std::string, double> scales;
    const auto kind = [&](std::size_t i) {
      return variables_[i]->role == Role::output ? variables_[i]->unit : variables_[i]->name;
    };
    for (std::size_t i = 0; i < a.size(); ++i)
      for (const double value : {a[i], b[i]})
        if (std::isfinite(value)) scales[kind(i)] = std::max(scales[kind(i)], std::abs(value));
    moved.resize(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double scale = scales[kind(i)];
      const double difference = std::abs(a[i] - b[i]);
      const double share = std::isfinite(difference) && scale > 0 ? difference / scale : 0;
      moved[i] = std::max(moved[i], share);
    }
  }

 private:
  std::vector<unsigned> references_;
  std::vector<const Variable*> variables_;
};

class Somewhere {
 public:
  explicit Somewhere(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double state(const std::string& name) {
    const auto is = [&](const char* part) { return name.find(part) != std::string::npos; };
    if (is("shaft_angle")) return between(-7, 7);
    if (is("shaft_speed")) return between(-200, 200) * (between(0, 1) < 0.3 ? 0.01 : 1);
    if (is("_rate")) return between(-40, 40);
    if (is("lag")) return between(-1, 1) * std::pow(10.0, between(-5.5, -2));
    if (is("ln_p_")) return between(0, 1) < 0.5 ? between(-2.5, 6.5) : std::log(between(1, 650));
    if (is("twist")) return between(-0.08, 0.08);
    if (is("air_out")) return between(0, 1);
    return between(-1, 1);
  }
  double input(const std::string& name) {
    if (name == "drive_speed") return between(-200, 200);
    if (name == "drive_acceleration") return between(-2e4, 2e4);
    if (name == "drive_torque") return between(-400, 400);
    if (name == "suction_pressure") return between(-0.5e5, 8e5);
    if (name == "delivery_pressure") return between(1e5, 4e7);
    return between(0, 1) < 0.4 ? 1 : between(0.2, 1.6);
  }

 private:
  std::mt19937 random_;
};

// Other parameters: ports that are not symmetrical; without oil also values where the case has 0,
// as far as the pump then starts.
void set_others(Unit2& unit, const Resources& resources) {
  const bool oil = read_case(resources.path() / "case.toml").hydraulics.has_value();
  for (const Variable& it : resources.variables()) {
    const bool arc =
        it.name == "port_plate.delivery_arc_deg[1]" || it.name == "port_plate.suction_arc_deg[1]";
    if (it.role != Role::parameter || !(arc || (*it.start == 0 && !oil))) continue;
    Unit2 alone(resources, fmi2ModelExchange);
    const double value = arc ? *it.start + 2 : 0.3;
    if (alone.set(it.name, value) != fmi2OK) continue;
    if (oil || (alone.f.fmi2SetupExperiment(alone.it, 0, 0, 0, 0, 0) == fmi2OK &&
                alone.f.fmi2EnterInitializationMode(alone.it) == fmi2OK &&
                alone.f.fmi2ExitInitializationMode(alone.it) == fmi2OK))
      unit.set(it.name, value);
  }
}

TEST_P(Dependency, WhileItRuns) {
  const Functions& f = library();
  const Reader reader(resources_, true);
  std::vector<const Variable*> knowns;
  std::vector<unsigned> states;
  for (const Variable& it : resources_.variables()) {
    if (it.role == Role::state) states.push_back(it.reference);
    if (it.role == Role::state || it.role == Role::time || it.role == Role::input)
      knowns.push_back(&it);
  }
  std::set<std::pair<unsigned, unsigned>> seen;
  Somewhere random(7);
  int points = 0;
  for (const bool others : {false, true}) {
    Unit2 unit(resources_, fmi2ModelExchange);
    if (others) set_others(unit, resources_);
    ASSERT_EQ(f.fmi2SetupExperiment(unit.it, 0, 0, 0, 0, 0), fmi2OK);
    ASSERT_EQ(f.fmi2EnterInitializationMode(unit.it), fmi2OK);
    ASSERT_EQ(f.fmi2ExitInitializationMode(unit.it), fmi2OK) << unit.messages.text;
    fmi2EventInfo info;
    ASSERT_EQ(f.fmi2NewDiscreteStates(unit.it, &info), fmi2OK);
    for (int p = 0; p < 100; ++p) {
      double time = random.between(0, 0.6);
      std::vector<double> x;
      for (const unsigned state : states)
        x.push_back(random.state(resources_.variables()[state].name));
      std::map<std::string, double> inputs;
      for (const Variable* it : knowns)
        if (it->role == Role::input)
          inputs[it->name] = it->boolean ? random.between(0, 1) < 0.4 : random.input(it->name);
      const auto stand = [&](std::vector<double>& values) {
        for (const auto& [name, value] : inputs) {
          const unsigned reference = resources_[name];
          const fmi2Boolean flag = value != 0 ? fmi2True : fmi2False;
          const bool boolean = resources_.variables()[reference].boolean;
          EXPECT_EQ(boolean ? f.fmi2SetBoolean(unit.it, &reference, 1, &flag)
                            : f.fmi2SetReal(unit.it, &reference, 1, &value),
                    fmi2OK)
              << unit.messages.text;
        }
        EXPECT_EQ(f.fmi2SetTime(unit.it, time), fmi2OK);
        EXPECT_EQ(f.fmi2EnterContinuousTimeMode(unit.it), fmi2OK);
        EXPECT_EQ(f.fmi2SetContinuousStates(unit.it, x.data(), x.size()), fmi2OK);
        const bool there = reader.read(unit, values);
        return there && f.fmi2EnterEventMode(unit.it) == fmi2OK;
      };
      std::vector<double> before, after, moved;
      if (!stand(before)) {  // no rates there: begins anew
        ASSERT_EQ(f.fmi2Reset(unit.it), fmi2OK);
        if (others) set_others(unit, resources_);
        unit.start();
        continue;
      }
      ++points;
      for (const Variable* known : knowns) {
        const double time_here = time;
        const auto x_here = x;
        const auto inputs_here = inputs;
        if (known->role == Role::time) time += 1e-3;
        if (known->role == Role::state)
          x[known->place] +=
              (random.between(0, 1) < 0.5 ? 0.05 : -0.2) * known->nominal.value_or(1);
        if (known->role == Role::input) {
          double& value = inputs[known->name];
          value = known->boolean ? 1 - value : 0.9 * value;
        }
        const bool there = stand(after);
        if (!there) {
          ASSERT_EQ(f.fmi2Reset(unit.it), fmi2OK);
          if (others) set_others(unit, resources_);
          unit.start();
        } else {
          moved.clear();
          reader.compare(before, after, moved);
        }
        time = time_here;
        x = x_here;
        inputs = inputs_here;
        if (!there) continue;
        for (std::size_t i = 0; i < moved.size(); ++i) {
          const Variable& unknown = *reader.variables()[i];
          if (unknown.role == Role::state) continue;
          const bool said = says(said_.running, unknown.reference, known->reference);
          EXPECT_TRUE(said || moved[i] < kMoved || is_residual(unknown))
              << unknown.name << " moves with " << known->name << " by " << moved[i];
          if (moved[i] > kRounding) seen.emplace(unknown.reference, known->reference);
        }
      }
    }
  }
  EXPECT_GT(points, 60);
  for (const Variable* unknown : reader.variables()) {
    if (unknown->role == Role::state || is_residual(*unknown)) continue;
    for (const Dependence& one : said_.running.at(unknown->reference))
      EXPECT_EQ(seen.count({unknown->reference, one.known}), 1U)
          << unknown->name << " is said to depend on " << resources_.variables()[one.known].name;
  }
}

// One parameter or input after the other is another one at the start.
TEST_P(Dependency, AtTheStart) {
  const Reader reader(resources_, false);
  const auto start = [&](const Variable* other, double value, std::vector<double>& values) {
    Unit2 unit(resources_);
    const auto set = [&] {
      const fmi2Boolean flag = fmi2True;
      if (other->boolean) return unit.f.fmi2SetBoolean(unit.it, &other->reference, 1, &flag);
      return unit.set(other->name, value);
    };
    if (other != nullptr && set() != fmi2OK) return false;
    return unit.f.fmi2SetupExperiment(unit.it, 0, 0, 0, 0, 0) == fmi2OK &&
           unit.f.fmi2EnterInitializationMode(unit.it) == fmi2OK &&
           unit.f.fmi2ExitInitializationMode(unit.it) == fmi2OK && reader.read(unit, values);
  };
  std::vector<double> before, after, moved;
  ASSERT_TRUE(start(nullptr, 0, before));
  // With oil each start is a periodic state: of similar kinds every fifth, of two kinds all.
  const std::string& name = GetParam().name;
  const bool oil = read_case(resources_.path() / "case.toml").hydraulics.has_value();
  const bool all = !oil || name == "bap63_reversal" ||
                   (name == "bap63_rated_hydraulic" && GetParam().drive == "torque");
  constexpr unsigned kShare = 5;
  int tried = 0;
  std::set<unsigned> of_something, moves_something;
  for (const Variable& known : resources_.variables()) {
    if (known.role != Role::parameter && known.role != Role::input) continue;
    if (!all && known.reference % kShare != 0) continue;
    const double here = *known.start;
    bool there = start(&known, here == 0 ? 0.01 : here * 0.997, after);
    there = there || start(&known, here == 0 ? -0.01 : here * 1.003, after);
    if (!there) continue;
    ++tried;
    moved.clear();
    reader.compare(before, after, moved);
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const Variable& unknown = *reader.variables()[i];
      const bool said = says(said_.initial, unknown.reference, known.reference);
      EXPECT_TRUE(said || moved[i] < kMoved || is_residual(unknown))
          << unknown.name << " moves with " << known.name << " by " << moved[i] << ", from "
          << before[i] << " to " << after[i];
      if (is_residual(unknown)) continue;
      if (said) of_something.insert(known.reference);
      if (moved[i] > kRounding) moves_something.insert(known.reference);
    }
  }
  EXPECT_GT(tried, all ? 25 : 10);
  for (const unsigned reference : moves_something) EXPECT_EQ(of_something.count(reference), 1U);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Dependency,
    testing::Values(
        Kind{"bap63_rated", "speed", {}}, Kind{"bap63_rated", "torque", {}},
        Kind{"bap63_rated_hydraulic", "speed", {}}, Kind{"bap63_rated_hydraulic", "torque", {}},
        Kind{"bap63_load_step", "speed", {}}, Kind{"bap63_load_step", "case", {}},
        Kind{"bap63_teeth", "speed", {}}, Kind{"bap63_teeth", "torque", {}},
        Kind{"bap63_tooth_rattle", "speed", {}}, Kind{"bap63_motor_start", "case", {}},
        Kind{"bap63_motoring", "torque", {}}, Kind{"bap63_reversal", "case", {}},
        Kind{"bap63_peak_hydraulic", "speed", {}},
        Kind{"bap63_rated_hydraulic",
             "speed",
             {{"\n[hydraulics]\n",
               "\n[suction_line]\nlength_m = 0.8\ndiameter_mm = 40\n\n[hydraulics]\n"}}},
        Kind{"bap63_rated_hydraulic",
             "speed",
             {{"\n[hydraulics]\n", "\n[load]\nkind = \"laminar\"\n\n[hydraulics]\n"}}},
        Kind{"bap63_rated_hydraulic",
             "speed",
             {{"\n[hydraulics]\n", "\n[load]\nkind = \"relief_valve\"\n\n[hydraulics]\n"}}}),
    [](const auto& parameter) {
      return parameter.param.name + "_" + parameter.param.drive + "_" +
             std::to_string(parameter.index);
    });

}  // namespace
}  // namespace bentaxis::fmu
