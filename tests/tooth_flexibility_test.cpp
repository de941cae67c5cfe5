// How much a slice of a tooth gives way: the law against a tooth cut by brute force, against beams
// solved by hand, and its properties.
#include "bentaxis/pump/tooth_flexibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::test {
namespace {

using testing::HasSubstr;

/// Spur teeth (pitch cone 0) or bevel ones, heights in modules.
Gear gear(int teeth, double module, double pressure_angle_deg, double addendum = 1,
          double dedendum = 1.25) {
  Gear to;
  to.pitch_diameter = module * teeth;
  to.pressure_angle = radians(pressure_angle_deg);
  to.contact = ToothContact::teeth;
  to.teeth.emplace();
  to.teeth->count = teeth;
  to.teeth->addendum = addendum * module;
  to.teeth->dedendum = dedendum * module;
  to.teeth->youngs_modulus = 206e9;
  to.teeth->poisson_ratio = 0.3;
  to.teeth->rim_ratio = 3;
  return to;
}

/// Half the thickness at y that a rack with rounded corners leaves: the rack is pushed past the
/// rolling gear in many small steps, and what it ever covers is gone. Knows no involute.
double half_thickness_by_cutting(const Gear& of, double corner_radius, double y) {
  const ToothData& data = *of.teeth;
  const double r = of.pitch_diameter / 2, module = of.pitch_diameter / data.count;
  const double a = of.pressure_angle;
  const double corner_depth = data.dedendum - corner_radius;
  const double straight = data.dedendum - corner_radius * (1 - std::sin(a));
  const double corner_offset =
      kPi * module / 4 + straight * std::tan(a) + corner_radius * std::cos(a);
  // Signed depth of a point of the gear in the rack's tooth beside the gear's tooth.
  const auto covered = [&](double x, double roll) {
    // Turn the gear so that what was at angle `roll` faces the rack; the rack has gone r roll.
    const double side = x * std::cos(roll) - y * std::sin(roll) + r * roll;
    const double depth = r - (x * std::sin(roll) + y * std::cos(roll));  // below the pitch line
    const double flank = (side - kPi * module / 4 - depth * std::tan(a)) * std::cos(a);
    if (depth > data.dedendum) return -1.0;
    if (depth < straight) return flank;
    const double corner = corner_radius - std::hypot(side - corner_offset, depth - corner_depth);
    return side > corner_offset ? data.dedendum - depth : corner;
  };
  const auto gone = [&](double x) {
    for (int i = -1000; i <= 1000; ++i)
      if (covered(x, i * 0.8 / 1000) > 0) return true;
    return false;
  };
  double in = 0, out = 3 * module;
  for (int i = 0; i < 30; ++i) (gone((in + out) / 2) ? out : in) = (in + out) / 2;
  return out;
}

TEST(ToothFlexibility, IsThatOfAToothCutByBruteForce) {
  for (const Gear& of : {gear(30, 2e-3, 20), gear(40, 3e-3, 25), gear(60, 1e-3, 17.5)}) {
    const ToothFlexibility law(of, 0.0);
    const auto& profile = law.profile();
    const double module = of.pitch_diameter / of.teeth->count;
    for (const double height : {-0.6 * module, 0.0, 0.9 * module}) {
      // Where the load is, from the gear's outline: half the thickness at that radius by steps.
      const double radius = of.pitch_diameter / 2 + height;
      double y = radius;
      for (int i = 0; i < 30; ++i)
        y = std::sqrt(radius * radius -
                      std::pow(half_thickness_by_cutting(of, profile.corner_radius, y), 2));
      const double x = half_thickness_by_cutting(of, profile.corner_radius, y);
      // The load is tangent to the base circle: its lever about the gear's centre is its radius.
      const double beta = std::acos(profile.base_radius / radius) - std::atan2(x, y);
      const int slices = 200;
      const double bottom = profile.root_radius * std::cos(profile.root_angle);
      double bending = 0, area = 0;
      for (int i = 0; i < slices; ++i) {
        const double at = bottom + (y - bottom) * (i + 0.5) / slices;
        const double half = half_thickness_by_cutting(of, profile.corner_radius, at);
        const double lever = std::cos(beta) * (y - at) - std::sin(beta) * x;
        bending += lever * lever / (2.0 / 3 * half * half * half) * (y - bottom) / slices;
        area += 1 / (2 * half) * (y - bottom) / slices;
      }
      const auto parts = law.parts(height);
      const double e = of.teeth->youngs_modulus;
      // By the number of slices and of steps of the rack.
      EXPECT_NEAR(parts.bending * e / bending, 1, 2e-3) << height / module;
      EXPECT_NEAR(parts.shear * e / (1.2 * std::pow(std::cos(beta), 2) * 2.6 * area), 1, 2e-3);
      EXPECT_NEAR(parts.compression * e / (std::pow(std::sin(beta), 2) * area), 1, 2e-3);
    }
  }
}

// Teeth of an endless gear are trapezoids: a wedge has closed forms. Only the part above the
// rack's corner is one, so two heights are taken, whose difference below is a polynomial's.
TEST(ToothFlexibility, OfAnEndlessGearIsThatOfAWedge) {
  const double module = 1e-3, slope = std::tan(radians(20));
  const Gear of = gear(4'000'000, module, 20);
  const ToothFlexibility law(of, 0.0);
  // Integral of 1 / (2 x) over the straight part between two heights: a logarithm.
  const auto x = [&](double height) { return kPi * module / 4 - height * slope; };
  const double low = -0.9 * module, high = 0.95 * module;
  const double expected = std::log(x(low) / x(high)) / (2 * slope) *
                          std::pow(std::sin(radians(20)), 2) / of.teeth->youngs_modulus;
  EXPECT_NEAR((law.parts(high).compression - law.parts(low).compression) / expected, 1, 1e-5);
  // The corner of the standard rack, whose flank ends one module deep.
  EXPECT_NEAR(law.profile().corner_radius, 0.25 * module / (1 - std::sin(radians(20))), 1e-12);
  // A load whose line passes through the root's middle bends it least: cos beta (y_l - y) is the
  // height over the root, sin beta x_l the shift.
  const double h = 0.5 * module;
  double bending = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {  // down to the flank's end
    const double at = -module + (h + module) * (i + 0.5) / n;
    const double lever = std::cos(radians(20)) * (h - at) - std::sin(radians(20)) * x(h);
    bending += lever * lever / (2.0 / 3 * std::pow(x(at), 3)) * (h + module) / n;
  }
  // The corner below holds less than a third of it, and gives more.
  const double whole = law.parts(h).bending * of.teeth->youngs_modulus;
  EXPECT_GT(whole, bending);
  EXPECT_LT(whole, 1.5 * bending);
}

TEST(ToothFlexibility, FoundationByHand) {
  // Z = 62, m = 2 mm, 20 deg, rim ratio 3.4: factors and distances worked out on paper with the
  // table of Sainsot, Velex and Duverger (2004); they print 6.82 < L < 6.94, 1.08 < M < 3.29,
  // 2.56 < P < 13.47, 0.141 < Q < 0.62.
  Gear of = gear(62, 2e-3, 20);
  of.teeth->rim_ratio = 3.4;
  const ToothFlexibility law(of, 0.0);
  const double t = law.profile().root_angle;
  const double corner = 0.25 / (1 - std::sin(radians(20)));
  EXPECT_NEAR(t, (kPi / 2 + 2 * std::tan(radians(20)) + 2 * corner * std::cos(radians(20))) / 62,
              1e-14);
  const double l = -5.574e-5 / t / t - 1.9986e-3 * 11.56 - 2.3015e-4 * 3.4 / t + 4.7702e-3 / t +
                   0.0271 * 3.4 + 6.8045;
  const double m = 60.111e-5 / t / t + 28.100e-3 * 11.56 - 83.431e-4 * 3.4 / t - 9.9256e-3 / t +
                   0.1624 * 3.4 + 0.9086;
  const double p = -50.952e-5 / t / t + 185.50e-3 * 11.56 + 0.0538e-4 * 3.4 / t + 53.300e-3 / t +
                   0.2895 * 3.4 + 0.9236;
  const double q = -6.2042e-5 / t / t + 9.0889e-3 * 11.56 - 4.0964e-4 * 3.4 / t + 7.8297e-3 / t -
                   0.1472 * 3.4 + 0.6904;
  EXPECT_GT(l, 6.82);
  EXPECT_LT(l, 6.94);
  EXPECT_GT(m, 1.08);
  EXPECT_LT(m, 3.29);
  // On the pitch circle the tooth's middle stands 90/62 deg from the load, which points 20 deg
  // off the flank's radius.
  const double half = kPi / 2 / 62, beta = radians(20) - half;
  const double u = 62e-3 * std::cos(half) - 62e-3 * std::sin(half) * std::tan(beta) - 59.5e-3;
  const double s = 2 * 59.5e-3 * t;
  const double tangent = std::tan(beta);
  EXPECT_NEAR(law.parts(0).foundation * 206e9 /
                  (std::pow(std::cos(beta), 2) *
                   (l * u * u / s / s + m * u / s + p * (1 + q * tangent * tangent))),
              1, 1e-9);
}

TEST(ToothFlexibility, IsInterpolatedWithoutLoss) {
  int cut = 0;
  for (const int teeth : {10, 17, 27, 60, 400})
    for (const double angle : {14.5, 20.0, 25.0, 28.0})
      for (const double cone : {0.0, 65.0, 70.0, 80.0, 88.0})
        for (const double dedendum : {1.1, 1.25, 1.4}) {
          const Gear of = gear(teeth, 2e-3, angle, 1, dedendum);
          try {
            const ToothFlexibility law(of, radians(cone));
            ++cut;
            for (int i = 0; i <= 97; ++i) {
              const double height = -2e-3 + 4e-3 * i / 97;
              const double exact = law.parts(height).sum();
              ASSERT_GT(exact, 0) << teeth << " teeth, " << angle << " deg, cone " << cone;
              ASSERT_NEAR(law.tooth(height) / exact, 1, 1e-10)
                  << teeth << " teeth, " << angle << " deg, cone " << cone << ", h " << height;
            }
          } catch (const InputError&) {  // undercut, pointed
          }
        }
  EXPECT_GT(cut, 150);
}

TEST(ToothFlexibility, GrowsWithHeightAndFallsWithStiffness) {
  Gear of = gear(27, 4e-3, 20);
  const double cone = radians(70);
  const ToothFlexibility law(of, cone);
  const double start = law.profile().base_radius * std::hypot(1, law.profile().start_roll) -
                       law.profile().pitch_radius;
  double last = 0;
  for (int i = 0; i <= 50; ++i) {
    const double height = start + (4e-3 - start) * i / 50;
    EXPECT_GT(law.tooth(height), last);
    last = law.tooth(height);
  }
  // Beyond both ends as there.
  EXPECT_EQ(law.tooth(start - 1e-3), law.tooth(start - 2e-3));
  EXPECT_NEAR(law.tooth(start - 1e-3), law.tooth(start), 1e-12 * last);
  EXPECT_EQ(law.tooth(5e-3), law.tooth(6e-3));
  // Material and size: 1/E; the size does not matter per width.
  of.teeth->youngs_modulus *= 2;
  const ToothFlexibility stiff(of, cone);
  EXPECT_NEAR(stiff.tooth(1e-3) / law.tooth(1e-3), 0.5, 1e-14);
  EXPECT_NEAR(stiff.contact() / law.contact(), 0.5, 1e-14);
  const ToothFlexibility large(gear(27, 8e-3, 20), cone);
  EXPECT_NEAR(large.tooth(2e-3) / law.tooth(1e-3), 1, 1e-13);
  EXPECT_NEAR(law.contact(), 4 * (1 - 0.09) / (kPi * 206e9), 1e-25);
  // Tredgold: 27 teeth on a cone of 60 deg are 54 of a spur gear.
  const ToothFlexibility bevel(of, radians(60));
  Gear spur = gear(54, 4e-3, 20);
  spur.teeth->youngs_modulus *= 2;
  EXPECT_NEAR(bevel.tooth(1e-3) / ToothFlexibility(spur, 0).tooth(1e-3), 1, 1e-13);
}

TEST(ToothFlexibility, RefusesTeethThatNoRackCuts) {
  const auto said = [](const Gear& of, double cone = 0) {
    try {
      const ToothFlexibility law(of, cone);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(said(gear(20, 2e-3, 20)), "");
  EXPECT_THAT(said(gear(12, 2e-3, 20)),
              HasSubstr("[gear] dedendum_mm: tooth gaps of this depth undercut"));
  EXPECT_EQ(said(gear(12, 2e-3, 20), radians(70)), "");
  EXPECT_THAT(said(gear(30, 2e-3, 20, 1, 1)), HasSubstr("no clearance"));
  EXPECT_THAT(said(gear(30, 2e-3, 20, 1, 2.3)), HasSubstr("pointed above their bottom"));
  EXPECT_THAT(said(gear(40, 2e-3, 30, 1.3, 1.32)),
              HasSubstr("[gear] addendum_mm: teeth of this height"));
}

}  // namespace
}  // namespace bentaxis::test
