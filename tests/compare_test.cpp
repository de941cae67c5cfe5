// The comparison: made-up tables with known answers; no model is run here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/compare/split.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/report/page.h"
#include "bentaxis/report/text.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using namespace compare;
using testing::HasSubstr;
using testing::Not;

Channel channel(const std::string& name, const std::string& group, const std::string& unit = "N",
                ChannelKind kind = ChannelKind::reaction) {
  Channel c;
  c.name = name;
  c.quantity = c.group = group;
  c.meaning = name;
  c.unit = unit;
  c.kind = kind;
  return c;
}

// One column per function of the angle in degrees.
ResultTable table(const std::string& name, const std::vector<Channel>& channels,
                  const std::vector<std::function<double(double)>>& curves, int samples = 72) {
  ResultTable t;
  t.name = name;
  t.channels = channels;
  for (int i = 0; i < samples; ++i) {
    t.theta_deg.push_back(360.0 * i / samples);
    for (const auto& curve : curves) t.values.push_back(curve(t.theta_deg.back()));
  }
  return t;
}

double wave(double deg, int order, double phase = 0) {
  return std::cos(order * radians(deg) - phase);
}

TEST(Comparison, MeasuresADifferenceOfKnownShape) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double t) { return 100 * wave(t, 5); }});
  const auto b =
      table("b", channels, {[](double t) { return 100 * wave(t, 5) + 1 + 2 * wave(t, 10, 0.5); }});
  Options options;
  options.orders = {5, 10};
  options.tolerance = 1e-3;
  const Comparison c = compare_tables(a, b, options);
  const ChannelComparison& x = c.channels.at(0);
  EXPECT_EQ(x.verdict, Verdict::differs);
  EXPECT_DOUBLE_EQ(x.peak, 100);
  EXPECT_NEAR(x.mean_difference, 1, 1e-12);
  EXPECT_NEAR(x.rms, std::sqrt(1 + 2), 1e-12);
  EXPECT_NEAR(x.largest, 3, 0.05);
  ASSERT_EQ(x.harmonics.size(), 2U);
  EXPECT_NEAR(x.harmonics[0].amplitude[0], 100, 1e-11);
  EXPECT_NEAR(x.harmonics[1].amplitude[1], 2, 1e-12);
  EXPECT_NEAR(*x.harmonics[1].phase_deg[1], 0.5 / kRadPerDegree, 1e-9);
  EXPECT_FALSE(x.harmonics[1].phase_deg[0]);  // no such order in a
  EXPECT_NEAR(x.digits, -std::log10(x.largest / 100), 1e-12);
  EXPECT_FALSE(c.agrees());
}

TEST(Comparison, OrdersThatTheSamplesCannotResolveAreLeftOut) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double t) { return wave(t, 1); }}, 12);
  Options options;
  options.orders = {5, 6};
  const Comparison c = compare_tables(a, a, options);
  ASSERT_EQ(c.channels[0].harmonics.size(), 1U);
  EXPECT_EQ(c.channels[0].harmonics[0].order, 5);
}

TEST(Comparison, OrdersOfATableOverSeveralTurnsAreOfOneTurn) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  ResultTable a = table("a", channels, {[](double t) { return 3 * wave(2 * t, 3); }}, 24);
  for (double& angle : a.theta_deg) angle *= 2;  // 12 samples in each of two turns
  Options options;
  options.orders = {3, 7};
  const Comparison c = compare_tables(a, a, options);
  ASSERT_EQ(c.channels.at(0).harmonics.size(), 1U);  // 12 samples do not resolve order 7
  EXPECT_EQ(c.channels[0].harmonics[0].order, 3);
  EXPECT_NEAR(c.channels[0].harmonics[0].amplitude[0], 3, 1e-12);
}

TEST(Comparison, OrdersNeedWholeTurns) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  ResultTable a = table("a", channels, {[](double t) { return wave(t, 1); }}, 24);
  Options options;
  options.orders = {1};
  EXPECT_EQ(compare_tables(a, a, options).channels.at(0).harmonics.size(), 1U);
  for (double& angle : a.theta_deg) angle *= 0.75;
  EXPECT_TRUE(compare_tables(a, a, options).channels.at(0).harmonics.empty());
}

TEST(Comparison, WorstIsTheFirstOfEquals) {
  const std::vector<Channel> channels = {channel("X_N", "X"), channel("Y_N", "Y")};
  const auto one = [](double) { return 1.0; };
  const auto two = [](double) { return 2.0; };
  const Comparison c =
      compare_tables(table("a", channels, {one, one}), table("b", channels, {two, two}), {});
  ASSERT_NE(c.worst(), nullptr);
  EXPECT_EQ(c.worst()->channel.name, "X_N");
}

TEST(Comparison, PeakIsSharedByTheComponentsOfAVector) {
  const std::vector<Channel> channels = {channel("X_x_N", "X"), channel("X_y_N", "X")};
  const auto a = table("a", channels, {[](double) { return 300.0; }, [](double) { return 0.0; }});
  const auto b = table("b", channels, {[](double) { return 300.0; }, [](double) { return 1e-8; }});
  Options options;
  options.tolerance = 1e-10;
  EXPECT_TRUE(compare_tables(a, b, options).agrees());
  options.tolerance = 1e-11;
  EXPECT_FALSE(compare_tables(a, b, options).agrees());
}

TEST(Comparison, ZeroReactionIsHeldToTheLoadScale) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double) { return 0.0; }});
  const auto b = table("b", channels, {[](double) { return 1e-9; }});
  Options options;
  EXPECT_FALSE(compare_tables(a, b, options).agrees());  // no scale: any difference counts
  options.zero_scales = {{"N", 1e4}};
  EXPECT_TRUE(compare_tables(a, b, options).agrees());
  options.zero_scales = {{"N", 1e-2}};
  EXPECT_FALSE(compare_tables(a, b, options).agrees());
}

// What is left of loads that cancel carries their round-off: 1e-12 of them is allowed at 1e-9.
TEST(Comparison, SmallReactionIsHeldToAThousandthOfTheLoad) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto with = [&](double peak, double difference) {
    Options options;
    options.zero_scales = {{"N", 1e4}};
    return compare_tables(table("a", channels, {[=](double t) { return peak * wave(t, 1); }}),
                          table("b", channels, {[=](double t) {
                                  return peak * wave(t, 1) + (t == 90 ? difference : 0);
                                }}),
                          options)
        .channels[0];
  };
  for (const double peak : {1e-6, 1e-3, 1.0, 9.9}) {
    EXPECT_EQ(with(peak, 0.99e-8).verdict, Verdict::agrees) << peak;
    EXPECT_EQ(with(peak, 1.01e-8).verdict, Verdict::differs) << peak;
    EXPECT_TRUE(with(peak, 0).at_floor) << peak;
    EXPECT_DOUBLE_EQ(with(peak, 0).peak, 10) << peak;
    EXPECT_DOUBLE_EQ(with(peak, 0).own_peak, peak);
    EXPECT_DOUBLE_EQ(with(peak, 1e-8).largest_over_peak(), 1e-9) << peak;
  }
  // A signal is held to itself, as before: a millionth of it is noticed.
  EXPECT_FALSE(with(20, 0).at_floor);
  EXPECT_EQ(with(20, 2.1e-8).verdict, Verdict::differs);
  EXPECT_EQ(with(0.02, 2e-8).verdict, Verdict::differs);
  // Round-off of the loads is no signal: zero is held to the load itself.
  EXPECT_DOUBLE_EQ(with(0.9e-8, 0).peak, 1e4);
}

// Neither the largest difference over the peak nor the first: the one that is beyond its limit.
TEST(Comparison, WorstIsTheChannelThatFailed) {
  const std::vector<Channel> channels = {channel("X_N", "X"), channel("Y_Nm", "Y", "Nm"),
                                         channel("Z_Nm", "Z", "Nm")};
  const auto of = [&](double x, double y, double z) {
    Options options;
    options.tolerance = 1e-3;
    options.absolute = {{"N", 1}};
    const auto constant = [](double value) { return [=](double) { return value; }; };
    return compare_tables(
        table("a", channels, {constant(1), constant(100), constant(100)}),
        table("b", channels, {constant(1 + x), constant(100 + y), constant(100 + z)}), options);
  };
  const Comparison c = of(0.5, 0.2, 0.3);
  ASSERT_NE(c.failed(), nullptr);
  EXPECT_EQ(c.failed()->channel.name, "Z_Nm");
  EXPECT_EQ(c.worst()->channel.name, "Z_Nm");
  EXPECT_EQ(c.worst()->verdict, Verdict::differs);
  EXPECT_EQ(of(0.5, 0, 0).failed(), nullptr);
  EXPECT_EQ(of(0.5, 0, 0).worst()->channel.name, "X_N");
}

TEST(Comparison, SmallComponentsOfALargeVectorAreMarked) {
  std::vector<Channel> channels = {channel("R_x_N", "R"), channel("R_y_N", "R"),
                                   channel("R_z_N", "R")};
  const auto of = [&](double y) {
    const auto a = table("a", channels,
                         {[](double) { return 1000.0; }, [=](double t) { return y * wave(t, 1); },
                          [](double) { return 0.0; }});
    return compare_tables(a, a, {});
  };
  EXPECT_FALSE(of(1.1).channels[1].is_small_component());
  EXPECT_TRUE(of(0.9).channels[1].is_small_component());
  EXPECT_TRUE(of(1e-8).channels[1].is_small_component());
  EXPECT_FALSE(of(1e-10).channels[1].is_small_component());  // zero but for round-off
  for (const std::size_t large : {0, 2}) EXPECT_FALSE(of(0.9).channels[large].is_small_component());
}

// What is named by its column is no component of a vector: pairs of teeth that carry together.
TEST(Comparison, PeakOfPairsIsTheLargestOfThem) {
  std::vector<Channel> channels = {channel("plus_at_N", "tooth"), channel("plus_after_N", "tooth")};
  const auto three = [](double) { return 3.0; };
  const auto four = [](double) { return -4.0; };
  EXPECT_DOUBLE_EQ(table("a", channels, {three, four}).peak("tooth"), 5);  // of one vector
  for (Channel& c : channels) c.quantity = c.name;
  EXPECT_DOUBLE_EQ(table("a", channels, {three, four}).peak("tooth"), 4);
}

// One spike in a turn: 1.2 times what is allowed, and by its rms a sixth of it.
TEST(Verdict, IsAboutTheLargestDifferenceNotTheRms) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double t) { return 100 * wave(t, 1); }});
  auto b = a;
  b.values[50] -= 1.2e-3;
  Options options;
  options.tolerance = 1e-5;
  const Comparison c = compare_tables(a, b, options);
  EXPECT_NEAR(c.channels[0].largest, 1.2e-3, 1e-13);
  EXPECT_LT(c.channels[0].rms, c.channels[0].allowed / 6);
  EXPECT_DOUBLE_EQ(c.channels[0].theta_of_largest_deg, 250);
  EXPECT_EQ(c.channels[0].verdict, Verdict::differs);
  EXPECT_FALSE(c.agrees());
}

// Powers of two: peak 1024, tolerance 1/128 of it, differences without rounding.
TEST(Verdict, ToleranceItselfIsStillAgreement) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double) { return 1024.0; }});
  Options options;
  options.tolerance = 0x1p-7;
  const auto verdict = [&](double difference) {
    const auto b = table("b", channels, {[=](double) { return 1024.0 + difference; }});
    return compare_tables(a, b, options).channels[0].verdict;
  };
  const double more = std::nextafter(1024.0 + 8, 2000.0) - 1024.0;
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(verdict(sign * 8), Verdict::agrees);
    EXPECT_EQ(verdict(sign * more), Verdict::differs);
  }
}

TEST(Verdict, AbsoluteAllowanceOfTheUnitComesOnTop) {
  const std::vector<Channel> channels = {channel("X_N", "X"), channel("T_Nm", "T", "Nm")};
  const auto a = table("a", channels, {[](double) { return 1024.0; }, [](double) { return 64.0; }});
  const auto b = table("b", channels, {[](double) { return 1044.0; }, [](double) { return 66.0; }});
  Options options;
  options.tolerance = 0x1p-7;  // 8 N, half a Nm
  options.absolute = {{"N", 12.0}};
  Comparison c = compare_tables(a, b, options);
  EXPECT_DOUBLE_EQ(c.channels[0].allowed, 20);
  EXPECT_EQ(c.channels[0].verdict, Verdict::agrees);
  EXPECT_DOUBLE_EQ(c.channels[1].allowed, 0.5);
  EXPECT_EQ(c.channels[1].verdict, Verdict::differs);
  options.absolute = {{"N", 11.999}, {"Nm", 1.5}};
  c = compare_tables(a, b, options);
  EXPECT_EQ(c.channels[0].verdict, Verdict::differs);
  EXPECT_EQ(c.channels[1].verdict, Verdict::agrees);
}

// A component may be small beside its vector; another vector's size does not count, nor does the
// second table's.
TEST(Verdict, IsScaledByThePeakOfTheChannelsOwnVectorInTheFirstTable) {
  const std::vector<Channel> channels = {channel("X_x_N", "X"), channel("X_y_N", "X"),
                                         channel("Y_N", "Y")};
  const auto a = table("a", channels,
                       {[](double t) { return 300 * wave(t, 1); },
                        [](double t) { return 400 * wave(t, 1); }, [](double) { return 1e6; }});
  const auto b = table("b", channels,
                       {[](double t) { return 300 * wave(t, 1) + 4; },
                        [](double t) { return 400 * wave(t, 1); }, [](double) { return 2e6; }});
  Options options;
  options.tolerance = 0.009;
  const Comparison c = compare_tables(a, b, options);
  EXPECT_DOUBLE_EQ(c.channels[0].peak, 500);
  EXPECT_DOUBLE_EQ(c.channels[1].peak, 500);
  EXPECT_DOUBLE_EQ(c.channels[2].peak, 1e6);
  EXPECT_EQ(c.channels[0].verdict, Verdict::agrees);
  EXPECT_EQ(c.channels[2].verdict, Verdict::differs);
  EXPECT_DOUBLE_EQ(c.channels[2].largest_over_peak(), 1);
  EXPECT_EQ(c.worst(), &c.channels[2]);
}

TEST(Verdict, WithinABandOnlyTheDistanceFromItCounts) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto constant = [&](double value) {
    return table("t", channels, {[=](double) { return value; }});
  };
  const ResultTable middle = constant(1024), low = constant(1000), high = constant(1064);
  Options options;
  options.tolerance = 0x1p-7;
  options.band = Band{&low, &high};
  const auto compared = [&](double value) {
    return compare_tables(middle, constant(value), options).channels[0];
  };
  for (const double inside : {1000.0, 1024.0, 1064.0}) EXPECT_EQ(compared(inside).largest, 0);
  EXPECT_DOUBLE_EQ(compared(1072).mean_difference, 8);
  EXPECT_DOUBLE_EQ(compared(992).mean_difference, -8);
  EXPECT_EQ(compared(1072).verdict, Verdict::agrees);
  EXPECT_EQ(compared(992).verdict, Verdict::agrees);
  EXPECT_EQ(compared(1072.5).verdict, Verdict::differs);
  EXPECT_EQ(compared(991.5).verdict, Verdict::differs);
}

// A record that had to be resampled is uncertain by its own amount at each angle: only there.
TEST(Verdict, ABandWithoutAFiniteLimitHoldsNothing) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double) { return 100; }});
  auto low = table("low", channels, {[](double) { return 90; }});
  auto high = table("high", channels, {[](double) { return 110; }});
  Options options;
  options.tolerance = 1e-3;
  options.band = Band{&low, &high};
  EXPECT_TRUE(compare_tables(a, a, options).agrees());
  for (const double limit : {not_computed(), std::numeric_limits<double>::infinity()})
    for (ResultTable* side : {&low, &high}) {
      const double kept = std::exchange(side->values[5], limit);
      const Comparison c = compare_tables(a, a, options);
      side->values[5] = kept;
      EXPECT_FALSE(c.agrees());
      EXPECT_EQ(c.channels.at(0).verdict, Verdict::incomplete);
    }
}

// It is found by the channel's name: a table of some channels says nothing of the others.
TEST(Verdict, AnUncertaintyIsThatOfTheChannelOfItsName) {
  const std::vector<Channel> channels = {channel("X_N", "X"), channel("Y_N", "Y")};
  const auto constant = [](double value) { return [value](double) { return value; }; };
  const auto a = table("a", channels, {constant(100), constant(100)});
  const auto b = table("b", channels, {constant(103), constant(103)});
  const ResultTable of_y = table("u", {channel("Y_N", "Y")}, {constant(5)});
  Options options;
  options.tolerance = 1e-2;
  options.uncertainty = &of_y;
  const Comparison found = compare_tables(a, b, options);
  EXPECT_EQ(found.find("X_N")->verdict, Verdict::differs);
  EXPECT_EQ(found.find("Y_N")->verdict, Verdict::agrees);
}

TEST(Verdict, AnUncertaintyExcusesWhereItIsAndByItsSize) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto at_90 = [](double most, double elsewhere) {
    return [=](double t) { return t == 90 ? most : elsewhere; };
  };
  const auto a = table("a", channels, {[](double) { return 100; }});
  const auto b = table("b", channels, {at_90(103, 100.5)});
  Options options;
  options.tolerance = 1e-2;  // 1 N
  const auto judged = [&](double there, double elsewhere) {
    const ResultTable uncertainty = table("u", channels, {at_90(there, elsewhere)});
    options.uncertainty = &uncertainty;
    return compare_tables(a, b, options).channels.at(0);
  };
  EXPECT_EQ(judged(0, 0).verdict, Verdict::differs);
  EXPECT_EQ(judged(1.99, 0).verdict, Verdict::differs);
  EXPECT_EQ(judged(0, 5).verdict, Verdict::differs);
  const ChannelComparison excused = judged(2.01, 0);
  EXPECT_EQ(excused.verdict, Verdict::agrees);
  EXPECT_EQ(excused.largest, 3);
  EXPECT_EQ(excused.theta_of_largest_deg, 90);
  EXPECT_NEAR(excused.allowed, 3.01, 1e-12);
  // The row that is nearest to its own limit counts: an excuse far above a difference hides no
  // other.
  EXPECT_EQ(judged(2.9, 0.1).largest, 3);
  EXPECT_EQ(judged(20, 0.1).largest, 0.5);
}

TEST(Verdict, DigitsAreThoseOfTheLargestDifferenceOverThePeak) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double) { return 1e3; }});
  Options options;
  const auto digits = [&](double difference) {
    const auto b =
        table("b", channels, {[=](double t) { return 1e3 + (t == 90 ? difference : 0); }});
    return compare_tables(a, b, options).channels[0].digits;
  };
  EXPECT_NEAR(digits(1e-2), 5, 1e-9);
  EXPECT_NEAR(digits(-1e-5), 8, 1e-6);
  EXPECT_EQ(digits(0), 16);
  EXPECT_EQ(digits(1e7), 0);  // not below none
  options.most_digits = 6;    // what the poorer table has
  EXPECT_EQ(digits(1e-5), 6);
  EXPECT_EQ(digits(0), 6);
}

// A value that is missing in one table: nobody said that it may be.
TEST(Verdict, OneMissingSampleIsNoAgreement) {
  const std::vector<Channel> channels = {channel("X_N", "X"), channel("Y_N", "Y")};
  const auto a = table("a", channels, {[](double) { return 1.0; }, [](double) { return 2.0; }});
  auto gap = a;
  gap.name = "b";
  gap.values[2 * 3] = not_computed();  // X at 15 deg
  for (const auto& [first, second] :
       {std::pair<const ResultTable*, const ResultTable*>{&a, &gap}, {&gap, &a}}) {
    const Comparison c = compare_tables(*first, *second, {});
    EXPECT_EQ(c.channels[0].verdict, Verdict::incomplete);
    EXPECT_EQ(c.channels[0].gap, "no value of b at 15 deg");
    EXPECT_EQ(c.channels[1].verdict, Verdict::agrees);
    EXPECT_EQ(c.compared(), 1);
    EXPECT_EQ(c.incomplete(), &c.channels[0]);
    EXPECT_FALSE(c.agrees());
  }
  // Both lack it: the rest is compared, unless it should be there.
  EXPECT_TRUE(compare_tables(gap, gap, {}).agrees());
  Options strict;
  strict.may_be_missing = [](const Channel&, std::size_t) { return false; };
  EXPECT_EQ(compare_tables(gap, gap, strict).channels[0].verdict, Verdict::incomplete);
  auto shifted = a;
  shifted.theta_deg[5] += 1e-9;
  EXPECT_THROW(compare_tables(a, shifted, {}), InputError);
}

TEST(Verdict, WhatIsExpectedToBeMissingIsNotJudged) {
  const std::vector<Channel> channels = {channel("X_N", "X"), channel("Y_N", "Y")};
  const auto a = table("a", channels, {[](double) { return 1.0; }, [](double) { return 2.0; }});
  auto gap = a;
  gap.values[2 * 3] = not_computed();
  Options options;
  options.may_be_missing = [](const Channel& c, std::size_t row) {
    return c.name == "X_N" && row == 3;
  };
  const Comparison c = compare_tables(a, gap, options);
  EXPECT_EQ(c.channels[0].verdict, Verdict::not_computed);
  EXPECT_TRUE(c.agrees());
  gap.values[2 * 4] = not_computed();  // the next one is not expected
  EXPECT_EQ(compare_tables(a, gap, options).channels[0].verdict, Verdict::incomplete);
}

TEST(Verdict, AChannelThatOneTableLacksIsNoAgreement) {
  const std::vector<Channel> channels = {channel("X_N", "X"), channel("Y_N", "Y")};
  const auto both = table("a", channels, {[](double) { return 1.0; }, [](double) { return 2.0; }});
  const auto one = table("b", {channels[0]}, {[](double) { return 1.0; }});
  for (const auto& [first, second] : {std::pair{&both, &one}, std::pair{&one, &both}}) {
    const Comparison c = compare_tables(*first, *second, {});
    ASSERT_EQ(c.channels.size(), 2U);
    EXPECT_EQ(c.channels[0].verdict, Verdict::agrees);
    EXPECT_EQ(c.find("Y_N")->verdict, Verdict::incomplete);
    EXPECT_FALSE(c.agrees());
  }
  Options options;
  options.may_be_missing = [](const Channel& c, std::size_t) { return c.name == "Y_N"; };
  EXPECT_TRUE(compare_tables(both, one, options).agrees());
  const auto other = table("c", {channels[1]}, {[](double) { return 2.0; }});
  EXPECT_FALSE(compare_tables(one, other, {}).agrees());  // nothing was compared
}

TEST(Checks, AreJudgedTogetherOverThePistons) {
  const std::vector<Channel> channels = {channel("m_1_Nm", "m", "Nm", ChannelKind::check),
                                         channel("m_2_Nm", "m", "Nm", ChannelKind::check)};
  auto t = table("a", channels,
                 {[](double) { return 1e-9; }, [](double d) { return d == 90 ? -2e-6 : 0; }});
  for (auto& c : t.channels) c.meaning = "moment";
  const auto checks = judge_checks(t, {{"Nm", 100.0}}, 1e-9);
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_DOUBLE_EQ(checks[0].worst, 2e-6);
  EXPECT_DOUBLE_EQ(checks[0].theta_deg, 90);
  EXPECT_FALSE(checks[0].holds());
  EXPECT_TRUE(judge_checks(t, {{"Nm", 1e4}}, 1e-9)[0].holds());
}

TEST(Checks, TheFailedOneIsFurthestBeyondItsTolerance) {
  const std::vector<Check> checks = {{"a", "holds", "N", 9, 0, 10, 1},
                                     {"a", "beyond", "N", 3, 0, 1, 1},
                                     {"b", "further", "N", 1, 0, 1, 0.1}};
  ASSERT_NE(failed_check(checks), nullptr);
  EXPECT_EQ(failed_check(checks)->name, "further");
  EXPECT_EQ(failed_check({checks[0]}), nullptr);
  EXPECT_EQ(failed_check({}), nullptr);
}

// Two assumptions with an interaction: contributions must add up and share it evenly.
TEST(Split, AddsUpAndSharesInteractionsEvenly) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto model = [&](double p, double q, double extra) {
    return table("m", channels, {[=](double) { return 10 + p + q + 3 * p * q + extra; }});
  };
  const auto first = model(0, 0, 0);
  const auto second = model(1, 2, 1e-7);
  const auto variant = [&](unsigned mask) {
    return model((mask & 1U) != 0 ? 1 : 0, (mask & 2U) != 0 ? 2 : 0, 0);
  };
  const Split split = split_difference(first, second, {"p", "q"}, variant, {}, 1e-6);
  const ChannelSplit& x = split.channels.at(0);
  EXPECT_NEAR(x.contributions[0].mean, 1 + 3, 1e-13);
  EXPECT_NEAR(x.contributions[1].mean, 2 + 3, 1e-13);
  EXPECT_NEAR(x.rest, 1e-7, 1e-14);
  EXPECT_NEAR(x.largest_difference, 1 + 2 + 3 * 2 + 1e-7, 1e-13);
  EXPECT_TRUE(split.explained());
  EXPECT_FALSE(split_difference(first, second, {"p", "q"}, variant, {}, 1e-9).explained());
}

// What equal assumptions give is missing: then nothing explains the difference.
TEST(Split, IsNotExplainedByAVariantThatLacksTheValue) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto model = [&](double p) {
    return table("m", channels, {[=](double) { return 10 + p; }});
  };
  auto variant = model(1);
  variant.values[7] = not_computed();
  const Split split = split_difference(
      model(0), model(1), {"p"}, [&](unsigned) { return variant; }, {}, 1e-9);
  EXPECT_FALSE(split.explained());
}

TEST(Split, MarksOnlyExplainedChannels) {
  const std::vector<Channel> channels = {channel("X_N", "X"), channel("Y_N", "Y")};
  const auto model = [&](double p, double extra) {
    return table("m", channels,
                 {[=](double) { return 10 + p; }, [=](double) { return 5 + extra; }});
  };
  const auto second = model(1, 0.1);
  const Split split = split_difference(
      model(0, 0), second, {"p"}, [&](unsigned) { return model(1, 0); }, {}, 1e-9);
  Comparison c = compare_tables(model(0, 0), second, {});
  mark_explained(c, split);
  EXPECT_EQ(c.channels[0].verdict, Verdict::explained);
  EXPECT_EQ(c.channels[1].verdict, Verdict::differs);  // no assumption accounts for it
  EXPECT_NEAR(split.largest_rest(), 0.02, 1e-12);
}

// A channel that is zero all round has no peak that a rest could be a share of.
TEST(Split, RestOfAChannelThatIsZero) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto model = [&](double x) { return table("m", channels, {[=](double) { return x; }}); };
  const auto split = [&](double x) {
    return split_difference(
        model(0), model(x), {"p"}, [&](unsigned) { return model(0); }, {}, 1e-9);
  };
  EXPECT_EQ(split(0).largest_rest(), 0);
  EXPECT_TRUE(split(0).explained());
  EXPECT_FALSE(split(1e-3).explained());
}

TEST(Page, HoldsTheDataAndNeedsNoNetwork) {
  report::Document document;
  document.title = "<T>";
  document.meaning = "</script><b>x";
  const std::string page = report::render_page(document, {{0, 1}, {}, {}});
  EXPECT_THAT(page, HasSubstr("&lt;T&gt;"));
  EXPECT_EQ(page.find("</script><b>x"), std::string::npos);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_THAT(page, HasSubstr(R"("title":"\u003cT>")"));
}

// Curves with the rows that a page shows make the page of the curves with all of them, whose
// figures bring a curve of their own.
TEST(Page, IsThatOfAllRowsWhereItsCurvesHaveThoseThatItShows) {
  constexpr std::size_t kRows = 9000;
  const ChannelLayout layout(5);
  ResultTable first, budget;
  first.name = "analytic";
  first.channels = layout.channels();
  budget.channels = {first.channels.front(), first.channels.front()};
  budget.channels.back().name = "of_the_budget_Nm";
  for (std::size_t row = 0; row < kRows; ++row) {
    first.theta_deg.push_back(0.04 * static_cast<double>(row));
    for (std::size_t c = 0; c < first.columns(); ++c)
      first.values.push_back(std::sin(static_cast<double>(row + 31 * c)) +
                             (row == 100 * c + 7 ? 3 : 0));
    for (std::size_t c = 0; c < 2; ++c) budget.values.push_back(row == 4567 + c ? 9 : 1);
  }
  budget.theta_deg = first.theta_deg;
  ResultTable second = first;
  second.name = "multibody";
  for (double& value : second.values) value *= 1.5;
  const std::vector<report::TablePair> pairs = {{first, second}, {budget, budget}};
  const report::Curves all = report::curves_of(pairs, report::Rows::all);
  const report::Curves shown = report::curves_of(pairs, report::Rows::shown);
  EXPECT_EQ(all.theta_deg.size(), kRows);
  const std::string& twice = first.channels.front().name;
  for (const report::Curves& curves : {all, shown}) {
    const auto& columns = curves.tables.front().columns;
    EXPECT_EQ(std::count_if(columns.begin(), columns.end(),
                            [&](const auto& column) { return column.first == twice; }),
              1);
    EXPECT_EQ(report::find(columns, twice)->front(), first.values.front());
  }
  EXPECT_LT(shown.theta_deg.size(), 4500U);
  report::Document document;
  report::ChannelFigure figure{"N", {first.channels.front().name}};
  figure.extra.push_back({"beside", report::values_of(first, first.channels.front().name)});
  document.figures = {{"one", "One", "", figure}};
  const std::string page = report::render_page(document, shown);
  EXPECT_TRUE(page == report::render_page(document, all));
  EXPECT_NE(page.find("of_the_budget_Nm"), std::string::npos);
}

// A spike between two of the evenly spread samples stays, with its angle.
TEST(Page, ShowsSomeOfVeryManySamplesWithTheExtremes) {
  const auto page = [](std::size_t samples) {
    report::Curves curves;
    report::Values values;
    for (std::size_t row = 0; row < samples; ++row) {
      curves.theta_deg.push_back(static_cast<double>(row));
      values.push_back(row == 1234 ? 5 : 0);
    }
    curves.tables.push_back({"analytic", {{"Rs_1_x2_N", values}}});
    curves.axis = "time (ms)";
    curves.marks = {{77.5, true}};  // it need not lie on a sample
    return report::render_page({}, curves);
  };
  EXPECT_EQ(page(3600).find("\"samples\":"), std::string::npos);
  const std::string whole = page(4000), thinned = page(200000);
  EXPECT_THAT(thinned, HasSubstr("\"samples\":200000"));
  EXPECT_THAT(thinned, HasSubstr(",1234.0,"));
  for (const std::string& each : {whole, thinned}) {
    EXPECT_THAT(each, HasSubstr("\"axis\":\"time (ms)\""));
    EXPECT_THAT(each, HasSubstr("77.5"));
  }
  EXPECT_EQ(thinned.find(",1235.0,"), std::string::npos);
  EXPECT_LT(thinned.size(), whole.size() + 20000);
}

TEST(Json, IsOnePerLineForAReaderAndOneLineForThePage) {
  report::Document document;
  document.title = "Größe";
  EXPECT_THAT(report::json_text(document), HasSubstr("\n \"title\": \"Größe\""));
  EXPECT_THAT(report::compact_json(document), HasSubstr("\"title\":\"Größe\""));
  EXPECT_EQ(report::compact_json(document).find('\n'), std::string::npos);
  EXPECT_EQ(report::compact_json(report::Curves{{0, 1}, {}, {}}).find('\n'), std::string::npos);
}

// What an assumption explains of a channel, over the channel's peak; nothing of one that is zero.
TEST(Json, ContributionsAreOverThePeak) {
  report::Document document;
  document.assumptions.emplace();
  Split& split = document.assumptions->split;
  split.assumptions = {"friction"};
  split.tolerance = 1e-9;
  for (const double peak : {200.0, 0.0}) {
    ChannelSplit part;
    part.channel = channel("X_N", "X");
    part.computed = true;
    part.peak = peak;
    part.largest_difference = peak / 4;
    part.contributions = {{peak / 10, 0}};
    split.channels.push_back(part);
  }
  const auto json = nlohmann::json::parse(report::json_text(document));
  const std::string text = json["assumptions"].dump();
  EXPECT_THAT(text, HasSubstr("\"over_peak\":0.25"));
  EXPECT_THAT(text, HasSubstr("\"over_peak\":0.1"));
  EXPECT_EQ(text.find("null"), std::string::npos) << text;
}

TEST(Json, SaysOnlyWhatThereIsToSay) {
  report::Document document;
  document.verdict = report::Verdict{true, "h"};
  document.comparison.emplace();
  ChannelComparison c;
  c.channel = channel("X_N", "X");
  document.comparison->channels = {c};
  const auto written = [&] { return nlohmann::json::parse(report::json_text(document)); };
  EXPECT_FALSE(written()["verdict"].contains("word"));
  EXPECT_FALSE(written()["channels"][0].contains("gap"));
  document.verdict->word = "Balanced";
  document.comparison->channels[0].gap = "at 3 deg";
  EXPECT_EQ(written()["verdict"]["word"], "Balanced");
  EXPECT_EQ(written()["channels"][0]["gap"], "at 3 deg");
}

TEST(Json, AMapHasItsLinesWhereThereAreAny) {
  report::MapFigure map{{"n"}, {"p"}, {"e"}, {1, 2}, {3}, {{5, 6}}, {}, {}};
  const auto written = [&] {
    report::Document document;
    document.figures = {{"id", "t", "", map}};
    return nlohmann::json::parse(report::json_text(document))["figures"][0];
  };
  EXPECT_FALSE(written().contains("lines")) << written();
  map.lines = {{"edge", {1, 2}, {3, 3}}};
  ASSERT_TRUE(written().contains("lines")) << written();
  EXPECT_EQ(written()["lines"][0]["label"], "edge");
}

TEST(Json, ALimitIsViolatedByTheSmallestShare) {
  report::Document document;
  document.validity.emplace();
  for (const double share : {0.0, 0.01, 1.0})
    document.validity->push_back({"l", "N", "c", true, share});
  document.validity->push_back({"l", "N", "c", false, 1});
  const auto json = nlohmann::json::parse(report::json_text(document));
  std::vector<bool> violated;
  for (const auto& row : json["validity"]) violated.push_back(row["violated"]);
  EXPECT_EQ(violated, (std::vector<bool>{false, true, true, false}));
}

// Worst first, equals by name, what was not computed last.
TEST(Text, OrderOfTheGroups) {
  Comparison comparison;
  for (const auto& [name, largest] :
       std::map<std::string, double>{{"A", -1}, {"B", 1e-3}, {"C", 2}, {"D", 1e-3}, {"E", 0}}) {
    ChannelComparison c;
    c.channel = channel(name + "_N", name);
    c.judged = true;
    c.peak = 1;
    c.largest = largest;
    c.verdict = largest < 0 ? Verdict::not_computed : Verdict::agrees;
    comparison.channels.push_back(c);
  }
  const std::string text = report::text_table(comparison);
  std::vector<std::size_t> places;
  for (const char* name : {"\nC_N", "\nB_N", "\nD_N", "\nE_N", "\nA_N"})
    places.push_back(text.find(name));
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end())) << text;
  EXPECT_NE(places.back(), std::string::npos);
  const auto row = [&](const std::string& name) {
    const auto from = text.find("\n" + name) + 1;
    return text.substr(from, text.find('\n', from) - from);
  };
  EXPECT_THAT(row("C_N"), HasSubstr("agrees"));
  EXPECT_THAT(row("C_N"), HasSubstr(" 2.00e+00 "));
  EXPECT_THAT(row("A_N"), HasSubstr("not computed by both"));
  // A quantity that the pump does not have is no gap.
  for (auto& c : comparison.channels) c.channel.of_pump = c.channel.name != "A_N";
  EXPECT_THAT(report::text_table(comparison), Not(HasSubstr("A_N")));
  EXPECT_THAT(report::text_table(comparison), HasSubstr("B_N"));
}

TEST(Curves, DifferencesAreTakenBeforeRounding) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double) { return 11017.123456789; }});
  const auto b = table("b", channels, {[](double) { return 11017.123456789 + 1e-9; }});
  const auto curves = nlohmann::json::parse(report::compact_json(report::curves_of(a, b)));
  EXPECT_NEAR(curves["difference"]["X_N"][0].get<double>(), 1e-9, 3e-12);
  EXPECT_EQ(curves["tables"][0]["columns"]["X_N"][0], curves["tables"][1]["columns"]["X_N"][0]);
}

// What a page packs: the upper five bytes of each number, the lowest of them first.
TEST(Curves, PackedColumns) {
  const auto packed = [](const report::Values& values) {
    report::Curves curves{{0, 1}, {{"a", {{"X_N", values}}}}, {}};
    return nlohmann::json::parse(report::packed_json(curves))["tables"][0]["columns"]["X_N"];
  };
  EXPECT_EQ(packed({0, 0}), "AAAAAAAAAAAAAA==");
  // 1 is 3f f0 00 .., not computed 7f f8 00 ..; 2 less a bit that is not kept is 2, 40 00 00 ..
  EXPECT_EQ(packed({1, not_computed()}), "AAAA8D8AAAD4fw==");
  EXPECT_EQ(packed({2 - 1e-15, -2}), "AAAAAEAAAAAAwA==");
}

TEST(Curves, SecondTableIsTheFirstWithTheDifference) {
  const auto second = [](double difference) {
    report::Curves curves{
        {0, 1},
        {{"a", {{"X_N", {1, not_computed()}}}}, {"b", {{"X_N", {1.5, not_computed()}}}}},
        {{"X_N", {difference, not_computed()}}}};
    return nlohmann::json::parse(report::packed_json(curves))["tables"][1]["columns"]["X_N"];
  };
  EXPECT_EQ(second(0.5), true);
  EXPECT_TRUE(second(0.5001).is_string());
}

TEST(Difference, IsHeldToItsScale) {
  EXPECT_EQ(difference(2, 5, 12).value, 3);
  EXPECT_EQ(difference(2, 5, 12).share(), 0.25);
  EXPECT_TRUE(difference(5, 2, 12).within(0.25));
  EXPECT_FALSE(difference(5, 2, 12).within(0.2499));
  EXPECT_EQ(difference(2, 2, 0).share(), 0);
  EXPECT_EQ(difference(2, 2 + 1e-15, 0).share(), kOverNoScale);
  EXPECT_EQ(difference(1, 3, 4).share_text(), "5.0e-01");
}

TEST(Difference, IsUnknownWithoutTwoFiniteValuesAndAScale) {
  const double none = not_computed(), much = HUGE_VAL;
  const auto is = [](const Difference& d, Comparable why, const std::string& text) {
    EXPECT_EQ(d.comparable, why) << text;
    EXPECT_FALSE(d.known());
    EXPECT_FALSE(is_computed(d.share()));
    EXPECT_FALSE(d.within(HUGE_VAL)) << text;
    EXPECT_EQ(d.why_unknown(), text);
    EXPECT_EQ(d.share_text(), "an unknown share (" + text + ")");
  };
  is({}, Comparable::nothing, "nothing was compared");
  is(difference(none, 1, 1), Comparable::first_missing, "the first result has no value");
  is(difference(1, none, 1), Comparable::second_missing, "the second result has no value");
  is(difference(none, none, 1), Comparable::both_missing, "neither result has a value");
  for (const auto& [x, y, scale] :
       {std::tuple{much, 1.0, 1.0}, std::tuple{1.0, -much, 1.0}, std::tuple{much, much, 1.0},
        std::tuple{1.0, 1.0, much}, std::tuple{1.0, 1.0, none}})
    is(difference(x, y, scale), Comparable::not_finite, "a value or its scale is not finite");
  EXPECT_STREQ(difference(1, 1, 1).why_unknown(), "");
}

TEST(Difference, TheLargestOfASeriesIsOneThatIsUnknown) {
  Difference largest;
  EXPECT_FALSE(largest.keep_larger({}));
  EXPECT_TRUE(largest.keep_larger(difference(1, 1, 1)));  // 0, of something that was compared
  EXPECT_TRUE(largest.known());
  EXPECT_FALSE(largest.keep_larger(difference(2, 2, 1)));
  EXPECT_TRUE(largest.keep_larger(difference(1, 2, 1)));
  EXPECT_FALSE(largest.keep_larger(difference(1, 3, 4)));  // larger by itself, not by its scale
  EXPECT_TRUE(largest.keep_larger(difference(1, not_computed(), 1)));
  EXPECT_FALSE(largest.keep_larger(difference(not_computed(), 1, 1)));
  EXPECT_FALSE(largest.keep_larger(difference(1, 2, 0)));
  EXPECT_EQ(largest.comparable, Comparable::second_missing);
  EXPECT_FALSE(largest.keep_larger({}));
}

// An infinite value in both tables makes the scale infinite too: everything would be within it.
TEST(Compare, AnInfiniteValueIsNoAgreement) {
  const auto table = [](double value) {
    ResultTable t;
    t.theta_deg = {0, 10};
    Channel channel;
    channel.name = "X_N";
    channel.group = "X";
    channel.unit = "N";
    t.channels = {channel};
    t.values = {1, value};
    return t;
  };
  EXPECT_TRUE(compare_tables(table(2), table(2), {}).agrees());
  for (const double wrong : {HUGE_VAL, -HUGE_VAL})
    for (const auto& [x, y] :
         {std::pair{wrong, 2.0}, std::pair{2.0, wrong}, std::pair{wrong, wrong}}) {
      const Comparison c = compare_tables(table(x), table(y), {});
      EXPECT_FALSE(c.agrees());
      ASSERT_NE(c.incomplete(), nullptr);
      EXPECT_THAT(c.incomplete()->gap, HasSubstr("no finite value"));
      EXPECT_FALSE(is_computed(c.incomplete()->largest_over_peak()));
    }
}

}  // namespace
}  // namespace bentaxis::test
