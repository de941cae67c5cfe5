// Folders of reference data: made, refused, brought up to date.
#include "bentaxis/study/reference_maker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "bentaxis/files/csv.h"
#include "bentaxis/study/reference_set.h"
#include "bentaxis/study/regression.h"
#include "support.h"

namespace bentaxis::test {
namespace {

namespace fs = std::filesystem;
using study::Model;
using study::Outcome;
using testing::HasSubstr;

fs::path rated() { return fs::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated.toml"; }

std::string content_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& file, const std::string& content) { std::ofstream(file) << content; }

void replace(const fs::path& file, const std::string& old, const std::string& now) {
  std::string text = content_of(file);
  const std::size_t at = text.find(old);
  ASSERT_NE(at, std::string::npos) << old;
  write(file, text.replace(at, old.size(), now));
}

// The record of another program: the analytic model's curves of a case, by other names.
fs::path record_in(const fs::path& folder, const std::vector<std::string>& changes = {}) {
  Case the_case = read_case(rated(), changes);
  the_case.operation.samples_per_revolution = 72;
  const ResultTable table = study::run_turn(study::prepare(the_case), Model::analytic);
  std::string text = "angle [deg],FX [N],FY [N],FZ [N],torque [Nm]\n";
  for (std::size_t row = 0; row < table.rows(); ++row) {
    text += number_text(table.theta_deg[row]);
    for (const char* name : {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N", "Td_z1_Nm"})
      text += "," + number_text(rounded(table.at(row, table.find(name)), 8));
    text += "\n";
  }
  write(folder / "record.csv", text);
  return folder / "record.csv";
}

TEST(ReferenceMaker, AGuessedRecordIsHeldAndAgrees) {
  const Scratch scratch;
  const Case the_case = read_case(rated());
  const fs::path record = record_in(scratch.path());
  const study::MappingGuess guess = study::guess_reference(the_case, record);
  EXPECT_EQ(guess.recognised(), 4U);
  const std::string proposal = study::proposal_text(guess);
  EXPECT_THAT(proposal, HasSubstr("Rb1"));
  EXPECT_THAT(proposal, HasSubstr("Td_z1_Nm"));
  const fs::path out = scratch.path() / "made";
  const auto names =
      study::make_reference(the_case, false, record, study::description_of(guess, "a test"), out);
  ASSERT_EQ(names.size(), 3U);
  for (const fs::path& name : names) EXPECT_TRUE(fs::exists(name)) << name;
  EXPECT_EQ(content_of(out / "case.toml"), content_of(rated()));
  const Outcome outcome = study::hold({out, "made"}, study::silent());
  EXPECT_EQ(outcome.state, Outcome::State::agrees) << outcome.error;
}

// A curve of another pressure is written, for it is a result; but it does not agree.
TEST(ReferenceMaker, ARecordOfAnotherPressureDiffers) {
  const Scratch scratch;
  const Case the_case = read_case(rated());
  const auto guess =
      study::guess_reference(the_case, record_in(scratch.path(), {"pressure.delivery_bar=270"}));
  const fs::path out = scratch.path() / "made";
  study::make_reference(the_case, false, scratch.path() / "record.csv",
                        study::description_of(guess, "", 1e-4), out);
  EXPECT_EQ(study::hold({out, "made"}, study::silent()).state, Outcome::State::differs);
}

TEST(ReferenceMaker, WhatCannotBeUsedIsRefusedAndNothingWritten) {
  const Scratch scratch;
  const Case the_case = read_case(rated());
  const fs::path record = record_in(scratch.path());
  const std::string good =
      study::description_of(study::guess_reference(the_case, record), "a test");
  write(scratch.path() / "case.toml", content_of(record));
  fs::create_directory(scratch.path() / "full");
  write(scratch.path() / "full" / "other.txt", "1");
  struct {
    std::string what;
    fs::path curve;
    std::string description;
    fs::path out;
    std::string why;
  } const cases[] = {
      {"a folder in use", record, good, scratch.path() / "full", "exists and is not empty"},
      {"a curve's name", scratch.path() / "case.toml", good, scratch.path() / "new",
       "is a reserved name"},
      {"no TOML", record, "schema = [", scratch.path() / "new", "record.csv"},
      {"another column", record, std::string(good).replace(good.find("torque [Nm]"), 6, "moment"),
       scratch.path() / "new", "moment"}};
  for (const auto& c : cases) {
    EXPECT_THAT(
        refusal([&] { study::make_reference(the_case, false, c.curve, c.description, c.out); }),
        HasSubstr(c.why))
        << c.what;
    EXPECT_FALSE(fs::exists(scratch.path() / "new")) << c.what;
  }
  EXPECT_EQ(content_of(scratch.path() / "full" / "other.txt"), "1");
}

TEST(ReferenceMaker, AToleranceIsWhatTheDigitsAllowUnlessGiven) {
  const Scratch scratch;
  const auto guess = study::guess_reference(read_case(rated()), record_in(scratch.path()));
  EXPECT_THAT(study::description_of(guess), HasSubstr("relative = 1e-05"));
  EXPECT_THAT(study::description_of(guess, "", 0.02), HasSubstr("relative = 0.02"));
  EXPECT_THAT(study::description_of(guess, "rig \"A\""), HasSubstr("source = \"rig \\\"A\\\"\""));
}

TEST(ReferenceMaker, GoldenCurvesHoldAndAreRewrittenWhereTheyDiffer) {
  const Scratch scratch;
  const fs::path out = scratch.path() / "golden";
  const auto names = study::make_golden(read_case(rated()), true, study::kGoldenSamples, out);
  ASSERT_EQ(names.size(), 4U);
  EXPECT_EQ(study::hold({out, "golden"}, study::silent()).state, Outcome::State::agrees);
  const auto update = [&] {
    return study::update_golden(compare::read_description(out, "golden"));
  };
  const std::string before = content_of(out / "analytic.csv");
  EXPECT_FALSE(update().rewritten);

  replace(out / "case.toml", "275.0", "276.0");
  EXPECT_EQ(study::hold({out, "golden"}, study::silent()).state, Outcome::State::differs);
  const study::GoldenUpdate changed = update();
  EXPECT_TRUE(changed.rewritten);
  EXPECT_THAT(changed.text, HasSubstr("golden: rewritten"));
  EXPECT_THAT(changed.text, HasSubstr("Td"));
  EXPECT_NE(content_of(out / "analytic.csv"), before);
  EXPECT_EQ(study::hold({out, "golden"}, study::silent()).state, Outcome::State::agrees);
  EXPECT_THAT(update().text, HasSubstr("golden: unchanged"));

  replace(out / "description.toml", "points = 36", "points = 35");
  EXPECT_THAT(refusal(update), HasSubstr("points = 35, but the case now gives 36 rows"));
}

TEST(ReferenceMaker, OnlyGoldenCurvesAreTheProgramsToWrite) {
  const Scratch scratch;
  EXPECT_THAT(refusal([&] {
                study::find_golden(fs::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "published");
              }),
              HasSubstr("holds no golden curves; published data are never written"));
  const auto found =
      study::find_golden(fs::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "golden");
  EXPECT_FALSE(found.golden.empty());
  EXPECT_EQ(found.others, 0);
  EXPECT_EQ(found.kinds, "");
}

TEST(ReferenceMaker, AnIntegratedOrUsedFolderIsNotOverwritten) {
  const Scratch scratch;
  const fs::path out = scratch.path() / "golden";
  study::make_golden(read_case(rated()), false, 12, out);
  // An unchanged case is referred to, not copied.
  EXPECT_FALSE(fs::exists(out / "case.toml"));
  EXPECT_THAT(refusal([&] { study::make_golden(read_case(rated()), false, 12, out); }),
              HasSubstr("exists and is not empty"));
}

}  // namespace
}  // namespace bentaxis::test
