// Variables, families, outputs and their evaluation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bentaxis/designs/design_validity.h"
#include "bentaxis/designs/evaluator.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/run.h"
#include "bentaxis/study/turn_summary.h"
#include "support.h"

namespace bentaxis::designs {
namespace {

using test::refusal;

const std::string kRated = std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml";

TEST(Variable, IsAParameterByItsName) {
  const Case base = read_case(kRated);
  const Variable tilt("pump.tilt_deg", base);
  EXPECT_EQ(tilt.value(base), 40);
  EXPECT_EQ(tilt.unit(), "deg");
  EXPECT_FALSE(tilt.discrete());
  EXPECT_EQ(Variable("pump.pistons", base).value(base), 5);
  EXPECT_TRUE(Variable("pump.pistons", base).discrete());
  const Variable inertia("assumptions.analytic.inertia", base);
  EXPECT_EQ(inertia.text(1), "real");
  EXPECT_EQ(inertia.value_of("lumped"), 0);
  EXPECT_THAT(refusal([&] { Variable("pump.tilt", base); }), testing::HasSubstr("pump.tilt_deg"));
  EXPECT_THAT(refusal([&] { Variable("name", base); }), testing::HasSubstr("cannot vary"));
  EXPECT_THAT(refusal([&] { Variable("gear.backlash_um", base); }),
              testing::HasSubstr("has no effect"));
  // Where the bore force acts does something in every case, but this one leaves it to its default.
  EXPECT_THAT(refusal([&] { Variable("piston.contact_mm", base); }),
              testing::HasSubstr("is not in this case: give it a value"));
  const Case with_ring = read_case(kRated, {"piston.contact_mm=44"});
  EXPECT_EQ(Variable("piston.contact_mm", with_ring).value(with_ring), 44);
  EXPECT_THAT(refusal([&] { Variable("port_plate.delivery_arc_deg", base); }),
              testing::HasSubstr("delivery_arc_deg.1"));
}

// A family's member is the case that --set makes, with what follows from it.
TEST(Family, IsWhatSetMakes) {
  const Case base = read_case(kRated);
  const Family family(base, {Variable("pump.tilt_deg", base), Variable("piston.mass_kg", base),
                             Variable("port_plate.delivery_arc_deg.2", base)});
  Case made = base;
  const double values[] = {35, 0.101, family.variables()[2].value(base) - 1};
  family.make(values, made);
  EXPECT_EQ(made.pump.geometry.tilt, read_case(kRated, {"pump.tilt_deg=35"}).pump.geometry.tilt);
  EXPECT_EQ(made.pump.piston.mass, read_case(kRated, {"piston.mass_kg=0.101"}).pump.piston.mass);
  EXPECT_EQ(made.pump.port_plate->delivery.to_deg, values[2]);
  const double impossible[] = {95, 0.101, values[2]};
  EXPECT_THAT(refusal([&] { family.make(impossible, made); }), testing::HasSubstr("tilt_deg = 95"));
}

TEST(Output, IsFoundByItsName) {
  const Case base = read_case(kRated);
  EXPECT_EQ(output("max:Rb1_z1", base).name, "max:Rb1_z1_N");
  EXPECT_EQ(output("min:Rs_z2", base).name, "min:Rs_1_z2_N");
  EXPECT_EQ(output("peak:Rb1", base).columns.size(), 3U);
  EXPECT_EQ(output("mean:budget.Td_inertia", base).unit, "Nm");
  EXPECT_THAT(refusal([&] { output("most:Td", base); }), testing::HasSubstr("no statistic"));
  EXPECT_THAT(refusal([&] { output("max:Rb3", base); }), testing::HasSubstr("did you mean"));
  // What is suggested is a name that is taken, of the statistic that was asked for.
  for (const auto& [name, meant] : {std::pair{"mean:Rb", "mean:Rb1"},
                                    {"peak:Td_Nm", "peak:Td_z1_Nm"},
                                    {"Td", "mean:Td"},
                                    {"rms:Rb2_x", "rms:Rb2"}}) {
    EXPECT_THAT(refusal([&] { output(name, base); }),
                testing::HasSubstr("did you mean \"" + std::string(meant) + "\"?"));
    EXPECT_NO_THROW(output(meant, base));
  }
  for (const std::string& name : output_names(base)) EXPECT_EQ(output(name, base).name, name);
}

// As every other command says it: where any limit is violated, not one alone.
TEST(DesignValidity, IsTheShareInWhichAnyLimitIsViolated) {
  const Case still = read_case(kRated, {"operation.speed_rpm=0", "block.bottom_area_mm2=140",
                                        "operation.samples_per_revolution=72"});
  const DesignValidity found = validity_of(still);
  const study::PreparedCase ready = study::prepare(still);
  const auto limits = study::limits_of_turn(
      ready.the_case, ready.assumptions(study::Model::analytic), ready.pressure);
  EXPECT_EQ(found.text(), "not valid " + study::not_valid_text(limits));
  double largest = 0;
  for (const auto& limit : limits) largest = std::max(largest, limit.violated_share);
  EXPECT_GT(found.share, largest + 0.1);
  EXPECT_TRUE(validity_of(read_case(kRated)).valid());
}

// Against numbers of the tables that the outputs are of.
TEST(Evaluator, GivesNumbersOfTheTurn) {
  const Case base = read_case(kRated);
  const Evaluator evaluator(
      Family(base, {Variable("pump.tilt_deg", base)}),
      {output("mean:Td", base), output("peak:Rb1", base), output("displacement_cm3", base),
       output("validity.film", base), output("efficiency.mechanical", base),
       output("mean:budget.Td_pressure", base)});
  const double values[] = {40};
  const Evaluation found = evaluator.evaluate(values);
  ASSERT_TRUE(found.feasible()) << found.reason;
  const study::PreparedCase ready = study::prepare(base);
  const ResultTable table = study::run_turn(ready, study::Model::analytic);
  const ChannelLayout at(5);
  double torque = 0, peak = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    torque += table.at(row, at.Td()) / static_cast<double>(table.rows());
    peak = std::max(peak, std::hypot(table.at(row, at.Rb1(0)), table.at(row, at.Rb1(1)),
                                     table.at(row, at.Rb1(2))));
  }
  EXPECT_NEAR(found.values[0], torque, 1e-12 * torque);
  EXPECT_NEAR(found.values[1], peak, 1e-12 * peak);
  const double difference = base.pressure.ports.delivery - base.pressure.ports.suction;
  EXPECT_NEAR(found.values[4], 100 * found.values[2] * 1e-6 * difference / (2 * M_PI * torque),
              1e-9);
  double film = -HUGE_VAL;  // Fh along z2 must not be positive
  for (std::size_t row = 0; row < table.rows(); ++row)
    film = std::max(film, table.at(row, at.Fh()));
  EXPECT_EQ(found.values[3], film);

  const double impossible[] = {95};
  const Evaluation refused = evaluator.evaluate(impossible);
  EXPECT_THAT(refused.reason, testing::HasSubstr("tilt_deg"));
  EXPECT_FALSE(is_computed(refused.values[0]));
}

// Statistics by the kernel against those of tables, for designs that differ in everything the
// kernel keeps from one to the next. Of the largest reaction: sums of some hundred numbers that are
// right to 1e-14.
constexpr double kKernelTolerance = 1e-12;

void expect_kernel_equals_tables(const Case& base, const std::vector<std::string>& names,
                                 const std::vector<std::vector<double>>& designs) {
  std::vector<Output> outputs;
  const ChannelLayout layout(base.pump.geometry.pistons);
  for (std::size_t c = 0; c < layout.reactions(); ++c)
    for (int s = 0; s < kStatistics; ++s)
      outputs.push_back(
          output(to_string(static_cast<Statistic>(s)) + ":" + layout.channels()[c].name, base));
  for (const char* vector : {"peak:Rs_2", "mean:Rb1", "min:Rb2", "rms:Th", "peak:Rc"})
    outputs.push_back(output(vector, base));
  outputs.push_back(output("stroke_mm", base));
  std::vector<Variable> variables;
  for (const std::string& name : names) variables.emplace_back(name, base);
  const Evaluator kernel(Family(base, variables), outputs);
  ASSERT_TRUE(kernel.fast());
  outputs.push_back(output("efficiency.mechanical", base));  // the kernel cannot
  const Evaluator tables(Family(base, variables), outputs);
  ASSERT_FALSE(tables.fast());
  std::vector<double> all;
  for (const auto& design : designs) all.insert(all.end(), design.begin(), design.end());
  std::vector<double> together(designs.size() * (outputs.size() - 1));
  std::vector<std::string> reasons(designs.size());
  kernel.evaluate(designs.size(), all, together, reasons);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const Evaluation expected = tables.evaluate(designs[i]);
    ASSERT_EQ(reasons[i], expected.reason);
    double scale = 0;
    for (const double v : expected.values)
      if (is_computed(v)) scale = std::max(scale, std::abs(v));
    const Evaluation alone = kernel.evaluate(designs[i]);
    for (std::size_t o = 0; o + 1 < outputs.size(); ++o) {
      const double found = together[i * (outputs.size() - 1) + o];
      ASSERT_EQ(is_computed(found), is_computed(expected.values[o])) << outputs[o].name;
      if (!is_computed(found)) continue;
      ASSERT_NEAR(found, expected.values[o], kKernelTolerance * scale)
          << outputs[o].name << " of design " << i;
      ASSERT_EQ(found, alone.values[o]) << outputs[o].name;
    }
  }
}

TEST(Evaluator, GivesTheSameByTheKernel) {
  Case base = read_case(kRated);
  base.operation.samples_per_revolution = 60;
  expect_kernel_equals_tables(base,
                              {"pump.tilt_deg", "pressure.delivery_bar", "operation.speed_rpm",
                               "operation.samples_per_revolution", "pressure.transition_deg",
                               "assumptions.analytic.gear", "pressure.suction_bar"},
                              {{40, 275, 1500, 60, 20, 0, 0},
                               {35, 275, 1500, 60, 20, 0, 0},
                               {35, 100, 1500, 60, 20, 0, 0},  // the ports' pressure alone
                               {95, 100, 1500, 60, 20, 0, 0},  // refused
                               {35, 100, -900, 60, 20, 0, 3},
                               {35, 100, -900, 61, 20, 0, 3},  // chambers at places of their own
                               {35, 100, -900, 61, 0, 0, 3},
                               {35, 100, -900, 60, 0, 0, 3},
                               {0, 100, 900, 1, 10, 1, 3},  // no tooth force
                               {40, 275, 1500, 720, 20, 0, 0}});
}

TEST(Evaluator, GivesTheSameByTheKernelUnderACurve) {
  Case base = read_case(kRated);
  base.pressure.kind = PressureKind::curve;
  base.pressure.curve = {{0, 90, 170, 200, 260, 350}, {1e5, 3e5, 9e6, 2.7e7, 2.5e7, 4e6}};
  expect_kernel_equals_tables(base, {"pump.axis_offset_mm", "operation.samples_per_revolution"},
                              {{0.1, 100}, {-0.5, 100}, {-0.5, 7}, {0.1, 100}});
}

// Columns of a table move with the number of pistons.
TEST(Evaluator, FindsChannelsOfAnotherNumberOfPistons) {
  const Case base = read_case(kRated);
  const std::vector<Output> outputs = {output("mean:Td", base), output("max:Rs_5_z2", base),
                                       output("peak:Rb1", base)};
  const Evaluator evaluator(Family(base, {Variable("pump.pistons", base)}), outputs);
  const double three[] = {3};
  const Evaluation found = evaluator.evaluate(three);
  ASSERT_TRUE(found.feasible()) << found.reason;
  const Case other = read_case(kRated, {"pump.pistons=3"});
  const std::vector<Output> of_other = {output("mean:Td", other), output("peak:Rb1", other)};
  const auto expected = outputs_of(of_other, study::prepare(other), study::Model::analytic);
  EXPECT_EQ(found.values[0], expected[0]);
  EXPECT_EQ(found.values[2], expected[1]);
  EXPECT_FALSE(is_computed(found.values[1]));
}

}  // namespace
}  // namespace bentaxis::designs
