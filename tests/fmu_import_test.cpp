// Units of others: what is refused, and what a unit for co-simulation is asked and says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zip.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/files/input_log.h"
#include "bentaxis/files/kept_case.h"
#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "unpacked.h"

namespace bentaxis::fmu {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

using Entries = std::vector<std::pair<std::string, std::string>>;

template <class Error>
std::string message_of(const std::function<void()>& job) {
  try {
    job();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    return error.what();
  }
  return "accepted";
}

fs::path unit(const std::string& name, int version) {
  return fs::path(BENTAXIS_TEST_UNITS) / (name + "_fmi" + std::to_string(version) + ".fmu");
}

// Unpacked units of all programs that run now.
std::vector<fs::path> unpacked_folders() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(fs::temp_directory_path()))
    if (entry.path().filename().string().rfind("bentaxis-fmu-", 0) == 0)
      found.push_back(entry.path());
  return found;
}

class FmuImportTest : public testing::Test {
 protected:
  FmuImportTest() {
    std::string name = (fs::temp_directory_path() / "bentaxis_test_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    temporary_ = folder_ / "tmp";
    fs::create_directory(temporary_);
    setenv("TMPDIR", temporary_.c_str(), 1);  // every test sees what is left there
  }
  ~FmuImportTest() override {
    EXPECT_TRUE(unpacked_folders().empty());
    unsetenv("TMPDIR");
    fs::remove_all(folder_);
  }

  fs::path archive(const Entries& entries) const {
    fs::path file = folder_ / "made.fmu";
    int error = 0;
    zip_t* zip = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    for (const auto& [name, text] : entries)
      zip_file_add(zip, name.c_str(), zip_source_buffer(zip, text.data(), text.size(), 0),
                   ZIP_FL_ENC_UTF_8);
    zip_close(zip);
    return file;
  }
  static std::string of(const fs::path& file) {
    return message_of<InputError>([&] { const ImportedUnit opened(file); });
  }
  std::string of(const Entries& entries) const { return of(archive(entries)); }
  // A description that differs from a good one by what is replaced.
  std::string with(const std::string& what, const std::string& by, int version = 2) const {
    std::ifstream in(fs::path(BENTAXIS_SOURCE_DIR) / "tests/fmu_units" /
                     ("valve.fmi" + std::to_string(version) + ".xml"));
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
    return of({{"modelDescription.xml", text}});
  }

  fs::path folder_, temporary_;
};

TEST_F(FmuImportTest, RefusesWhatIsNoUnitByName) {
  EXPECT_THAT(of(folder_ / "none.fmu"), EndsWith("none.fmu: does not exist"));
  EXPECT_THAT(of(folder_), HasSubstr("is a directory"));
  std::ofstream(folder_ / "text.fmu") << "hello";
  EXPECT_THAT(of(folder_ / "text.fmu"), HasSubstr("not a zip archive"));
  EXPECT_THAT(of(Entries{{"readme.txt", "hello"}}), HasSubstr("it has no modelDescription.xml"));
  EXPECT_THAT(of(Entries{{"modelDescription.xml", "<fmi"}}), HasSubstr("is no XML"));
  EXPECT_THAT(of(Entries{{"modelDescription.xml", "<other/>"}}),
              HasSubstr("must be <fmiModelDescription>"));
}

// The bytes that were unpacked are those that are noted, whatever the file is later.
TEST_F(FmuImportTest, NotesWhatItHasRead) {
  const fs::path any = unit("motor", 2);
  const InputLog log;
  const Unpacked unpacked(any);
  ASSERT_EQ(log.noted().size(), 1);
  EXPECT_EQ(log.noted()[0].file, any);
  EXPECT_EQ(log.noted()[0].sha256, sha256_of(bytes_of(any)));
}

TEST_F(FmuImportTest, RefusesPathsThatLeaveTheFolder) {
  for (const std::string name : {"../evil.txt", "resources/../../evil.txt", "/tmp/evil.txt",
                                 "resources\\..\\evil.txt", "C:/evil.txt"})
    EXPECT_THAT(of(Entries{{name, "x"}, {"modelDescription.xml", "<x/>"}}),
                AllOf(HasSubstr(name), HasSubstr("would be unpacked outside")));
  EXPECT_FALSE(fs::exists(temporary_ / "evil.txt"));
}

TEST_F(FmuImportTest, RefusesWhatUnpacksToTooMuch) {
  // Zeros shrink a thousand times; what counts is what comes out.
  const Entries entries = {{"modelDescription.xml", "<x/>"},
                           {"resources/a", std::string(2U << 20, '\0')}};
  const fs::path file = archive(entries);
  EXPECT_LT(fs::file_size(file), 1U << 16);
  EXPECT_THAT(message_of<InputError>([&] { const Unpacked opened(file, 1U << 20); }),
              HasSubstr("is larger than 1 MiB when unpacked"));
}

TEST_F(FmuImportTest, RefusesDescriptionsByElementAndValue) {
  EXPECT_THAT(with("\"2.0\"", "\"1.0\""), HasSubstr("fmiVersion = \"1.0\": must be 2.0 or 3.0"));
  EXPECT_THAT(with("guid=", "gid="), HasSubstr("has no guid"));
  EXPECT_THAT(with("instantiationToken=", "guid=", 3), HasSubstr("has no instantiationToken"));
  EXPECT_THAT(with("\"valve\" canHandle", "\"../valve\" canHandle"),
              HasSubstr("modelIdentifier = \"../valve\""));
  EXPECT_THAT(with("valueReference=\"1\"", "valueReference=\"-1\""),
              AllOf(HasSubstr("\"moving\""), HasSubstr("valueReference = \"-1\"")));
  EXPECT_THAT(with("stopTime=\"1\"", "stopTime=\"soon\""), HasSubstr("stopTime = \"soon\""));
  EXPECT_THAT(with("<CoSimulation", "<ModelExchange"), HasSubstr("is for model exchange only"));
  EXPECT_THAT(with("<CoSimulation", "<Other"), HasSubstr("has no <CoSimulation>"));
}

TEST_F(FmuImportTest, RefusesNamesThatStandTwice) {
  EXPECT_THAT(with("\"moving\"", "\"load_share\""),
              AllOf(HasSubstr("variable \"load_share\": duplicate name"),
                    HasSubstr("valueReference 0 and 1"), HasSubstr("must be unique")));
  // Of a long one no more than fits into a line.
  const std::string name(1U << 20, 'x');
  const std::string variable = "<ScalarVariable name='" + name + "' valueReference='1'/>";
  const std::string said = message_of<InputError>([&] {
    read_description("<fmiModelDescription fmiVersion='2.0' guid='g'><ModelVariables>" + variable +
                         variable + "</ModelVariables></fmiModelDescription>",
                     "here");
  });
  EXPECT_THAT(said, HasSubstr("xxx..\": duplicate name"));
  EXPECT_LT(said.size(), 600U);
}

TEST_F(FmuImportTest, SaysWhichBinaryIsMissing) {
  std::ifstream in(fs::path(BENTAXIS_SOURCE_DIR) / "tests/fmu_units/valve.fmi2.xml");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THAT(of(Entries{{"modelDescription.xml", text}, {"binaries/win64/valve.dll", "x"}}),
              AllOf(HasSubstr("/valve.so"), HasSubstr("its binaries are for win64")));
  EXPECT_THAT(of(Entries{{"modelDescription.xml", text}}), HasSubstr("none for another"));
  EXPECT_THAT(of(Entries{{"modelDescription.xml", text},
                         {"binaries/linux64/valve.so", "x"},
                         {"binaries/linux-aarch64/valve.so", "x"}}),
              HasSubstr("valve.so cannot be loaded"));
}

TEST_F(FmuImportTest, RefusesLibrariesOfAnotherVersionOrWithoutFunctions) {
  for (const int version : {2, 3}) {
    const auto start = [&](const char* name) {
      return message_of<InputError>(
          [&] { (void)ImportedUnit(unit(name, version)).instantiate("it"); });
    };
    EXPECT_THAT(start("old_valve"), HasSubstr("its library is of FMI "));
    EXPECT_THAT(start("short_valve"), AllOf(HasSubstr("no function fmi"), HasSubstr("Terminate")));
    EXPECT_EQ(start("valve"), "accepted");
  }
}

TEST_F(FmuImportTest, ReadsVariablesWithUnits) {
  for (const int version : {2, 3}) {
    const ImportedUnit rotor(unit("rotor", version));
    const UnitDescription& d = rotor.description();
    EXPECT_EQ(d.version, version);
    EXPECT_EQ(d.model_name, "rotor");
    EXPECT_EQ(d.step_size, 1e-4);
    const UnitVariable* speed = d.find("drive_speed");
    ASSERT_NE(speed, nullptr);
    EXPECT_EQ(speed->causality, "output");
    EXPECT_EQ(speed->unit, "1/min");
    ASSERT_TRUE(speed->measure);
    // By its definition: not 1/60 Hz, as the name alone would have it.
    EXPECT_DOUBLE_EQ(converted(1500, *speed->measure, *measure_named("rad/s")), 50 * kPi);
    EXPECT_TRUE(same_quantity(*speed->measure, *measure_named("rpm")));
    EXPECT_FALSE(same_quantity(*speed->measure, *measure_named("Hz")));
    EXPECT_EQ(d.find("torque")->start, "320");
    EXPECT_EQ(d.find("nothing"), nullptr);
    EXPECT_TRUE(fs::exists(rotor.folder()));
  }
}

// Units that are known by their name, each of those it is made of.
TEST_F(FmuImportTest, UnitsAreWhatTheyAreMadeOf) {
  struct Made {
    const char* name;
    double factor;
    std::vector<std::pair<const char*, int>> of;
  };
  const double turn = 2 * kPi;
  const std::vector<Made> all = {{"1", 1, {}},
                                 {"-", 1, {}},
                                 {"%", 0.01, {}},
                                 {"mm", 1e-3, {{"m", 1}}},
                                 {"m/s", 1, {{"m", 1}, {"s", -1}}},
                                 {"N", 1, {{"kg", 1}, {"m", 1}, {"s", -2}}},
                                 {"kN", 1e3, {{"N", 1}}},
                                 {"N.m", 1, {{"N", 1}, {"m", 1}}},
                                 {"Nm", 1, {{"N", 1}, {"m", 1}}},
                                 {"N*m", 1, {{"N", 1}, {"m", 1}}},
                                 {"J", 1, {{"N", 1}, {"m", 1}}},
                                 {"W", 1, {{"N", 1}, {"m", 1}, {"s", -1}}},
                                 {"kW", 1e3, {{"W", 1}}},
                                 {"Pa", 1, {{"N", 1}, {"m", -2}}},
                                 {"kPa", 1e3, {{"Pa", 1}}},
                                 {"MPa", 1e6, {{"Pa", 1}}},
                                 {"bar", 1e5, {{"Pa", 1}}},
                                 {"deg", turn / 360, {{"rad", 1}}},
                                 {"rad/s", 1, {{"rad", 1}, {"s", -1}}},
                                 {"deg/s", 1, {{"deg", 1}, {"s", -1}}},
                                 {"rpm", turn / 60, {{"rad", 1}, {"s", -1}}},
                                 {"rev/min", 1, {{"rpm", 1}}},
                                 {"rad/s2", 1, {{"rad", 1}, {"s", -2}}},
                                 {"rad/s^2", 1, {{"rad", 1}, {"s", -2}}},
                                 {"m3", 1, {{"m", 3}}},
                                 {"m3/s", 1, {{"m", 3}, {"s", -1}}},
                                 {"m^3/s", 1, {{"m", 3}, {"s", -1}}},
                                 {"L/min", 1e-3 / 60, {{"m", 3}, {"s", -1}}},
                                 {"l/min", 1, {{"L/min", 1}}},
                                 {"kg/s", 1, {{"kg", 1}, {"s", -1}}},
                                 {"1/s", 1, {{"s", -1}}},
                                 {"Hz", 1, {{"s", -1}}},
                                 {"1/min", 1.0 / 60, {{"s", -1}}}};
  for (const Made& made : all) {
    Measure product;
    product.factor = made.factor;
    for (const auto& [part, power] : made.of) {
      const Measure unit = measure_named(part).value();
      product.factor *= std::pow(unit.factor, power);
      for (std::size_t i = 0; i < product.exponents.size(); ++i)
        product.exponents[i] += power * unit.exponents[i];
    }
    const auto named = measure_named(made.name);
    ASSERT_TRUE(named) << made.name;
    EXPECT_TRUE(same_quantity(*named, product)) << made.name;
    EXPECT_NEAR(named->factor / product.factor, 1, 1e-14) << made.name;
    EXPECT_EQ(named->offset, 0) << made.name;
  }
  const std::vector<const char*> base = {"kg", "m", "s", "rad"};
  for (const char* a : base)
    for (const char* b : base)
      EXPECT_EQ(same_quantity(*measure_named(a), *measure_named(b)), a == b) << a << ' ' << b;
}

TEST_F(FmuImportTest, TakesUnitsFromTypes) {
  const UnitDescription two = read_description(
      "<fmiModelDescription fmiVersion='2.0' guid='g'><TypeDefinitions><SimpleType name='P'><Real "
      "unit='bar'/></SimpleType></TypeDefinitions><ModelVariables><ScalarVariable name='p' "
      "valueReference='4'><Real declaredType='P'/></ScalarVariable></ModelVariables>"
      "</fmiModelDescription>",
      "here");
  EXPECT_EQ(two.find("p")->unit, "bar");
  EXPECT_DOUBLE_EQ(converted(2, *two.find("p")->measure, *measure_named("Pa")), 2e5);
  const UnitDescription three = read_description(
      "<fmiModelDescription fmiVersion='3.0' instantiationToken='g'><UnitDefinitions><Unit "
      "name='F'><BaseUnit K='1' factor='0.5555555555555556' offset='255.37'/></Unit>"
      "</UnitDefinitions><TypeDefinitions><Float64Type name='T' unit='F'/></TypeDefinitions>"
      "<ModelVariables><Float64 name='t' valueReference='4' declaredType='T'><Dimension start='3'/>"
      "</Float64></ModelVariables></fmiModelDescription>",
      "here");
  EXPECT_NEAR(converted(212, *three.find("t")->measure, Measure{{0, 0, 0, 0, 1, 0, 0, 0}, 1, 0}),
              373.15, 0.01);
  EXPECT_FALSE(three.find("t")->numeric());
}

TEST_F(FmuImportTest, StepsARotorByItsEquation) {
  for (const int version : {2, 3}) {
    const ImportedUnit rotor(unit("rotor", version));
    const auto variable = [&](const char* name) { return *rotor.description().find(name); };
    const auto slave = rotor.instantiate("it");
    slave->set(variable("torque"), 300);
    slave->enter_initialisation(0, 1);
    slave->set(variable("Td_z1_Nm"), 290);
    EXPECT_DOUBLE_EQ(slave->get(variable("drive_acceleration")), 50);
    slave->exit_initialisation();
    slave->step(0, 0.1);
    EXPECT_NEAR(slave->get(variable("drive_speed")), 1500 + 5 / kRadPerSecondPerRpm, 1e-9);
    // Another instance has values of its own.
    const auto other = rotor.instantiate("other");
    EXPECT_EQ(other->get(variable("drive_speed")), 1500);
  }
}

TEST_F(FmuImportTest, TakesAndGivesOtherTypes) {
  for (const int version : {2, 3}) {
    const ImportedUnit stubborn(unit("stubborn", version));
    const auto variable = [&](const char* name) { return *stubborn.description().find(name); };
    const auto slave = stubborn.instantiate("it");
    slave->set(variable("whole"), -7);
    slave->set(variable("small"), 200);
    slave->set(variable("yes"), 1);
    slave->set(variable("single"), 0.5);
    EXPECT_EQ(slave->get(variable("sum")), -7 + 200 + 1 + 0.5);
    for (const char* name : {"whole", "small", "yes"})
      EXPECT_EQ(slave->get(variable(name)), name == std::string("yes")     ? 1.0
                                            : name == std::string("small") ? 200.0
                                                                           : -7.0);
    const auto refused = [&](const char* name, double value) {
      return message_of<ComputationError>([&] { slave->set(variable(name), value); });
    };
    EXPECT_THAT(refused("whole", 0.5), AllOf(HasSubstr("\"whole\""), HasSubstr("must be whole")));
    EXPECT_THAT(refused("small", 3e9), HasSubstr("3e+09"));
    EXPECT_THAT(refused("yes", 2), HasSubstr("in [0, 1]"));
    EXPECT_THAT(refused("single", std::nan("")), HasSubstr("not finite"));
  }
}

TEST_F(FmuImportTest, TellsARefusalInTheUnitsWords) {
  for (const int version : {2, 3})
    for (const int status : {2, 3, 4}) {
      const ImportedUnit stubborn(unit("stubborn", version));
      const auto slave = stubborn.instantiate("it");
      slave->set(*stubborn.description().find("status"), status);
      slave->enter_initialisation(0, 1);
      slave->exit_initialisation();
      slave->step(0, 1e-3);
      EXPECT_THAT(slave->log(), Contains("warning: the tank is half empty"));
      const std::string said = message_of<ComputationError>([&] { slave->step(0.005, 0.005); });
      const char* words[] = {"discard", "error", "fatal"};
      EXPECT_THAT(said, AllOf(HasSubstr("DoStep at 0.005 s"), HasSubstr(words[status - 2]),
                              HasSubstr("no level of oil at 0.005 s"), HasSubstr("stubborn_fmi")));
    }
}

TEST_F(FmuImportTest, TellsWhyAUnitDoesNotStart) {
  for (const int version : {2, 3}) {
    // The description's token is not that of the library.
    const ImportedUnit good(unit("valve", version));
    std::ifstream in(good.folder() / "modelDescription.xml");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.replace(text.find("valve-1"), 7, "valve-2");
    std::string library, name;
    for (const auto& entry : fs::recursive_directory_iterator(good.folder() / "binaries"))
      if (entry.is_regular_file()) {
        name = fs::relative(entry.path(), good.folder()).string();
        std::ifstream bytes(entry.path(), std::ios::binary);
        library.assign(std::istreambuf_iterator<char>(bytes), {});
      }
    const ImportedUnit other(archive({{"modelDescription.xml", text}, {name, library}}));
    EXPECT_THAT(message_of<InputError>([&] { (void)other.instantiate("it"); }),
                HasSubstr("the FMU does not start: error: token \"valve-2\""));
  }
}

TEST_F(FmuImportTest, AnInstanceOutlivesTheUnit) {
  std::unique_ptr<Slave> slave;
  UnitVariable share;
  {
    const ImportedUnit valve(unit("valve", 3));
    share = *valve.description().find("load_share");
    slave = valve.instantiate("it");
  }
  EXPECT_EQ(slave->get(share), 100);
}

}  // namespace
}  // namespace bentaxis::fmu
