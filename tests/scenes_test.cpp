// Scenes of the multibody model and its evaluation without multipliers: the same numbers as the
// full pump, and right answers or a clear refusal where a piston has no inertia.
#include <gtest/gtest.h>

#include <cstdio>
#include <tuple>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using multibody::Method;
using multibody::Scene;

// Condition number of the constraint equations times round-off, of peak: 2e-13 measured, 1e-11
// required.
constexpr double kSameNumbers = 1e-12;

// Largest difference from a full table over each group's peak in what the other computed; and how
// many channels that was.
std::pair<double, int> difference_where_computed(const ResultTable& full, const ResultTable& other,
                                                 double bore_radius) {
  double worst = 0;
  int computed = 0;
  for (std::size_t c = 0; c < full.columns(); ++c) {
    if (full.channels[c].kind == ChannelKind::check || !is_computed(other.at(0, c))) continue;
    ++computed;
    // A piston's torque on the block is a difference of products of Rc with the bore radius: at
    // zero tilt little of them is left.
    double peak = full.peak(full.channels[c].group);
    if (full.channels[c].quantity == "Tc") peak = std::max(peak, full.peak("Rc") * bore_radius);
    for (std::size_t row = 0; row < full.rows(); ++row)
      worst = std::max(worst, std::abs(full.at(row, c) - other.at(row, c)) / (peak > 0 ? peak : 1));
  }
  return {worst, computed};
}

class Scenes : public testing::TestWithParam<std::tuple<std::string, std::string, std::string>> {};

TEST_P(Scenes, GiveTheNumbersOfTheAnalyticModel) {
  const auto& [name, scene_name, method_name] = GetParam();
  const auto index = [](const std::vector<std::string>& names, const std::string& word) {
    return std::find(names.begin(), names.end(), word) - names.begin();
  };
  const auto scene = static_cast<Scene>(index(multibody::scene_names(), scene_name));
  const auto method = static_cast<Method>(index(multibody::method_names(), method_name));
  const Case the_case = reference_case(name);
  const Samples samples = one_turn(the_case);
  const ResultTable a = analytic::run(the_case, the_case.multibody, samples);
  const ResultTable m =
      multibody::run_driven(the_case, the_case.multibody, samples, {}, scene, method);
  const auto [worst, computed] =
      difference_where_computed(a, m, the_case.pump.geometry.bore_circle_radius);
  EXPECT_LE(worst, scaled(kSameNumbers));
  // Rs, Rc, p, zB, Rs in S3 and Tc of each piston; in the full scene everything.
  const int n = the_case.pump.geometry.pistons;
  if (scene == Scene::full)
    EXPECT_GE(computed, 11 * n + 12);
  else
    EXPECT_EQ(computed, 11 * n);
  for (std::size_t c = 0; c < m.columns(); ++c) {
    if (m.channels[c].kind != ChannelKind::check || !is_computed(m.at(0, c))) continue;
    const double scale = m.peak("Rs") * the_case.pump.geometry.joint_circle_radius;
    for (std::size_t row = 0; row < m.rows(); ++row)
      ASSERT_NEAR(m.at(row, c), 0, scaled(1e-12) * scale) << m.channels[c].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Scenes,
                         testing::Combine(testing::ValuesIn(reference_cases()),
                                          testing::Values("full", "pistons", "piston"),
                                          testing::Values("multipliers", "residual")),
                         [](const auto& test) {
                           return std::get<0>(test.param) + "_" + std::get<1>(test.param) + "_" +
                                  std::get<2>(test.param);
                         });

TEST(Scene, AgreesOnRandomPumpsAndChangingSpeed) {
  RandomPump random(31);
  for (int n = 0; n < 60; ++n) {
    const PumpParameters pump = random.pump();
    Assumptions assumptions = random.assumptions(pump);
    if (n % 4 == 3) assumptions.gear = BlockDrive::imposed;
    const Instant instant = random.instant(pump, n % 2 == 0);
    const analytic::Model a(pump, assumptions);
    std::vector<double> va(a.layout().size());
    a.evaluate(instant, va);
    for (const Scene scene : {Scene::full, Scene::pistons, Scene::piston}) {
      for (const Method method : {Method::multipliers, Method::residual}) {
        multibody::Model m(pump, assumptions, instant.shaft.speed, scene, method);
        std::vector<double> vm(a.layout().size(), not_computed());
        m.evaluate(instant, vm);
        double largest = 0;
        for (std::size_t c = 0; c < a.layout().reactions(); ++c)
          if (is_computed(va[c])) largest = std::max(largest, std::abs(va[c]));
        for (std::size_t c = 0; c < a.layout().reactions(); ++c)
          if (is_computed(vm[c])) {
            ASSERT_NEAR(va[c], vm[c], scaled(1e-11) * largest)
                << a.layout().channels()[c].name << ", pump " << n;
          }
      }
    }
  }
}

TEST(Scene, OnePistonStandsForAllOrIsEvaluatedOneByOne) {
  Case the_case = reference_case("bap63_rated");
  const auto pistons_fact = [&](int samples_per_turn) {
    the_case.operation.samples_per_revolution = samples_per_turn;
    const Samples samples = one_turn(the_case);
    const ResultTable table =
        multibody::run_driven(the_case, the_case.multibody, samples, {}, Scene::piston);
    const ResultTable a = analytic::run(the_case, the_case.multibody, samples);
    EXPECT_LE(difference_where_computed(a, table, the_case.pump.geometry.bore_circle_radius).first,
              scaled(kSameNumbers));
    return table.provenance.facts.back().second;
  };
  EXPECT_EQ(pistons_fact(60), "one piston represents all");
  EXPECT_EQ(pistons_fact(61), "evaluated one by one");
  // A piston of its own pressure must not be stood for.
  the_case.operation.samples_per_revolution = 60;
  Samples samples = one_turn(the_case);
  samples.chamber_pressure[7] += 1e5;
  const ResultTable table =
      multibody::run_driven(the_case, the_case.multibody, samples, {}, Scene::piston);
  EXPECT_LE(difference_where_computed(analytic::run(the_case, the_case.multibody, samples), table,
                                      the_case.pump.geometry.bore_circle_radius)
                .first,
            scaled(kSameNumbers));
}

TEST(Scene, BuildsAndSolvesOnlyWhatItNeeds) {
  const Case the_case = reference_case("bap63_rated");
  const auto size = [&](Scene scene) {
    return multibody::scene_size(the_case.pump, the_case.multibody, scene);
  };
  EXPECT_EQ(size(Scene::full).bodies, 7);
  EXPECT_EQ(size(Scene::full).equations, 14);  // 2 bearing, 1 gear, 1 drive, 2 per piston
  EXPECT_EQ(size(Scene::pistons).bodies, 7);
  EXPECT_EQ(size(Scene::pistons).equations, 10);
  EXPECT_EQ(size(Scene::piston).bodies, 3);
  EXPECT_EQ(size(Scene::piston).equations, 2);
}

// Any jump of the angle, forth and back, and interleaved pressures: nothing is carried over.
TEST(Scene, DoesNotDependOnWhatWasEvaluatedBefore) {
  const Case the_case = reference_case("seven_real_spinning");
  const analytic::Model a(the_case.pump, the_case.multibody);
  for (const Scene scene : {Scene::full, Scene::pistons, Scene::piston}) {
    multibody::Model m(the_case.pump, the_case.multibody, 1, scene, Method::residual);
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> step(-0.3, 0.3);
    Instant i;
    i.chamber_pressure.assign(7, 1e7);
    double angle = 0;
    for (int n = 0; n < 300; ++n) {
      angle += n % 20 == 0 ? 10 * step(engine) : step(engine) * std::pow(10.0, -(n % 7));
      i.turn(angle, 150);
      std::vector<double> va(a.layout().size());
      std::vector<double> vm(a.layout().size(), not_computed());
      a.evaluate(i, va);
      m.evaluate(i, vm);
      for (int k = 0; k < 7; ++k)
        for (int axis = 0; axis < 2; ++axis)
          ASSERT_NEAR(va[a.layout().Rc(k, axis)], vm[a.layout().Rc(k, axis)], scaled(1e-9)) << n;
    }
  }
}

// ---- pistons without inertia -----------------------------------------------------------------

enum class Kind { no_mass, all_mass_at_joint, all_mass_at_ring, rod_without_transverse_inertia };

Case limit_case(Kind kind) {
  Case the_case = reference_case("bap63_rated");
  PistonMass& piston = the_case.pump.piston;
  switch (kind) {
    case Kind::no_mass:
      piston.mass = 0;
      break;
    case Kind::all_mass_at_joint:
      piston.joint_mass_fraction = 1;
      break;
    case Kind::all_mass_at_ring:
      piston.joint_mass_fraction = 0;
      break;
    case Kind::rod_without_transverse_inertia:
      piston.real = PistonMass::Real{0.019, 0, 0, 0};
      the_case.analytic.inertia = the_case.multibody.inertia = PistonInertia::real;
      break;
  }
  return the_case;
}

class PistonLimits : public testing::TestWithParam<Kind> {};

TEST_P(PistonLimits, GiveTheRightAnswerOrAClearRefusal) {
  const Case the_case = limit_case(GetParam());
  const Samples samples = one_turn(the_case);
  const bool singular = GetParam() == Kind::no_mass || GetParam() == Kind::all_mass_at_joint;
  const ResultTable a = analytic::run(the_case, the_case.analytic, samples);
  for (const Scene scene : {Scene::full, Scene::pistons, Scene::piston}) {
    const ResultTable m =
        multibody::run_driven(the_case, the_case.multibody, samples, {}, scene, Method::residual);
    EXPECT_LE(difference_where_computed(a, m, the_case.pump.geometry.bore_circle_radius).first,
              scaled(kSameNumbers));
    if (singular) {
      EXPECT_THROW(multibody::run_driven(the_case, the_case.multibody, samples, {}, scene),
                   ComputationError);
    } else {
      const ResultTable f = multibody::run_driven(the_case, the_case.multibody, samples, {}, scene);
      EXPECT_LE(difference_where_computed(a, f, the_case.pump.geometry.bore_circle_radius).first,
                scaled(kSameNumbers));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, PistonLimits,
                         testing::Values(Kind::no_mass, Kind::all_mass_at_joint,
                                         Kind::all_mass_at_ring,
                                         Kind::rod_without_transverse_inertia));

// ---- three point masses ------------------------------------------------------------------------

// Three point masses at A, centre of mass and B are the real piston without spin, in both models.
TEST(DynamicallyEquivalent, IsTheRealPistonWithoutSpin) {
  Case the_case = reference_case("noload_2350_real");
  the_case.pump.piston.real->spin = 0;
  const Samples samples = one_turn(the_case);
  Assumptions real = the_case.analytic;
  real.inertia = PistonInertia::real;
  Assumptions masses = real;
  masses.inertia = PistonInertia::dynamically_equivalent;
  const ResultTable a = analytic::run(the_case, real, samples);
  EXPECT_LE(worst_difference(a, analytic::run(the_case, masses, samples), true).over_peak,
            scaled(1e-14));
  EXPECT_LE(worst_difference(a, multibody::run_driven(the_case, masses, samples), true).over_peak,
            scaled(5e-12));
  // Control: another transverse inertia shows.
  the_case.pump.piston.real->transverse_inertia *= 1 + 1e-6;
  EXPECT_GT(worst_difference(a, analytic::run(the_case, masses, samples), true).over_peak, 1e-9);
}

TEST(DynamicallyEquivalent, NeedsTheCentreOfMassBetweenTheEnds) {
  Case the_case = reference_case("noload_2350_real");
  Assumptions masses = the_case.analytic;
  masses.inertia = PistonInertia::dynamically_equivalent;
  for (const double centre : {0.0, -0.001, 0.046, 0.05}) {
    the_case.pump.piston.real->centre_of_mass = centre;
    EXPECT_THROW(analytic::Model(the_case.pump, masses), InputError);
    EXPECT_THROW(multibody::Model(the_case.pump, masses, 1), InputError);
  }
  the_case.pump.piston.real->transverse_inertia = the_case.pump.piston.real->axial_inertia = 0;
  EXPECT_NO_THROW(analytic::Model(the_case.pump, masses));
  EXPECT_NO_THROW(multibody::Model(the_case.pump, masses, 1));
}

// ---- counts -----------------------------------------------------------------------------------

// What an angle costs, as counts that no busy machine changes: positions once, because Simbody
// finds nothing left to do, velocities once, accelerations once or not at all.
TEST(Counts, RealizationsPerAngle) {
  Case the_case = reference_case("bap63_rated");
  the_case.operation.samples_per_revolution = 720;
  for (const Method method : {Method::multipliers, Method::residual})
    for (const Scene scene : {Scene::full, Scene::pistons, Scene::piston}) {
      const ResultTable table = multibody::run_driven(the_case, the_case.multibody,
                                                      one_turn(the_case), {}, scene, method);
      std::string found;
      for (const auto& [name, value] : table.provenance.facts)
        if (name == "realizations per angle") found = value;
      double positions = 0;
      double velocities = 0;
      double accelerations = 0;
      ASSERT_EQ(std::sscanf(found.c_str(), "positions %lf, velocities %lf, accelerations %lf",
                            &positions, &velocities, &accelerations),
                3)
          << found;
      EXPECT_LE(positions, 1.1);
      EXPECT_LE(velocities, 1.1);
      EXPECT_LE(accelerations, method == Method::multipliers ? 1.0 : 0.0);
    }
}

}  // namespace
}  // namespace bentaxis::test
