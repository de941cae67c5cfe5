// Derivatives of outputs: exact ones against differences of the same outputs and of Simbody, what
// differences say of their own error, and closed forms.
#include "bentaxis/designs/sensitivity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/sensitivity_document.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::designs {
namespace {

Case rated() {
  Case base = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml");
  base.operation.samples_per_revolution = 60;
  return base;
}

std::vector<Output> outputs_of(const Case& base, const std::vector<std::string>& names) {
  std::vector<Output> outputs;
  for (const std::string& name : names) outputs.push_back(output(name, base));
  return outputs;
}

std::vector<Variable> variables_of(const Case& base, const std::vector<std::string>& names) {
  std::vector<Variable> variables;
  for (const std::string& name : names) variables.emplace_back(name, base);
  return variables;
}

// Central differences of the outputs over kStep of a parameter: truncation of its square and
// round-off of 1e-15 / kStep, of an output's scale per relative change. So short that no other
// sample becomes the largest.
constexpr double kStep = 1e-6;
constexpr double kDifferences = 5e-9;

TEST(Sensitivity, ExactDerivativesAreDifferencesOfTheOutputs) {
  for (const bool another : {false, true}) {
    Case base = rated();
    base.pressure.transition_deg = 30;
    if (another) {  // with everything that can be
      base = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml",
                       {"piston.inertia=real", "gear.flanks=two", "operation.speed_rpm=-1200",
                        "piston.spin_rpm=300", "friction.regularization_m_per_s=0.5",
                        "pressure.transition_deg=40", "pressure.delivery_start_deg=179.7"});
      base.operation.samples_per_revolution = 44;  // not whole per chamber
    }
    const auto variables = continuous_variables(base);
    const auto outputs =
        outputs_of(base, {"mean:Td", "max:Rb1_y1", "min:Rb1_y1", "peak:Rb1", "rms:Rb2", "range:Td",
                          "mean:Rc_2", "peak:Th", "rms:Rcs", "peak:Rs_3_x2", "max:Fh"});
    const Sensitivities found = sensitivities(base, variables, outputs);
    const Evaluator evaluator(Family(base, variables), outputs);
    std::size_t exact = 0;
    for (std::size_t v = 0; v < variables.size(); ++v) {
      const double size = found.at[v] == 0 ? 1 : std::abs(found.at[v]);
      const NumberRange range = variables[v].range(base);
      if (found.derivatives[0][v].way != Way::exact) continue;
      if (found.at[v] - kStep * size < range.low || found.at[v] + kStep * size > range.high)
        continue;
      ++exact;
      const auto difference = [&](std::size_t o, double step) {
        auto at = found.at;
        at[v] = found.at[v] + step;
        const double above = at[v], high = evaluator.evaluate(at).values[o];
        at[v] = found.at[v] - step;
        return (high - evaluator.evaluate(at).values[o]) / (above - at[v]);
      };
      for (std::size_t o = 0; o < outputs.size(); ++o) {
        EXPECT_NEAR(found.derivatives[o][v].value * size, difference(o, kStep * size) * size,
                    kDifferences * found.scales[o])
            << outputs[o].name << " by " << variables[v].name();
      }
    }
    EXPECT_GE(exact, 30U);
  }
}

// A term whose factor is 0 must not be left out with its derivative: at 0 it is nearly that next to
// 0, whatever the parameter.
TEST(Sensitivity, FromZeroIsThatNextToZero) {
  const std::string file = std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml";
  std::set<std::string> compared;
  for (const char* inertia : {"lumped", "real", "dynamically_equivalent"})
    for (const char* width : {"0", "0.1"}) {
      const auto with = [&](const std::string& name, const std::string& value) {
        Case base = read_case(
            file, {std::string("piston.inertia=") + inertia, "piston.axial_inertia_kg_mm2=0",
                   std::string("friction.regularization_m_per_s=") + width,
                   "pressure.transition_deg=30", name + "=" + value});
        base.operation.samples_per_revolution = 20;
        return base;
      };
      const auto slopes = [&](const std::string& name, const std::string& value) {
        const Case base = with(name, value);
        return sensitivities(base, variables_of(base, {name}),
                             outputs_of(base, {"mean:Td", "peak:Rb1", "peak:Rs_1", "peak:Rc_1",
                                               "peak:Fh", "mean:Rcs"}));
      };
      for (const Variable& variable : continuous_variables(with("operation.speed_rpm", "1500"))) {
        const std::string& name = variable.name();
        // At a tilt or a speed of 0 dry friction changes its sign: a kink, no left-out term.
        if (name == "pump.tilt_deg" || name == "operation.speed_rpm") continue;
        if (name.ends_with(".1") || name.ends_with(".2")) continue;
        std::optional<Sensitivities> at, next;
        try {
          at = slopes(name, "0");
          next = slopes(name, "1e-9");
        } catch (const InputError&) {
          continue;  // may not be 0
        }
        if (at->derivatives[0][0].way != Way::exact || next->derivatives[0][0].way != Way::exact)
          continue;
        compared.insert(name + " " + inertia + " " + width);
        for (std::size_t o = 0; o < at->derivatives.size(); ++o) {
          const Derivative &zero = at->derivatives[o][0], &beside = next->derivatives[o][0];
          EXPECT_NEAR(zero.value, beside.value,
                      1e-5 * std::abs(beside.value) + zero.error + 1e-9 * at->scales[o])
              << name << ", " << inertia << ", output " << o;
        }
      }
    }
  for (const char* name :
       {"friction.piston_coulomb_N lumped 0", "friction.piston_coulomb_N lumped 0.1",
        "friction.piston_viscous_N_s_per_m real 0",
        "piston.transverse_inertia_kg_mm2 dynamically_equivalent 0"})
    EXPECT_EQ(compared.count(name), 1U) << name;
}

// Where a force is nowhere, its size grows on both sides of what is varied: nothing is exact.
TEST(Sensitivity, OfTheSizeOfNothingIsNotSure) {
  const Case base = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml",
                              {"pump.tilt_deg=0", "pump.bore_circle_radius_mm=24.92",
                               "pump.axis_offset_mm=0", "piston.mass_kg=0"});
  const Sensitivities found =
      sensitivities(base, variables_of(base, {"piston.mass_kg"}),
                    outputs_of(base, {"peak:Rc_1", "mean:Rc_1", "rms:Rc_1", "max:Rc_1_y2_N"}));
  for (const auto& of_output : found.derivatives) {
    EXPECT_GT(of_output[0].error, 100) << found.outputs[0].name;  // N/kg
    EXPECT_LT(std::abs(of_output[0].value), of_output[0].error);
  }
}

// Without inertia, friction and weight the mean torque is displacement x pressure / 2 pi, and with
// a step of pressure at both dead centres it is linear in the pressures.
TEST(Sensitivity, OfTheMeanTorqueByThePressureIsTheDisplacement) {
  Case base = rated();
  base.operation.samples_per_revolution = 720;
  base.pressure.transition_deg = 0;
  const Sensitivities found = sensitivities(base, variables_of(base, {"pressure.delivery_bar"}),
                                            outputs_of(base, {"mean:Td", "displacement_cm3"}));
  const double expected = found.values[1] * 1e-6 * 1e5 / (2 * M_PI);
  const double factor = base.pump.friction.shaft_torque_factor;
  // Trapezoidal sum over samples of a piecewise smooth torque: (2 pi / 720)^2 and the edges.
  EXPECT_NEAR(found.derivatives[0][0].value * factor / expected, 1, 2e-3);
  EXPECT_EQ(found.derivatives[0][0].way, Way::exact);
  EXPECT_EQ(found.derivatives[1][0].way, Way::differences);
  EXPECT_EQ(found.derivatives[1][0].value, 0);
}

// The displacement is N A stroke: twice itself over the diameter.
TEST(Sensitivity, DifferencesKnowTheirError) {
  const Case base = rated();
  const Sensitivities found =
      sensitivities(base, variables_of(base, {"pump.bore_diameter_mm", "pump.tilt_deg"}),
                    outputs_of(base, {"displacement_cm3", "mean:budget.Td_pressure"}));
  const Derivative& d = found.derivatives[0][0];
  EXPECT_EQ(d.way, Way::differences);
  const double exact = 2 * found.values[0] / found.at[0];
  EXPECT_LE(std::abs(d.value - exact), d.error + 1e-12 * exact);
  EXPECT_LE(d.error, 1e-9 * exact);
  EXPECT_NEAR(found.elasticity(0, 0), 2, 1e-9);
  for (const auto& row : found.derivatives)
    for (const Derivative& each : row) EXPECT_LE(each.error, 1e-7 * std::abs(each.value));
}

// The share of a transition lies in the derivative of the pressure with respect to it.
TEST(Sensitivity, AStepOfPressureIsNotDifferentiatedByItsPlace) {
  Case base = rated();
  base.pressure.transition_deg = 0;
  const Sensitivities found = sensitivities(
      base, variables_of(base, {"pressure.delivery_start_deg"}), outputs_of(base, {"mean:Td"}));
  EXPECT_EQ(found.derivatives[0][0].way, Way::differences);
}

TEST(Sensitivity, AgreesWithDifferencesOfSimbody) {
  Case base = rated();
  base.operation.samples_per_revolution = 20;
  const Sensitivities found = sensitivities(
      base,
      variables_of(base, {"pump.tilt_deg", "pump.axis_offset_mm", "pump.bore_circle_radius_mm",
                          "piston.mass_kg", "bearings.tapered_z_mm", "operation.speed_rpm",
                          "pressure.delivery_bar", "pressure.transition_deg",
                          "friction.shaft_torque_factor", "port_plate.inner_land_mm.2"}),
      outputs_of(base, {"mean:Td", "peak:Rb1", "max:Rb2_x1", "peak:Rs", "rms:Rc", "min:Fh"}));
  const SensitivityCheck compared = check(found);
  EXPECT_EQ(compared.missing, 0U);
  EXPECT_TRUE(compared.agrees()) << found.outputs[compared.output].name << " by "
                                 << found.variables[compared.variable].name() << ": "
                                 << compared.worst;
  EXPECT_EQ(compared.compared, 60U);
  // A value that one model alone lacks is no agreement; where it refuses neighbours nothing is
  // said.
  for (const double lost : {not_computed(), HUGE_VAL}) {
    Sensitivities other = compared.other;
    other.derivatives[1][0] = {lost};
    EXPECT_FALSE(compare_derivatives(found, other).agrees());
    EXPECT_FALSE(compare_derivatives(other, compared.other).agrees());
    EXPECT_EQ(compare_derivatives(found, other).lacking, 1U);
    other.derivatives[1][0].reason = "is at a bound of its range";
    EXPECT_TRUE(compare_derivatives(found, other).agrees());
    EXPECT_EQ(compare_derivatives(found, other).missing, 1U);
    for (auto& row : other.derivatives)
      for (Derivative& derivative : row) derivative = {lost, 0, Way::differences, "refused"};
    EXPECT_FALSE(compare_derivatives(found, other).agrees());  // nothing was compared
  }
  // A derivative that is off by 1e-5 of itself is noticed.
  Sensitivities wrong = found;
  wrong.derivatives[1][0].value *= 1 + 1e-5;
  EXPECT_FALSE(check(wrong).agrees());
}

// Under hydraulic pressure: differences of whole searches, of a step and of twice the step. Curves
// of an error of 1e-9 of their peak, over the step, are what is left; reactions follow the
// pressure.
constexpr double kStepOfSearch = 1e-4;
constexpr double kDifferencesOfSearch = 1.5 * 1e-9 / kStepOfSearch;

TEST(Sensitivity, UnderHydraulicPressureIsThatOfThePeriodicState) {
  for (const bool load_given : {false, true}) {
    std::vector<std::string> changes = {"hydraulics.tolerance=1e-12", "hydraulics.curve_error=1e-9",
                                        "operation.samples_per_revolution=60"};
    std::vector<std::string> names = {"hydraulics.bulk_modulus_MPa", "hydraulics.dead_volume_cm3",
                                      "operation.speed_rpm"};
    if (load_given) {  // the delivery pressure, on the lands too, follows
      changes.insert(changes.end(),
                     {"load.kind=laminar", "load.conductance_l_per_min_per_bar=0.33"});
      names.emplace_back("load.conductance_l_per_min_per_bar");
    } else {  // on the pump alone, on its pressure alone, on both
      for (const char* name :
           {"port_plate.delivery_arc_deg.1", "port_plate.inner_land_mm.2", "pump.piston_length_mm",
            "pump.tilt_deg", "pump.bore_diameter_mm", "pressure.delivery_bar", "piston.mass_kg"})
        names.emplace_back(name);
    }
    const Case base =
        read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated_hydraulic.toml", changes);
    const auto variables = variables_of(base, names);
    const auto outputs = outputs_of(
        base,
        {"mean:Td", "peak:Rb1", "max:Rb2_x1", "rms:Rc", "mean:Rs", "min:Fh", "efficiency.overall",
         "efficiency.mechanical_mass", "efficiency.overall_iso", "hydraulics.flow_l_per_min",
         "hydraulics.leakage_l_per_min", "hydraulics.work_J", "hydraulics.delivery_mean_bar"});
    const Sensitivities found = sensitivities(base, variables, outputs);
    const Evaluator evaluator(Family(base, variables), outputs);
    for (std::size_t v = 0; v < variables.size(); ++v) {
      const auto at_share = [&](double share) {
        auto at = found.at;
        at[v] *= 1 + share;
        return evaluator.evaluate(at).values;
      };
      const auto up = at_share(kStepOfSearch), down = at_share(-kStepOfSearch);
      const auto far_up = at_share(2 * kStepOfSearch), far_down = at_share(-2 * kStepOfSearch);
      for (std::size_t o = 0; o < outputs.size(); ++o) {
        const Derivative& d = found.derivatives[o][v];
        EXPECT_EQ(d.way, Way::forward);
        EXPECT_NEAR(d.value * found.at[v],
                    (8 * (up[o] - down[o]) - (far_up[o] - far_down[o])) / (12 * kStepOfSearch),
                    kDifferencesOfSearch * found.scales[o])
            << outputs[o].name << " by " << variables[v].name();
        EXPECT_LE(d.error * found.at[v], 1e-6 * found.scales[o])
            << outputs[o].name << " by " << variables[v].name();
      }
    }
  }
}

TEST(Sensitivity, UnderHydraulicPressureSaysWhereDifferencesAreTaken) {
  Case base = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated_hydraulic.toml",
                        {"operation.samples_per_revolution=60"});
  const auto ways = [&] {
    const Sensitivities found = sensitivities(
        base, variables_of(base, {"hydraulics.bulk_modulus_MPa"}),
        outputs_of(base, {"mean:Td", "efficiency.volumetric", "hydraulics.chamber_greatest_bar"}));
    return std::vector<Way>{found.derivatives[0][0].way, found.derivatives[1][0].way,
                            found.derivatives[2][0].way};
  };
  EXPECT_THAT(ways(), testing::ElementsAre(Way::forward, Way::forward, Way::differences));
  base.pressure.points = 72;  // a spline
  EXPECT_THAT(ways(), testing::ElementsAre(Way::differences, Way::differences, Way::differences));
  // On the bound of its range: of the pump alone.
  base.pressure.points = 0;
  base.pump.friction.shaft_torque_factor = 1;
  const Sensitivities found = sensitivities(
      base, variables_of(base, {"friction.shaft_torque_factor"}), outputs_of(base, {"mean:Td"}));
  EXPECT_EQ(found.derivatives[0][0].way, Way::forward);
  EXPECT_NEAR(found.derivatives[0][0].value, -found.values[0], 1e-12 * found.values[0]);
  EXPECT_EQ(to_string(Way::forward), "forward sensitivities (CVODES)");
}

// The oil's arc is that of the port plate where the case does not give it: a row of the port plate
// moves both, whatever else is asked for beside it.
TEST(Sensitivity, OfAParameterThatAnotherOneFollowsIsThatOfBoth) {
  const Case base =
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated_hydraulic.toml",
                {"operation.samples_per_revolution=60"});
  const auto outputs = outputs_of(base, {"hydraulics.chamber_greatest_bar"});
  const auto derivative = [&](const std::vector<std::string>& names) {
    const Derivative d = sensitivities(base, variables_of(base, names), outputs).derivatives[0][0];
    EXPECT_EQ(d.way, Way::differences);
    return d.value;
  };
  const double alone = derivative({"port_plate.delivery_arc_deg.1"});
  EXPECT_GT(std::abs(alone), 0.1);  // bar per degree
  EXPECT_EQ(derivative({"port_plate.delivery_arc_deg.1", "hydraulics.delivery_arc_deg.1"}), alone);
}

TEST(Sensitivity, SaysWhatItCannotDo) {
  const Case base = rated();
  const auto refusal = [&](const std::string& name) -> std::string {
    try {
      sensitivities(base, variables_of(base, {name}), outputs_of(base, {"mean:Td"}));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("pump.pistons"), testing::HasSubstr("not a continuous number"));
  EXPECT_THAT(refusal("assumptions.analytic.gear"), testing::HasSubstr("not a continuous number"));
  // On the bound of its range there are no two sides.
  Case bound = base;
  bound.pump.friction.shaft_torque_factor = 1;
  const Sensitivities found =
      sensitivities(bound, variables_of(bound, {"friction.shaft_torque_factor"}),
                    outputs_of(bound, {"efficiency.mechanical", "mean:Td"}));
  EXPECT_THAT(found.derivatives[0][0].reason, testing::HasSubstr("bound"));
  EXPECT_FALSE(is_computed(found.derivatives[0][0].value));
  const std::string csv = sensitivity_csv(found, {});
  EXPECT_THAT(csv, testing::HasSubstr(",error,reason\n"));
  EXPECT_THAT(csv, testing::HasSubstr(found.derivatives[0][0].reason + "\nmean:Td,"));
  EXPECT_EQ(csv.substr(csv.size() - 2), ",\n");  // there is a derivative
  EXPECT_NEAR(found.derivatives[1][0].value, -found.values[1], 1e-12 * found.values[1]);
}

TEST(Sensitivity, TablesHaveEveryDerivative) {
  const Case base = rated();
  const auto variables = variables_of(base, {"pump.tilt_deg", "piston.mass_kg"});
  const auto outputs = outputs_of(base, {"mean:Td", "stroke_mm"});
  const Sensitivities found = sensitivities(base, variables, outputs);
  const std::string csv = sensitivity_csv(found, {});
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_THAT(csv, testing::HasSubstr("mean:Td,Nm,"));
  const report::Document document = sensitivity_document(found, {}, {}, {});
  ASSERT_EQ(document.figures->size(), 2U);
  const auto& bars = std::get<report::BarsFigure>(document.figures->front().content).bars;
  ASSERT_EQ(bars.size(), 1U);  // a piston's mass takes no mean torque
  EXPECT_EQ(document.runs->at(1).text, "No influence: piston.mass_kg.");
  EXPECT_THAT(sensitivity_text(found, {}),
              testing::ContainsRegex("piston.mass_kg +0.09 +0 +-  exact"));
  EXPECT_EQ(document.runs->at(1).table.rows.size(), 1U);
  EXPECT_EQ(bars[0].label, "pump.tilt_deg");
  EXPECT_NEAR(bars[0].high, found.derivatives[0][0].value * 0.4, 1e-12 * bars[0].high);
}

}  // namespace
}  // namespace bentaxis::designs
