// Sets of output files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/new_folder.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/files/run_lock.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/files/whole_file.h"
#include "bentaxis/pump/error.h"

namespace bentaxis {
namespace {

namespace fs = std::filesystem;
using testing::UnorderedElementsAre;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
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
                                 testing::HasSubstr("another sweep is running there"),
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
  EXPECT_EQ(known_unit("furlong"), "");
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

}  // namespace
}  // namespace bentaxis
