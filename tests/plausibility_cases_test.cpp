// Plausibility of a case: which values are warned of, by the rated pump with one thing changed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "bentaxis/study/comparison.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/timing.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Case shipped(const std::string& name, const std::vector<std::string>& changes) {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / (name + ".toml"),
                   changes);
}

std::vector<std::string> codes_of(const std::vector<study::PlausibilityWarning>& warnings) {
  std::vector<std::string> codes;
  for (const auto& warning : warnings) codes.push_back(warning.code);
  return codes;
}

struct Changed {
  const char* code;
  std::string yes, no;  // changes, with blanks between, that are warned of, and some that are not
};

// On both sides of each limit, as it follows from the rated pump: Ra 24.92, Rd 22, Dpi 22.5, b1 46
// mm, 40 deg, 5 pistons.
const Changed kRated[] = {
    {"pump-size", "pump.joint_circle_radius_mm=3.9", "pump.joint_circle_radius_mm=4.1"},
    {"tilt-in-radians", "pump.tilt_deg=0.7", "pump.tilt_deg=0"},
    {"tilt-beyond-45", "pump.tilt_deg=46.1", "pump.tilt_deg=45.9"},
    {"radii-exchanged", "pump.bore_circle_radius_mm=28", "pump.bore_circle_radius_mm=24"},
    {"bores-overlap", "pump.bore_diameter_mm=25.9", "pump.bore_diameter_mm=25.8"},
    {"bores-touch", "pump.bore_diameter_mm=25.3", "pump.bore_diameter_mm=22.5"},
    {"bore-small", "pump.bore_diameter_mm=12.9", "pump.bore_diameter_mm=13"},
    {"axis-offset", "pump.axis_offset_mm=12.5", "pump.axis_offset_mm=-12.4"},
    {"piston-length", "pump.piston_length_mm=99.7", "pump.piston_length_mm=99.6"},
    {"gear-inside-bores", "gear.pitch_diameter_mm=66.4", "gear.pitch_diameter_mm=66.6"},
    {"gear-large", "gear.pitch_diameter_mm=199.6", "gear.pitch_diameter_mm=199.4"},
    {"pressure-angle", "gear.pressure_angle_deg=9.9", "gear.pressure_angle_deg=0"},
    {"bearing-side", "bearings.tapered_z_mm=-6.2", "bearings.tapered_z_mm=-6.3"},
    {"bearings-exchanged", "bearings.tapered_z_mm=-69", "bearings.tapered_z_mm=-61"},
    {"bearings-close", "bearings.tapered_z_mm=-61.8", "bearings.tapered_z_mm=-61.7"},
    {"bearing-far", "bearings.cylindrical_z_mm=-249.3", "bearings.cylindrical_z_mm=-249.1"},
    {"piston-heavier-than-steel", "piston.mass_kg=0.22", "piston.mass_kg=0.21"},
    {"piston-too-light", "piston.mass_kg=0.0129", "piston.mass_kg=0.0132"},
    {"piston-centre-of-mass", "piston.joint_mass_fraction=0.09", "piston.joint_mass_fraction=0.1"},
    {"shaft-mass", "shaft.mass_kg=0.2", "shaft.mass_kg=0"},
    {"shaft-centre-of-mass", "shaft.centre_of_mass_z_mm=-4.9", "shaft.centre_of_mass_z_mm=-5"},
    {"block-mass", "block.mass_kg=0.3", "block.mass_kg=0"},
    {"block-centre-of-mass", "block.centre_of_mass_z_mm=4.5", "block.centre_of_mass_z_mm=4.7"},
    {"bottom-area", "block.bottom_area_mm2=398", "block.bottom_area_mm2=397"},
    {"torque-factor", "friction.shaft_torque_factor=0.79", "friction.shaft_torque_factor=0.8"},
    {"regularization", "friction.regularization_m_per_s=0.4",
     "friction.regularization_m_per_s=0.39"},
    {"speed-in-rad-per-s", "operation.speed_rpm=157.08", "operation.speed_rpm=160"},
    {"piston-speed", "operation.speed_rpm=9370", "operation.speed_rpm=9350"},
    {"speed-low", "operation.speed_rpm=46", "operation.speed_rpm=0"},
    {"gravity", "operation.gravity_m_per_s2=1.4", "operation.gravity_m_per_s2=0"},
    {"samples", "operation.samples_per_revolution=5", "operation.samples_per_revolution=6"},
    {"samples", "operation.samples_per_revolution=25", "operation.samples_per_revolution=30"},
    {"pressure-beyond-1000-bar", "pressure.delivery_bar=1001", "pressure.delivery_bar=999"},
    {"pressure-low", "pressure.delivery_bar=2.9", "pressure.delivery_bar=0"},
    {"pressure-low", "pressure.delivery_bar=-1.02", "pressure.delivery_bar=-1.01"},
    {"delivery-below-suction", "pressure.suction_bar=276", "pressure.suction_bar=275"},
    {"suction-pressure", "pressure.suction_bar=1.01325", "pressure.suction_bar=1.1"},
    {"transition", "pressure.transition_deg=0.5", "pressure.transition_deg=0"},
    {"pressure-phase", "pressure.delivery_start_deg=0", "pressure.delivery_start_deg=180"},
    {"lands-off-bores", "port_plate.outer_land_mm=[21,22]", "port_plate.outer_land_mm=[21,22.1]"},
    {"port-arc", "port_plate.delivery_arc_deg=[189,218]", "port_plate.delivery_arc_deg=[189,220]"},
    {"port-arcs-overlap", "port_plate.delivery_arc_deg=[167,345]",
     "port_plate.delivery_arc_deg=[168,345]"},
    {"block-lifts-off", "block.bottom_area_mm2=20", "block.bottom_area_mm2=250"},
};

const Changed kHydraulic[] = {
    {"oil-density", "hydraulics.density_kg_per_m3=599", "hydraulics.density_kg_per_m3=601"},
    {"bulk-modulus", "hydraulics.bulk_modulus_MPa=399", "hydraulics.bulk_modulus_MPa=401"},
    {"air-content", "hydraulics.air_percent=16", "hydraulics.air_percent=14"},
    {"kidney", "hydraulics.kidney_width_deg=73", "hydraulics.kidney_width_deg=60"},
    {"notch", "hydraulics.delivery_notch_area_mm2=80", "hydraulics.delivery_notch_area_mm2=0"},
    {"discharge-coefficient", "hydraulics.discharge_coefficient=0.29",
     "hydraulics.discharge_coefficient=0.31"},
    {"dead-volume", "hydraulics.dead_volume_cm3=0.3", "hydraulics.dead_volume_cm3=0.5"},
    {"curve-points", "pressure.points=89", "pressure.points=90"},
};

const Changed kCardan[] = {
    {"cardan-tilt", "pump.tilt_deg=25.1", "pump.tilt_deg=24.9"},
    {"cardan-tilt", "pump.tilt_deg=25.1", "pump.tilt_deg=25.1 transfer.kind=constant_velocity"},
    // Ra 24.92, Rd 24.17 mm, 20 deg: joints are up to 1.5271 mm from the axes of their bores.
    {"piston-touches-bore",
     "transfer.contact_from_joint_mm=23 transfer.stiffness_N_per_um=100 "
     "transfer.clearance_mm=0.763",
     "transfer.contact_from_joint_mm=23 transfer.stiffness_N_per_um=100 "
     "transfer.clearance_mm=0.764"},
};

const Changed kDoubleCardan[] = {
    {"cross-distance", "transfer.cross_distance_mm=1.9", "transfer.cross_distance_mm=2.1"},
    {"cross-distance", "transfer.cross_distance_mm=201",
     "transfer.cross_distance_mm=201 transfer.kind=constant_velocity"},
};

// Seven pistons, w = 12/46: the pistons swing by 0.7605 mm. The piston that carries leaves its wall
// at 20.36 mm/s: 1/49.1 of a m/s. It does so at psi_k = 203 deg, where it stands 30.88 mm out of a
// bore that begins where its joint comes nearest to the block. Both by positions alone, at 3600
// angles. Against the ports' direction other pistons carry; a stroke of 25 deg is shorter.
const Changed kPistons[] = {
    {"wall-clearance", "transfer.clearance_mm=0.763", "transfer.clearance_mm=0.845"},
    {"wall-clearance", "transfer.clearance_mm=1.04", "transfer.clearance_mm=0.98"},
    {"wall-stiffness", "transfer.stiffness_N_per_um=0.9", "transfer.stiffness_N_per_um=1.1"},
    {"wall-stiffness", "transfer.stiffness_N_per_um=5100", "transfer.stiffness_N_per_um=4900"},
    {"wall-damping", "transfer.dissipation_s_per_m=49.6", "transfer.dissipation_s_per_m=48.6"},
    // The clearances keep h/w, and with it the lag at which a piston carries.
    {"wall-contact", "transfer.contact_from_joint_mm=30.7 transfer.clearance_mm=1.0774",
     "transfer.contact_from_joint_mm=31 transfer.clearance_mm=1.05625"},
    {"wall-contact", "transfer.contact_from_joint_mm=24 transfer.clearance_mm=1.55",
     "transfer.contact_from_joint_mm=24 transfer.clearance_mm=0.65 pump.tilt_deg=25 "
     "pump.bore_circle_radius_mm=23.75"},
    {"wall-contact", "piston.contact_mm=33.9", "piston.contact_mm=34.1"},
};

std::vector<std::string> split(const std::string& changes) {
  std::istringstream words(changes);
  return {std::istream_iterator<std::string>(words), {}};
}

void hold(const std::string& name, const Changed& c) {
  EXPECT_THAT(codes_of(study::plausibility(shipped(name, split(c.yes))).warnings), Contains(c.code))
      << c.yes;
  EXPECT_THAT(codes_of(study::plausibility(shipped(name, split(c.no))).warnings),
              Not(Contains(c.code)))
      << c.no;
}

TEST(PlausibilityCases, WarnBeyondALimitAndNotWithinIt) {
  for (const Changed& c : kRated) hold("bap63_rated", c);
  for (const Changed& c : kHydraulic) hold("bap63_rated_hydraulic", c);
  for (const Changed& c : kCardan) hold("bap63_cardan", c);
  for (const Changed& c : kDoubleCardan) hold("bap63_double_cardan", c);
  for (const Changed& c : kPistons) hold("bap63_tapered_pistons", c);
}

TEST(PlausibilityCases, AShippedPumpIsNotWarnedOf) {
  for (const char* name :
       {"bap63_rated", "bap63_rated_hydraulic", "bap63_teeth", "bap63_constant_velocity",
        "bap63_cardan", "bap63_double_cardan", "bap63_tapered_pistons"}) {
    const study::Plausibility found = study::plausibility(shipped(name, {}));
    EXPECT_THAT(codes_of(found.warnings), IsEmpty()) << name;
    EXPECT_THAT(codes_of(found.meant), IsEmpty()) << name;
  }
}

TEST(PlausibilityCases, OilIsNotAskedForWhereItIsUnused) {
  const Case unused = shipped("bap63_rated_hydraulic",
                              {"hydraulics.density_kg_per_m3=500", "pressure.kind=ideal",
                               "pressure.transition_deg=20", "pressure.delivery_start_deg=180"});
  EXPECT_THAT(codes_of(study::plausibility(unused).warnings), Not(Contains("oil-density")));
}

TEST(PlausibilityCases, AStatedReasonMovesAWarning) {
  const Case meant = shipped("bap63_rated", {"gear.pressure_angle_deg=9",
                                             "plausibility.meant=\"pressure-angle: a test\""});
  const study::Plausibility found = study::plausibility(meant);
  EXPECT_THAT(codes_of(found.warnings), IsEmpty());
  ASSERT_THAT(codes_of(found.meant), testing::ElementsAre("pressure-angle"));
  EXPECT_EQ(found.meant[0].reason, "a test");
  EXPECT_EQ(study::stated_reason(meant, "pressure-angle"), "a test");
  EXPECT_EQ(study::stated_reason(meant, "pump-size"), "");
}

TEST(PlausibilityCases, AReasonNeedsACheckAndWords) {
  const auto said = [](const std::string& meant) {
    return refusal([&] {
      study::plausibility(shipped("bap63_rated", {"plausibility.meant=\"" + meant + "\""}));
    });
  };
  EXPECT_THAT(said("no-such-check: why"),
              HasSubstr("\"no-such-check\" is not the code of a check"));
  EXPECT_THAT(said("pump-size"), HasSubstr("\"pump-size\" needs a reason"));
  EXPECT_EQ(said("pump-size: why; below-vapour: why"), "accepted");  // of timing too
  EXPECT_EQ(said(" ; "), "accepted");
}

TEST(PlausibilityCases, AMessageSaysKeyLimitAndWhatMayBeMeant) {
  const auto text = [](const std::string& change) {
    const auto found = study::plausibility(shipped("bap63_rated", {change}));
    return found.warnings.empty() ? "" : found.warnings[0].text;
  };
  EXPECT_EQ(
      text("pump.joint_circle_radius_mm=0.02492"),
      "joint_circle_radius_mm = 0.02492 is below 4 mm: no pump is of this size; in metres? 24.92 "
      "would do");
  EXPECT_EQ(text("bearings.tapered_z_mm=26"),
            "tapered_z_mm = 26 is above -6.23 mm: the shaft extends from the joints towards "
            "-z1, the pistons towards +z1; with the other sign? -26 would do");
  // Nothing usual explains it.
  EXPECT_THAT(text("gear.pressure_angle_deg=36"), Not(HasSubstr("would do")));
}

std::string text_of(const Case& the_case, const std::string& code) {
  for (const auto& warning : study::plausibility(the_case).warnings)
    if (warning.code == code) return warning.text;
  return "";
}

// A warning before the run and the limit of validity after it are one fact.
TEST(PlausibilityCases, AnAngleOfTheTurnIsThatOfTheComparison) {
  for (const char* samples : {"50", "360"}) {
    const Case lifted =
        shipped("bap63_rated", {"block.bottom_area_mm2=1", "pressure.transition_deg=7",
                                "operation.samples_per_revolution=" + std::string(samples)});
    const auto limits = study::compare_models(lifted, {}, {}).limits;
    const auto film = std::find_if(limits.begin(), limits.end(),
                                   [](const auto& limit) { return limit.key == "film"; });
    ASSERT_NE(film, limits.end());
    EXPECT_THAT(text_of(lifted, "block-lifts-off"),
                testing::StartsWith(fmt::format(
                    "the block lifts off its plate in {:.3g} % of the turn, worst {:.4g} N at "
                    "{:.4g} deg",
                    100 * film->violated_share, film->worst, film->theta_deg)));
  }
}

TEST(PlausibilityCases, APressureThatIsNotYetComputedIsSaidToBeIdeal) {
  EXPECT_THAT(
      text_of(shipped("bap63_rated_hydraulic", {"block.bottom_area_mm2=1"}), "block-lifts-off"),
      testing::StartsWith("with an ideal pressure trace the block lifts off"));
}

TEST(PlausibilityCases, EveryCodeIsOneAndIsInTheListForPeople) {
  std::vector<std::string> codes = study::plausibility_codes();
  const std::string table = study::plausibility_markdown();
  for (const std::string& code : codes) EXPECT_THAT(table, HasSubstr("| `" + code + "` | "));
  for (const Changed& c : kRated) EXPECT_THAT(codes, Contains(c.code));
  for (const Changed& c : kPistons) EXPECT_THAT(codes, Contains(c.code));
  std::sort(codes.begin(), codes.end());
  EXPECT_EQ(std::adjacent_find(codes.begin(), codes.end()), codes.end());
  for (const std::string& code : study::timing_codes()) EXPECT_THAT(codes, Not(Contains(code)));
}

}  // namespace
}  // namespace bentaxis::test
