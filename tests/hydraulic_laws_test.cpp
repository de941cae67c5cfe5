// Laws of the hydraulic side, one by one: the oil with its air and vapour, the openings of a port.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/hydraulics/accuracy_log.h"
#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "chamber.h"
#include "fluid.h"
#include "integrator.h"
#include "network.h"
#include "port.h"
#include "support.h"

namespace bentaxis::hydraulics {
namespace {

namespace fs = std::filesystem;
using test::scaled;

const fs::path kCases = fs::path(BENTAXIS_SOURCE_DIR) / "cases";
Case rated() { return read_case(kCases / "bap63_rated_hydraulic.toml"); }

constexpr double kAtmosphere = 101325;
// Round-off of formulas of ten or so operations.
constexpr double kRoundOff = 1e-13;
// Beyond this in ln of pressure nothing is left of the rounded kink at saturation (fluid.h).
constexpr double kBeyondKink = 0.8;
// And so far above vapour pressure nothing of the other; there the air's own pressure is a
// difference that has lost two digits.
constexpr double kAboveVapour = 0.085;
constexpr double kNearVapour = 100 * kRoundOff;

HydraulicData oil(double dissolved, double saturation, double vapour, double modulus_slope = 0) {
  HydraulicData data = *rated().hydraulics;
  data.cavitation = Cavitation::equilibrium;
  data.dissolved_air = dissolved;
  data.saturation_pressure = saturation;
  data.vapour_pressure = vapour;
  data.bulk_modulus_slope = modulus_slope;
  return data;
}

// Volume of what takes up a unit at P0 before any dissolved air comes out.
double volume(const Fluid& fluid, const HydraulicData& data, double s) {
  return data.density * (1 - data.air_share) / fluid.state(s).density;
}

// ---- Oil
// -----------------------------------------------------------------------------------------

TEST(Cavitation, WithoutDissolvedAirAndVapourIsTheSimpleLawToTheBit) {
  const HydraulicData simple = *rated().hydraulics;
  ASSERT_EQ(simple.cavitation, Cavitation::ignored);
  ASSERT_GT(simple.dissolved_air, 0);  // the defaults, which it then leaves out
  ASSERT_GT(simple.vapour_pressure, 0);
  const Fluid a(simple), b(oil(0, 0, 0));
  for (double s = -30; s < 9; s += 0.01) {
    const auto first = a.state(s), second = b.state(s);
    EXPECT_EQ(first.pressure, second.pressure);
    EXPECT_EQ(first.density, second.density);
    EXPECT_EQ(first.stiffness, second.stiffness);
    EXPECT_EQ(first.d_stiffness, second.d_stiffness);
    EXPECT_EQ(a.released_air(s), 0);
    // Written out here again.
    const double p = kAtmosphere * std::exp(s);
    EXPECT_NEAR(volume(a, simple, s) / (0.995 * std::exp(-(p - kAtmosphere) / 1.4e9) +
                                        0.005 * std::pow(p / kAtmosphere, -1 / 1.4)),
                1, scaled(kRoundOff));
  }
}

TEST(Cavitation, AirComesOutByHenrysLaw) {
  for (const double saturation : {pascals(-0.4), 0.0, pascals(3)})
    for (const double vapour : {0.0, pascals(0.02)}) {
      const HydraulicData data = oil(0.09, saturation, vapour);
      const Fluid fluid(data);
      const double at_saturation = saturation + kAtmosphere - vapour;
      int below = 0, above = 0;
      for (double ratio = 1e-3; ratio < 1e4; ratio *= 1.07) {
        const double air = at_saturation * ratio;  // the air's own pressure
        if (std::abs(std::log(ratio)) < kBeyondKink || air < kAboveVapour * vapour) continue;
        const double s = std::log((air + vapour) / kAtmosphere);
        const double kept = std::min(1.0, ratio);
        EXPECT_NEAR(fluid.released_air(s), 1 - kept, scaled(kNearVapour)) << ratio;
        // Dalton and the gas law: what is out fills its room at the air's pressure.
        const double oil_room = 0.995 * std::exp(-(air + vapour - kAtmosphere) / 1.4e9);
        const double entrained = 0.005 * std::pow((kAtmosphere - vapour) / air, 1 / 1.4);
        const double released = 0.995 * 0.09 * (1 - kept) * kAtmosphere / air;
        EXPECT_NEAR(volume(fluid, data, s) / (oil_room + entrained + released), 1,
                    scaled(kNearVapour))
            << ratio;
        EXPECT_NEAR(fluid.bubbles(s), (entrained + released) / (oil_room + entrained + released),
                    scaled(kNearVapour));
        EXPECT_EQ(fluid.below_saturation(s), ratio < 1);
        ++(ratio < 1 ? below : above);
      }
      EXPECT_GT(below, 50);
      EXPECT_GT(above, 50);
    }
}

TEST(Cavitation, KinkAtSaturationIsRoundedOverTheBandStated) {
  const HydraulicData data = oil(0.09, 0, 0);
  const Fluid fluid(data);
  HydraulicData none = data;
  none.dissolved_air = 0;
  const Fluid without(none);
  const double b = 0.02;
  for (double t = -1; t < 1; t += 0.003) {  // ln(Ps/P)
    const double released = (volume(fluid, data, -t) - volume(without, none, -t)) / (0.995 * 0.09);
    const double sharp = std::expm1(std::max(t, 0.0));
    EXPECT_GE(released, sharp - scaled(1e-13));
    EXPECT_LE(released - sharp,
              std::exp(std::abs(t)) * b * std::exp(-std::abs(t) / b) + scaled(1e-13));
  }
  EXPECT_NEAR(fluid.released_air(0), 1 - std::pow(2, -b), scaled(kRoundOff));
}

TEST(Cavitation, PressureStaysAtVapourPressure) {
  for (const double vapour : {pascals(1e-5), pascals(1e-3), pascals(0.02), pascals(0.5)})
    for (const double air : {0.05, 0.005, 1e-6})
      for (const double dissolved : {0.0, 0.09}) {
        HydraulicData data = oil(dissolved, 0, vapour);
        data.air_share = air;
        const auto pressure_at = [&](double room) {
          const Fluid fluid(data);
          double low = -60, high = 0;
          while (high - low > 1e-13) {
            const double middle = (low + high) / 2;
            (volume(fluid, data, middle) > room ? low : high) = middle;
          }
          return fluid.state(low).pressure;
        };
        // A chamber torn to a hundred times the oil in it.
        EXPECT_GT(pressure_at(100), 0.95 * vapour) << vapour << " " << air;
        if (dissolved > 0) {
          EXPECT_GT(pressure_at(2), vapour);
        }
        data.vapour_pressure = 0;  // negative control
        if (vapour > pascals(0.01) && dissolved == 0) {
          EXPECT_LT(pressure_at(100), 0.1 * vapour);
        }
      }
}

TEST(Cavitation, DensityRisesAndFollowsItsOwnModulus) {
  for (const HydraulicData& data :
       {oil(0.09, 0, pascals(0.001)), oil(0.09, pascals(2), 0, 10), oil(0.3, 0, pascals(0.5), 3),
        oil(0, 0, pascals(0.02)), oil(1, pascals(-0.9), pascals(0.05))}) {
    const Fluid fluid(data);
    const double lowest =
        data.vapour_pressure > 0 ? std::log(0.95 * data.vapour_pressure / kAtmosphere) : -12;
    const double h = 1e-6;  // against kinks rounded over 0.002
    double before = 0;
    for (double s = lowest; s < 8; s += 0.00137) {
      const auto at = fluid.state(s);
      EXPECT_GT(at.density, before) << s;
      before = at.density;
      const auto low = fluid.state(s - h), high = fluid.state(s + h);
      EXPECT_NEAR(std::log(high.density / low.density) / (2 * h) * at.stiffness, 1,
                  scaled(1e-5) + scaled(2e-10) * at.stiffness)
          << s;
      EXPECT_NEAR((high.stiffness - low.stiffness) / (2 * h), at.d_stiffness,
                  scaled(1e-5) * (std::abs(at.d_stiffness) + at.stiffness))
          << s;
    }
  }
}

TEST(Cavitation, BulkModulusGrowsWithPressure) {
  HydraulicData data = oil(0, 0, 0, 9.5);
  data.air_share = 1e-10;
  const Fluid fluid(data);
  for (const double bar : {0.0, 100.0, 350.0, 2000.0}) {
    // Entrained air of 1e-10 softens by K/P0 x 1e-10.
    EXPECT_NEAR(
        fluid.effective_bulk_modulus(pascals(bar)) / (data.bulk_modulus + 9.5 * pascals(bar)), 1,
        scaled(2e-6));
    // dP/K(P) integrated: Murnaghan.
    EXPECT_NEAR(fluid.density(pascals(bar)) / data.density /
                    std::pow(1 + 9.5 * pascals(bar) / data.bulk_modulus, 1 / 9.5),
                1, scaled(1e-9));
  }
  data.bulk_modulus_slope = 1e-7;
  HydraulicData constant = data;
  constant.bulk_modulus_slope = 0;
  EXPECT_NEAR(Fluid(data).density(pascals(500)) / Fluid(constant).density(pascals(500)), 1,
              scaled(1e-8));
}

TEST(Oil, PotentialWithAirOutGiven) {
  const Fluid fluid(oil(0.09, 0, 100));
  for (const double air_out : {0.0, 0.3, 1.0})
    for (const double s : {-4.0, -0.5, 0.5, 5.0}) {
      const double h = 1e-4;
      const double slope =
          (fluid.potential(s + h, air_out) - fluid.potential(s - h, air_out)) / (2 * h);
      const auto at = fluid.mixture(s, air_out);
      EXPECT_NEAR(slope / (at.pressure / at.density), 1, scaled(1e-6)) << s << " " << air_out;
      EXPECT_NEAR(fluid.potential(s, air_out) - fluid.potential(s, 0),
                  air_out * fluid.potential_by_air(s), scaled(1e-9));
    }
  EXPECT_EQ(fluid.potential(0, 1), 0);
  // Where none is out in equilibrium, the two are one from there on.
  const double above = fluid.log_pressure(5e5), far = fluid.log_pressure(275e5);
  EXPECT_NEAR((fluid.potential(far, 0) - fluid.potential(above, 0)) /
                  (fluid.potential(far) - fluid.potential(above)),
              1, scaled(1e-12));
}

// By Simpson's rule over the law itself, at every pressure.
TEST(Oil, PotentialIsTheIntegralOfPressureOverDensity) {
  std::vector<HydraulicData> laws = {*rated().hydraulics};
  for (const double slope : {1e-3, 1.0, 10.0}) {
    laws.push_back(laws[0]);
    laws.back().bulk_modulus_slope = slope;
  }
  laws.push_back(laws[0]);
  laws.back().air_exponent = 1;
  for (const double vapour : {0.0, 100.0, 5000.0})
    for (const double saturation : {0.0, pascals(3)}) laws.push_back(oil(0.09, saturation, vapour));
  laws.push_back(oil(0, 0, 100, 10));
  laws.back().air_exponent = 1;
  laws.push_back(oil(0.09, pascals(3), 100));
  laws.back().oil_law = OilLaw::dowson_higginson;
  for (const OilLaw named : {OilLaw::dissolving_air, OilLaw::dowson_higginson}) {
    laws.push_back(laws[0]);
    laws.back().oil_law = named;
  }
  for (std::size_t law = 0; law < laws.size(); ++law) {
    const Fluid fluid(laws[law]);
    EXPECT_EQ(fluid.potential(0), 0) << law;
    const auto slope = [&](double s) {
      const auto at = fluid.state(s);
      return at.pressure / at.density;
    };
    const bool boils =
        laws[law].cavitation == Cavitation::equilibrium && laws[law].vapour_pressure > 0;
    const double lowest = boils ? std::log(laws[law].vapour_pressure / kAtmosphere) - 0.004 : -12;
    const double scale = 100e5 / 850, h = 1e-4;
    for (const double way : {-h, h}) {
      double sum = 0, worst = 0, before = slope(0);
      for (double s = 0; s > lowest && s < 7; s += way) {
        const double after = slope(s + way);
        sum += way / 6 * (before + 4 * slope(s + way / 2) + after);
        before = after;
        worst = std::max(worst, std::abs(fluid.potential(s + way) - sum));
      }
      EXPECT_LT(worst, scaled(1e-10) * scale) << law << " " << way;
      EXPECT_GT(std::abs(sum), 0.1 * kAtmosphere / 850) << law;
    }
  }
}

HydraulicData law(OilLaw named) {
  HydraulicData data = *rated().hydraulics;
  data.oil_law = named;
  return data;
}

// Written out here again, with numbers of the sources.
TEST(OilLaw, DensitiesAreThoseOfTheSources) {
  // Dowson and Higginson: 0.6 p/(1 + 1.7 p), p in GPa; x = 0.5 % of air.
  const HydraulicData dowson = law(OilLaw::dowson_higginson);
  const Fluid mineral(dowson);
  for (const double bar : {0.0, 100.0, 275.0, 5000.0}) {
    const double s = mineral.log_pressure(pascals(bar)), p = bar * 1e-4;
    const double liquid = 1 / (1 + 0.6 * p / (1 + 1.7 * p));
    const double air = 0.005 * std::pow((pascals(bar) + kAtmosphere) / kAtmosphere, -1 / 1.4);
    EXPECT_NEAR(volume(mineral, dowson, s), 0.995 * liquid + air, scaled(kRoundOff)) << bar;
  }
  // Air that dissolves: all of it at P0 and below, half of it half way, none from 30 bar on.
  const HydraulicData dissolving = law(OilLaw::dissolving_air);
  const Fluid soluble(dissolving), entrained(law(OilLaw::entrained_air));
  for (const double bar : {-0.9, -0.3, 0.0})
    EXPECT_EQ(soluble.density(pascals(bar)), entrained.density(pascals(bar))) << bar;
  const auto air_at = [&](double bar) {
    const double oil = 0.995 * std::exp(-pascals(bar) / 1.4e9);
    return volume(soluble, dissolving, soluble.log_pressure(pascals(bar))) - oil;
  };
  EXPECT_NEAR(air_at(15), 0.5 * 0.005 * std::pow(pascals(15) / kAtmosphere + 1, -1 / 1.4), 1e-12);
  for (const double bar : {30.0, 31.0, 275.0}) {
    EXPECT_NEAR(air_at(bar), 0, scaled(kRoundOff)) << bar;
    EXPECT_NEAR(soluble.effective_bulk_modulus(pascals(bar)), 1.4e9, 1e-6 * 1.4e9) << bar;
  }
  EXPECT_LT(soluble.effective_bulk_modulus(pascals(20)), 1.38e9);
  EXPECT_EQ(soluble.bubbles(soluble.log_pressure(pascals(40))), 0);
  EXPECT_GT(soluble.bubbles(soluble.log_pressure(pascals(20))), 0);
}

// By central differences, h = 1e-5: h^2 of the value and round-off over h.
TEST(OilLaw, DerivativesAreExact) {
  for (const OilLaw named : {OilLaw::dissolving_air, OilLaw::dowson_higginson}) {
    const Fluid fluid(law(named));
    const double h = 1e-5;
    for (double s = -8; s < 8; s += 0.0371) {
      const auto at = fluid.state(s), more = fluid.state(s + h), less = fluid.state(s - h);
      EXPECT_NEAR((std::log(more.density) - std::log(less.density)) / (2 * h) * at.stiffness, 1,
                  scaled(1e-6) * (1 + at.stiffness / 1e4))
          << s;
      EXPECT_EQ(at.density_stiffness, at.stiffness);
      EXPECT_NEAR((more.stiffness - less.stiffness) / (2 * h), at.d_stiffness,
                  scaled(1e-5) * (std::abs(at.d_stiffness) + at.stiffness))
          << s;
    }
  }
}

TEST(OilLaw, ConstantDensityIsOneDensityAndAModulus) {
  HydraulicData data = law(OilLaw::constant_density);
  data.lowest_pressure = 50;
  const Fluid fluid(data);
  for (const double s : {-20.0, -1.0, 0.0, 5.0}) {
    const auto at = fluid.state(s);
    EXPECT_EQ(at.density, 850);
    EXPECT_NEAR(at.stiffness * at.pressure, 1.4e9, 1e-4);
    EXPECT_EQ(at.d_stiffness, -at.stiffness);
    EXPECT_EQ(1 / at.density_stiffness, 0);
    EXPECT_NEAR(fluid.potential(s), (at.pressure - kAtmosphere) / 850, 1e-9 * at.pressure);
    EXPECT_NEAR(fluid.expanding(s).value, 1 - 50 / at.pressure, 1e-9 * 50 / at.pressure);
    EXPECT_NEAR(fluid.expanding(s).slope, 50 / at.pressure, 1e-9 * 50 / at.pressure);
    EXPECT_EQ(Fluid(law(OilLaw::entrained_air)).expanding(s).value, 1);
  }
}

// The Jacobian is that of the rates, by differences. @return the rates
std::vector<double> expect_jacobian_of_rates(const Network& network, double x,
                                             const std::vector<double>& y) {
  constexpr double kLoad = 9e-6;
  const int size = network.size();
  std::vector<double> by_state(static_cast<std::size_t>(size) * size), by_load(size), low(size),
      high(size), rates(size);
  network.jacobian(x, y.data(), kLoad, by_state.data(), by_load.data());
  network.rates(x, y.data(), kLoad, rates.data());
  const double h = 1e-6;
  for (int j = 0; j < size; ++j) {
    auto to = y;
    to[j] = y[j] - h;
    network.rates(x, to.data(), kLoad, low.data());
    to[j] = y[j] + h;
    network.rates(x, to.data(), kLoad, high.data());
    for (int i = 0; i < size; ++i) {
      const double slope = (high[i] - low[i]) / (2 * h);
      EXPECT_NEAR(slope, by_state[j * size + i],
                  scaled(1e-5) * (1 + std::abs(slope) + std::abs(rates[i])))
          << x << ": " << i << " by " << j;
    }
  }
  return rates;
}

TEST(OilLaw, JacobianOfConstantDensityIsThatOfTheRates) {
  Case the_case = rated();
  the_case.hydraulics->oil_law = OilLaw::constant_density;
  the_case.hydraulics->suction_line = SuctionLineData{2, 0.04, 2, 1e-3};
  const Network network(the_case);
  const int size = network.size();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  const double lowest = std::log(the_case.hydraulics->lowest_pressure / kAtmosphere);
  int expanding = 0;
  for (const double x : {3.0, 21.0, 40.0, 66.0}) {
    std::vector<double> y(size);
    // Some near the lowest pressure, some of a running pump.
    for (int k = 0; k < 5; ++k)
      y[k] = k % 2 == 0 ? lowest + 0.1 + 2 * share(random) : share(random);
    y[5] = 5.5;
    y[6] = -0.1;
    y[7] = 0.9;
    const std::vector<double> rates = expect_jacobian_of_rates(network, x, y);
    for (int k = 0; k < 5; k += 2) expanding += rates[k] < 0;
  }
  EXPECT_GT(expanding, 0);  // else nothing above is of the lowest pressure
}

TEST(OilLaw, WhatDoesNotGoTogetherIsRefused) {
  using testing::HasSubstr;
  const auto refusal = [](const std::vector<std::string>& changes) -> std::string {
    try {
      read_case(kCases / "bap63_rated_hydraulic.toml", changes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string key = "hydraulics.oil_law=", air = "hydraulics.cavitation=equilibrium";
  EXPECT_EQ(refusal({key + "dowson_higginson", air}), "");
  EXPECT_EQ(refusal({key + "dissolving_air"}), "");
  EXPECT_THAT(refusal({key + "dissolving_air", air}), HasSubstr("oil_law"));
  EXPECT_THAT(refusal({key + "constant_density", air}), HasSubstr("oil_law"));
  EXPECT_THAT(refusal({key + "water"}), HasSubstr("oil_law"));
  EXPECT_THAT(refusal({key + "constant_density", "hydraulics.lowest_pressure_bar=0.9",
                       "pressure.suction_bar=-0.2"}),
              HasSubstr("lowest_pressure_bar"));
  EXPECT_THAT(refusal({key + "dissolving_air", "hydraulics.air_dissolved_bar=0"}),
              HasSubstr("air_dissolved_bar"));
  // What belongs to another law is checked and unused.
  const Case plain = rated(), with = read_case(kCases / "bap63_rated_hydraulic.toml",
                                               {"hydraulics.compressibility_per_GPa=1"});
  EXPECT_EQ(Fluid(*plain.hydraulics).density(2e7), Fluid(*with.hydraulics).density(2e7));
}

// Torn oil: without the law the chambers are far below vapour pressure and say nothing of it.
TEST(Cavitation, StarvedPumpStaysAboveVapourPressure) {
  Case the_case = rated();
  the_case.operation.speed_rpm = 3000;
  const SteadyState simple = steady_state(the_case);
  const double vapour = pascals(0.02);
  ASSERT_LT(simple.summary.chamber_least + kAtmosphere, vapour);
  the_case.hydraulics->cavitation = Cavitation::equilibrium;
  for (const double pressure : {the_case.hydraulics->vapour_pressure, vapour}) {
    the_case.hydraulics->vapour_pressure = pressure;
    const SteadyState state = steady_state(the_case);
    EXPECT_GT(state.summary.chamber_least + kAtmosphere, pressure);
    EXPECT_LT(state.summary.chamber_least, -pascals(0.5));  // it is starved
    EXPECT_LE(state.computed->error, the_case.hydraulics->curve_error * state.computed->peak);
    EXPECT_NEAR(state.summary.mass_in / state.summary.mass_out, 1, scaled(1e-8));
    // The bound on the work of any run is 1.5e7 steps x states; this is an ordinary one.
    EXPECT_LT(state.convergence.steps, 40 * simple.convergence.steps);
    RecordProperty("steps", std::to_string(state.convergence.steps));
  }
}

// ---- Ports
// ---------------------------------------------------------------------------------------

constexpr double kRadius = 0.022;
const double kLength = radians(1) * kRadius;  // m per degree on the bore circle

HydraulicData plain() {
  HydraulicData data = *rated().hydraulics;
  data.delivery = {{204, 336}, {}};
  data.suction = {{28, 154}, {}};
  return data;
}

// Half the height of a slot or a disk over x; circular ends or straight ones.
using Profile = std::function<double(double)>;
Profile slot(double from, double to, double height, bool circular) {
  return [=](double x) {
    if (x < from || x > to) return 0.0;
    const double r = height / 2;
    if (!circular) return r;
    const double off = std::max({0.0, from + r - x, x - (to - r)});
    return std::sqrt(std::max(0.0, r * r - off * off));
  };
}

// Common area by counting strips: everything is symmetric to the bore circle. Round ends are met
// to 1/strips^1.5, a straight one to half a strip.
constexpr double kStrip = 1.5e-4;
double common(const Profile& a, const Profile& b, double from, double to) {
  const int strips = 4000;
  const double width = (to - from) / strips;
  double sum = 0;
  for (int i = 0; i < strips; ++i) {
    const double x = from + (i + 0.5) * width;
    sum += 2 * width * std::min(a(x), b(x));
  }
  return sum;
}

TEST(PortOpening, CircularEndsAreTheCommonAreaOfTwoSlots) {
  HydraulicData data = plain();
  data.kidney_ends = KidneyEnds::circular;
  for (const PortArc arc : {PortArc{204, 336}, PortArc{190, 230}}) {  // the second shorter
    data.delivery.arc = arc;
    const PortOpening port(data, data.delivery, kRadius);
    const Profile fixed =
        slot(arc.from_deg * kLength, arc.to_deg * kLength, data.kidney_height, true);
    const double half = data.kidney_width_deg / 2;
    double largest = 0;
    for (double theta = 150; theta < 370; theta += 0.73) {
      const double from = (theta - half) * kLength, to = (theta + half) * kLength;
      const double counted = common(slot(from, to, data.kidney_height, true), fixed, from, to);
      EXPECT_NEAR(port.area(theta), counted, 5e-5 * data.kidney_height * data.kidney_height)
          << theta;
      EXPECT_NEAR(port.area(theta - 720), port.area(theta), 1e-14);
      largest = std::max(largest, port.area(theta));
    }
    const double length = std::min(arc.to_deg - arc.from_deg, data.kidney_width_deg) * kLength;
    const double r = data.kidney_height / 2;
    EXPECT_NEAR(largest, 2 * r * (length - 2 * r) + kPi * r * r, 1e-12);
  }
}

TEST(PortOpening, HolesAreWhatTheKidneyCoversOfThem) {
  for (const bool circular : {false, true})
    for (const double diameter : {0.001, 0.003, 0.008}) {
      HydraulicData data = plain();
      data.kidney_ends = circular ? KidneyEnds::circular : KidneyEnds::rounded;
      const PortOpening without(data, data.delivery, kRadius);
      data.delivery.holes = {{{190, diameter}, {350, diameter / 2}}};
      const PortOpening port(data, data.delivery, kRadius);
      const auto disk = [&](const PlateHole& hole) {
        const double x = hole.angle_deg * kLength;
        return slot(x - hole.diameter / 2, x + hole.diameter / 2, hole.diameter, true);
      };
      const double half = data.kidney_width_deg / 2;
      for (double theta = 140; theta < 400; theta += 0.41) {
        double counted = 0;
        for (const PlateHole& hole : data.delivery.holes) {
          const double x = hole.angle_deg * kLength, r = hole.diameter / 2;
          counted += common(slot((theta - half) * kLength, (theta + half) * kLength,
                                 data.kidney_height, circular),
                            disk(hole), x - r, x + r);
        }
        EXPECT_NEAR(port.area(theta) - without.area(theta), counted, kStrip * diameter * diameter)
            << theta << " " << circular;
      }
    }
}

TEST(PortOpening, TrailingNotchIsTheLeadingOneSeenBackwards) {
  for (const NotchLaw law : {NotchLaw::quadratic, NotchLaw::linear}) {
    HydraulicData data = plain();
    data.notch_law = law;
    const PlatePort behind{{204, 336}, {7, 2e-6}, {12, 4e-6}};
    const PlatePort before{{24, 156}, {12, 4e-6}, {7, 2e-6}};
    const PortOpening port(data, behind, kRadius), mirrored(data, before, kRadius);
    for (double theta = 0; theta < 360; theta += 0.37)
      EXPECT_NEAR(port.area(theta), mirrored.area(360 - theta), 1e-17) << theta;
    // Its end: three degrees of twelve are left under the kidney.
    const double share = law == NotchLaw::linear ? 0.25 : 0.0625;
    EXPECT_NEAR(port.area(336 + 9 + data.kidney_width_deg / 2), share * 4e-6, 1e-17);
    EXPECT_EQ(port.area(336 + 12.01 + data.kidney_width_deg / 2), 0);
  }
}

TEST(PortOpening, ReliefGrooveIsTheSmallerOfMouthAndSection) {
  HydraulicData data = plain();
  data.delivery.groove = {170, 195, 0.001, 0.8e-6};
  const PortOpening port(data, data.delivery, kRadius);
  const double half = data.kidney_width_deg / 2;
  const PortOpening without(plain(), plain().delivery, kRadius);
  for (double theta = 100; theta < 300; theta += 0.19) {
    double under = 0;  // degrees of groove under the kidney, counted
    for (double psi = 170.0005; psi < 195; psi += 0.001)
      if (std::abs(psi - theta) < half) under += 0.001;
    EXPECT_NEAR(port.area(theta) - without.area(theta), std::min(under * kLength * 0.001, 0.8e-6),
                2e-3 * kLength * 0.001)
        << theta;
  }
  // Half a degree in: the mouth; far in: the section.
  EXPECT_NEAR(port.area(170 - half + 0.5), 0.5 * kLength * 0.001, 1e-18);
  EXPECT_EQ(port.area(170), 0.8e-6);
}

OpeningTable trapezoid() {
  OpeningTable table{"made here", {}, {}};
  for (double theta = 160; theta < 520; theta += 5) {
    table.theta_deg.push_back(theta);
    table.area.push_back(1e-6 * std::clamp(std::min(theta - 180, 380 - theta), 0.0, 40.0));
  }
  return table;
}

TEST(PortOpening, TableGoesThroughItsPointsAndStaysBetweenThem) {
  HydraulicData data = plain();
  data.delivery.table = trapezoid();
  data.delivery.groove = {170, 195, 0.001, 0.8e-6};  // has no say
  const OpeningTable& table = data.delivery.table;
  const PortOpening port(data, data.delivery, kRadius);
  const std::size_t n = table.area.size();
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(port.area(table.theta_deg[i] + 360 * (static_cast<int>(i % 3) - 1)), table.area[i],
                1e-18);
    const double next = table.area[(i + 1) % n];
    double before = table.area[i];
    for (double share = 0.1; share < 1; share += 0.1) {  // monotone from point to point
      const double area = port.area(table.theta_deg[i] + 5 * share);
      EXPECT_GE((area - before) * (next - table.area[i]), -1e-30);
      EXPECT_TRUE(area == 0 || next + table.area[i] > 0);
      before = area;
    }
  }
  // Both ends of the pieces beside the corners, where the slope changes.
  EXPECT_THAT(port.edges_deg(),
              testing::Pointwise(testing::DoubleNear(1e-12),
                                 std::vector<double>{15, 20, 180, 185, 215, 220, 340, 345}));
}

// Between the edges listed no slope jumps, and the area nowhere.
TEST(PortOpening, EveryKinkIsAnEdge) {
  struct Port {
    const char* name;
    void (*change)(HydraulicData&);
  };
  const Port ports[] = {
      {"square law", [](HydraulicData&) {}},
      {"straight", [](HydraulicData& h) { h.kidney_rounding_deg = 0; }},
      {"circular", [](HydraulicData& h) { h.kidney_ends = KidneyEnds::circular; }},
      {"notches",
       [](HydraulicData& h) {
         h.delivery.notch = {18, 4e-6};
         h.delivery.trailing_notch = {9, 3e-6};
         h.notch_law = NotchLaw::linear;
       }},
      {"groove",
       [](HydraulicData& h) {
         h.delivery.groove = {-17, 1, 0.001, 0.8e-6};
       }},
      {"short groove",
       [](HydraulicData& h) {
         h.delivery.groove = {181, 182, 0.001, 0.8e-6};
       }},
      {"holes",
       [](HydraulicData& h) {
         h.delivery.holes = {{{190, 0.002}, {345, 0.003}}};
       }},
      {"holes, circular",
       [](HydraulicData& h) {
         h.kidney_ends = KidneyEnds::circular;
         h.delivery.holes = {{{190, 0.002}, {345, 0.008}}};
       }},
      {"table", [](HydraulicData& h) { h.delivery.table = trapezoid(); }}};
  for (const Port& each : ports) {
    HydraulicData data = plain();
    each.change(data);
    const PortOpening port(data, data.delivery, kRadius);
    const auto& edges = port.edges_deg();
    ASSERT_TRUE(std::is_sorted(edges.begin(), edges.end()));
    const double h = 1e-4;
    const double slope = kLength * data.kidney_height;  // of a straight kidney
    int kinks = 0;
    double before = port.area(-h), at = port.area(0);
    for (int i = 0; i < 3600000; ++i) {
      const double theta = i * h, after = port.area(theta + h);
      const double bend = std::abs(after - 2 * at + before) / h;
      ASSERT_LE(std::abs(after - at), 2 * slope * h) << each.name << " " << theta;
      // Round-off of the angles, wrapped, is 1e-13 of a slope; curvature gives at most 1e-3 of it
      // beyond a hundredth of a degree from where it is infinite.
      before = at;
      at = after;
      if (bend < 1e-3 * slope) continue;
      ++kinks;
      const bool known = std::any_of(edges.begin(), edges.end(), [&](double edge) {
        return std::abs(std::remainder(theta - edge, 360)) < 0.01;
      });
      EXPECT_TRUE(known) << each.name << " " << theta;
    }
    if (std::string(each.name) == "straight") {
      EXPECT_GE(kinks, 4);
    }
  }
}

TEST(PortOpening, OverlapIsWhatArcsAndKidneyMake) {
  const auto of = [](PortArc suction, PortArc delivery, Notch notch) {
    HydraulicData data = plain();
    data.kidney_width_deg = 50;
    data.suction = {suction, {}};
    data.delivery = {delivery, notch};
    return bridges(PortOpening(data, data.suction, kRadius),
                   PortOpening(data, data.delivery, kRadius));
  };
  // The kidney leaves the suction port at 153 + 25 and meets the delivery port at 207 - 25.
  auto found = of({27, 153}, {207, 333}, {});
  ASSERT_EQ(found.size(), 2);
  EXPECT_NEAR(found[0].from_deg, 178, 1e-12);
  EXPECT_NEAR(found[0].to_deg, 182, 1e-12);
  EXPECT_FALSE(found[0].both_open);
  EXPECT_NEAR(found[1].from_deg, 358, 1e-12);
  EXPECT_NEAR(found[1].to_deg, 362, 1e-12);
  EXPECT_FALSE(found[1].both_open);
  // A notch of 10 deg opens at 172: 6 deg of negative overlap.
  found = of({27, 153}, {207, 333}, {10, 1e-6});
  ASSERT_EQ(found.size(), 2);
  EXPECT_NEAR(found[0].from_deg, 172, 1e-12);
  EXPECT_NEAR(found[0].to_deg, 178, 1e-12);
  EXPECT_TRUE(found[0].both_open);
  // The shipped plate: 30 deg of the turn.
  const HydraulicData data = *rated().hydraulics;
  double both = 0;
  for (const Bridge& bridge : bridges(PortOpening(data, data.suction, kRadius),
                                      PortOpening(data, data.delivery, kRadius))) {
    EXPECT_TRUE(bridge.both_open);
    both += bridge.to_deg - bridge.from_deg;
  }
  EXPECT_NEAR(both, 30, 1e-11);
}

// Ports that open and close at the same angle but for round-off have no overlap.
TEST(PortOpening, RoundOffIsNoOverlap) {
  HydraulicData data = plain();
  data.kidney_width_deg = 51.3;
  data.suction = {{25.65, 180 - 25.65}, {}};
  data.delivery = {{180 + 25.65, 360 - 25.65}, {}};
  EXPECT_TRUE(
      bridges(PortOpening(data, data.suction, kRadius), PortOpening(data, data.delivery, kRadius))
          .empty());
}

// ---- Air that takes time to come out
// ----------------------------------------------------------------------------

Case with_rate(double release, double dissolution) {
  Case the_case = rated();
  HydraulicData& h = *the_case.hydraulics;
  h.cavitation = Cavitation::rate;
  h.release_time = release;
  h.dissolution_time = dissolution;
  h.saturation_pressure = -pascals(0.3);
  h.vapour_pressure = 100;
  h.dissolved_air = 0.09;
  return the_case;
}

double difference(const SteadyState& a, const SteadyState& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.chamber.pressure.size(); ++i)
    most = std::max(most, std::abs(a.chamber.pressure[i] - b.chamber.pressure[i]));
  return most;
}

TEST(AirRelease, MixtureWithTheAirOfEquilibriumIsThatOfTheLaw) {
  const Fluid fluid(*with_rate(1, 1).hydraulics);
  for (double s = -6; s < 6; s += 0.0931) {  // vapour pressure is at -6.9
    const auto law = fluid.state(s);
    const auto out = fluid.equilibrium(s);
    const auto mixture = fluid.mixture(s, out.value);
    EXPECT_NEAR(mixture.density / law.density, 1, scaled(1e-12)) << s;
    EXPECT_GE(out.value, 0);
    EXPECT_LE(out.value, 1);
    // d ln(density)/ds of the law is that at constant air less the swelling by more air.
    EXPECT_NEAR(1 / mixture.stiffness - mixture.swelling * out.slope, 1 / law.stiffness,
                scaled(1e-10) / law.stiffness)
        << s;
    const double h = 1e-6;
    EXPECT_NEAR((fluid.equilibrium(s + h).value - fluid.equilibrium(s - h).value) / (2 * h),
                out.slope, scaled(1e-5))
        << s;
    for (const double air : {0.0, 0.3, 1.0}) {
      const auto at = fluid.mixture(s, air);
      const auto low = fluid.mixture(s - h, air), high = fluid.mixture(s + h, air);
      const auto less = fluid.mixture(s, air - h), more = fluid.mixture(s, air + h);
      const auto expect = [&](double up, double down, double slope, double scale) {
        EXPECT_NEAR((up - down) / (2 * h) / scale, slope / scale, scaled(1e-5)) << s << " " << air;
      };
      expect(std::log(high.density), std::log(low.density), 1 / at.stiffness, 1 / at.stiffness);
      expect(std::log(more.density), std::log(less.density), -at.swelling, at.swelling);
      expect(high.stiffness, low.stiffness, at.d_stiffness, at.stiffness);
      expect(more.stiffness, less.stiffness, at.stiffness_by_air, at.stiffness);
      expect(high.swelling, low.swelling, at.d_swelling, at.swelling);
      expect(more.swelling, less.swelling, at.swelling_by_air, at.swelling);
    }
  }
}

TEST(AirRelease, JacobianIsThatOfTheRates) {
  Case the_case = with_rate(2e-3, 30e-3);
  the_case.hydraulics->suction_line = SuctionLineData{2, 0.04, 2, 1e-3};
  const Network network(the_case);
  ASSERT_EQ(network.states(), 5 + 1 + 2 + 5);
  ASSERT_EQ(network.air_at(), 8);
  const int size = network.size();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (const double x : {3.0, 21.0, 40.0, 66.0}) {
    std::vector<double> y(size);
    for (int k = 0; k < 5; ++k) {
      y[k] = -2.5 + 4 * share(random);
      y[network.air_at() + k] = share(random);
    }
    y[5] = 5.5;
    y[6] = -0.1;
    y[7] = 0.9;
    expect_jacobian_of_rates(network, x, y);
  }
}

// At constant pressure, only oil of its own leaving: an exponential.
TEST(AirRelease, RelaxesExponentially) {
  for (const bool release : {true, false}) {
    Case the_case = with_rate(5e-3, 0.2);
    HydraulicData& h = *the_case.hydraulics;
    h.leakage = 0;
    h.kidney_height = 100;  // m, and next to no drop: the port holds the pressure
    h.transition_pressure = 1;
    h.suction = {{250, 380}};
    h.delivery = {{60, 150}};
    const double suction = pascals(release ? -0.6 : -0.31);
    the_case.pressure.ports.suction = suction;
    const Network network(the_case);
    const Fluid& fluid = network.fluid();
    const double wanted = fluid.equilibrium(fluid.log_pressure(suction)).value;
    const double start = release ? 0 : 0.5;
    ASSERT_EQ(wanted > start, release);
    auto y = network.uniform(fluid.log_pressure(suction), network.delivery_log_pressure(), 0);
    std::fill(y.begin() + network.air_at(), y.end(), start);
    const double time = release ? h.release_time : h.dissolution_time;
    double worst = 0, last = 0;
    Integrator(network).over_period(
        y, 9e-6, 1e-11, nullptr, nullptr, [&](const Integrator::Step& step) {
          if (step.to > 60) return;  // the chamber stands at 288 degrees and goes to 348
          const double air = network.air_out(step.state(step.to), 1);
          last =
              wanted + (start - wanted) * std::exp(-step.to * network.seconds_per_degree() / time);
          worst = std::max(worst, std::abs(air - last));
        });
    EXPECT_LT(worst, scaled(1e-6));
    EXPECT_GT(std::abs(last - start), 0.01);  // 6.7 ms
  }
}

// In no time it is the equilibrium; off by a time, so a tenth of the time is a tenth of it.
TEST(AirRelease, InNoTimeIsTheEquilibrium) {
  Case the_case = with_rate(1e-5, 1e-5);
  const SteadyState slower = steady_state(the_case);
  the_case = with_rate(1e-6, 1e-6);
  const SteadyState fast = steady_state(the_case);
  the_case.hydraulics->cavitation = Cavitation::equilibrium;
  const SteadyState equilibrium = steady_state(the_case);
  const double off = difference(fast, equilibrium);
  // 1 us is 0.009 degrees, in which a chamber's pressure falls by 275 bar over 10 degrees at most.
  EXPECT_LT(off, pascals(0.25));
  EXPECT_LT(off, 0.2 * difference(slower, equilibrium));
  EXPECT_GT(difference(slower, equilibrium), 100 * equilibrium.computed->error);
}

TEST(AirRelease, NeverIsTheLawWithoutDissolvedAir) {
  Case the_case = with_rate(1e6, 1e6);
  the_case.pressure.ports.suction = 0;
  const SteadyState never = steady_state(the_case);
  the_case.hydraulics->cavitation = Cavitation::equilibrium;
  const SteadyState equilibrium = steady_state(the_case);
  the_case.hydraulics->dissolved_air = 0;
  const SteadyState without = steady_state(the_case);
  // In a turn of 40 ms 4e-8 of the air comes out, which is 9 % of the oil's volume.
  EXPECT_LT(difference(never, without), 3 * (never.computed->error + without.computed->error));
  EXPECT_GT(difference(equilibrium, without), pascals(0.05));
}

TEST(AirRelease, BothTimesCount) {
  const Case base = with_rate(5e-3, 50e-3);
  const SteadyState usual = steady_state(base);
  for (double HydraulicData::*time :
       {&HydraulicData::release_time, &HydraulicData::dissolution_time}) {
    Case changed = base;
    (*changed.hydraulics).*time *= 1.01;
    const SteadyState state = steady_state(changed);
    EXPECT_GT(difference(usual, state), 10 * (usual.computed->error + state.computed->error));
  }
}

TEST(AirRelease, MassThatEntersLeavesAndTheRateLiesBetween) {
  Case the_case = with_rate(5e-3, 50e-3);
  the_case.operation.speed_rpm = 2350;
  const SteadyState state = steady_state(the_case);
  const Summary& s = state.summary;
  EXPECT_NEAR(s.mass_in / s.mass_out, 1, scaled(1e-9));
  EXPECT_LE(state.computed->error, 1e-7 * state.computed->peak);
  Case other = the_case;
  other.hydraulics->cavitation = Cavitation::equilibrium;
  const double softest = steady_state(other).summary.chamber_least;
  other.hydraulics->dissolved_air = 0;
  const double stiffest = steady_state(other).summary.chamber_least;
  EXPECT_LT(stiffest, s.chamber_least);
  EXPECT_LT(s.chamber_least, softest);
}

TEST(Control, EveryNumberOfOilAndPortsCounts) {
  Case base = rated();
  HydraulicData& h = *base.hydraulics;
  h.cavitation = Cavitation::equilibrium;
  h.bulk_modulus_slope = 9;
  h.delivery.trailing_notch = {5, 1e-6};
  h.delivery.groove = {150, 160, 0.001, 0.4e-6};
  h.delivery.holes = {{{185, 0.001}, {357, 0.001}}};
  h.suction.table = trapezoid();
  for (double& angle : h.suction.table.theta_deg) angle -= 175;
  base.hydraulics->tolerance = 1e-11;
  const SteadyState usual = steady_state(base);
  using Change = void (*)(HydraulicData&);
  const Change changes[] = {[](HydraulicData& d) { d.bulk_modulus_slope *= 1.001; },
                            [](HydraulicData& d) { d.dissolved_air *= 1.001; },
                            [](HydraulicData& d) { d.saturation_pressure += 100; },
                            [](HydraulicData& d) { d.vapour_pressure *= 1.001; },
                            [](HydraulicData& d) { d.cavitation = Cavitation::ignored; },
                            [](HydraulicData& d) { d.kidney_ends = KidneyEnds::circular; },
                            [](HydraulicData& d) { d.delivery.trailing_notch.length_deg += 0.01; },
                            [](HydraulicData& d) { d.delivery.trailing_notch.area *= 1.001; },
                            [](HydraulicData& d) { d.delivery.groove.from_deg += 0.01; },
                            [](HydraulicData& d) { d.delivery.groove.to_deg += 0.01; },
                            [](HydraulicData& d) { d.delivery.groove.width *= 1.001; },
                            [](HydraulicData& d) { d.delivery.groove.area *= 1.001; },
                            [](HydraulicData& d) { d.delivery.holes[0].angle_deg += 0.01; },
                            [](HydraulicData& d) { d.delivery.holes[0].diameter *= 1.001; },
                            [](HydraulicData& d) { d.delivery.holes[1].angle_deg += 0.01; },
                            [](HydraulicData& d) { d.delivery.holes[1].diameter *= 1.001; },
                            [](HydraulicData& d) { d.suction.table.theta_deg[10] += 0.01; },
                            [](HydraulicData& d) { d.suction.table.area[10] *= 1.001; }};
  int number = 0;
  for (const Change change : changes) {
    Case changed = base;
    change(*changed.hydraulics);
    const SteadyState state = steady_state(changed);
    double most = 0;
    for (std::size_t i = 0; i < usual.chamber.pressure.size(); ++i)
      most = std::max(most, std::abs(state.chamber.pressure[i] - usual.chamber.pressure[i]));
    EXPECT_GT(most, 10 * (usual.computed->error + state.computed->error)) << number;
    ++number;
  }
}

// ---- From a case file
// ----------------------------------------------------------------------------

class PortFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        ("ports_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(folder_);
    fs::copy_file(kCases / "bap63_rated_hydraulic.toml", folder_ / "case.toml",
                  fs::copy_options::overwrite_existing);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string refusal(const std::vector<std::string>& changes) const {
    try {
      read_case(folder_ / "case.toml", changes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string refusal_of(const std::string& table) const {
    std::ofstream(folder_ / "opening.csv") << table;
    return refusal({"hydraulics.delivery_opening_file=opening.csv"});
  }

  fs::path folder_;
};

TEST_F(PortFile, TableOfTheGeometryGivesTheSamePressures) {
  const Case geometry = rated();
  for (const char* name : {"delivery", "suction"}) {
    const HydraulicData& h = *geometry.hydraulics;
    const PortOpening port(h, name == std::string("suction") ? h.suction : h.delivery,
                           geometry.pump.geometry.bore_circle_radius);
    std::string text = "theta_deg,area_mm2\n";
    for (int i = 0; i < 3600; ++i)
      text += std::to_string(0.1 * i) + "," + std::to_string(port.area(0.1 * i) * 1e6) + "\n";
    std::ofstream(folder_ / (std::string(name) + ".csv")) << text;
  }
  const Case the_case =
      read_case(folder_ / "case.toml",
                {"hydraulics.delivery_opening_file=delivery.csv",
                 "hydraulics.suction_opening_file=suction.csv", "hydraulics.curve_error=1e-6"});
  const SteadyState a = steady_state(geometry), b = steady_state(the_case);
  double worst = 0;
  for (std::size_t i = 0; i < a.chamber.pressure.size(); ++i)
    worst = std::max(worst, std::abs(a.chamber.pressure[i] - b.chamber.pressure[i]));
  // Kinks rounded over a tenth of a degree, areas to 1e-6 mm2.
  EXPECT_LT(worst, 2e-3 * a.computed->peak);
  // Written and read again.
  std::ofstream(folder_ / "again.toml") << case_text(the_case);
  const Case again = read_case(folder_ / "again.toml");
  EXPECT_EQ(again.hydraulics->delivery.table.area, the_case.hydraulics->delivery.table.area);
  EXPECT_EQ(again.hydraulics->suction.table.theta_deg,
            the_case.hydraulics->suction.table.theta_deg);
}

// ---- Stroke of a file

class StrokeFile : public PortFile {
 protected:
  // What the pump's own geometry does, as a file.
  void write_own(const Case& the_case, bool volume, int points) const {
    const Geometry& g = the_case.pump.geometry;
    const Chamber own(g, the_case.hydraulics->dead_volume);
    const double area = kPi / 4 * g.bore_diameter * g.bore_diameter;
    std::ofstream file(folder_ / "stroke.csv");
    file << (volume ? "theta_deg,volume_cm3\n" : "theta_deg,stroke_mm\n");
    for (int i = 0; i < points; ++i) {
      const double theta = 360.0 * i / points;
      const double cubic_metres = own.volume(radians(theta)).value;
      // A stroke has any zero.
      file << number_text(theta) << ","
           << number_text(volume ? cubic_metres * 1e6 : cubic_metres / area * 1e3 - 17) << "\n";
    }
  }
  Case with_file() const {
    return read_case(folder_ / "case.toml", {"hydraulics.stroke_file=stroke.csv"});
  }
  std::string refusal_of_stroke(const std::string& table) const {
    std::ofstream(folder_ / "stroke.csv") << table;
    return refusal({"hydraulics.stroke_file=stroke.csv"});
  }
};

// Of a spline of step h = 1 deg through a sine: 5/384 h^4 = 1.2e-9 of the amplitude at most, a
// slope of h^3/24 = 2.2e-7; harmonics of the stroke are small.
TEST_F(StrokeFile, OfTheOwnGeometryIsTheOwnVolume) {
  const Case plain = rated();
  const Chamber own(plain.pump.geometry, plain.hydraulics->dead_volume);
  for (const bool volume : {false, true}) {
    write_own(plain, volume, 360);
    const Case the_case = with_file();
    EXPECT_EQ(the_case.hydraulics->stroke.is_volume, volume);
    const Chamber given(the_case.pump.geometry, the_case.hydraulics->dead_volume,
                        the_case.hydraulics->stroke);
    EXPECT_TRUE(given.is_given());
    EXPECT_NEAR(given.swept(), own.swept(), 1e-8 * own.swept());
    EXPECT_NEAR(given.dead(), 3e-6, 1e-8 * own.swept());
    for (double theta = -7; theta < 7; theta += 0.0137) {
      EXPECT_NEAR(given.volume(theta).value, own.volume(theta).value, 1e-8 * own.swept()) << theta;
      EXPECT_NEAR(given.volume(theta).slope, own.volume(theta).slope, 1e-6 * own.swept()) << theta;
    }
  }
}

TEST_F(StrokeFile, RateIsContinuousAndTheVolumesSlope) {
  std::ofstream(folder_ / "stroke.csv")
      << "theta_deg,stroke_mm\n0,0\n70,9\n181,21\n200,20\n300,2\n";
  const Case the_case = with_file();
  const Chamber given(the_case.pump.geometry, 3e-6, the_case.hydraulics->stroke);
  const double h = 1e-6;
  for (const double deg : {0.0, 70.0, 181.0, 200.0, 300.0, 360.0, 35.0, 190.0, 331.0}) {
    const double theta = radians(deg);
    const auto at = given.volume(theta), more = given.volume(theta + h),
               less = given.volume(theta - h);
    EXPECT_NEAR((more.value - less.value) / (2 * h), at.slope, 1e-6 * given.swept()) << deg;
    // A jump would not fall with h; the slope's own slope is below 100 strokes per rad^2.
    EXPECT_NEAR(more.slope, less.slope, 2 * h * 100 * given.swept()) << deg;
  }
  // Extremes lie between the points too.
  double least = 1, greatest = 0;
  for (double theta = 0; theta < 2 * kPi; theta += 1e-4) {
    least = std::min(least, given.volume(theta).value);
    greatest = std::max(greatest, given.volume(theta).value);
  }
  EXPECT_NEAR(least, 3e-6, 1e-7 * given.swept());
  EXPECT_NEAR(greatest - least, given.swept(), 1e-7 * given.swept());
}

// Volumes differ by 1e-9 of the stroke: K times that over the dead volume is 2e-7 of the peak.
TEST_F(StrokeFile, OfTheOwnGeometryGivesTheSamePressures) {
  const Case plain = rated();
  const SteadyState own = steady_state(plain);
  write_own(plain, false, 360);
  const SteadyState given = steady_state(with_file());
  EXPECT_NEAR(given.summary.displacement, own.summary.displacement,
              1e-8 * own.summary.displacement);
  double worst = 0;
  for (double theta = 0; theta < 360; theta += 0.7)
    worst = std::max(worst, std::abs(own.computed->gauge(theta) - given.computed->gauge(theta)));
  EXPECT_LT(worst, 5e-6 * own.computed->peak);
  // Another stroke has another flow: 5 bores of 22.5 mm, 16 mm.
  std::ofstream(folder_ / "stroke.csv") << "theta_deg,stroke_mm\n0,0\n90,8\n180,16\n270,8\n";
  EXPECT_NEAR(steady_state(with_file()).summary.displacement, 31.809e-6, 0.001e-6);
}

TEST_F(StrokeFile, IsWrittenAndReadAgainAndListedAsAnInput) {
  write_own(rated(), false, 36);
  const Case the_case = with_file();
  std::ofstream(folder_ / "again.toml") << case_text(the_case);
  EXPECT_EQ(read_case(folder_ / "again.toml").hydraulics->stroke.value,
            the_case.hydraulics->stroke.value);
  std::vector<std::string> names;
  for (const InputFile& input : the_case.inputs) names.push_back(input.file.filename().string());
  EXPECT_THAT(names, testing::Contains("stroke.csv"));
  EXPECT_EQ(rated().hydraulics->stroke.theta_deg.size(), 0U);
}

TEST_F(StrokeFile, IsRefusedInTime) {
  write_own(rated(), false, 36);
  try {
    oil_in_time(with_file(), OilStart());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("[hydraulics] stroke_file"));
  }
  EXPECT_NO_THROW(oil_in_time(rated(), OilStart()));
}

TEST_F(StrokeFile, FaultsAreNamed) {
  using testing::HasSubstr;
  const std::string head = "theta_deg,stroke_mm\n";
  EXPECT_EQ(refusal_of_stroke(head + "0,0\n100,5\n200,-5\n300,0\n"), "");
  EXPECT_THAT(
      refusal_of_stroke("theta_deg,volume_l\n0,1\n"),
      HasSubstr("stroke.csv:1: header must be theta_deg,stroke_mm or theta_deg,volume_cm3"));
  EXPECT_THAT(refusal_of_stroke(head + "0,0\n100,5\n90,5\n300,0\n"),
              HasSubstr("stroke.csv:4: theta_deg = 90: must be > 100"));
  EXPECT_THAT(refusal_of_stroke(head + "0,0\n100,5\n200,5\n360,0\n"),
              HasSubstr("stroke.csv:5: theta_deg = 360: must be < 360"));
  EXPECT_THAT(refusal_of_stroke(head + "0,0\n100,5\n200,5\n"),
              HasSubstr("stroke.csv: has 3 points, must be at least 4"));
  EXPECT_THAT(refusal_of_stroke(head + "0,3\n100,3\n200,3\n300,3\n"), HasSubstr("no stroke"));
  EXPECT_THAT(refusal_of_stroke("theta_deg,volume_cm3\n0,3\n100,0\n200,3\n300,3\n"),
              HasSubstr("stroke.csv:3: volume_cm3 = 0: must be > 0"));
  EXPECT_THAT(refusal({"hydraulics.stroke_file=none.csv"}), HasSubstr("no such file"));
}

// ---- Discharge coefficients of the ports

// Area times coefficient is what counts. Tables: their cubics are linear in the areas, so that all
// that is left is round-off, which the search amplifies to its curves' error.
TEST(Discharge, OfAPortIsAreaTimesCoefficient) {
  const fs::path file = fs::path(BENTAXIS_SOURCE_DIR) / "tests" / "close_points" / "case.toml";
  const Case scaled_areas = read_case(file);
  ASSERT_EQ(scaled_areas.hydraulics->discharge_coefficient, 0.6);
  Case own = read_case(file, {"hydraulics.suction_discharge_coefficient=0.8"});
  for (double& area : own.hydraulics->suction.table.area) area *= 0.6 / 0.8;
  EXPECT_EQ(own.hydraulics->suction.discharge_coefficient, 0.8);
  EXPECT_FALSE(own.hydraulics->delivery.discharge_coefficient);
  const SteadyState a = steady_state(scaled_areas), b = steady_state(own);
  const double allowed = 4 * (a.computed->error + b.computed->error);
  EXPECT_LT(allowed, 1e-5 * a.computed->peak);
  Case half = own;  // the coefficient counts
  half.hydraulics->suction.discharge_coefficient = 0.4;
  const SteadyState c = steady_state(half);
  double worst = 0, other = 0;
  for (double theta = 0; theta < 360; theta += 0.7) {
    worst = std::max(worst, std::abs(a.computed->gauge(theta) - b.computed->gauge(theta)));
    other = std::max(other, std::abs(a.computed->gauge(theta) - c.computed->gauge(theta)));
  }
  EXPECT_LT(worst, allowed);
  EXPECT_GT(other, 1e-3 * a.computed->peak);
}

TEST(Discharge, TheCommonOneOfEachPortIsTheSameToTheBit) {
  const SteadyState a = steady_state(rated());
  const SteadyState b = steady_state(read_case(kCases / "bap63_rated_hydraulic.toml",
                                               {"hydraulics.delivery_discharge_coefficient=0.67",
                                                "hydraulics.suction_discharge_coefficient=0.67"}));
  EXPECT_EQ(a.chamber.pressure, b.chamber.pressure);
  EXPECT_EQ(a.states, b.states);
  EXPECT_THROW(read_case(kCases / "bap63_rated_hydraulic.toml",
                         {"hydraulics.suction_discharge_coefficient=0"}),
               InputError);
}

// Corners as the manual asks for them: a point at the corner and one on each side, close by.
class ClosePoints : public testing::Test {
 protected:
  // Trapezoids of the case in tests/close_points, with points `width` degrees beside the corners.
  static Case with_corners(double width, double inlet_bar) {
    Case the_case =
        read_case(fs::path(BENTAXIS_SOURCE_DIR) / "tests" / "close_points" / "case.toml");
    HydraulicData& h = *the_case.hydraulics;
    for (OpeningTable* table : {&h.delivery.table, &h.suction.table}) {
      constexpr double kAsGiven = 0.02;  // degrees
      for (std::size_t i = 0; i < table->theta_deg.size(); ++i) {
        const std::size_t corner = i / 3 * 3 + 1;
        if (i == corner) continue;
        const double share = width / kAsGiven;
        table->theta_deg[i] =
            table->theta_deg[corner] + share * (table->theta_deg[i] - table->theta_deg[corner]);
        table->area[i] = table->area[corner] + share * (table->area[i] - table->area[corner]);
      }
    }
    the_case.pressure.ports.suction = pascals(inlet_bar) - the_case.hydraulics->atmosphere;
    return the_case;
  }
};

TEST_F(ClosePoints, PressuresAreAsAccurateAsAskedFor) {
  const struct {
    double width, inlet_bar;
  } points[] = {{0.01, 12.111}, {0.02, 5},     {0.02, 17.444},
                {0.02, 20},     {0.03, 8.556}, {0.03, 13.889}};
  for (const auto& [width, inlet_bar] : points) {
    const Case the_case = with_corners(width, inlet_bar);
    const SteadyState state = steady_state(the_case);
    EXPECT_LT(pressure_error(state), the_case.hydraulics->curve_error) << width << " " << inlet_bar;
  }
}

TEST_F(ClosePoints, EveryBendEndsAStep) {
  const Case the_case = with_corners(0.02, 20);
  const HydraulicData& h = *the_case.hydraulics;
  for (const PlatePort* port : {&h.delivery, &h.suction}) {
    // Of the three points of a corner the one on the flat side ends no bend.
    const auto& at = port->table.theta_deg;
    EXPECT_THAT(PortOpening(h, *port, the_case.pump.geometry.bore_circle_radius).edges_deg(),
                testing::Pointwise(
                    testing::DoubleNear(1e-9),
                    std::vector<double>{at[1], at[2], at[3], at[4], at[7], at[8], at[9], at[10]}));
  }
}

// A table of many points that bends slowly costs no restart at each of them; rounding of its
// areas is no bend.
TEST_F(ClosePoints, SmoothTablesEndFewSteps) {
  Case the_case = with_corners(0.02, 20);
  HydraulicData& h = *the_case.hydraulics;
  constexpr int kPoints = 720;
  OpeningTable table;
  for (int i = 0; i < kPoints; ++i) {
    const double theta = 360.0 * i / kPoints;
    table.theta_deg.push_back(theta);
    const double area = 20 * std::max(0.0, std::sin(radians(theta)));  // mm2
    table.area.push_back(std::round(area * 1e6) * 1e-12);
  }
  h.suction.table = table;
  const auto edges =
      PortOpening(h, h.suction, the_case.pump.geometry.bore_circle_radius).edges_deg();
  EXPECT_THAT(edges, testing::Contains(testing::DoubleNear(0, 1e-9)));
  EXPECT_THAT(edges, testing::Contains(testing::DoubleNear(180, 1e-9)));
  EXPECT_LT(edges.size(), 60U);
}

TEST_F(PortFile, FaultsOfATableAreNamed) {
  using testing::HasSubstr;
  const std::string head = "theta_deg,area_mm2\n";
  EXPECT_EQ(refusal_of(head + "0,0\n100,5\n200,5\n"), "");
  EXPECT_THAT(refusal_of("angle,area\n0,1\n"),
              HasSubstr("opening.csv:1: header must be theta_deg"));
  EXPECT_THAT(refusal_of(head + "0,0\n100,-5\n200,5\n"),
              HasSubstr("opening.csv:3: area_mm2 = -5: must be >= 0"));
  EXPECT_THAT(refusal_of(head + "0,0\n100,5\n90,5\n"),
              HasSubstr("opening.csv:4: theta_deg = 90: must be > 100"));
  EXPECT_THAT(refusal_of(head + "0,0\n100,5\n360,0\n"),
              HasSubstr("opening.csv:4: theta_deg = 360: must be < 360"));
  EXPECT_THAT(refusal_of(head + "0,0\n100,x\n360,0\n"),
              HasSubstr("opening.csv:3: area_mm2 = \"x\": must be a finite number"));
  EXPECT_THAT(refusal_of(head + "0,0\n100,5\n"), HasSubstr("at least 3"));
  EXPECT_THAT(refusal_of(head + "0,0\n100,0\n200,0\n"), HasSubstr("must be > 0 somewhere"));
  EXPECT_THAT(refusal({"hydraulics.suction_opening_file=none.csv"}),
              HasSubstr("no such file: " + (folder_ / "none.csv").string()));
  EXPECT_THAT(refusal({"hydraulics.suction_opening_file=."}), HasSubstr("is a directory"));
}

TEST_F(PortFile, ImpossiblePartsAreRefused) {
  using testing::HasSubstr;
  const auto expect = [&](const std::vector<std::string>& changes, const std::string& why) {
    std::vector<std::string> with;
    for (const auto& change : changes) with.push_back("hydraulics." + change);
    EXPECT_THAT(refusal(with), HasSubstr(why)) << changes[0];
  };
  expect({"delivery_groove_area_mm2=1", "delivery_groove_width_mm=1"}, "from < to");
  expect({"delivery_groove_area_mm2=1", "delivery_groove_deg=[170, 190]"}, "must be > 0 where");
  expect({"suction_hole_diameter_mm=8.5"}, "must be <= 8, the smaller side");
  expect({"suction_hole_2_diameter_mm=8.5"}, "must be <= 8, the smaller side");
  expect({"kidney_ends=circular", "suction_arc_deg=[80, 90]"}, "at least 20.8");
  expect({"delivery_trailing_notch_deg=89", "delivery_notch_deg=89"}, "must not exceed 360 deg");
  expect({"cavitation=equilibrium", "vapour_bar=0.9", "case_bar=-0.5"}, "must be < 0.51325");
  expect({"vapour_bar=1.2"}, "[0, 1.01325)");
  expect({"saturation_bar=-1.2"}, "saturation_bar");
  expect({"bulk_modulus_slope=21"}, "20");
}

// ---- Accuracy
// ------------------------------------------------------------------------------------

TEST(Accuracy, StatesBeyondTheLimitAreNotedWithTheWorstAndOthersAreNot) {
  // The kink where air begins to dissolve is never resolved to this limit.
  Case the_case = rated();
  the_case.hydraulics->cavitation = Cavitation::rate;
  the_case.hydraulics->curve_error = 1e-9;
  steady_state(the_case);  // without a log
  EXPECT_EQ(AccuracyLog::record().count, 0U);
  const AccuracyLog log;
  Case less = the_case;
  less.hydraulics->curve_error = 1e-6;
  EXPECT_TRUE(is_accurate(less, steady_state(less)));
  EXPECT_EQ(AccuracyLog::record().count, 0U);
  double worst = 0;
  for (const double bar : {275, 200}) {
    the_case.pressure.ports.delivery = pascals(bar);
    const SteadyState state = steady_state(the_case);
    ASSERT_FALSE(is_accurate(the_case, state)) << bar;
    worst = std::max(worst, state.computed->error / state.computed->peak);
  }
  const AccuracyLog::Record record = AccuracyLog::record();
  EXPECT_EQ(record.count, 2U);
  EXPECT_EQ(record.worst.error, worst);
  EXPECT_EQ(record.worst.limit, 1e-9);
  EXPECT_EQ(record.worst.speed_rpm, the_case.operation.speed_rpm);
  EXPECT_EQ(record.worst.file, the_case.file);
}

// At 175 bar the usual search stops at a jump of its map above its limit; neighbours say what the
// state is.
TEST(OtherSearches, FindTheStateBetweenItsNeighbours) {
  Case the_case =
      read_case(fs::path(BENTAXIS_SOURCE_DIR) / "tests" / "periodic_state" / "case.toml");
  const auto at = [&](double bar) {
    the_case.pressure.ports.delivery = pascals(bar);
    return steady_state(the_case);
  };
  const SteadyState state = at(175), low = at(174.9), high = at(175.1);
  const auto expect_between = [&](double Summary::*value, double relative) {
    EXPECT_NEAR(state.summary.*value, (low.summary.*value + high.summary.*value) / 2,
                relative * std::abs(state.summary.*value));
  };
  expect_between(&Summary::mass_flow, 1e-5);
  expect_between(&Summary::work, 1e-5);
  expect_between(&Summary::chamber_greatest, 1e-4);
  EXPECT_NEAR(state.summary.delivery_mean, pascals(175), 1);
  EXPECT_LT(pressure_error(state), 1e-6);
}

// A start from which no integration gets anywhere, and which alone is tried.
TEST(OtherSearches, AFailureNamesTheOperatingPoint) {
  const Case the_case = rated();
  try {
    steady_state(the_case, Start{pascals(1e6), pascals(1e6), 1e3});
    ADD_FAILURE();
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("bap63_rated_hydraulic.toml: [pressure] "
                                                 "delivery_bar = 275, [operation] speed_rpm = "
                                                 "1500: hydraulics: "));
  }
}

}  // namespace
}  // namespace bentaxis::hydraulics
