// The rattle map: classes that are known by construction, the criterion against a search by brute
// force, rows that do not depend on threads, and points by Simbody.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <set>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/rattle_document.h"
#include "bentaxis/study/rattle_file.h"
#include "rattle_pieces.h"
#include "support.h"

namespace bentaxis::study {
namespace {

using test::scaled;
using testing::HasSubstr;
namespace fs = std::filesystem;
const fs::path kCases = fs::path(BENTAXIS_SOURCE_DIR) / "cases";

// The pump at its rated pressure with compliant teeth.
Case pump_with(double drag, double backlash_um) {
  Case c = read_case(kCases / "bap63_tooth_rattle.toml");
  c.pump.friction.block_viscous =
      read_case(kCases / "bap63_rated.toml").pump.friction.block_viscous * drag;
  c.pump.gear.compliance->backlash = backlash_um * 1e-6;
  return c;
}

std::string text_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

RattleOptions map_of(std::vector<double> speeds, std::vector<double> pressures) {
  RattleOptions options;
  options.speed_rpm = std::move(speeds);
  options.delivery_bar = std::move(pressures);
  return options;
}

RattlePoint point_at(const Case& c, double rpm, double bar) {
  const RattleMap map = rattle_map(c, map_of({rpm}, {bar}));
  return map.rows[0].up[0];
}

TEST(Rattle, StretchesHaveTheirClass) {
  coupled::ContactInterval s;
  s.duration = s.plus = 1;
  EXPECT_EQ(class_of(s), RattleClass::carries);
  s.plus = 0.5;
  s.minus = 0.5;
  EXPECT_EQ(class_of(s), RattleClass::reverses);
  s.plus = 1;  // the other flank presses as well, now and then
  EXPECT_EQ(class_of(s), RattleClass::carries);
  s.plus = 0.5;
  s.apart = 1.01 * kNoGap;
  EXPECT_EQ(class_of(s), RattleClass::hits_both);
  s.minus = 0;
  EXPECT_EQ(class_of(s), RattleClass::loses_contact);
  s.apart = 0.99 * kNoGap;
  EXPECT_EQ(class_of(s), RattleClass::carries);
}

TEST(Rattle, TwoSteadyStates) {
  RattlePoint a, b;
  a.largest = b.largest = 100;
  a.least_turn = 95;
  b.least_turn = 90;
  EXPECT_FALSE(two_states(a, b));
  b.largest = 112;
  b.least_turn = 101;  // above all of the other
  EXPECT_TRUE(two_states(a, b));
  EXPECT_TRUE(two_states(b, a));
  b.least_turn = 99;  // their turns overlap
  EXPECT_FALSE(two_states(a, b));
  b.least_turn = 101;
  b.largest = 110;  // not far enough apart
  EXPECT_FALSE(two_states(a, b));
  b = a;
  b.kind = RattleClass::loses_contact;
  EXPECT_TRUE(two_states(a, b));
}

// With the printed drag at a low pressure the flank never leaves; without drag the torque on the
// block changes its sign: over no backlash the force passes to the other flank, over some it hits.
// A little reversal of torque, and a backlash that the block does not cross before it is driven
// back: one flank only.
TEST(Rattle, ClassesByConstruction) {
  const RattlePoint carries = point_at(pump_with(1, 20), 1500, 100);
  EXPECT_EQ(carries.kind, RattleClass::carries);
  EXPECT_EQ(carries.plus, 1);
  EXPECT_EQ(carries.apart, 0);
  EXPECT_EQ(carries.impacts, 0);
  EXPECT_EQ(carries.period, 1);
  EXPECT_LT(carries.passed, 10);  // it is not waited for what is settled

  const RattlePoint reverses = point_at(pump_with(0, 0), 1500, 275);
  EXPECT_EQ(reverses.kind, RattleClass::reverses);
  EXPECT_GT(reverses.plus, 0.1);
  EXPECT_GT(reverses.minus, 0.1);

  const RattlePoint hits = point_at(pump_with(0, 20), 1500, 275);
  EXPECT_EQ(hits.kind, RattleClass::hits_both);
  EXPECT_GT(hits.impacts, 10);
  EXPECT_GT(hits.largest_impulse, 0);
  EXPECT_NEAR(hits.apart + hits.plus + hits.minus, 1, 1e-9);

  const RattlePoint loses = point_at(pump_with(1, 100), 1150, 350);
  EXPECT_EQ(loses.kind, RattleClass::loses_contact);
  EXPECT_EQ(loses.minus, 0);
  EXPECT_GT(loses.apart, 0.01);
}

// Shaft's teeth that stand by turns ahead and back, without backlash: wedged between two of them
// the block's teeth touch on both flanks nearly all the time, and that is no gap.
TEST(Rattle, WedgedTeethTouchOnBothFlanks) {
  Case c = read_case(kCases / "bap63_teeth.toml");
  c.pump.friction.block_viscous = 0.01 * 60 / (2 * kPi);
  ToothData& teeth = *c.pump.gear.teeth;
  teeth.backlash = 0;
  for (int tooth = 1; tooth <= teeth.count; ++tooth)
    teeth.shaft.pitch.push_back(tooth % 2 == 0 ? -15e-6 : 15e-6);
  teeth.block.pitch.assign(teeth.count, 0.0);
  const PreparedCase ready = prepare(c);
  const auto mechanics = analytic::mechanics(c, ready.assumptions(Model::analytic));
  const auto oil =
      coupled::prescribed_oil(c.pump.geometry.pistons, ready.pressure, c.pressure.ports);
  coupled::ToothWatch watch("analytic", *mechanics, *oil, 1e-8, kImpactSpeed);
  watch.start(mechanics->start());
  coupled::ContactInterval all;
  double plus = 0, minus = 0, apart = 0;
  constexpr int kParts = 2000;
  for (int i = 0; i < kParts; ++i) {
    TeethAction action;
    const double time = 0.01 * (i + 0.5) / kParts;
    all = all + watch.run_to(time);
    ASSERT_TRUE(mechanics->teeth(time, watch.motion(), action));
    double forces[2] = {};
    for (const PairContact& pair : action.pairs) forces[pair.flank > 0 ? 0 : 1] += pair.force;
    plus += (forces[0] > 0 ? 1.0 : 0.0) / kParts;
    minus += (forces[1] > 0 ? 1.0 : 0.0) / kParts;
    apart += (forces[0] == 0 && forces[1] == 0 ? 1.0 : 0.0) / kParts;
  }
  EXPECT_GT(plus + minus, 1.5);  // both at once
  EXPECT_NEAR(all.plus / all.duration, plus, 2e-3);
  EXPECT_NEAR(all.minus / all.duration, minus, 2e-3);
  EXPECT_EQ(all.apart, 0);
  EXPECT_EQ(apart, 0);
}

TEST(Rattle, RigidTeethCarryOrReverse) {
  Case c = read_case(kCases / "bap63_rated.toml");
  EXPECT_EQ(point_at(c, 1500, 275).kind, RattleClass::carries);
  EXPECT_EQ(point_at(c, 500, 275).kind, RattleClass::reverses);
  const RattlePoint p = point_at(c, 1500, 275);
  EXPECT_EQ(p.apart, 0);
  EXPECT_EQ(p.observed, 0);
  EXPECT_GT(p.largest, p.mean);
}

// The force at ten times as many angles, from the tables that `run` gives.
std::pair<double, double> extremes_by_brute_force(const Case& the_case, double rpm, double bar) {
  Case c = rattle_case(the_case, rpm, bar);
  c.pump.gear.contact = ToothContact::rigid;
  c.pump.gear.compliance.reset();
  c.operation.samples_per_revolution = 7200;
  const ResultTable table = run_turn(prepare(c), Model::analytic);
  const std::vector<double> force = test::column(table, "Rcs_z4_N");
  const auto [least, greatest] = std::minmax_element(force.begin(), force.end());
  return {*least, *greatest};
}

double least_by_brute_force(const Case& the_case, double rpm, double bar) {
  return extremes_by_brute_force(the_case, rpm, bar).first;
}

TEST(Rattle, CriterionIsThatOfASearchByBruteForce) {
  const Case c = pump_with(1, 20);
  for (const double rpm : {400.0, 2900.0}) {
    Case at = c;
    // Also with kinks of the pressure between the angles of the coarse search.
    if (rpm > 1000) at.pressure.delivery_start_deg += 5.2;
    const auto [least, greatest] = rigid_extremes(prepare(rattle_case(at, rpm, 275)));
    const auto [low, high] = extremes_by_brute_force(at, rpm, 275);
    EXPECT_NEAR(least, low, scaled(1e-3)) << rpm;  // of 100 N
    EXPECT_NEAR(greatest, high, scaled(1e-3)) << rpm;
  }
  RattleOptions options = map_of({300, 1000, 1700}, {150, 300});
  const RattleMap map = rattle_map(c, options);
  for (const RattleRow& row : map.rows) {
    ASSERT_EQ(row.boundary_rpm.size(), 1U);
    EXPECT_LT(least_by_brute_force(c, row.boundary_rpm[0] - 0.1, row.delivery_bar), 0);
    EXPECT_GT(least_by_brute_force(c, row.boundary_rpm[0] + 0.1, row.delivery_bar), 0);
  }
  // About in proportion to the pressure.
  EXPECT_NEAR(map.rows[1].boundary_rpm[0] / map.rows[0].boundary_rpm[0], 2, 0.1);
  const BoundaryAgreement agreement = boundary_agreement(map);
  EXPECT_EQ(agreement.points, 6U);
  ASSERT_EQ(agreement.places.size(), 2U);
  EXPECT_EQ(agreement.places[0].simulated_rpm, 650);
  EXPECT_EQ(agreement.places[1].criterion_rpm, map.rows[1].boundary_rpm[0]);
}

// Against the trajectory of analytic::simulate, another method: half a turn of impacts.
// Of pistons: the wall force with which one piston would carry what a constant-velocity joint does.
// A wall acts at D, where the axis of the piston moves by 1 - l_c/b1 of what the bore turns.
TEST(Rattle, CriterionOfPistonsIsTheForceOfOneThatCarriesAlone) {
  Case the_case = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" /
                            "bap63_tapered_pistons.toml");
  const Case at_point = study::rattle_case(the_case, 1200, 150);
  const auto [least, greatest] = study::rigid_extremes(study::prepare(at_point));
  Case joint = at_point;
  joint.pump.transfer.kind = TransferKind::constant_velocity;
  joint.operation.samples_per_revolution = 7 * 720;
  const ResultTable table = study::run_turn(study::prepare(joint), study::Model::analytic);
  const std::size_t couple = table.find("Tcs_z2_Nm");
  double low = 1e300, high = -1e300;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    low = std::min(low, table.at(row, couple));
    high = std::max(high, table.at(row, couple));
  }
  const double arm = 0.022 * (1 - 34.0 / 46.0);  // m: Rd, l_c and b1 of the case
  EXPECT_NEAR(least, low / arm, scaled(1e-4) * std::abs(high / arm));
  EXPECT_NEAR(greatest, high / arm, scaled(1e-4) * std::abs(high / arm));
}

TEST(Rattle, TheWatchSeesWhatASimulationSees) {
  Case c = read_case(kCases / "bap63_tooth_rattle.toml");
  c.drive->duration = 0.004;
  c.drive->samples = 40000;
  const PressureTrace pressure(c.pressure);
  analytic::SimulationOptions options;
  options.error = 1e-9;
  const Trajectory truth = analytic::simulate(c, c.analytic, pressure, options);
  const auto oil = coupled::prescribed_oil(c.pump.geometry.pistons, pressure, c.pressure.ports);
  const auto mechanics = analytic::mechanics(c, c.analytic);
  coupled::ToothWatch watch("analytic", *mechanics, *oil, 1e-10, kImpactSpeed);
  watch.start(mechanics->start());
  const coupled::ContactInterval first = watch.run_to(0.0015);
  const coupled::ContactInterval all = first + watch.run_to(0.004);

  const auto& events = truth.record.events;
  const auto touches = std::count_if(events.begin(), events.end(), [](const ToothEvent& e) {
    return e.touch && e.approach_speed >= kImpactSpeed;
  });
  EXPECT_GT(touches, 3);
  EXPECT_EQ(all.impacts, touches);
  EXPECT_NEAR(all.apart / 0.004, truth.record.share_out_of_contact, scaled(1e-5));
  EXPECT_NEAR(all.apart + all.plus + all.minus, 0.004, 1e-15);
  double impulse = 0, hit = 0, largest = 0;
  for (const ToothEvent& e : events) {
    impulse += e.impulse;
    hit = std::max(hit, e.impulse);
  }
  for (const double force : test::column(truth.table.results, "Rcs_law_N"))
    largest = std::max(largest, std::abs(force));
  EXPECT_NEAR(all.impulse, impulse, scaled(1e-5) * impulse);
  EXPECT_NEAR(all.largest_hit, hit, scaled(1e-5) * hit);
  EXPECT_NEAR(all.largest, largest, scaled(1e-4) * largest);
  EXPECT_EQ(std::max(first.largest, all.largest), all.largest);
}

// What a watch needs, of the pump that rattles.
struct Watched {
  explicit Watched(double tolerance)
      : the_case(read_case(kCases / "bap63_tooth_rattle.toml")),
        pressure(the_case.pressure),
        oil(coupled::prescribed_oil(the_case.pump.geometry.pistons, pressure,
                                    the_case.pressure.ports)),
        mechanics(analytic::mechanics(the_case, the_case.analytic)),
        watch("analytic", *mechanics, *oil, tolerance, kImpactSpeed) {}
  Case the_case;
  PressureTrace pressure;
  std::unique_ptr<Oil> oil;
  std::unique_ptr<Mechanics> mechanics;
  coupled::ToothWatch watch;
};

// Steps far apart find the largest force of every stretch nearly as the dense rows of
// analytic::simulate do.
TEST(Rattle, TopsBetweenStepsAreFound) {
  Watched reference(1e-9);
  Case c = reference.the_case;
  c.drive->duration = 0.004;
  c.drive->samples = 40000;
  analytic::SimulationOptions options;
  options.error = 1e-9;
  const ResultTable rows =
      analytic::simulate(c, c.analytic, reference.pressure, options).table.results;
  const std::vector<double> force = test::column(rows, "Rcs_law_N");
  for (const double tolerance : {1e-7, 1e-8}) {
    Watched w(tolerance);
    w.watch.start(w.mechanics->start());
    std::size_t row = 0;
    for (const int part : {5, 10, 20, 30, 40}) {  // ends, 0.1 ms
      double largest = std::abs(force.at(row));
      while (row < static_cast<std::size_t>(part) * 1000)
        largest = std::max(largest, std::abs(force.at(++row)));
      EXPECT_NEAR(w.watch.run_to(part * 1e-4).largest, largest, scaled(5e-5) * largest) << part;
    }
    EXPECT_LT(w.watch.steps(), 800);
  }
}

// A point is its observed turns, counted and averaged; without turns before them those from the
// middle of the backlash on.
TEST(Rattle, APointIsTheMeanOfItsTurns) {
  constexpr double kRpm = 1500, kBar = 275;
  const PreparedCase ready = prepare(rattle_case(pump_with(0, 20), kRpm, kBar));
  RattleOptions options = map_of({kRpm}, {kBar});
  options.discard = 0;
  options.turns = 3;
  double lag = 0, lag_rate = 0;
  const RattlePoint p = settle(ready, options, lag, lag_rate, [] {});
  EXPECT_EQ(p.observed, 3);
  EXPECT_EQ(p.passed, 0);
  EXPECT_EQ(p.period, 0);
  EXPECT_EQ(p.lag, 0);

  const Case& c = ready.the_case;
  const auto oil =
      coupled::prescribed_oil(c.pump.geometry.pistons, ready.pressure, c.pressure.ports);
  const auto mechanics = analytic::mechanics(c, ready.assumptions(Model::analytic));
  coupled::ToothWatch watch("analytic", *mechanics, *oil, step_tolerance(options.error),
                            kImpactSpeed);
  watch.start(mechanics->start());
  constexpr double kTurn = 60 / kRpm;
  double apart = 0, plus = 0, impulse = 0, impacts = 0, least = INFINITY, largest = 0, hit = 0;
  for (int n = 1; n <= 3; ++n) {
    const coupled::ContactInterval s = watch.run_to(n * kTurn);
    apart += s.apart;
    plus += s.plus;
    impulse += s.impulse;
    impacts += s.impacts;
    least = std::min(least, s.largest);
    largest = std::max(largest, s.largest);
    hit = std::max(hit, s.largest_hit);
  }
  EXPECT_EQ(lag, watch.motion()[kLag]);
  EXPECT_EQ(lag_rate, watch.motion()[kLagRate]);
  EXPECT_LT(least, largest);
  EXPECT_EQ(p.least_turn, least);
  EXPECT_EQ(p.largest, largest);
  EXPECT_EQ(p.largest_impulse, hit);
  EXPECT_NEAR(p.impacts, impacts / 3, 1e-12 * impacts);
  EXPECT_NEAR(p.apart, apart / (3 * kTurn), 1e-12);
  EXPECT_NEAR(p.plus, plus / (3 * kTurn), 1e-12);
  EXPECT_NEAR(p.minus, 1 - p.apart - p.plus, 1e-12);
  EXPECT_NEAR(p.mean, impulse / (3 * kTurn), 1e-12 * p.mean);
}

// What was watched before leaves no trace.
TEST(Rattle, AWatchBeginsAnew) {
  Watched used(1e-9), fresh(1e-9);
  used.watch.start(used.mechanics->start());
  constexpr double kStretch = 2.5e-7;
  std::optional<MotionVector> touching;
  double first = 0, last = 0, now = 0;  // forces of a contact, as it grows
  // Until the force hardly grows any more, nearly at its top: from there a parabola to another
  // time would have a top.
  const auto at_top = [&](int n) {
    return touching && now > 3 * first && now > last &&
           (now - last) / kStretch < 0.5 * (now - first) / (n * kStretch);
  };
  int n = 0;
  while (!at_top(n) && n < 20000) {
    const coupled::ContactInterval s = used.watch.run_to(++n * kStretch);
    if (s.apart > 0) {
      touching.reset();
      continue;
    }
    last = now;
    now = s.largest;
    if (touching) continue;
    touching = used.watch.motion();
    first = now;
  }
  ASSERT_TRUE(at_top(n));
  for (Watched* w : {&used, &fresh}) w->watch.start(*touching);
  const coupled::ContactInterval a = used.watch.run_to(1e-7), b = fresh.watch.run_to(1e-7);
  EXPECT_GT(b.largest, 0);
  EXPECT_LT(b.largest, now);
  EXPECT_EQ(a.largest, b.largest);
  EXPECT_EQ(a.plus, b.plus);
  EXPECT_EQ(a.minus, b.minus);
  EXPECT_EQ(a.impulse, b.impulse);
  EXPECT_EQ(used.watch.motion(), fresh.watch.motion());
}

TEST(Rattle, RowsDoNotDependOnThreads) {
  RattleOptions options = map_of({800, 1500}, {100, 200, 300});
  options.turns = options.discard = 2;
  options.threads = 1;
  const Case c = pump_with(0.3, 20);
  const std::string one = rattle_csv(rattle_map(c, options));
  EXPECT_THAT(one, HasSubstr("hits both flanks"));
  for (const int threads : {2, 3}) {
    options.threads = threads;
    EXPECT_EQ(rattle_csv(rattle_map(c, options)), one);
  }
}

TEST(Rattle, RowsThatAreThereAreNotComputedAgain) {
  RattleOptions options = map_of({1500, 2000}, {100, 200});
  const Case c = pump_with(1, 20);
  const fs::path file = fs::path(testing::TempDir()) / "rattle_rows.csv";
  fs::remove(file);
  RattleFile kept(file, "one case");
  RattleKeeping keeping;
  keeping.keep = [&](const RattleRow& row) { kept.keep(row); };
  const std::string whole = rattle_csv(rattle_map(c, options, keeping));
  EXPECT_EQ(kept.rows(), 2U);

  keeping.finished = RattleFile(file, "one case").read();
  ASSERT_EQ(keeping.finished.size(), 2U);
  keeping.keep = [](const RattleRow&) { FAIL() << "nothing is left to do"; };
  EXPECT_EQ(rattle_csv(rattle_map(c, options, keeping)), whole);
  keeping.finished[0].up[0].largest = 12345;  // taken as it is
  EXPECT_THAT(rattle_csv(rattle_map(c, options, keeping)), HasSubstr("12345"));

  EXPECT_THROW(RattleFile(file, "another case").read(), InputError);
  EXPECT_TRUE(RattleFile(file.string() + ".none", "one case").read().empty());
  // A damaged row, one that is there twice, one of another map.
  const std::string rows = text_of_file(file);
  const std::size_t middle = rows.find("\nsum,") + 1;
  const std::size_t first = rows.find("row,"), second = rows.find("row,", middle);
  const auto refused = [&](const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return test::refusal([&] { RattleFile(file, "one case").read(); });
  };
  for (std::size_t at = first; at < rows.size(); at += 13) {
    std::string damaged = rows;
    damaged[at] = damaged[at] == '7' ? '8' : '7';
    EXPECT_THAT(refused(damaged), HasSubstr("is damaged")) << at;
  }
  EXPECT_THAT(refused(rows + rows.substr(second)), HasSubstr("which is a duplicate row"));
  EXPECT_THAT(refused("# rows of a rattle map that is not complete (docs/rattle.md)\n# one case\n" +
                      rows.substr(first, second - first)),
              "accepted");
  RattleFile other(file, "another case");
  other.keep(keeping.finished[1]);
  const std::string others = text_of_file(file);
  EXPECT_THAT(refused(rows.substr(0, second) + others.substr(others.find("row,"))),
              HasSubstr("row 2 is damaged"));
  std::ofstream(file, std::ios::binary) << rows;
  std::ofstream(file, std::ios::app) << "row,300\nrigid,1";
  EXPECT_THROW(RattleFile(file, "one case").read(), InputError);
  std::ofstream(file) << "delivery_bar\n1\n";
  EXPECT_THROW(RattleFile(file, "one case").read(), InputError);
  fs::remove(file);
}

// The boundary of the motion that is nearest to the criterion's, of those that the speeds show.
TEST(Rattle, BoundariesAreComparedWithTheNearest) {
  RattleMap map;
  map.options = map_of({100, 200, 300, 500}, {1});
  map.rows.resize(1);
  RattleRow& row = map.rows[0];
  row.up.resize(4);
  row.up[0].kind = row.up[3].kind = RattleClass::hits_both;
  row.least = {-1, 1, 1, 1};
  row.greatest = {2, 2, 2, 2};
  row.boundary_rpm = {160, 320};
  const BoundaryAgreement found = boundary_agreement(map);
  EXPECT_EQ(found.points, 4U);
  EXPECT_EQ(found.same, 3U);  // at 500 it hits though rigid teeth would carry
  ASSERT_EQ(found.places.size(), 2U);
  EXPECT_EQ(found.places[0].simulated_rpm, 150);
  EXPECT_EQ(found.places[0].spacing_rpm, 100);
  EXPECT_EQ(found.places[1].simulated_rpm, 400);
  EXPECT_EQ(found.places[1].spacing_rpm, 200);
}

TEST(Rattle, PointsToCheckAreSpreadOverTheClasses) {
  RattleMap map;
  map.options = map_of({1, 2, 3, 4}, {1, 2, 3, 4});
  map.options.check = 7;
  map.rows.resize(4);
  for (RattleRow& row : map.rows) {
    row.up.resize(4);
    for (RattlePoint& p : row.up) p.observed = 1;
  }
  map.rows[1].up[2].kind = RattleClass::loses_contact;
  for (RattlePoint& p : map.rows[3].up) p.kind = RattleClass::hits_both;
  const auto chosen = points_to_check(map);
  std::vector<int> counts(4, 0);
  for (const auto& [i, j] : chosen) ++counts[static_cast<std::size_t>(map.rows[i].up[j].kind)];
  EXPECT_THAT(counts, testing::ElementsAre(3, 0, 1, 3));
  EXPECT_EQ((std::set<std::pair<std::size_t, std::size_t>>(chosen.begin(), chosen.end()).size()),
            chosen.size());
  map.options.check = 100;
  EXPECT_EQ(points_to_check(map).size(), 16U);
  map.rows[0].up[3].observed = 0;  // as of rigid teeth: no motion to follow
  EXPECT_EQ(points_to_check(map).size(), 15U);
  EXPECT_THAT(points_to_check(map),
              testing::Not(testing::Contains(std::pair<std::size_t, std::size_t>(0, 3))));
}

TEST(Rattle, AForceThatIsMissingIsNoAgreement) {
  RattleCheck check;
  check.judged = 1;
  check.allowed = 1e-3;
  const auto agrees = [&](double analytic, double multibody) {
    check.difference = force_difference(analytic, multibody).share();
    return check.agrees();
  };
  EXPECT_TRUE(agrees(1000, 1000.5));
  EXPECT_TRUE(agrees(0, 0));
  EXPECT_FALSE(agrees(0, 1000));
  EXPECT_FALSE(agrees(1002, 1000));
  for (const double wrong : {not_computed(), HUGE_VAL}) {
    EXPECT_FALSE(agrees(wrong, 1000));
    EXPECT_FALSE(agrees(1000, wrong));
    EXPECT_FALSE(agrees(wrong, wrong));
    EXPECT_FALSE(agrees(0, wrong));
  }
}

TEST(Rattle, SimbodyFindsTheSameOrIsSaidNotTo) {
  Case c = pump_with(1, 20);
  RattleOptions options = map_of({600, 1500}, {300});
  options.turns = options.discard = 2;
  options.check = 2;
  const RattleMap map = rattle_map(c, options);
  ASSERT_EQ(map.checks.size(), 2U);
  bool chaotic = false, whole = false;
  for (const RattleCheck& check : map.checks) {
    EXPECT_TRUE(check.agrees()) << check.difference << " of " << check.allowed;
    (check.chaotic() ? chaotic : whole) = true;
  }
  EXPECT_TRUE(chaotic && whole);
  EXPECT_TRUE(map.agrees());

  // Simbody without friction of the pistons: another pump.
  c.pump.friction.piston_coulomb = 500;
  c.multibody.piston_friction = false;
  options = map_of({1500}, {90, 100});
  options.turns = options.discard = 2;  // still ringing
  options.check = 1;
  const RattleMap other = rattle_map(c, options);
  EXPECT_FALSE(other.agrees());
  EXPECT_EQ(other.checks.at(0).row, 1U);
  EXPECT_THAT(rattle_text(other), HasSubstr("differs"));
}

TEST(Rattle, TeethOfBevelGearsAreMovedAlike) {
  const Case c = read_case(kCases / "bap63_teeth.toml");
  RattleOptions options = map_of({2000}, {100});
  options.turns = options.discard = options.check = 1;
  const RattleMap map = rattle_map(c, options);
  EXPECT_EQ(map.rows[0].up[0].kind, RattleClass::hits_both);
  EXPECT_TRUE(map.agrees());
  // Rigid teeth know nothing of how teeth give way.
  Case rigid = c;
  rigid.pump.gear = read_case(kCases / "bap63_rated.toml").pump.gear;
  EXPECT_EQ(rattle_map(rigid, options).rows[0].least, map.rows[0].least);
}

}  // namespace
}  // namespace bentaxis::study
