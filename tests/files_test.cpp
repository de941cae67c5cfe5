// Sets of output files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/kept_case.h"
#include "bentaxis/files/module.h"
#include "bentaxis/files/module_folders.h"
#include "bentaxis/files/new_folder.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/files/run_lock.h"
#include "bentaxis/files/staging_folder.h"
#include "bentaxis/files/stored_values.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/files/whole_file.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Rows of two blocks and a part; values that no other place has, one not computed.
ResultTable many_rows() {
  ResultTable table;
  table.name = "many";
  table.channels.resize(3);
  for (std::size_t c = 0; c < 3; ++c) table.channels[c].name = "c" + std::to_string(c);
  for (std::size_t row = 0; row < 2 * StoredValues::kBlock + 7; ++row) {
    table.theta_deg.push_back(static_cast<double>(row));
    for (std::size_t c = 0; c < 3; ++c)
      table.values.push_back(static_cast<double>(3 * row + c) / 7);
  }
  table.values[4] = not_computed();
  return table;
}

TEST(StoredValuesTest, AreReadAsTheyWere) {
  const fs::path folder = fs::temp_directory_path() / ("stored-" + std::to_string(getpid()));
  fs::create_directory(folder);
  const ResultTable whole = many_rows();
  std::optional<ResultTable> table = whole;
  ASSERT_TRUE(store_values(*table, folder));
  EXPECT_TRUE(fs::is_empty(folder));  // it has no name
  EXPECT_TRUE(table->values.empty());
  const ResultTable copy = *table;
  table.reset();
  for (std::size_t row = 0; row < whole.rows(); ++row)
    for (std::size_t c = 0; c < whole.columns(); ++c)
      if (row != 1 || c != 1) {
        ASSERT_EQ(copy.at(row, c), whole.at(row, c)) << row << " " << c;
      }
  EXPECT_FALSE(is_computed(copy.at(1, 1)));
  EXPECT_EQ(to_csv(copy), to_csv(whole));
  EXPECT_EQ(to_csv(every_row(copy, 1000)), to_csv(every_row(whole, 1000)));
  EXPECT_EQ(every_row(copy, 1000).values.size(), 3u * 3);
  const auto last = [](const Channel& channel) { return channel.name == "c2"; };
  EXPECT_EQ(select_channels(copy, last).values, select_channels(whole, last).values);
  std::size_t rows = 0;
  copy.for_each_row([&](double theta_deg, const double* values) {
    ASSERT_EQ(theta_deg, static_cast<double>(rows));
    ASSERT_EQ(values[2], whole.at(rows, 2));
    ++rows;
  });
  EXPECT_EQ(rows, whole.rows());
  fs::remove(folder);
}

TEST(StoredValuesTest, StayInTheMemoryWhereNoFileCanBeMade) {
  ResultTable table = many_rows();
  EXPECT_FALSE(store_values(table, "/proc/no such folder"));
  EXPECT_EQ(table.at(5, 1), many_rows().at(5, 1));
  EXPECT_FALSE(table.values.empty());
}

TEST(StoredValuesTest, StayInTheMemoryWhereTheDiskIsFull) {
  const fs::path folder = fs::temp_directory_path() / ("stored-full-" + std::to_string(getpid()));
  fs::create_directory(folder);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit little{30'000, before.rlim_max};  // a block of three columns is 24 576 bytes
  setrlimit(RLIMIT_FSIZE, &little);
  ResultTable table = many_rows();
  EXPECT_FALSE(store_values(table, folder));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_FALSE(table.values.empty());
  EXPECT_EQ(table.at(9000 % table.rows(), 2), many_rows().at(9000 % table.rows(), 2));
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove(folder);
}

TEST(ModuleTest, WhatIsMissingIsNamedWithTheFoldersThatWereSearched) {
  const Module module("absent_module.so");
  EXPECT_FALSE(module.loaded());
  EXPECT_THROW(module.function<void()>("anything", "MATLAB files"), InputError);
  try {
    module.table<int>("numbers", "MATLAB files");
    FAIL() << "a table of a module that is not there";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("MATLAB files: the module absent_module.so"),
                                    HasSubstr(module_folders().front().lexically_normal().string()),
                                    HasSubstr("build or install")));
  }
}

TEST(ModuleTest, ATableThatAModuleLacksIsRefused) {
  const Module module("bentaxis_matio.so");
  EXPECT_TRUE(module.loaded());
  EXPECT_NO_THROW(module.table<int>("kBentaxisMatio", "MATLAB files"));
  EXPECT_THROW(module.table<int>("kBentaxisHdf5", "sweep.h5"), InputError);
}

class OutputFolderTest : public testing::Test {
 protected:
  OutputFolderTest() {
    std::string name = (fs::temp_directory_path() / "bentaxis_test_XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~OutputFolderTest() override { fs::remove_all(folder_); }

  void file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string text(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  // Names of everything in the folder, hidden files too.
  std::set<std::string> contents() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  }

  fs::path folder_;
};

TEST_F(OutputFolderTest, LeavesNothingUnlessCommitted) {
  const fs::path target = folder_ / "a" / "b";
  {
    OutputFolder folder(target);
    folder.add("x.txt", "hello");
    EXPECT_FALSE(fs::exists(target / "x.txt"));
  }
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  {
    OutputFolder folder(target);
    folder.add("x.txt", "hello");
    folder.commit();
  }
  EXPECT_EQ(text("a/b/x.txt"), "hello");
  EXPECT_EQ(std::distance(fs::directory_iterator(target), fs::directory_iterator()), 1);
}

TEST_F(OutputFolderTest, AFileInItsPlaceIsNoFolder) {
  file("taken", "1");
  fs::permissions(folder_ / "taken", fs::perms::all);
  for (const char* name : {"taken", "taken/", "taken/below"})
    EXPECT_THROW(OutputFolder{folder_ / name}, InputError) << name;
  EXPECT_EQ(text("taken"), "1");
}

TEST_F(OutputFolderTest, NamesThePathItCannotWrite) {
  file("taken", "x");
  EXPECT_THROW(OutputFolder(folder_ / "taken"), InputError);
  EXPECT_THROW(OutputFolder(folder_ / "taken" / "below"), InputError);
}

TEST_F(OutputFolderTest, AFailureInTheMiddleLeavesTheOldSet) {
  file("one", "old one");
  file("two", "old two");
  {
    OutputFolder folder(folder_);
    folder.add("one", "new one");
    folder.add("new", "was not there before");
    folder.add("two", "new two");
    // The last file's temporary is gone: its renaming fails when the others are in place.
    for (const auto& name : contents())
      if (name.starts_with(".bentaxis.part-")) fs::remove(folder_ / name / "two.new");
    EXPECT_THROW(folder.commit(), InputError);
  }
  EXPECT_THAT(contents(), UnorderedElementsAre("one", "two"));
  EXPECT_EQ(text("one"), "old one");
  EXPECT_EQ(text("two"), "old two");
}

TEST_F(OutputFolderTest, TwoWritersOfOneProcessDoNotMix) {
  OutputFolder first(folder_);
  OutputFolder second(folder_);
  first.add("a", "of the first");
  second.add("a", "of the second");
  first.add("b", "of the first");
  second.add("b", "of the second");
  second.commit();
  first.commit();
  EXPECT_EQ(text("a"), "of the first");
  EXPECT_EQ(text("b"), "of the first");
  EXPECT_THAT(contents(), UnorderedElementsAre("a", "b"));
}

// Those who clean up may meet a folder that was made and is not locked yet.
TEST_F(OutputFolderTest, AStagingFolderIsThereThoughOthersCleanUp) {
  std::atomic<bool> done = false;
  std::vector<std::thread> others;
  for (int i = 0; i < 3; ++i)
    others.emplace_back([&] {
      while (!done) StagingFolder::remove_abandoned(folder_, ".part-");
    });
  int missing = 0;
  for (int i = 0; i < 3000; ++i) {
    const StagingFolder staging(folder_, ".part-");
    missing += fs::is_directory(staging.path()) ? 0 : 1;
  }
  done = true;
  for (std::thread& other : others) other.join();
  EXPECT_EQ(missing, 0);
}

TEST_F(OutputFolderTest, WhatAnEarlierSetHasLeftIsRemoved) {
  {
    OutputFolder folder(folder_);
    folder.add("pressure.csv", "1");
    folder.add("curve.csv", "1");
    folder.add("report.txt", "pressure.csv\ncurve.csv\nreport.txt");
    folder.commit("report.txt", lines_of);
  }
  file("mine.csv", "not of any set");
  {
    OutputFolder folder(folder_);
    folder.add("curve.csv", "2");
    folder.add("report.txt", "curve.csv\nreport.txt");
    EXPECT_THAT(folder.names(), testing::ElementsAre("curve.csv", "report.txt"));
    folder.commit("report.txt", lines_of);
  }
  EXPECT_THAT(contents(), UnorderedElementsAre("mine.csv", "curve.csv", "report.txt"));
  EXPECT_EQ(text("curve.csv"), "2");
}

TEST_F(OutputFolderTest, WhatIsNotOfTheEarlierSetStays) {
  const auto write_with = [&](const std::string& record) {
    OutputFolder folder(folder_);
    folder.add("report.txt", record);
    folder.commit("report.txt", lines_of);
  };
  file("changed.csv", "1");
  fs::create_directory(folder_ / "folder");
  file("outside.csv", "1");
  file("folder/inside.csv", "1");
  write_with("changed.csv\nfolder\n../outside.csv\nfolder/inside.csv\n..\n\nmissing.csv");
  // Changed since: somebody else's now.
  fs::last_write_time(folder_ / "changed.csv",
                      fs::last_write_time(folder_ / "report.txt") + std::chrono::seconds(1));
  write_with("");
  EXPECT_THAT(contents(),
              UnorderedElementsAre("changed.csv", "folder", "outside.csv", "report.txt"));
  EXPECT_EQ(text("folder/inside.csv"), "1");
  write_with("report.txt");
  EXPECT_THAT(contents(),
              UnorderedElementsAre("changed.csv", "folder", "outside.csv", "report.txt"));
}

TEST_F(OutputFolderTest, WhatTheDiskDoesNotHoldIsNotBegun) {
  OutputFolder folder(folder_);
  OutputFolder::Stream& stream = folder.open("curve.csv");
  EXPECT_NO_THROW(stream.expect(1000));
  EXPECT_THROW(stream.expect(1e30), InputError);
}

// A process of its own that is killed in the middle of a job.
template <typename Job>
void killed_after(const Job& job) {
  const pid_t child = fork();
  if (child == 0) {
    job();
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
}

TEST_F(OutputFolderTest, WhatAKilledRunHasLeftIsRemovedByTheNext) {
  file("a", "of the user");
  killed_after([&] {
    OutputFolder folder(folder_);
    folder.add("a", "of the killed run");
    folder.open("b.json").write("half");
    std::_Exit(raise(SIGKILL));
  });
  EXPECT_EQ(text("a"), "of the user");
  EXPECT_EQ(contents().size(), 2U);
  // Whoever looks for results in all folders, by their endings, finds none in what is left.
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    EXPECT_NE(entry.path().extension(), ".json");
  OutputFolder running(folder_);  // what it holds is not taken for left behind
  running.add("c", "of the running one");
  {
    OutputFolder failed(folder_);
    failed.add("d", "never put in place");
  }
  EXPECT_EQ(contents().size(), 3U);
  {
    OutputFolder folder(folder_);
    folder.add("a", "of the next run");
    folder.commit();
  }
  EXPECT_EQ(contents().size(), 2U);
  running.commit();
  EXPECT_THAT(contents(), UnorderedElementsAre("a", "c"));
  EXPECT_EQ(text("c"), "of the running one");
}

TEST_F(OutputFolderTest, ANewFolderRemovesWhatAKilledRunHasLeft) {
  killed_after([&] {
    NewFolder folder(folder_ / "project");
    folder.add("case.toml", "half");
    std::_Exit(raise(SIGKILL));
  });
  EXPECT_EQ(contents().size(), 1U);
  NewFolder folder(folder_ / "project");
  folder.add("case.toml", "whole");
  folder.commit();
  EXPECT_THAT(contents(), UnorderedElementsAre("project"));
  EXPECT_EQ(text("project/case.toml"), "whole");
}

TEST_F(OutputFolderTest, RunsAreKeptApartByALock) {
  const fs::path file = folder_ / "parts" / "lock";
  const auto refused = [&](RunLock::Kind kind) {
    try {
      const RunLock lock(file, kind, "sweep");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(RunLock::Kind::reader), "");
  EXPECT_FALSE(fs::exists(folder_ / "parts"));  // a reader makes nothing
  {
    const RunLock lock(file, RunLock::Kind::alone, "sweep");
    for (const RunLock::Kind kind :
         {RunLock::Kind::alone, RunLock::Kind::shared, RunLock::Kind::reader})
      EXPECT_THAT(refused(kind),
                  testing::AllOf(testing::HasSubstr((folder_ / "parts").string()),
                                 testing::HasSubstr("another sweep is running in this directory"),
                                 testing::HasSubstr("process " + std::to_string(getpid()))));
  }
  EXPECT_FALSE(fs::exists(file));
  {
    const RunLock first(file, RunLock::Kind::shared, "sweep");
    EXPECT_EQ(refused(RunLock::Kind::shared), "");
    EXPECT_EQ(refused(RunLock::Kind::reader), "");
    EXPECT_NE(refused(RunLock::Kind::alone), "");
  }
  EXPECT_EQ(refused(RunLock::Kind::alone), "");  // the file of shared ones stays, held by nobody
  EXPECT_FALSE(fs::exists(file));
  killed_after([&] {
    const RunLock lock(file, RunLock::Kind::alone, "sweep");
    std::_Exit(raise(SIGKILL));
  });
  EXPECT_TRUE(fs::exists(file));
  EXPECT_EQ(refused(RunLock::Kind::alone), "");
  EXPECT_FALSE(fs::exists(file));
}

// Files of this process may have so many bytes while it lives; the system refuses more as it does
// on a full disk.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : former_signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &former_);
    rlimit limit = former_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;
  ~FileLimit() {
    setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, former_signal_);
  }

 private:
  void (*former_signal_)(int);
  rlimit former_ = {};
};

TEST_F(OutputFolderTest, AFullDiskLeavesWhatWasThere) {
  file("a", "old");
  const auto said = [&](const std::function<void()>& job) {
    const FileLimit limit(1000);
    try {
      job();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string large(100000, 'x');
  const std::vector<std::function<void()>> jobs = {[&] { write_whole(folder_ / "a", large); },
                                                   [&] {
                                                     OutputFolder folder(folder_);
                                                     folder.add("b", "small");
                                                     folder.add("a", large);
                                                     folder.commit();
                                                   },
                                                   [&] {
                                                     OutputFolder folder(folder_);
                                                     OutputFolder::Stream& stream =
                                                         folder.open("a");
                                                     for (int i = 0; i < 100; ++i)
                                                       stream.write(std::string(1000, 'y'));
                                                     folder.commit();
                                                   },
                                                   [&] {
                                                     NewFolder folder(folder_ / "a.new");
                                                     folder.add("a", large);
                                                     folder.commit();
                                                   }};
  for (const auto& job : jobs) {
    EXPECT_THAT(said(job), testing::AllOf(testing::HasSubstr("/a"),
                                          testing::HasSubstr("cannot be written: File too large")));
    EXPECT_THAT(contents(), UnorderedElementsAre("a"));
    EXPECT_EQ(text("a"), "old");
  }
  EXPECT_EQ(said([&] { write_whole(folder_ / "a", "new"); }), "");
  EXPECT_EQ(text("a"), "new");
}

class ForeignTableTest : public OutputFolderTest {
 protected:
  ForeignTable table(const std::string& text) const {
    file("table.txt", text);
    return read_table(folder_ / "table.txt");
  }
};

// What stands above a blank line belongs to something else.
TEST_F(ForeignTableTest, UnitsStandNextToTheNames) {
  using testing::ElementsAre;
  const ForeignTable apart = table("s;N\n\ntime;force\n1;2\n2;3\n");
  EXPECT_THAT(apart.header, ElementsAre("time", "force"));
  EXPECT_THAT(apart.units, ElementsAre("", ""));
  EXPECT_THAT(table("s;N\ntime;force\n1;2\n2;3\n").units, ElementsAre("s", "N"));
  EXPECT_THAT(table("time;force\n[s];[N]\n1;2\n2;3\n").units, ElementsAre("s", "N"));
}

TEST_F(ForeignTableTest, ASeparatorBehindEveryLineIsNoColumn) {
  using testing::ElementsAre;
  const ForeignTable ended = table("time;force;\n1;2;\n2;3;\n3;4;\n");
  EXPECT_THAT(ended.header, ElementsAre("time", "force"));
  EXPECT_THAT(ended.rows, ElementsAre(ElementsAre(1, 2), ElementsAre(2, 3), ElementsAre(3, 4)));
  EXPECT_EQ(table("1;2;\n2;3;\n3;4;\n").header.size(), 2U);
  EXPECT_EQ(table("time;force\n1;\n2;3\n3;4\n").header.size(), 2U);
}

TEST_F(ForeignTableTest, AFaultIsNamedByItsColumn) {
  const auto said = [&](const std::string& text) {
    try {
      table(text);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(said("1;2;0\n2;3;0\n3;many;0\n4;5;0\n"), testing::HasSubstr("column 2 = "));
  EXPECT_THAT(said("t;F;m\n1;2;0\n2;3;0\n3;many;0\n4;5;0\n"), testing::HasSubstr("F = "));
  // A cell as it is, of a long one its beginning.
  for (const auto& [length, end] :
       std::map<int, std::string>{{4, ""}, {60, ""}, {61, ".."}, {500, ".."}}) {
    const std::string cell(static_cast<std::size_t>(length), 'x');
    EXPECT_THAT(said("1;2;0\n2;3;0\n3;" + cell + ";0\n4;5;0\n"),
                testing::HasSubstr(" = \"" + cell.substr(0, 60) + end + "\": must"))
        << length;
  }
}

TEST(ForeignUnits, StandInTheNamesOfColumns) {
  const std::map<std::string, std::string> units = {
      {"torque_Nmm", "Nmm"}, {"Kraft in kN", "kN"},
      {"F / N", "N"},        {"Rs (kN) [measured]", "kN"},
      {"travel_m", "m"},     {"t_s", "s"},
      {"t / min", "min"},    {"Zeit in min", "min"},
      {"p_min", ""},         {"Rs_n", ""},
      {"bearing_in", ""},    {"travel / in", "in"},
      {"Rcs", ""},           {"gear_", ""},
      {"angle [deg]", "deg"}};
  for (const auto& [name, unit] : units) EXPECT_EQ(unit_in_name(name), unit) << name;
}

TEST(ForeignUnits, AreKnownByAnySpelling) {
  EXPECT_EQ(known_unit("N.m"), "Nm");
  EXPECT_EQ(known_unit("N*m"), "Nm");
  EXPECT_EQ(known_unit("N-m"), "Nm");
  EXPECT_EQ(known_unit("newton_mm"), "Nmm");
  const std::map<std::string, std::string> written = {
      {"KN", "kN"},      {"mNm", "Nmm"},        {"lbf ft", "lbf ft"},
      {"µm", "um"},      {"N/mm²", "MPa"},      {"°", "deg"},
      {"\xB0", "deg"},   {"rev", "turn"},       {"grad", "gon"},
      {"µs", "us"},      {"Newtons", "N"},      {"Kilo-Newton-Meter", "kNm"},
      {"Umdr.", "turn"}, {"sek", "s"},          {"poundforce inch", "lbf in"},
      {"Grad°", "deg"},  {"megapascal", "MPa"}, {"kilogram-force", "kgf"}};
  for (const auto& [text, unit] : written) EXPECT_EQ(known_unit(text), unit) << text;
  EXPECT_EQ(known_unit("rpm"), "rpm");  // of drive files
  EXPECT_EQ(known_unit("furlong"), "");
  // Units of this program that no measured column has.
  for (const char* other : {"J", "cSt", "kg", "1/s", "percent"})
    EXPECT_EQ(known_unit(other), "") << other;
}

// FIPS 180-4's examples, and lengths about those of its blocks, by sha256sum.
TEST(Sha256, OfKnownTexts) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_F(OutputFolderTest, FilesReadAreLoggedWhileALogIsKept) {
  file("a.toml", "abc = 1");
  file("b.toml", "abc = 2");
  TomlFile::read(folder_ / "a.toml", "file");
  EXPECT_TRUE(InputLog::files().empty());
  {
    const InputLog log;
    TomlFile::read(folder_ / "b.toml", "file");
    TomlFile::read(folder_ / "a.toml", "file");
    TomlFile::read(folder_ / "a.toml", "file");
    ASSERT_EQ(InputLog::files().size(), 2);
    EXPECT_EQ(InputLog::files()[0].file, folder_ / "b.toml");
    EXPECT_EQ(InputLog::files()[0].sha256, sha256_of("abc = 2"));
    file("a.toml", "abc = 3");  // another file of the same name
    TomlFile::read(folder_ / "a.toml", "file");
    ASSERT_EQ(InputLog::files().size(), 3);
    EXPECT_EQ(InputLog::files()[2].sha256, sha256_of("abc = 3"));
  }
  EXPECT_TRUE(InputLog::files().empty());
}

TEST_F(OutputFolderTest, ALogWithinALogTakesNothingFromIt) {
  for (const char* name : {"a.toml", "b.toml", "c.toml"}) file(name, "abc = 1");
  const InputLog outer;
  TomlFile::read(folder_ / "a.toml", "file");
  {
    const InputLog inner;
    TomlFile::read(folder_ / "b.toml", "file");
    ASSERT_EQ(InputLog::files().size(), 1);
    EXPECT_EQ(InputLog::files()[0].file, folder_ / "b.toml");
  }
  TomlFile::read(folder_ / "c.toml", "file");
  ASSERT_EQ(InputLog::files().size(), 3);
  for (const std::size_t i : {0, 1, 2})
    EXPECT_EQ(InputLog::files()[i].file, folder_ / (std::string(1, "abc"[i]) + ".toml"));
}

TEST_F(OutputFolderTest, LogsOfSeveralThreadsKeepTheirOwn) {
  for (const char* name : {"a.toml", "b.toml"}) file(name, "abc = 1");
  const InputLog all;
  const InputLog own(InputLog::Threads::own);
  TomlFile::read(folder_ / "a.toml", "file");
  std::vector<InputFile> others;
  std::thread([&] {
    const InputLog log(InputLog::Threads::own);
    TomlFile::read(folder_ / "b.toml", "file");
    others = InputLog::files();
  }).join();
  ASSERT_EQ(own.noted().size(), 1);
  EXPECT_EQ(own.noted()[0].file, folder_ / "a.toml");
  ASSERT_EQ(others.size(), 1);
  EXPECT_EQ(others[0].file, folder_ / "b.toml");
  EXPECT_EQ(all.noted().size(), 2);
}

TEST_F(OutputFolderTest, ACaseNamesWhatItWasReadFrom) {
  const fs::path shipped = fs::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated.toml";
  const std::string curve = "theta_deg,pressure_bar\n0,5\n90,5\n180,200\n270,200\n";
  file("curve.csv", curve);
  fs::copy_file(shipped, folder_ / "case.toml");
  const std::string text = bytes_of(folder_ / "case.toml");
  const Case the_case =
      read_case(folder_ / "case.toml", {"pressure.kind=curve", "pressure.file=curve.csv"});
  file("curve.csv", "theta_deg,pressure_bar\n0,5\n90,5\n180,300\n270,300\n");
  file("case.toml", "schema = 1");
  ASSERT_EQ(the_case.inputs.size(), 2);
  EXPECT_EQ(the_case.inputs[0].file, folder_ / "case.toml");
  EXPECT_EQ(the_case.inputs[0].sha256, sha256_of(text));
  EXPECT_EQ(the_case.inputs[1].file, folder_ / "curve.csv");
  EXPECT_EQ(the_case.inputs[1].sha256, sha256_of(curve));
  // What is kept would be another case.
  EXPECT_THAT([&] { kept_case(the_case); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("curve.csv: has changed")));
  file("curve.csv", curve);
  EXPECT_EQ(kept_case(the_case).curves.at(0).bytes, curve);
}

// ---- Input files

class InputFileTest : public OutputFolderTest {
 protected:
  std::string refusal(const fs::path& path, std::uint64_t largest) const {
    try {
      read_input_file(path, {"a curve", largest});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(InputFileTest, AreReadWholeUpToALimit) {
  file("five", "12345");
  EXPECT_EQ(read_input_file(folder_ / "five", {"a curve", 5}), "12345");
  EXPECT_THAT(refusal(folder_ / "five", 4), HasSubstr("five: has "));
  EXPECT_THAT(refusal(folder_ / "five", 4), HasSubstr("a curve must have at most"));
  file("empty", "");
  EXPECT_EQ(read_input_file(folder_ / "empty", {"a curve", 0}), "");
  // A file of the system says that it has 0 bytes.
  EXPECT_THAT(refusal("/proc/self/maps", 10), HasSubstr("larger than its size says"));
  EXPECT_GT(read_input_file("/proc/self/maps", {"a curve", kMebibyte}).size(), 10U);
}

TEST_F(InputFileTest, AreRegular) {
  EXPECT_THAT(refusal(folder_, 10), HasSubstr("is a directory, not a curve"));
  EXPECT_THAT(refusal(folder_ / "none", 10), HasSubstr("no such file"));
  EXPECT_THAT(refusal("/dev/null", 10), HasSubstr("is a device: a curve must be a regular file"));
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal(folder_ / "pipe", 10), HasSubstr("is a pipe"));
  EXPECT_FALSE(read_input_file_if_there(folder_ / "none", {"a curve", 10}));
  EXPECT_THROW(read_input_file_if_there(folder_ / "pipe", {"a curve", 10}), InputError);
}

// ---- Depth and length of TOML

std::string refusal_of_toml(const std::string& text) {
  try {
    TomlFile(text, "x.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(TomlDepth, KeysListsAndTablesAreAtMostThirtyTwoDeep) {
  const auto key = [](int levels) { return repeated("a.", levels - 1) + "a"; };
  EXPECT_EQ(refusal_of_toml(key(30) + " = 1\n"), "");
  EXPECT_THAT(refusal_of_toml("\n" + key(40) + " = 1\n"), HasSubstr("x.toml:2: "));
  EXPECT_EQ(refusal_of_toml("[" + key(30) + "]\n"), "");
  EXPECT_THAT(refusal_of_toml("[" + key(40) + "]\n"), HasSubstr("deep"));
  EXPECT_EQ(refusal_of_toml("a = " + repeated("[", 30) + repeated("]", 30)), "");
  EXPECT_THAT(refusal_of_toml("a = " + repeated("[", 40) + repeated("]", 40)), HasSubstr("deep"));
  // Headings and keys add up, as keys in tables in lists do.
  EXPECT_THAT(refusal_of_toml("[" + key(20) + "]\n" + key(20) + " = 1\n"), HasSubstr("deep"));
  EXPECT_THAT(refusal_of_toml("a = [{" + key(20) + " = {" + key(20) + " = 1}}]\n"),
              HasSubstr("deep"));
  for (const int levels : {1000, 100000, 1000000}) {
    EXPECT_THAT(refusal_of_toml(key(levels) + " = 1\n"), HasSubstr("deep"));
    EXPECT_THAT(refusal_of_toml("a = " + repeated("{b=", levels)), HasSubstr("deep"));
  }
}

TEST(TomlDepth, WhatStandsInTextsAndCommentsDoesNotCount) {
  const std::string dots = repeated(".[{", 100);
  for (const std::string& text :
       {"a = \"" + dots + "\"\n", "a = '" + dots + "'\n", "a = 1 # " + dots + "\nb = 1\n",
        "a = \"\"\"\n" + dots + "\n\\\"\"\"\"\n", "a = \'\'\'\n" + dots + "'\n\'\'\'\n",
        "\"" + dots + "\" = 1\n", "a = \"\\\"" + dots + "\"\n",
        "a = [" + repeated("1.5, ", 1000) + "]\n", repeated("[[a]]\nb.c = 1.5\n", 1000)})
    EXPECT_EQ(refusal_of_toml(text), "") << text.substr(0, 40);
  // Behind a text it counts again.
  EXPECT_THAT(refusal_of_toml("a = '" + dots + "'\n" + repeated("a.", 99) + "b = 1\n"),
              HasSubstr("x.toml:2: "));
  // What is no TOML says so, whatever is in it.
  for (const char* text : {"a = \"", "a = \'\'\'", "a = \"\\", "]]]}}}", "a = [}", "\"", "'", "#"})
    EXPECT_THAT(refusal_of_toml(text), Not(HasSubstr("deep")));
}

TEST(TomlLists, AreAtMostTenThousandLong) {
  EXPECT_EQ(refusal_of_toml("a = [" + repeated("1,", 10000) + "]\n"), "");
  EXPECT_THAT(refusal_of_toml("\n\na = [" + repeated("1,", 10001) + "]\n"),
              HasSubstr("x.toml:3: a list of 10001 entries: must have at most 10000"));
  EXPECT_THAT(refusal_of_toml(repeated("[[a]]\n", 10001)), HasSubstr("10001 entries"));
  std::string keys;
  for (int i = 0; i < 10001; ++i) keys += "k" + std::to_string(i) + " = 1\n";
  EXPECT_THAT(refusal_of_toml(keys), HasSubstr("a table of 10001 entries"));
}

TEST(TomlTexts, HoldNoControlCharacters) {
  EXPECT_EQ(refusal_of_toml("a = \"\\t\\n\\r\\u00e4 \\u00a0\"\n"), "");
  for (const char* escape : {"\\u0000", "\\u001b", "\\u007f", "\\u0085", "\\u009b"}) {
    const std::string text = std::string("\"x") + escape + "\"";
    EXPECT_THAT(refusal_of_toml("\na = " + text), HasSubstr("x.toml:2: the text"));
    EXPECT_THAT(refusal_of_toml(text + " = 1\n"), HasSubstr("x.toml:1: the key"));
    EXPECT_THAT(refusal_of_toml("a = [[" + text + "]]\n"), HasSubstr("control character"));
  }
}

// ---- Characters

TEST(Characters, ControlCharactersOfAsciiAndUnicode) {
  EXPECT_FALSE(has_control_characters("plain \xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80", true));
  EXPECT_FALSE(has_control_characters("a\tb\nc\r", false));
  EXPECT_TRUE(has_control_characters("a\tb", true));
  for (const std::string& text :
       {std::string(1, '\0'), std::string("\x1b[31m"), std::string("\x7f"), std::string("\xc2\x9b"),
        std::string("\xc2\x80")})
    EXPECT_TRUE(has_control_characters("a" + text, false));
  EXPECT_EQ(without_control_characters(std::string("a\0\x1b[\n", 5)), "a\\u0000\\u001B[\\u000A");
  EXPECT_EQ(without_control_characters("a\n\t\x1b", false), "a\n\t\\u001B");
  EXPECT_EQ(without_control_characters("\xc2\x9b \x9b \xe4"), "\\u009B \\x9B \xe4");
}

TEST(Characters, Utf8AndWindows1252) {
  EXPECT_TRUE(is_utf8("a\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80"));
  for (const char* text : {"\xe4", "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                           "\xe0\x80\x80", "\xff", "\x80"})
    EXPECT_FALSE(is_utf8(text)) << text;
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      TomlFile file(text, "a.toml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("a = 1\r\nb = 2\r\n"), "");
  EXPECT_EQ(
      refusal("a = 1\rb = 2\r"),
      "a.toml: its lines end with a carriage return alone: save it with line feeds (LF or CR LF)");
  EXPECT_EQ(refusal(std::string("\xFF\xFE"
                                "a\0=\0",
                                6)),
            "a.toml: is in UTF-16: save it as UTF-8");
  EXPECT_EQ(refusal("a = 1\n# \xE4\nb = 2\n"),
            "a.toml:2: a letter that is not in UTF-8, as one of Latin-1 or Windows-1252: save the "
            "file as "
            "UTF-8");
  EXPECT_EQ(utf8_of_windows_1252("a\xe4\x80\x96"), "a\xc3\xa4\xe2\x82\xac\xe2\x80\x93");
  EXPECT_TRUE(is_utf8(utf8_of_windows_1252("\x81\x8d\x8f\x90\x9d\xff")));
}

// ---- MATLAB files that are not whole

class MatlabFileTest : public OutputFolderTest {
 protected:
  std::string content_of(const std::string& name) const {
    std::ifstream in(fs::path(BENTAXIS_SOURCE_DIR) / name, std::ios::binary);
    std::string content{std::istreambuf_iterator<char>(in), {}};
    EXPECT_GT(content.size(), 100U) << name;
    return content;
  }
  // What is wrong with a content, or "".
  std::string refusal(const std::string& content) const {
    file("record.mat", content);
    try {
      read_table(folder_ / "record.mat");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

// Lengths at which a file of version 5 ends with a variable.
std::set<std::size_t> ends_of_variables(const std::string& content) {
  std::set<std::size_t> ends;
  for (std::size_t at = 128; at + 8 <= content.size();) {
    std::uint32_t size = 0;
    std::memcpy(&size, content.data() + at + 4, sizeof size);
    at += 8 + size;
    ends.insert(at);
  }
  return ends;
}

TEST_F(MatlabFileTest, AreRefusedAtEveryLengthButTheEndOfAVariable) {
  // At these a file of as many variables is whole, with two vectors or more.
  for (const auto& [name, whole] : std::map<std::string, std::size_t>{{"plain_5.mat", 1},
                                                                      {"packed_5.mat", 1},
                                                                      {"structure.mat", 3},
                                                                      {"version_4.mat", 0},
                                                                      {"version_7_3.mat", 0}}) {
    const std::string content = content_of("tests/fuzz/corpus/mat/" + name);
    EXPECT_EQ(refusal(content), "") << name;
    const auto ends = ends_of_variables(content);
    std::size_t read = 0;
    for (std::size_t length = 0; length < content.size(); ++length)
      if (refusal(content.substr(0, length)).empty()) {
        ++read;
        EXPECT_EQ(ends.count(length), 1U) << name << ": " << length;
      }
    EXPECT_EQ(read, whole) << name;
  }
}

TEST_F(MatlabFileTest, SayWhatIsMissing) {
  const std::string five = content_of("tests/fuzz/corpus/mat/plain_5.mat");
  EXPECT_THAT(
      refusal(five.substr(0, five.size() - 1)),
      AllOf(HasSubstr("record.mat: is a truncated MATLAB file: "), HasSubstr("variable 3 takes")));
  const std::string four = content_of("tests/fuzz/corpus/mat/version_4.mat");
  EXPECT_THAT(refusal(four.substr(0, four.size() - 1)), HasSubstr("variable 2 takes"));
  const std::string seven = content_of("tests/fuzz/corpus/mat/version_7_3.mat");
  EXPECT_THAT(refusal(seven.substr(0, seven.size() - 1)),
              HasSubstr("the file by its own count takes " + std::to_string(seven.size())));
}

// More values than there are, by the dimensions alone: the file has the length that it says.
TEST_F(MatlabFileTest, HaveAsManyValuesAsTheirDimensionsSay) {
  std::string content = content_of("tests/fuzz/corpus/mat/plain_5.mat");
  const std::size_t dimensions = 128 + 8 + 16 + 8;
  for (const char columns : {'\x0b', '\x0d', '\x78'}) {  // 12 values are there
    content[dimensions + 4] = columns;
    if (columns > 12) {
      EXPECT_THAT(refusal(content), HasSubstr("truncated")) << int(columns);
    }
  }
  content[dimensions + 7] = '\xff';
  EXPECT_THAT(refusal(content), HasSubstr("negative dimension"));
}

TEST_F(MatlabFileTest, WrittenByOthersAreWhole) {
  for (const char* name : {"tests/imports/good/run.mat", "tests/imports/good/run_octave.mat",
                           "tests/imports/bad/one_sign.mat", "tests/imports/bad/tilt.mat"}) {
    const std::string content = content_of(name);
    EXPECT_EQ(refusal(content), "") << name;
    const auto ends = ends_of_variables(content);
    for (std::size_t percent = 1; percent < 100; ++percent) {
      const std::size_t length = content.size() * percent / 100;
      if (ends.count(length) == 0) {
        EXPECT_THAT(refusal(content.substr(0, length)), HasSubstr("truncated"))
            << name << ": " << percent;
      }
    }
  }
}

TEST_F(ForeignTableTest, NamesThatRepeatAreToldApart) {
  std::string names = "a", values = "1";
  for (int i = 1; i < 5000; ++i) {
    names += ",f";
    values += "," + std::to_string(i);
  }
  file("wide.csv", names + "\n" + values + "\n" + values + "\n" + values + "\n");
  const ForeignTable table = read_table(folder_ / "wide.csv");
  const std::set<std::string> different(table.header.begin(), table.header.end());
  EXPECT_EQ(different.size(), 5000U);
  EXPECT_EQ(table.header[1], "f");
  EXPECT_EQ(table.header[2], "f (2)");
  EXPECT_EQ(table.header[4999], "f (4999)");
}

}  // namespace
}  // namespace bentaxis
