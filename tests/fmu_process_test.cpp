// FMUs run in processes of their own: whatever an FMU does, its call ends with its name and that of
// the function, and nothing is left behind. tests/fmu_units/hostile.c has what is done.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cfenv>
#include <chrono>
#include <clocale>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "channel.h"

namespace bentaxis::fmu {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr double kShort = 1;  // s, for calls that hang: others take milliseconds

fs::path unit(const std::string& name, int version) {
  return fs::path(BENTAXIS_TEST_UNITS) / (name + "_fmi" + std::to_string(version) + ".fmu");
}

// Processes whose environment names a folder: those of FMUs, with what they have started.
std::vector<int> processes_of(const fs::path& folder) {
  std::vector<int> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream in(entry.path() / "environ", std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (text.find("TMPDIR=" + folder.string()) != std::string::npos)
      found.push_back(std::stoi(name));
  }
  return found;
}

class FmuProcessTest : public testing::Test {
 protected:
  FmuProcessTest() : old_temporary_(getenv("TMPDIR") != nullptr ? getenv("TMPDIR") : "") {
    std::string name = (fs::temp_directory_path() / "bentaxis_test_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    setenv("TMPDIR", folder_.c_str(), 1);
  }
  ~FmuProcessTest() override {
    unsetenv("BENTAXIS_TEST_HOSTILE");
    expect_nothing_left();
    if (old_temporary_.empty())
      unsetenv("TMPDIR");
    else
      setenv("TMPDIR", old_temporary_.c_str(), 1);
    fs::remove_all(folder_);
  }

  void expect_nothing_left() const {
    EXPECT_THAT(processes_of(folder_), IsEmpty());
    EXPECT_TRUE(fs::is_empty(folder_));
  }

  // The supervisor does it, after the program has ended.
  void wait_until_nothing_is_left() const {
    constexpr int kTries = 1000;
    for (int i = 0; i < kTries && !(processes_of(folder_).empty() && fs::is_empty(folder_)); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    expect_nothing_left();
  }

  // A life from loading to the end, with one call of each kind.
  static std::vector<double> live(int version, const Limits& limits = {},
                                  const std::string& name = "hostile_rotor",
                                  std::vector<std::string>* log = nullptr) {
    const ImportedUnit opened(unit(name, version), limits);
    const auto variable = [&](const char* wanted) { return *opened.description().find(wanted); };
    const auto slave = opened.instantiate("it");
    slave->set(variable("torque"), 300);
    slave->enter_initialisation(0, 1);
    slave->set(variable("Td_z1_Nm"), 290.1);
    slave->exit_initialisation();
    std::vector<double> values;
    for (int i = 0; i < 5; ++i) {
      slave->step(0.1 * i, 0.1);
      values.push_back(slave->get(variable("drive_speed")));
      values.push_back(slave->get(variable("drive_acceleration")));
    }
    slave->end();
    if (log != nullptr) *log = slave->log();
    return values;
  }

  // What is said of a life with an action at a place; "lived": nothing.
  std::string said(const std::string& place, const std::string& action, int version,
                   const Limits& limits = {}) const {
    setenv("BENTAXIS_TEST_HOSTILE", (place + " " + action).c_str(), 1);
    std::string text = "lived";
    try {
      live(version, limits);
    } catch (const ComputationError& error) {
      text = error.what();
      EXPECT_THAT(text, AllOf(HasSubstr("hostile_rotor_fmi"), Not(HasSubstr("\n"))));
    }
    unsetenv("BENTAXIS_TEST_HOSTILE");
    expect_nothing_left();
    return text;
  }

  fs::path folder_;

 private:
  std::string old_temporary_;
};

// ---- Ends

struct Place {
  const char* name;
  const char* functions[2];  // of FMI 2, of FMI 3; "": there is none
};
const std::vector<Place>& places() {
  static const std::vector<Place> all = {
      {"load", {"loading rotor.so", "loading rotor.so"}},
      {"instantiate", {"fmi2Instantiate", "fmi3InstantiateCoSimulation"}},
      {"set_up", {"fmi2SetupExperiment", ""}},
      {"enter", {"fmi2EnterInitializationMode", "fmi3EnterInitializationMode"}},
      {"exit", {"fmi2ExitInitializationMode", "fmi3ExitInitializationMode"}},
      {"set", {"fmi2SetReal of \"torque\"", "fmi3SetFloat64 of \"torque\""}},
      {"get", {"fmi2GetReal of \"drive_speed\"", "fmi3GetFloat64 of \"drive_speed\""}},
      {"step", {"fmi2DoStep at 0 s", "fmi3DoStep at 0 s"}},
      {"terminate", {"fmi2Terminate", "fmi3Terminate"}},
      {"free", {"fmi2FreeInstance", "fmi3FreeInstance"}}};
  return all;
}

TEST_F(FmuProcessTest, AnEndAnywhereNamesTheFunction) {
  for (const Place& place : places())
    for (const int version : {2, 3}) {
      const std::string function = place.functions[version - 2];
      if (function.empty()) continue;
      EXPECT_THAT(said(place.name, "exit0", version),
                  EndsWith(": " + function + ": the FMU ended its process, by exit status 0"));
      EXPECT_THAT(said(place.name, "segv", version),
                  HasSubstr(": " + function + ": the FMU ended by signal SIGSEGV (Segmentation "));
    }
}

TEST_F(FmuProcessTest, AHangAnywhereIsEndedInTime) {
  Limits limits;
  limits.call_seconds = kShort;
  for (const Place& place : places())
    for (const int version : {2, 3}) {
      const std::string function = place.functions[version - 2];
      if (function.empty()) continue;
      EXPECT_THAT(said(place.name, "hang", version, limits),
                  AllOf(HasSubstr(": " + function + ": the FMU has not returned after 1 s"),
                        HasSubstr("--fmu-timeout")));
    }
  EXPECT_THAT(said("unload", "hang", 2, limits), HasSubstr("exit handlers"));
  EXPECT_THAT(said("unload", "segv", 2, limits),
              AllOf(HasSubstr("exit handlers"), HasSubstr("SIGSEGV")));
}

TEST_F(FmuProcessTest, EveryWayToEndIsSaid) {
  const auto step = [&](const char* action) { return said("step", action, 2); };
  EXPECT_THAT(step("exit7"), EndsWith("by exit status 7"));
  EXPECT_THAT(step("abort"),
              AllOf(HasSubstr("SIGABRT"), EndsWith("it printed: no licence for this pump")));
  EXPECT_THAT(step("log_and_abort"), EndsWith("it logged: warning: the licence has run out"));
  EXPECT_THAT(step("divide"), HasSubstr("SIGFPE"));
  EXPECT_THAT(step("kill"), HasSubstr("SIGKILL"));
  EXPECT_THAT(step("kill_group"), HasSubstr("SIGKILL"));
  EXPECT_THAT(step("stop"), HasSubstr("SIGSTOP"));
  EXPECT_THAT(step("recursion"), HasSubstr("SIGSEGV"));
  EXPECT_THAT(step("exception"), EndsWith("the FMU threw a C++ exception: no level of oil"));
  EXPECT_THAT(step("close_all"), EndsWith("the FMU closed the descriptor by which it is called"));
  EXPECT_THAT(step("close_and_open"), EndsWith("by which it is called"));
  EXPECT_THAT(step("close_and_pair"), EndsWith("by which it is called"));
  EXPECT_THAT(step("rubbish"), Not(HasSubstr("lived")));
  EXPECT_THAT(step("kill_supervisor"), HasSubstr("the process of the FMU"));
}

TEST_F(FmuProcessTest, NoSignalHandlerKeepsAnFmuAlive) {
  Limits limits;
  limits.call_seconds = kShort;
  for (const char* action : {"hang_deaf", "hang_in_handler", "endless_log", "endless_print"})
    EXPECT_THAT(said("step", action, 3, limits), HasSubstr("has not returned")) << action;
}

// ---- What it goes on from

TEST_F(FmuProcessTest, WhatChangesItsProcessLeavesResultsAndProgramAlone) {
  const fs::path here = fs::current_path();
  for (const int version : {2, 3}) {
    const std::vector<double> wanted = live(version, {}, "rotor");
    for (const char* action :
         {"close_standard", "chdir", "print", "flood", "long_log", "strange_log", "limits",
          "handlers", "fork", "daemon", "lock_folder"}) {
      setenv("BENTAXIS_TEST_HOSTILE", ("step " + std::string(action)).c_str(), 1);
      EXPECT_EQ(live(version), wanted) << action;
      expect_nothing_left();
    }
    // The FMU computes in its own way then; the program does not.
    setenv("BENTAXIS_TEST_HOSTILE", "step numbers", 1);
    live(version);
    EXPECT_EQ(std::fegetround(), FE_TONEAREST);
    EXPECT_STREQ(std::setlocale(LC_ALL, nullptr), "C");
    unsetenv("BENTAXIS_TEST_HOSTILE");
  }
  EXPECT_EQ(fs::current_path(), here);
  const mode_t mask = umask(0);
  umask(mask);
  EXPECT_NE(mask, 0777U);
}

TEST_F(FmuProcessTest, WhatAnFmuLogsIsCutAndPlain) {
  for (const int version : {2, 3}) {
    const auto log_of = [&](const char* action) {
      setenv("BENTAXIS_TEST_HOSTILE", (std::string("enter ") + action).c_str(), 1);
      std::vector<std::string> log;
      live(version, {}, "hostile_rotor", &log);
      return log;
    };
    EXPECT_THAT(log_of("strange_log"), ElementsAre("warning: a [31mred ?? bar\xc3\xa9"));
    EXPECT_THAT(log_of("long_log"), ElementsAre("warning: " + std::string(400, 'x') + ".."));
    const std::vector<std::string> flood = log_of("flood");
    EXPECT_EQ(flood.size(), 1000U);
    EXPECT_THAT(flood.back(), StartsWith("warning: message 1"));
  }
}

TEST_F(FmuProcessTest, TextsArePlainUtf8) {
  EXPECT_EQ(plain_text("oil", 3), "oil");
  EXPECT_EQ(plain_text("oil level", 3), "oil..");
  EXPECT_EQ(plain_text("a\tb\x7f \n", 9), "a b");
  EXPECT_EQ(plain_text("\xc3\xa9\xc3\xa9", 3), "\xc3\xa9..");  // whole characters
  EXPECT_EQ(plain_text("\xf0\x9f\x9b\xa2", 4), "\xf0\x9f\x9b\xa2");
  // Cut short, overlong, a surrogate, beyond the last character, a control character of two bytes.
  EXPECT_EQ(plain_text("\xc3", 9), "?");
  EXPECT_EQ(plain_text("\xc0\xaf\xe0\x80\xaf", 9), "?????");
  EXPECT_EQ(plain_text("\xed\xa0\x80", 9), "???");
  EXPECT_EQ(plain_text("\xf4\x90\x80\x80", 9), "????");
  EXPECT_EQ(plain_text("a\xc2\x85z", 9), "a z");
}

// ---- Limits

TEST_F(FmuProcessTest, TheCallerIsAskedWhileAnFmuComputes) {
  struct Enough {};
  Limits limits;
  limits.call_seconds = 0;  // no limit
  int asked = 0;
  limits.while_waiting = [&] {
    if (++asked == 3) throw Enough();
  };
  setenv("BENTAXIS_TEST_HOSTILE", "step hang", 1);
  EXPECT_THROW(live(2, limits), Enough);
  EXPECT_EQ(asked, 3);
}

TEST_F(FmuProcessTest, AnInstanceThatIsNotEndedIsFreed) {
  for (const char* action :
       {"free trace", "terminate trace", "unload trace", "free hang", "free exit0"}) {
    setenv("BENTAXIS_TEST_HOSTILE", action, 1);
    {
      const ImportedUnit opened(unit("hostile_rotor", 2));
      const auto slave = opened.instantiate("it");
      slave->enter_initialisation(0, 1);
      slave->exit_initialisation();
    }
    EXPECT_EQ(fs::remove(folder_ / "trace"), std::string(action).find("trace") != std::string::npos)
        << action;
    expect_nothing_left();
  }
}

TEST_F(FmuProcessTest, InstancesHaveProcessesOfTheirOwn) {
  setenv("BENTAXIS_TEST_HOSTILE", "step exit0", 1);
  const ImportedUnit opened(unit("hostile_rotor", 3));
  const auto first = opened.instantiate("first");
  const auto second = opened.instantiate("second");
  for (const auto& slave : {first.get(), second.get()}) {
    slave->enter_initialisation(0, 1);
    slave->exit_initialisation();
  }
  EXPECT_THROW(first->step(0, 0.1), ComputationError);
  EXPECT_EQ(second->get(*opened.description().find("drive_speed")), 1500);
  // There is no calling it again.
  EXPECT_THROW(first->step(0.1, 0.1), ComputationError);
}

TEST_F(FmuProcessTest, ManyVariablesGoInOneMessageAndOneIsNamed) {
  const ImportedUnit opened(unit("rotor", 2));
  const auto slave = opened.instantiate("it");
  const UnitVariable& torque = *opened.description().find("torque");
  const UnitVariable& load = *opened.description().find("Td_z1_Nm");
  slave->set({&torque, &load}, {310, 290});
  EXPECT_THAT(slave->get({&load, &torque, opened.description().find("drive_acceleration")}),
              ElementsAre(290, 310, 100));
  EXPECT_THAT(slave->get(std::vector<const UnitVariable*>(2500, &load)),
              testing::Each(290));  // of several messages
  EXPECT_THAT(slave->get(std::vector<const UnitVariable*>()), IsEmpty());
}

// ---- The program

// In a process of its own, which ends as `how` has it while an FMU is open or computes.
void die_with_an_fmu(const std::function<void()>& how) {
  const pid_t child = fork();
  if (child == 0) {
    how();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
}

TEST_F(FmuProcessTest, NothingIsLeftByAProgramThatDies) {
  const auto killed_later = [](const char* hostile, const std::function<void()>& work) {
    setenv("BENTAXIS_TEST_HOSTILE", hostile, 1);
    die_with_an_fmu([&] {
      std::thread([] {
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        kill(getpid(), SIGKILL);
      }).detach();
      work();
      for (;;) pause();
    });
  };
  Limits endless;
  endless.call_seconds = 0;
  killed_later("step hang", [&] { live(2, endless); });
  wait_until_nothing_is_left();
  killed_later("enter daemon", [&] {
    static const ImportedUnit opened(unit("hostile_rotor", 3));
    static const auto slave = opened.instantiate("it");
    slave->enter_initialisation(0, 1);
  });
  wait_until_nothing_is_left();
}

TEST_F(FmuProcessTest, AThreadMayOpenAnFmuAndEnd) {
  std::unique_ptr<ImportedUnit> opened;
  std::unique_ptr<Slave> slave;
  std::thread([&] {
    opened = std::make_unique<ImportedUnit>(unit("rotor", 2));
    slave = opened->instantiate("it");
  }).join();
  EXPECT_EQ(slave->get(*opened->description().find("drive_speed")), 1500);
  slave->end();
}

TEST_F(FmuProcessTest, AProgramThatIgnoresItsChildrenMayUseFmus) {
  std::signal(SIGCHLD, SIG_IGN);
  const std::vector<double> values = live(2);
  std::signal(SIGCHLD, SIG_DFL);
  EXPECT_EQ(values, live(2));
}

TEST_F(FmuProcessTest, WithoutRoomForFoldersOrProcessesItSaysSo) {
  struct rlimit usual {};
  getrlimit(RLIMIT_NOFILE, &usual);
  const auto refused = [&] {
    try {
      const ImportedUnit opened(unit("rotor", 2));
    } catch (const std::exception& error) {
      setrlimit(RLIMIT_NOFILE, &usual);  // sanitizers need descriptors, too
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  setenv("TMPDIR", (folder_ / "none").c_str(), 1);
  EXPECT_THAT(refused(), AllOf(HasSubstr("TMPDIR = "), HasSubstr("not a directory")));
  setenv("TMPDIR", folder_.c_str(), 1);
  // No descriptor is left for sockets.
  int report[2];
  ASSERT_EQ(pipe(report), 0);
  const pid_t child = fork();
  if (child == 0) {
    struct rlimit few = usual;
    few.rlim_cur = static_cast<rlim_t>(report[1] + 2);
    setrlimit(RLIMIT_NOFILE, &few);
    const std::string said = refused();
    (void)!write(report[1], said.data(), said.size());
    _exit(0);
  }
  close(report[1]);
  int status = 0;
  waitpid(child, &status, 0);
  std::array<char, 1000> text{};
  EXPECT_GT(read(report[0], text.data(), text.size() - 1), 0);
  EXPECT_THAT(std::string(text.data()), HasSubstr("Too many open files"));
  close(report[0]);
}

TEST_F(FmuProcessTest, AProgramWithoutStandardStreamsMayUseFmus) {
  int status = 0;
  const pid_t child = fork();
  if (child == 0) {
    for (int i = 0; i < 5; ++i) close(i);
    bool lived = false;
    try {
      lived = live(3).size() == 10;
    } catch (const std::exception&) {
    }
    _exit(lived ? 0 : 1);
  }
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace bentaxis::fmu
