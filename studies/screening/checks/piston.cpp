// Pistons.
#include <fmt/format.h>

#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

constexpr double kLightest = 0.06;  // of solid steel: hollow aluminium is a third of it, halved

std::string no_body_has_it(const Facts& f) {
  return fmt::format("not possible for a body of {:.4g} kg in a bore of {:.4g} mm over {:.4g} mm",
                     f.pump.piston.mass, mm(f.bore), mm(f.piston_span));
}
bool has_real_pistons(const Facts& f) { return f.real && f.pump.piston.mass != 0; }

}  // namespace

std::vector<Check> piston() {
  return {
      {"piston-heavier-than-steel",
       "piston mass above a steel cylinder of the bore's diameter and the length b1 + Dpi",
       [](const Facts& f) {
         return outside(f, "piston", "[piston] mass_kg", 0, kSteel * f.area * f.piston_span,
                        fmt::format("a solid steel cylinder of bore {:.4g} mm and length {:.4g} mm",
                                    mm(f.bore), mm(f.piston_span)),
                        {kTenth, kHundredth, kGrams});
       }},
      {"piston-too-light",
       "piston mass below 6 % of that cylinder (a hollow one of aluminium); 0 is an idealisation, "
       "accepted where pressure forces exceed the inertia of a steel piston ten times",
       [](const Facts& f) -> std::string {
         const double steel = kSteel * f.area * f.piston_span;
         const double omega = f.speed * kRadPerSecondPerRpm;
         const double inertia = steel / 3 * f.g.joint_circle_radius * square(omega);
         const double push = f.highest * f.area;
         if (f.pump.piston.mass == 0)
           return push >= 10 * inertia ? ""
                                       : fmt::format(
                                             "[piston] mass_kg = 0 where inertia matters: the "
                                             "inertia force of a steel piston would be {:.3g} N at "
                                             "{:.4g} rpm, the pressure force is {:.3g} N",
                                             inertia, f.speed, push);
         return outside(f, "piston", "[piston] mass_kg", kLightest * steel, HUGE_VAL,
                        "a hollow piston of aluminium weighs this",
                        {kTenfold, {100, "a hundred times too small?"}, kTons});
       }},
      {"piston-centre-of-mass",
       "centre of mass outside 0.1 .. 0.9 b1 from A (lumped: (1 - chi) b1)",
       [](const Facts& f) { return f.pump.piston.mass != 0; },
       [](const Facts& f) {
         const double b1 = mm(f.g.piston_length);
         return f.real ? outside(f, "piston", "[piston] centre_of_mass_mm", 0.1 * b1, 0.9 * b1,
                                 fmt::format("it lies between A and B, {:.4g} mm apart", b1),
                                 {kCentimetres, kTenth, kMetres, kMicrometres, kSign})
                       : implausible(f, "piston", "joint_mass_fraction");
       }},
      {"piston-transverse-inertia",
       "It outside of what a steel body of that mass within bore and length b1 + Dpi can have: of "
       "a "
       "solid disc that fills the bore, and of two masses at the ends",
       has_real_pistons,
       [](const Facts& f) {
         const double m = f.pump.piston.mass;
         const double r = f.bore / 2;
         const double disc = m / (1.1 * kSteel * f.area);
         return outside(f, "piston", "transverse_inertia_kg_mm2",
                        m * (square(r) / 4 + square(disc) / 12) * 1e6,
                        m * (square(f.piston_span / 2) + square(r) / 2) * 1e6, no_body_has_it(f),
                        {kTenth, kTenfold, kKgM2, kGMm2, kHundredth});
       }},
      {"piston-axial-inertia",
       "Ia outside of what a steel body of that mass within bore and length b1 + Dpi can have: of "
       "a "
       "rod of that length, and of a tube on the bore",
       has_real_pistons,
       [](const Facts& f) {
         const double m = f.pump.piston.mass;
         return outside(f, "piston", "[piston] axial_inertia_kg_mm2",
                        m * m / (2 * kPi * 1.1 * kSteel * f.piston_span) * 1e6,
                        m * square(f.bore / 2) * 1e6, no_body_has_it(f), kOfInertia);
       }},
      {"piston-spin", "spin above +-2.5 x speed: shaft and block, which drag it round, turn slower",
       [](const Facts& f) { return f.real; },
       [](const Facts& f) {
         return outside(
             f, "piston", "spin_rpm", -2.5 * f.speed, 2.5 * f.speed,
             fmt::format("shaft and block, which drag the pistons round, turn at {:.4g}", f.speed),
             {kTenth});
       }},
  };
}

}  // namespace bentaxis::study::checks
