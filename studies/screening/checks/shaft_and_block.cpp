// Shaft and block.
#include <fmt/format.h>

#include <algorithm>

#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

bool has_shaft_mass(const Facts& f) { return f.pump.shaft.mass != 0; }
bool has_block_mass(const Facts& f) { return f.pump.block.mass != 0; }

const Slips kOfLength = {kSign, kTenfold, kTenth, kMetres, kMicrometres};
const Slips kOfMass = {kTenth, kTenfold, kGrams, kTons};

}  // namespace

std::vector<Check> shaft_and_block() {
  return {
      {"shaft-mass",
       "shaft mass outside 0.12 .. 4 times a steel cylinder of radius Ra + Dpi/2 to the farther "
       "bearing; 0 is an idealisation and accepted",
       has_shaft_mass,
       [](const Facts& f) {
         const double size =
             kSteel * kPi * square(f.g.joint_circle_radius + f.bore / 2) * f.shaft_reach;
         return outside(
             f, "shaft", "[shaft] mass_kg", 0.12 * size, 4 * size,
             fmt::format("a steel cylinder around joints and bearings weighs {:.3g} kg", size),
             kOfMass);
       }},
      {"shaft-centre-of-mass",
       "shaft's centre of mass at z1 > -Ra/5, or farther than twice the farther bearing",
       has_shaft_mass,
       [](const Facts& f) {
         return outside(f, "shaft", "[shaft] centre_of_mass_z_mm", -2 * mm(f.shaft_reach),
                        -mm(f.g.joint_circle_radius) / 5,
                        "the shaft reaches from the joints past its bearings, along -z1",
                        {kSign, kTenth, kMetres, kMicrometres});
       }},
      {"shaft-inertia",
       "I_s of a shaft: below a steel rod of that mass to the farther bearing, or above m (2.5 "
       "Ra)2",
       [](const Facts& f) {
         return has_shaft_mass(f) && !f.defaulted("shaft", "axial_inertia_kg_mm2");
       },
       [](const Facts& f) {
         const double m = f.pump.shaft.mass, ra = f.g.joint_circle_radius;
         return outside(f, "shaft", "[shaft] axial_inertia_kg_mm2",
                        m * m / (2 * kPi * kSteel * (2 * f.shaft_reach + ra)) * 1e6,
                        m * square(2.5 * ra) * 1e6,
                        fmt::format("not possible for a shaft of {:.4g} kg and this size", m),
                        kOfInertia);
       }},
      {"block-mass",
       "block mass outside 0.1 .. 1.2 times a steel cylinder of radius Rd + Dpi and length b1 + "
       "stroke; 0 is an idealisation and accepted",
       has_block_mass,
       [](const Facts& f) {
         const double size =
             kSteel * kPi * square(f.g.bore_circle_radius + f.bore) * f.block_length;
         return outside(f, "block", "[block] mass_kg", 0.1 * size, 1.2 * size,
                        fmt::format("a steel cylinder around the bores weighs {:.3g} kg", size),
                        kOfMass);
       }},
      {"block-centre-of-mass", "block's centre of mass at z2 < b1/10 or > b1 + stroke + Dpi",
       has_block_mass,
       [](const Facts& f) {
         return outside(f, "block", "[block] centre_of_mass_z_mm", mm(f.g.piston_length) / 10,
                        mm(f.block_length + f.bore),
                        "the block is around the piston heads, along +z2", kOfLength);
       }},
      {"block-inertia",
       "I_c of a block: below a steel rod of that mass and the block's length, or above m (Rd + "
       "Dpi)2",
       [](const Facts& f) {
         return has_block_mass(f) && !f.defaulted("block", "axial_inertia_kg_mm2");
       },
       [](const Facts& f) {
         const double m = f.pump.block.mass;
         return outside(f, "block", "[block] axial_inertia_kg_mm2",
                        m * m / (2 * kPi * kSteel * f.block_length) * 1e6,
                        m * square(f.g.bore_circle_radius + f.bore) * 1e6,
                        fmt::format("not possible for a block of {:.4g} kg and this size", m),
                        kOfInertia);
       }},
      {"pin-position",
       "pin at z2 < 0.15 (b1 + stroke), or > b1 + stroke + 2 Dpi: outside the block",
       [](const Facts& f) {
         return outside(f, "block", "pin_z_mm", 0.15 * mm(f.block_length),
                        mm(f.block_length + 2 * f.bore),
                        "the pin meets the block inside of it, along +z2", kOfLength);
       }},
      {"bottom-area", "Ac above the area of a bore, or 0 < Ac below a twentieth of it",
       [](const Facts& f) { return f.pump.block.bottom_area != 0; },
       [](const Facts& f) {
         const double area = mm2(f.area);
         return outside(f, "block", "bottom_area_mm2", area / 20, area,
                        fmt::format("it is a part of each bore's {:.4g} mm2", area),
                        {kTenth,
                         kTenfold,
                         kSquareCm,
                         kHundredth,
                         kSquareM,
                         {1. / f.g.pistons, "of all bores?"}});
       }},
      {"spring-force",
       "spring above the force of a coil spring between the bores at 1000 MPa, or below a tenth of "
       "the block's weight; 0 is an idealisation and accepted",
       [](const Facts& f) { return f.pump.block.spring_force != 0; },
       [](const Facts& f) {
         // Of outer radius r and index 4: wire 2 r/5, mean diameter 8 r/5; F = pi d^3 tau / (8 D).
         const double r =
             std::max(f.g.bore_circle_radius - f.bore / 2, 0.1 * f.g.bore_circle_radius);
         const double most = kPi * 0.005 * square(r) * kYield;
         const double weight = f.pump.block.mass * 9.81;
         return outside(
             f, "block", "spring_force_N", std::min(0.1 * weight, most), most,
             fmt::format("a coil spring of {:.3g} mm between the bores has at most {:.3g} "
                         "N, the block weighs {:.3g} N",
                         2 * mm(r), most, weight),
             {kTenth, kTenfold, {1e3, "in kN?"}, kThousandth});
       }},
  };
}

}  // namespace bentaxis::study::checks
