// How far Simbody's multipliers are trusted: no NaN passes for exact, and where they differ from
// inverse dynamics the right one of the two is blamed.
#include "reactions/solver_guard.h"

#include <SimTKsimbody.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "placement/placement.h"
#include "reactions/inverse_dynamics.h"

namespace bentaxis::multibody {
namespace {

using testing::HasSubstr;

Case case_of(const std::string& name) {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / name /
                   "case.toml");
}

// A pump placed at an angle under its full pressure, solved by both ways.
struct Solved {
  explicit Solved(const Case& the_case, double pressure = 2e7)
      : pump(the_case.pump, the_case.multibody, 1, Drive::given_acceleration),
        placement(pump),
        inverse(pump, placement) {
    pump.inputs().chamber_pressure = [pressure](double, double, std::vector<double>& p) {
      p.assign(p.size(), pressure);
    };
    placement.place({0.3, 150, 0}, {0.3, 150, 0});
    pump.system().realize(pump.dynamics(), SimTK::Stage::Acceleration);
    reactions_from_multipliers(pump, pump.dynamics(), multipliers);
    inverse.solve(residual);
  }

  double difference() const { return force_difference(pump, multipliers, residual); }
  double estimated() const { return estimated_force_error(pump, pump.dynamics()); }
  // What the guard says; empty where it lets the state pass.
  std::string refusal() const {
    try {
      require_agreement(
          difference(), [this] { return estimated(); }, 0.3);
    } catch (const ComputationError& error) {
      return error.what();
    }
    return "";
  }

  PumpSystem pump;
  Placement placement;
  InverseDynamics inverse;
  Reactions multipliers, residual;
};

TEST(SolverGuard, SoundPumpsPassAndAreEstimatedSo) {
  const Solved solved(case_of("high_precision/bap63_rated"));
  EXPECT_LT(solved.estimated(), 1e-12);
  EXPECT_LT(solved.difference(), 1e-12);
  EXPECT_EQ(solved.refusal(), "");
}

// The guess that a placement starts from is right to round-off: here the solver has work to do.
TEST(PistonSolver, FindsThePlacesAgainFromNearby) {
  Solved solved(case_of("high_precision/bap63_rated"));
  PistonSolver solver = solved.placement.piston_solver();
  SimTK::State& state = solved.pump.dynamics();
  std::vector<SimTK::Vec3> axes;
  const auto axis_of = [&](const SimTK::MobilizedBody& piston) {
    return SimTK::Vec3(piston.getBodyRotation(state).z());
  };
  for (const auto& piston : solved.pump.bodies().pistons) axes.push_back(axis_of(piston));
  for (const auto& piston : solved.pump.bodies().pistons) {
    const int q = piston.getFirstQIndex(state);
    state.updQ()[q + 1] += 0.01;
    state.updQ()[q + 2] -= 0.02;
    SimTK::Vec4 quaternion(&state.updQ()[q]);
    quaternion /= quaternion.norm();
    for (int i = 0; i < 4; ++i) state.updQ()[q + i] = quaternion[i];
  }
  EXPECT_LE(solver.solve_positions(state), kAssemblyTolerance);
  for (std::size_t k = 0; k < axes.size(); ++k)
    EXPECT_LT((axis_of(solved.pump.bodies().pistons[k]) - axes[k]).norm(), 1e-10) << k;
}

// A load that is no number makes every multiplier one: that scored 0.
TEST(SolverGuard, MultipliersThatAreNoNumbersAreRefused) {
  const Solved solved(case_of("high_precision/bap63_rated"), SimTK::NaN);
  ASSERT_TRUE(std::isnan(solved.pump.dynamics().getMultipliers()[0]));
  EXPECT_TRUE(std::isnan(solved.estimated()));
  EXPECT_TRUE(std::isnan(solved.difference()));
  EXPECT_THAT(solved.refusal(), HasSubstr("Simbody's constraint solver returns reactions that are "
                                          "not finite"));
  try {
    require_accurate_forces(solved.estimated(), 0.3);
    FAIL() << "not refused";
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("not finite at theta = 17.18"));
  }
}

// One force among many, on either side.
TEST(SolverGuard, OneForceThatIsNoNumberShowsInTheDifference) {
  for (const bool of_multipliers : {true, false}) {
    Solved solved(case_of("high_precision/bap63_rated"));
    (of_multipliers ? solved.multipliers : solved.residual).pistons[2].bore[1] = SimTK::NaN;
    EXPECT_TRUE(std::isnan(solved.difference()));
    EXPECT_NE(solved.refusal(), "");
  }
}

// Simbody drops directions of its matrix for pistons of next to no mass: its own accelerations say
// so.
TEST(SolverGuard, SimbodyIsBlamedForWhatItsAccelerationsViolate) {
  // At 1e-9 kg what is lost is about what is allowed, more or less by round-off.
  Case light = case_of("hard/mass_1e-9");
  light.pump.piston.mass = 1e-10;
  for (const auto& [name, the_case] :
       {std::pair("1e-12 kg", case_of("hard/mass_1e-12")), std::pair("1e-10 kg", light),
        std::pair("1 um", case_of("hard/bearings_1_um"))}) {
    const Solved solved(the_case);
    EXPECT_GT(solved.difference(), kLargestForceError) << name;
    EXPECT_EQ(fault_of(solved.difference(), solved.estimated()), Fault::multipliers) << name;
    EXPECT_THAT(solved.refusal(), HasSubstr("Simbody's constraint solver is inaccurate"));
    EXPECT_THAT(solved.refusal(), HasSubstr("difference from inverse dynamics "));
    EXPECT_THAT(solved.refusal(), HasSubstr("estimated error of the multipliers "));
  }
}

// The control: an error put into our inverse dynamics must not be blamed on Simbody.
TEST(SolverGuard, InverseDynamicsIsBlamedForItsOwnError) {
  Solved solved(case_of("high_precision/bap63_rated"));
  solved.residual.pistons[1].joint *= 1 + 1e-6;
  EXPECT_EQ(fault_of(solved.difference(), solved.estimated()), Fault::inverse_dynamics);
  EXPECT_THAT(solved.refusal(), HasSubstr("the error is in inverse dynamics"));
  EXPECT_THAT(solved.refusal(), HasSubstr("estimated error of the multipliers "));
  EXPECT_THAT(solved.refusal(), testing::Not(HasSubstr("is inaccurate")));
}

TEST(SolverGuard, NeitherIsBlamedWhereTheEstimateExplainsAPart) {
  EXPECT_EQ(fault_of(1e-3, 2e-4), Fault::multipliers);
  EXPECT_EQ(fault_of(1e-3, 1e-6), Fault::undecided);
  EXPECT_EQ(fault_of(1e-3, 1e-9), Fault::inverse_dynamics);
  EXPECT_EQ(fault_of(1e-3, SimTK::NaN), Fault::multipliers);
  try {
    require_agreement(
        1e-3, [] { return 1e-6; }, 0);
    FAIL() << "not refused";
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("neither is known to be right"));
  }
}

// A torque an imposed block is moved with is a reaction like the others.
TEST(SolverGuard, TheTorqueOfAnImposedBlockCounts) {
  Case the_case = case_of("high_precision/bap63_rated");
  the_case.multibody.gear = BlockDrive::imposed;
  Solved solved(the_case);
  EXPECT_LT(solved.difference(), 1e-12);
  solved.multipliers.imposed += 1;  // Nm
  EXPECT_GT(solved.difference(), 1e-6);
}

}  // namespace
}  // namespace bentaxis::multibody
