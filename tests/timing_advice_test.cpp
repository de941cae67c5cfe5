// Advice on the timing of the ports: what it promises, the pump does.
#include "bentaxis/designs/timing_advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bentaxis/designs/timing_advice_section.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/study/run.h"
#include "bentaxis/study/timing.h"

namespace bentaxis::designs {
namespace {

using testing::HasSubstr;

study::PreparedCase solved(const std::string& name, std::vector<std::string> changes = {}) {
  changes.emplace_back("operation.samples_per_revolution=36");
  return study::prepare(
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/" + name + ".toml", changes));
}

std::vector<TimingRow> rows_of(const study::PreparedCase& ready) {
  return study::timing_rows(ready.the_case, *ready.hydraulics);
}

// KEY=VALUE; of an end of a pair with the other end as it is.
std::string changed_key(const Case& base, const TimingChange& change, const std::string& to) {
  const std::string& name = change.variable.name();
  if (!name.ends_with(".1") && !name.ends_with(".2")) return name + "=" + to;
  const std::string key = name.substr(0, name.size() - 2);
  const std::string first =
      name.ends_with(".1")
          ? to
          : Variable(key + ".1", base).text(Variable(key + ".1", base).value(base));
  const std::string second =
      name.ends_with(".2")
          ? to
          : Variable(key + ".2", base).text(Variable(key + ".2", base).value(base));
  return key + "=[" + first + ", " + second + "]";
}

TEST(TimingAdviceTest, EveryChangeDoesWhatItSays) {
  const study::PreparedCase before = solved("bap63_rated_hydraulic");
  const TimingStudy found = timing_advice(before.the_case, *before.hydraulics);
  std::vector<std::string> flagged;
  for (const TimingRow& row : rows_of(before))
    if (row.flagged && row.meant.empty()) flagged.push_back(row.code);
  ASSERT_GE(flagged.size(), 3U);
  ASSERT_EQ(found.advice.size(), flagged.size());
  std::size_t within = 0;
  for (std::size_t i = 0; i < flagged.size(); ++i) {
    const TimingAdvice& advice = found.advice[i];
    EXPECT_EQ(advice.row.code, flagged[i]);
    ASSERT_TRUE(advice.change) << flagged[i];
    const TimingChange& change = *advice.change;
    // As a user would: what takes its default from the key follows.
    const std::string to = change.variable.text(change.to);
    const study::PreparedCase after =
        solved("bap63_rated_hydraulic", {changed_key(before.the_case, change, to)});
    std::vector<std::string> worse;
    for (const TimingRow& row : rows_of(after)) {
      if (row.code == flagged[i]) {
        EXPECT_NEAR(row.value, change.value_after, 1e-9 * std::max(1.0, row.value));
        EXPECT_EQ(!row.flagged, change.within);
        EXPECT_LT(row.value, advice.row.value);
      }
      const auto old = rows_of(before);
      const auto same = std::find_if(old.begin(), old.end(),
                                     [&](const TimingRow& o) { return o.code == row.code; });
      if (row.flagged && same != old.end() && !same->flagged) worse.push_back(row.quantity);
    }
    EXPECT_EQ(worse, change.worse) << flagged[i];
    EXPECT_NEAR(100 * (after.hydraulics->summary.volumetric_efficiency -
                       before.hydraulics->summary.volumetric_efficiency),
                change.efficiency_change, 1e-9);
    within += change.within ? 1 : 0;
  }
  EXPECT_GE(within, 1U);
  EXPECT_GT(found.trials, 30U);
}

// Ports that open 6 deg late trap the oil: the advice is to open them earlier or to widen a notch,
// and it names the quantity.
TEST(TimingAdviceTest, ALatePortIsToOpenEarlier) {
  const study::PreparedCase late =
      solved("bap63_rated_timed_plate", {"port_plate.delivery_arc_deg=[235, 331]"});
  const TimingStudy found = timing_advice(late.the_case, *late.hydraulics);
  const auto overshoot =
      std::find_if(found.advice.begin(), found.advice.end(),
                   [](const TimingAdvice& a) { return a.row.code == "overshoot"; });
  ASSERT_NE(overshoot, found.advice.end());
  ASSERT_TRUE(overshoot->change);
  EXPECT_TRUE(overshoot->change->variable.name() == "port_plate.delivery_arc_deg.1"
                  ? overshoot->change->to < overshoot->change->from
                  : overshoot->change->to > overshoot->change->from)
      << overshoot->change->text(overshoot->row);
  EXPECT_LT(overshoot->change->value_after, overshoot->row.value);
}

TEST(TimingAdviceTest, SaysNothingWhereAReasonIsStated) {
  const study::PreparedCase timed = solved("bap63_rated_timed_plate");
  const auto rows = rows_of(timed);
  ASSERT_TRUE(std::any_of(rows.begin(), rows.end(), [](const TimingRow& r) { return r.flagged; }));
  const TimingStudy found = timing_advice(timed.the_case, *timed.hydraulics);
  EXPECT_TRUE(found.advice.empty());
  EXPECT_EQ(found.trials, 0U);
  EXPECT_THAT(advice_texts(found).at(0), HasSubstr("No change advised"));
}

TEST(TimingAdviceTest, SaysThatNoKeyHelps) {
  TimingStudy study;
  study.advice.push_back({{.code = "backflow", .quantity = "oil", .value = 2, .unit = "cm3"}, {}});
  EXPECT_THAT(advice_texts(study).at(0), HasSubstr("no single key"));
  report::Document document;
  document.verdict = report::Verdict{};
  add_advice(document, study);
  EXPECT_EQ(document.verdict->answers.size(), 1U);
  EXPECT_EQ(document.runs->at(0).table.rows.at(0).size(),
            document.runs->at(0).table.columns.size());
}

}  // namespace
}  // namespace bentaxis::designs
