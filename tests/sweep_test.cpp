// Plans of sweeps, their blocks, and what is kept of them.
#include "bentaxis/designs/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "bentaxis/designs/sweep_parts.h"
#include "bentaxis/designs/sweep_tables.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "support.h"

namespace bentaxis::designs {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using testing::ElementsAre;
using testing::HasSubstr;

Case rated(const std::vector<std::string>& changes = {}) {
  std::vector<std::string> all = {"operation.samples_per_revolution=36"};
  all.insert(all.end(), changes.begin(), changes.end());
  return read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml", all);
}

SweepRequest tilts(const std::string& values = "20:40:5") {
  SweepRequest request;
  request.vary = {{"pump.tilt_deg", values}};
  request.outputs = {"max:Rb1_z1", "mean:Td"};
  return request;
}

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("bentaxis_sweep_" + std::to_string(getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// Equal to the bit, also where a number was not computed.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
           return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
         });
}

TEST(SweepPlan, LevelsOfEveryForm) {
  const Case base = rated();
  const Variable tilt("pump.tilt_deg", base), pistons("pump.pistons", base);
  EXPECT_THAT(levels_of("20:40:5", tilt), ElementsAre(20, 25, 30, 35, 40));
  EXPECT_THAT(levels_of("20:40:#3", tilt), ElementsAre(20, 30, 40));
  EXPECT_THAT(levels_of("5, 20:40:#2", tilt), ElementsAre(5, 20, 40));
  EXPECT_THAT(levels_of("log(1:100:#3),7", tilt), ElementsAre(1, 10, 100, 7));
  EXPECT_THAT(levels_of("3:9:2", pistons), ElementsAre(3, 5, 7, 9));
  EXPECT_THAT(levels_of("real,lumped", Variable("piston.inertia", base)), ElementsAre(1, 0));
  EXPECT_THAT(refusal([&] { levels_of("3:9:#4.5", pistons); }), HasSubstr("pump.pistons"));
  EXPECT_THAT(refusal([&] { levels_of("20:40:#3,", tilt); }), HasSubstr("must be a number"));
}

// The text of a plan is a study file that gives the same plan: every number, every word.
TEST(SweepPlan, IsReadBackFromItsText) {
  const Folder folder;
  const Case base = rated();
  SweepRequest request = tilts("log(10:41:#7)");
  request.vary.emplace_back("piston.inertia", "real,lumped");
  request.minimise = {"peak:Rb1"};
  request.maximise = {"mean:Td"};
  request.check_share = 0.1;
  SweepRequest sampled = request;
  sampled.sampling = Sampling::latin_hypercube;
  sampled.samples = 100;
  sampled.seed = 7;
  sampled.vary = {{"pump.tilt_deg", "relative(0.01)"}, {"operation.speed_rpm", "500:2000"}};
  for (const SweepRequest& one : {request, sampled}) {
    const SweepPlan plan = sweep_plan(one, base);
    std::ofstream(folder.path() / "plan.toml") << plan_text(plan);
    const SweepPlan again = sweep_plan(read_sweep_request(folder.path() / "plan.toml"), base);
    EXPECT_EQ(plan_text(again), plan_text(plan));
    EXPECT_EQ(again.size(), plan.size());
    EXPECT_EQ(again.direction, (std::vector<int>{0, 1, -1}));
    for (std::size_t i = 0; i < plan.varied.size(); ++i)
      EXPECT_EQ(again.varied[i].levels, plan.varied[i].levels);
  }
}

// Blocks are the designs one by one, in their order, whatever their number.
TEST(Sweep, BlocksHoldWhatTheEvaluatorGives) {
  const Case base = rated();
  SweepRequest request = tilts("20:100:#9");
  request.vary.emplace_back("pressure.delivery_bar", "50:400:#160");
  const Sweep sweep(base, sweep_plan(request, base));
  ASSERT_EQ(sweep.designs(), 1440U);
  EXPECT_EQ(sweep.block_size(), 4U);  // of 256 blocks and more the largest power of two
  EXPECT_EQ(sweep.blocks(), 360U);
  const Evaluator evaluator(
      Family(base, {Variable("pump.tilt_deg", base), Variable("pressure.delivery_bar", base)}),
      sweep.plan().outputs);
  std::size_t infeasible = 0;
  for (std::size_t b = 0; b < sweep.blocks(); ++b) {
    const SweepBlock block = sweep.compute(b, [] {});
    ASSERT_EQ(block.first, b * 4);
    for (std::size_t i = 0; i < block.designs; ++i) {
      const std::size_t design = block.first + i;
      const std::size_t tilt = design / 160;
      const double values[] = {20 + 10 * static_cast<double>(tilt),
                               50 + 350.0 / 159 * static_cast<double>(design % 160)};
      EXPECT_NEAR(block.values[2 * i], values[0], 1e-12);
      EXPECT_NEAR(block.values[2 * i + 1], values[1], 1e-12);
      const Evaluation one = evaluator.evaluate(std::span(block.values).subspan(2 * i, 2));
      EXPECT_TRUE(same({block.results.begin() + 2 * static_cast<long>(i),
                        block.results.begin() + 2 * static_cast<long>(i) + 2},
                       one.values));
      EXPECT_EQ(block.reasons[i], one.reason);
      infeasible += one.feasible() ? 0 : 1;
    }
  }
  EXPECT_EQ(infeasible, 320U);  // at 90 and 100 deg
}

// What a file of a block says is what was kept; one bit less is nothing.
TEST(SweepParts, KeepsBlocksWholeOrNotAtAll) {
  const Folder folder;
  const Case base = rated();
  SweepRequest request = tilts("20:100:#5");
  request.check_share = 1;
  const Sweep sweep(base, sweep_plan(request, base));
  const SweepParts parts(folder.path() / "parts", record_of(sweep, "test 1"));
  parts.begin();
  EXPECT_EQ(parts.count(), 0U);
  EXPECT_FALSE(parts.read(4));
  const SweepBlock block = sweep.compute(4, [] {});
  parts.keep(4, block);
  EXPECT_EQ(parts.count(), 1U);
  const auto found = parts.read(4);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first, 4U);
  EXPECT_TRUE(same(found->values, block.values));
  EXPECT_TRUE(same(found->results, block.results));
  EXPECT_EQ(found->reasons, block.reasons);
  EXPECT_THAT(found->reasons[0], HasSubstr("tilt_deg"));
  ASSERT_EQ(found->checks.size(), 1U);
  EXPECT_EQ(found->checks[0].reason, block.checks[0].reason);
  EXPECT_FALSE(found->checks[0].compared());  // refused by both

  const fs::path file = folder.path() / "parts" / "block-000004.bin";
  const std::string whole = content(file);
  for (std::size_t at = 0; at < whole.size(); at += 7) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    std::ofstream(file, std::ios::binary) << damaged;
    EXPECT_FALSE(parts.read(4)) << at;
    std::ofstream(file, std::ios::binary) << whole.substr(0, at);
    EXPECT_FALSE(parts.read(4)) << at;
  }
  parts.remove(sweep.blocks());
  EXPECT_FALSE(fs::exists(folder.path() / "parts"));
}

// A block that is whole, but under the name of another one: its designs would be there twice, and
// those of the other one nowhere.
TEST(SweepParts, AreNotTakenForOneAnother) {
  const Folder folder;
  const Case base = rated();
  SweepRequest request = tilts("20:100:#515");
  request.check_share = 0.01;
  const Sweep sweep(base, sweep_plan(request, base));
  ASSERT_EQ(sweep.block_size(), 2U);
  ASSERT_EQ(sweep.blocks(), 258U);  // the last of one design
  const SweepParts parts(folder.path() / "parts", record_of(sweep, "test 1"));
  parts.begin();
  EXPECT_EQ(compute_blocks(sweep, parts, {}, [](double) {}).kept, 0U);
  const auto file = [&](const char* number) {
    return folder.path() / "parts" / (std::string("block-000") + number + ".bin");
  };
  const auto overwrite = [&](const char* from, const char* to) {
    fs::copy_file(file(from), file(to), fs::copy_options::overwrite_existing);
  };
  overwrite("003", "007");
  overwrite("004", "257");
  fs::remove(file("009"));
  EXPECT_TRUE(parts.read(3));
  EXPECT_FALSE(parts.read(7));
  EXPECT_FALSE(parts.read(257));
  EXPECT_FALSE(parts.read(258));
  EXPECT_THAT(parts.misplaced({3, 7, 9, 257}), ElementsAre(7, 257));
  const auto write = [&] {
    OutputFolder out(folder.path() / "out");
    return write_sweep(sweep, parts, {.csv = true, .hdf5 = false}, out, 2, [](double) {});
  };
  EXPECT_THAT(
      refusal([&] { write(); }),
      HasSubstr("2 hold the designs of another block: 7, 257; 1 are missing or damaged: 9"));
  SweepShare share;
  share.resume = true;
  const ResumedBlocks resumed = compute_blocks(sweep, parts, share, [](double) {});
  EXPECT_EQ(resumed.kept, 255U);
  EXPECT_THAT(resumed.misplaced, ElementsAre(7, 257));
  EXPECT_EQ(write().values, compute_in_memory(sweep, 2).values);
}

// Numbers that the plan does not ask for belong to no block.
TEST(SweepParts, HoldWhatThePlanAsksFor) {
  const Case base = rated();
  SweepRequest request = tilts("20:40:#600");
  request.check_share = 1;
  const Sweep sweep(base, sweep_plan(request, base));
  const BlockLayout layout = record_of(sweep, "test 1").layout;
  const SweepBlock block = sweep.compute(5, [] {});
  ASSERT_EQ(block.designs, 2U);
  EXPECT_TRUE(layout.fits(5, block));
  const auto fits = [&](const std::function<void(SweepBlock&)>& change) {
    SweepBlock changed = block;
    change(changed);
    return layout.fits(5, changed);
  };
  EXPECT_FALSE(fits([](SweepBlock& b) { b.first += 2; }));
  EXPECT_FALSE(fits([](SweepBlock& b) { b.designs = 1; }));
  EXPECT_FALSE(fits([](SweepBlock& b) { b.values.pop_back(); }));
  EXPECT_FALSE(fits([](SweepBlock& b) { b.results.push_back(0); }));
  EXPECT_FALSE(fits([](SweepBlock& b) { b.reasons.pop_back(); }));
  EXPECT_FALSE(fits([](SweepBlock& b) { b.checks[1].own.pop_back(); }));
  EXPECT_FALSE(fits([](SweepBlock& b) { b.checks[1].design = b.first + 2; }));
  EXPECT_FALSE(fits([](SweepBlock& b) { b.checks[1].design = b.first; }));  // twice
}

// The final count: what a wrong layout lets through does not become a table.
TEST(SweepParts, AreCountedDesignByDesign) {
  const Folder folder;
  const Case base = rated();
  const Sweep sweep(base, sweep_plan(tilts("20:40:#4"), base));
  const auto said = [&](std::size_t block_size, const std::vector<std::size_t>& firsts) {
    SweepRecord record = record_of(sweep, "test 1");
    record.layout.block_size = block_size;
    record.layout.designs = firsts.back() + block_size;
    const SweepParts parts(folder.path() / std::to_string(block_size), record);
    parts.begin();
    for (std::size_t i = 0; i < firsts.size(); ++i)
      parts.keep(i, {.first = firsts[i],
                     .designs = block_size,
                     .values = std::vector<double>(block_size),
                     .results = std::vector<double>(2 * block_size),
                     .reasons = std::vector<std::string>(block_size),
                     .checks = {}});
    OutputFolder out(folder.path() / "out");
    try {
      write_sweep(sweep, parts, {.csv = true, .hdf5 = false}, out, 2, [](double) {});
    } catch (const ComputationError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(said(1, {0, 1, 2, 3}), "");
  EXPECT_THAT(said(2, {0, 2, 4, 6}), HasSubstr("8 designs, but the plan has 4"));
}

// Case, plan, version: each of them makes other blocks; what is better does not.
TEST(SweepParts, AreOfOneSweepOnly) {
  const Folder folder;
  const Case base = rated();
  const auto record = [&](const SweepRequest& request, const Case& the_case, const char* program) {
    return record_of(Sweep(the_case, sweep_plan(request, the_case)), program);
  };
  const fs::path place = folder.path() / "parts";
  SweepParts(place, record(tilts(), base, "test 1")).begin();
  SweepRequest better = tilts();
  better.minimise = {"mean:Td"};
  SweepParts(place, record(better, base, "test 1")).begin();
  SweepRequest checked = tilts();
  checked.check_share = 0.5;
  for (const SweepRecord& other :
       {record(tilts("20:40:#6"), base, "test 1"), record(checked, base, "test 1"),
        record(tilts(), rated({"piston.mass_kg=0.1"}), "test 1"),
        // The same numbers, but one of them does not follow from another any more.
        record(tilts(), rated({"assumptions.analytic.inertia=lumped"}), "test 1")}) {
    EXPECT_THAT(refusal([&] { SweepParts(place, other).begin(); }),
                HasSubstr("another case or plan"));
    EXPECT_THAT(refusal([&] { SweepParts(folder.path() / "other", other).add(place); }),
                HasSubstr("another case, plan or version"));
  }
  EXPECT_THAT(refusal([&] { SweepParts(place, record(tilts(), base, "test 2")).begin(); }),
              HasSubstr("another version, test 1"));
}

// A folder of blocks moves between machines: the curve of the case moves with it.
TEST(SweepParts, SayWhatSweepTheyAreOf) {
  const Folder folder;
  std::ofstream(folder.path() / "curve.csv")
      << "theta_deg,pressure_bar\n0,5\n90,6\n180,100\n270,90\n";
  const Case base =
      rated({"pressure.kind=curve", "pressure.file=" + (folder.path() / "curve.csv").string()});
  const Sweep sweep(base, sweep_plan(tilts(), base));
  const SweepParts parts(folder.path() / "parts", record_of(sweep, "test 1"));
  parts.begin();
  parts.keep(0, sweep.compute(0, [] {}));
  fs::remove(folder.path() / "curve.csv");
  fs::rename(folder.path() / "parts", folder.path() / "moved");
  const auto [again, record] = sweep_in(folder.path() / "moved");
  EXPECT_EQ(record.identity, parts.record().identity);
  EXPECT_TRUE(SweepParts(folder.path() / "moved", record).read(0));
  EXPECT_TRUE(same(again.compute(3, [] {}).results, sweep.compute(3, [] {}).results));
}

// About the share that was asked for, the same designs in any block; at least one.
TEST(SweepChecks, AreAShareOfTheDesigns) {
  const Case base = rated();
  SweepRequest request = tilts("20:40:#400");
  request.check_share = 0.1;
  const auto checks = [&] {
    const Sweep sweep(base, sweep_plan(request, base));
    std::size_t count = 0;
    for (std::size_t b = 0; b < sweep.blocks(); ++b)
      for (const SweepCheck& check : sweep.compute(b, [] {}).checks) {
        EXPECT_TRUE(check.agrees(1e-12)) << check.design;
        EXPECT_GT(check.scales[0], 1000);  // N: the peak of Rb1
        ++count;
      }
    return count;
  };
  EXPECT_NEAR(static_cast<double>(checks()), 40, 4 * std::sqrt(400 * 0.1 * 0.9));
  request.check_share = 1e-12;
  EXPECT_EQ(checks(), 1U);
  request.check_share = 0;
  EXPECT_EQ(checks(), 0U);
}

// Negative control: the smallest difference that counts, and one model alone that refuses.
TEST(SweepChecks, NoticeADifference) {
  SweepCheck check;
  check.own = {100, 5};
  check.values = {100, 5};
  check.scales = {1000, 0};
  EXPECT_TRUE(check.agrees(1e-9));
  check.values[0] = 100 + 2e-6;
  EXPECT_FALSE(check.agrees(1e-9));
  check.values[0] = 100 + 0.5e-6;
  EXPECT_TRUE(check.agrees(1e-9));
  check.values[1] = 6;  // not compared
  EXPECT_TRUE(check.agrees(1e-9));
  check.reason = "no assembly found";
  EXPECT_FALSE(check.agrees(1e-9));
  EXPECT_TRUE(check.compared());
  check.own_reason = "refused too";
  EXPECT_FALSE(check.agrees(1e-9));
  EXPECT_FALSE(check.compared());

  check.own_reason = check.reason = "";
  EXPECT_TRUE(check.agrees(1e-9));
  for (const double wrong : {not_computed(), HUGE_VAL}) {
    for (std::vector<double>* values : {&check.own, &check.values}) {
      const double right = std::exchange((*values)[0], wrong);
      EXPECT_FALSE(check.agrees(1e-9)) << wrong;
      (*values)[0] = right;
    }
    check.scales[0] = wrong;
    EXPECT_FALSE(check.agrees(1e-9)) << wrong;
    check.scales[0] = 1000;
  }
  EXPECT_TRUE(check.agrees(1e-9));

  const Case base =
      rated({"friction.piston_coulomb_N=100", "assumptions.multibody.piston_friction=false"});
  SweepRequest request = tilts("20:40:#3");
  request.check_share = 1;
  const Sweep sweep(base, sweep_plan(request, base));
  EXPECT_FALSE(sweep.compute(0, [] {}).checks.at(0).agrees(kCheckTolerance));
}

// Of more designs than are wanted every second, third, ..; counts are of all.
TEST(SweepResult, IsThinnedEvenly) {
  const Folder folder;
  const Case base = rated();
  const Sweep sweep(base, sweep_plan(tilts("20:100:#9"), base));
  const SweepParts parts(folder.path() / "parts", record_of(sweep, "test 1"));
  parts.begin();
  SweepShare share;
  share.threads = 2;
  EXPECT_EQ(compute_blocks(sweep, parts, share, [](double) {}).kept, 0U);
  share.resume = true;
  EXPECT_EQ(compute_blocks(sweep, parts, share, [](double) {}).kept, 9U);
  const auto results = [&](std::size_t most) {
    OutputFolder out(folder.path() / "out");
    return write_sweep(
        sweep, parts, {.csv = true, .hdf5 = false}, out, 2, [](double) {}, most);
  };
  const SweepResult whole = results(9), some = results(4);
  EXPECT_EQ(whole.every, 1U);
  EXPECT_EQ(whole.designs, 9U);
  EXPECT_EQ(some.every, 3U);
  EXPECT_THAT(some.values, ElementsAre(20, 50, 80));
  EXPECT_EQ(some.all_infeasible, 2U);
  EXPECT_TRUE(some.infeasible.empty());
  EXPECT_THAT(whole.infeasible, testing::SizeIs(2));
  EXPECT_EQ(whole.infeasible[1].first, 8U);
  EXPECT_EQ(some.results[2], whole.results[6]);
}

TEST(SweepParts, ListsOfNumbers) {
  EXPECT_EQ(list_of({3}), "3");
  EXPECT_EQ(list_of({3, 4, 5, 9, 11, 12}), "3-5, 9, 11-12");
  std::vector<std::size_t> even;
  for (std::size_t i = 0; i < 100; i += 2) even.push_back(i);
  EXPECT_TRUE(list_of(even).ends_with("38, ..")) << list_of(even);
}

}  // namespace
}  // namespace bentaxis::designs
