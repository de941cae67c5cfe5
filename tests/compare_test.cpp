// The comparison: made-up tables with known answers; no model is run here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/compare/split.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/report/page.h"
#include "bentaxis/report/report.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using namespace compare;
using testing::HasSubstr;

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

TEST(Comparison, WhatOneTableLacksIsNotComputedAndNotAgreeing) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double) { return 1.0; }});
  auto gap = a;
  gap.values[3] = not_computed();
  EXPECT_EQ(compare_tables(a, gap, {}).channels[0].verdict, Verdict::not_computed);
  auto other = a;
  other.channels[0].name = "Y_N";
  const Comparison none = compare_tables(a, other, {});
  EXPECT_EQ(none.channels[0].verdict, Verdict::not_computed);
  EXPECT_FALSE(none.agrees());  // nothing was compared
  EXPECT_EQ(compare_tables(gap, gap, {}).channels[0].verdict, Verdict::agrees);
  auto shifted = a;
  shifted.theta_deg[5] += 1e-9;
  EXPECT_THROW(compare_tables(a, shifted, {}), InputError);
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
  EXPECT_TRUE(split.explained());
  EXPECT_FALSE(split_difference(first, second, {"p", "q"}, variant, {}, 1e-9).explained());
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

TEST(Page, HoldsTheDataAndNeedsNoNetwork) {
  const report::Json report = {{"title", "</script><b>x"}};
  const std::string page = report::render_page("<T>", report, {{"theta_deg", {0, 1}}});
  EXPECT_THAT(page, HasSubstr("&lt;T&gt;"));
  EXPECT_EQ(page.find("</script><b>x"), std::string::npos);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
}

TEST(Curves, DifferencesAreTakenBeforeRounding) {
  const std::vector<Channel> channels = {channel("X_N", "X")};
  const auto a = table("a", channels, {[](double) { return 11017.123456789; }});
  const auto b = table("b", channels, {[](double) { return 11017.123456789 + 1e-9; }});
  const report::Json curves = report::curve_section(a, b);
  EXPECT_NEAR(curves["difference"]["X_N"][0].get<double>(), 1e-9, 3e-12);
  EXPECT_EQ(curves["tables"][0]["columns"]["X_N"][0], curves["tables"][1]["columns"]["X_N"][0]);
}

}  // namespace
}  // namespace bentaxis::test
