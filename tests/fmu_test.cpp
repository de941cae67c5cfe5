// The pump's own unit through importers of our own, for both versions and both kinds, against
// simulate; expectations first: 1e-8 of the peak of every output, whatever the steps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "bentaxis/fmu/slave.h"
#include "bentaxis/fmu/unit.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/study/simulation.h"
#include "fmu_exchange.h"
#include "support.h"

namespace bentaxis {
namespace {

namespace fs = std::filesystem;
using Columns = std::map<std::string, std::vector<double>>;

constexpr double kDuration = 0.012;
constexpr int kRows = 24;

Case rated() {
  Case c = read_case(fs::path(BENTAXIS_SOURCE_DIR) / "cases/bap63_rated_hydraulic.toml");
  DriveSpec drive;
  drive.duration = kDuration;
  drive.samples = kRows;
  c.drive = drive;
  return c;
}

// From rest by a motor, with teeth that give way and have backlash: they rattle.
Case rattling() {
  Case c = read_case(fs::path(BENTAXIS_SOURCE_DIR) / "cases/bap63_motor_start.toml");
  c.drive->duration = kDuration;
  c.drive->samples = kRows;
  return c;
}

// Rows of simulate: reactions, states and oil by their columns.
struct Truth {
  Columns columns;
  std::size_t touches = 0;  // of flanks, and leavings
};
const Truth& simulated(const Case& c) {
  static std::map<std::string, Truth> kept;
  if (const auto found = kept.find(c.name); found != kept.end()) return found->second;
  Truth& truth = kept[c.name];
  truth.columns = [&] {
    study::SimulationChoice choice;
    choice.only = study::Model::analytic;
    choice.error = 1e-8;
    const auto r = study::simulate(study::prepare_simulation(c, choice), choice);
    truth.touches = r.analytic->record.events.size();
    const Trajectory& t = *r.analytic;
    Columns made;
    for (std::size_t row = 0; row < t.lag.size(); ++row) {
      for (std::size_t i = 1; i < t.table.state_names.size(); ++i)
        made[t.table.state_names[i]].push_back(t.table.state(row, i));
      for (const Channel& channel : t.table.results.channels)
        if (channel.kind == ChannelKind::reaction)
          made[channel.name].push_back(t.table.results.at(row, t.table.results.find(channel.name)));
      // Flows through open ports are errors of the pressures a thousand times larger.
      for (std::size_t i = 0; t.oil && i < t.oil->columns.size(); ++i)
        if (t.oil->columns[i].name.find("_bar") != std::string::npos)
          made[t.oil->columns[i].name].push_back(t.oil->value(row, i));
    }
    return made;
  }();
  return truth;
}

// A unit in a file that goes.
class PumpUnit {
 public:
  PumpUnit(int version, const Case& the_case, fmu::Drive drive = fmu::Drive::speed,
           bool si_outputs = false) {
    fmu::UnitOptions wanted;
    wanted.si_outputs = si_outputs;
    wanted.drive = drive;
    wanted.version = version == 2 ? fmu::Version::fmi2 : fmu::Version::fmi3;
    wanted.tolerance = 1e-11;
    std::string pattern = (fs::temp_directory_path() / "bentaxis_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    std::ofstream(folder_ / "pump.fmu", std::ios::binary) << fmu::unit_archive(the_case, wanted);
    unit_ = std::make_unique<fmu::ImportedUnit>(folder_ / "pump.fmu");
  }
  ~PumpUnit() { fs::remove_all(folder_); }
  PumpUnit(const PumpUnit&) = delete;
  PumpUnit& operator=(const PumpUnit&) = delete;
  const fmu::ImportedUnit& operator*() const { return *unit_; }
  const fmu::ImportedUnit* operator->() const { return unit_.get(); }

 private:
  fs::path folder_;
  std::unique_ptr<fmu::ImportedUnit> unit_;
};

// Rows of an instance at the times of simulate.
Columns stepped(const fmu::ImportedUnit& unit, const Columns& wanted, int parts) {
  const auto slave = unit.instantiate("pump");
  slave->enter_initialisation(0, kDuration);
  slave->exit_initialisation();
  Columns rows;
  const auto add = [&] {
    for (const auto& [name, values] : wanted)
      rows[name].push_back(slave->get(*unit.description().find(name)));
  };
  add();
  const double step = kDuration / (kRows * parts);
  for (int i = 0; i < kRows * parts; ++i) {
    slave->step(step * i, step);
    if ((i + 1) % parts == 0) add();
  }
  return rows;
}

double apart(const Columns& a, const Columns& b, const char* what) {
  double worst = 0;
  std::string where;
  for (const auto& [name, values] : b) {
    // Components of one force have one peak: Rs_1_x2_N, Rs_1_y2_N.
    double peak = 0;
    const std::string group = name.substr(0, name.find('_'));
    for (const auto& [other, others] : b)
      if (other.substr(0, other.find('_')) == group)
        for (const double x : others) peak = std::max(peak, std::abs(x));
    const std::vector<double>& mine = a.at(name);
    EXPECT_EQ(mine.size(), values.size());
    for (std::size_t row = 0; row < values.size() && peak > 0; ++row)
      if (const double share = std::abs(mine[row] - values[row]) / peak; !(share <= worst)) {
        worst = share;
        where = name;
      }
  }
  std::printf("%s: %.2e of peak (%s)\n", what, worst, where.c_str());
  return worst;
}

#ifdef BENTAXIS_SANITIZER_RUNTIME
// The process of an FMU is never sanitized. The pump's library is in this build, and needs the
// sanitizer's runtime before all others.
class RuntimeFirst : public testing::Environment {
  void SetUp() override { setenv("LD_PRELOAD", BENTAXIS_SANITIZER_RUNTIME, 1); }
};
const auto* const kRuntimeFirst = testing::AddGlobalTestEnvironment(new RuntimeFirst);
#endif

TEST(PumpUnitTest, CoSimulationIsSimulateWhateverTheStep) {
  for (const int version : {2, 3}) {
    const Columns& truth = simulated(rated()).columns;
    const PumpUnit pump(version, rated());
    const Columns coarse = stepped(*pump, truth, 1), fine = stepped(*pump, truth, 7);
    EXPECT_LT(apart(coarse, truth, "a step per row, against simulate"), 1e-8);
    EXPECT_LT(apart(fine, truth, "seven steps per row"), 1e-8);
    EXPECT_LT(apart(fine, coarse, "against each other"), 1e-8);
  }
}

// The same pump twice: only outputs differ, by the factors of their units.
TEST(PumpUnitTest, OutputsInTheUnitsOfTheSi) {
  const std::map<std::string, std::string> renamed = {
      {"theta_deg", "theta_rad"}, {"shaft_rpm", "shaft_rad_per_s"},
      {"xh_x2_mm", "xh_x2_m"},    {"p_1_bar", "p_1_Pa"},
      {"Td_z1_Nm", "Td_z1_Nm"},   {"flow_delivery_l_per_min", "flow_delivery_m3_per_s"}};
  for (const int version : {2, 3}) {
    const PumpUnit columns(version, rated());
    const PumpUnit si(version, rated(), fmu::Drive::speed, true);
    const auto& plain = columns->description().variables;
    const auto& others = si->description().variables;
    ASSERT_EQ(plain.size(), others.size());
    EXPECT_NE(columns->description().token, si->description().token);
    for (const auto& [name, new_name] : renamed) {
      ASSERT_TRUE(columns->description().find(name)) << name;
      ASSERT_TRUE(si->description().find(new_name)) << new_name;
    }
    const auto a = columns->instantiate("pump"), b = si->instantiate("pump");
    for (const auto& slave : {&a, &b}) {
      (*slave)->enter_initialisation(0, kDuration);
      (*slave)->exit_initialisation();
      (*slave)->step(0, kDuration / kRows);
    }
    int changed = 0, outputs = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      SCOPED_TRACE(plain[i].name + ", " + others[i].name);
      EXPECT_EQ(plain[i].reference, others[i].reference);
      if (plain[i].causality != "output" || plain[i].unit.empty()) {
        EXPECT_EQ(plain[i].name, others[i].name);
        EXPECT_EQ(plain[i].unit, others[i].unit);
        continue;
      }
      ++outputs;
      changed += plain[i].name != others[i].name;
      EXPECT_EQ(plain[i].name != others[i].name, plain[i].unit != others[i].unit);
      ASSERT_TRUE(plain[i].measure && others[i].measure);
      EXPECT_EQ(others[i].measure->factor, 1);
      EXPECT_EQ(plain[i].measure->exponents, others[i].measure->exponents);
      const double there = a->get(plain[i]) * plain[i].measure->factor;
      const double here = b->get(others[i]);
      EXPECT_LE(std::abs(here - there),
                4 * std::numeric_limits<double>::epsilon() * std::abs(here));
    }
    // Angle, angle, speed, speed, point of the film, ring contacts, pressures, flows.
    EXPECT_GE(changed, 14);
    EXPECT_GT(outputs - changed, 40);  // N, Nm, W
  }
}

TEST(PumpUnitTest, InterleavedInstancesAreEachAlone) {
  const PumpUnit pump(3, rated());
  const fmu::UnitVariable torque = *pump->description().find("Td_z1_Nm");
  const fmu::UnitVariable tilt = *pump->description().find("pump.tilt_deg");
  const auto start = [&](double degrees) {
    auto slave = pump->instantiate("pump");
    slave->set(tilt, degrees);
    slave->enter_initialisation(0, kDuration);
    slave->exit_initialisation();
    return slave;
  };
  std::vector<double> alone[2];
  for (int i = 0; i < 2; ++i) {
    const auto slave = start(40 - 5 * i);
    for (int k = 0; k < 10; ++k) {
      slave->step(k * 1e-4, 1e-4);
      alone[i].push_back(slave->get(torque));
    }
  }
  const auto a = start(40), b = start(35);
  for (int k = 0; k < 10; ++k) {
    a->step(k * 1e-4, 1e-4);
    b->step(k * 1e-4, 1e-4);
    EXPECT_EQ(a->get(torque), alone[0][static_cast<std::size_t>(k)]);
    EXPECT_EQ(b->get(torque), alone[1][static_cast<std::size_t>(k)]);
  }
  EXPECT_GT(std::abs(alone[0].back() - alone[1].back()), 1);
}

// Rows by an integrator that knows FMI's calls alone; events are where indicators change sign.
struct Exchanged {
  Columns rows;
  std::size_t states = 0;
  long events = 0;
};
Exchanged exchanged(const fmu::ImportedUnit& unit, const Columns& wanted, double tolerance) {
  const int version = unit.description().version;
  const fs::path file = unit.folder() / "binaries" / (version == 2 ? "linux64" : "x86_64-linux") /
                        (unit.description().identifier + ".so");
  const std::unique_ptr<void, int (*)(void*)> library(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL),
                                                      dlclose);
  if (!library) throw std::runtime_error(dlerror());
  std::ostringstream text;
  text << std::ifstream(unit.folder() / "modelDescription.xml").rdbuf();
  const std::string xml = text.str();
  std::smatch found;
  const std::size_t indicators =
      std::regex_search(xml, found, std::regex("numberOfEventIndicators=\"(\\d+)\""))
          ? std::stoul(found[1])
          : 0;
  std::unique_ptr<test::Exchange> it;
  if (version == 2)
    it = std::make_unique<test::Exchange2>(library.get(), unit, indicators, kDuration);
  else
    it = std::make_unique<test::Exchange3>(library.get(), unit, kDuration);
  test::Solver solver(*it, tolerance);
  Exchanged result;
  result.states = it->states();
  for (int row = 0; row <= kRows; ++row) {
    solver.go_to(kDuration * row / kRows);
    for (const auto& [name, values] : wanted)
      result.rows[name].push_back(it->get(unit.description().find(name)->reference));
  }
  result.events = solver.events;
  std::printf("FMI %d: %ld steps, %ld events\n", version, solver.steps, solver.events);
  return result;
}

TEST(PumpUnitTest, ModelExchangeIsSimulateWithEventsAtTheEdges) {
  for (const int version : {2, 3}) {
    const Columns& truth = simulated(rated()).columns;
    const PumpUnit pump(version, rated());
    const Exchanged it = exchanged(*pump, truth, 1e-11);
    EXPECT_EQ(it.states, 7U);  // angle, five chambers, delivery
    EXPECT_LT(apart(it.rows, truth, "model exchange, against simulate"), 1e-8);
    // One for each edge of a port that a chamber passes in 108 degrees.
    long edges = 0;
    for (const double edge : hydraulics::oil_in_time(rated(), {})->edges_deg())
      if (edge > 0 && edge < 360 * kDuration * 1500 / 60) ++edges;
    EXPECT_EQ(it.events, edges);
  }
}

// Impacts make errors grow: 1e-7 of peak, and a touch or a leaving at least as often as simulate
// has them.
TEST(PumpUnitTest, ModelExchangeHasEventsWhereTeethTouch) {
  for (const int version : {2, 3}) {
    const Truth& truth = simulated(rattling());
    EXPECT_GT(truth.touches, 2U);
    const PumpUnit pump(version, rattling(), fmu::Drive::as_in_case);
    EXPECT_LT(apart(stepped(*pump, truth.columns, 3), truth.columns, "co-simulation of rattle"),
              1e-7);
    const Exchanged it = exchanged(*pump, truth.columns, 1e-11);
    EXPECT_LT(apart(it.rows, truth.columns, "model exchange of rattle"), 1e-7);
    std::printf("%zu touches and leavings\n", truth.touches);
    EXPECT_GE(it.events, static_cast<long>(truth.touches));
  }
}

}  // namespace
}  // namespace bentaxis
