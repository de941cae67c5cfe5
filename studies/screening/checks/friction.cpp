// Friction.
#include <fmt/format.h>

#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

// What an input in Nm/rpm takes of the torque, where that is more than a share of the ideal one.
std::string viscous_torque(const Facts& f, const char* key, double coefficient, double share,
                           const char* share_in_words) {
  const double torque = coefficient * f.speed * kRadPerSecondPerRpm;
  if (torque <= share * f.full_torque) return "";
  return fmt::format(
      "{} = {:.4g} takes {:.4g} Nm at {:.6g} rpm, above {} of {:.4g} Nm; in Nm s/rad it would be "
      "{:.4g} Nm",
      key, coefficient * kRadPerSecondPerRpm, torque, f.speed, share_in_words, f.full_torque,
      torque * kRadPerSecondPerRpm);
}

}  // namespace

std::vector<Check> friction() {
  return {
      {"piston-friction",
       "Fc + cv v above a tenth of the pressure force on a piston (at 100 bar at least)",
       [](const Facts& f) -> std::string {
         const double v = f.speed * kRadPerSecondPerRpm * f.derived.stroke / 2;
         const double friction =
             f.pump.friction.piston_coulomb + f.pump.friction.piston_viscous * v;
         const double force = f.load * f.area;
         if (friction <= 0.1 * force) return "";
         return fmt::format(
             "piston_coulomb_N = {:.6g} and piston_viscous_N_s_per_m = {:.6g} make {:.4g} N of "
             "friction on a piston that {:.4g} bar push with {:.4g} N: more than a tenth would be "
             "lost",
             f.pump.friction.piston_coulomb, f.pump.friction.piston_viscous, friction, bar(f.load),
             force);
       }},
      {"block-viscous-torque",
       "Cc n above a tenth of N A 2 Ra p/(2 pi), with p of 100 bar at least",
       [](const Facts& f) {
         return viscous_torque(f, "block_viscous_Nm_per_rpm", f.pump.friction.block_viscous, 0.1,
                               "a tenth");
       }},
      {"shaft-viscous-torque", "Cs n above 3 % of that torque",
       [](const Facts& f) {
         return viscous_torque(f, "shaft_viscous_Nm_per_rpm", f.pump.friction.shaft_viscous, 0.03,
                               "3 %");
       }},
      {"torque-factor", "Ct below 0.8: the loss instead of what is left, or per cent",
       [](const Facts& f) { return f.pump.friction.shaft_torque_factor < 0.8; },
       [](const Facts& f) {
         const double ct = f.pump.friction.shaft_torque_factor;
         return fmt::format(
             "shaft_torque_factor = {:.6g} is below 0.8: {:.3g} % of the drive torque would be "
             "lost "
             "(1 is no loss)",
             ct, 100 * (1 - ct));
       }},
      {"regularization",
       "v_reg above a tenth of the joints' speed omega Ra: Coulomb friction does not reach its "
       "full "
       "value",
       [](const Facts& f) { return f.pump.friction.piston_coulomb != 0 && f.speed != 0; },
       [](const Facts& f) {
         return outside(
             f, "friction", "regularization_m_per_s", 0,
             f.speed * kRadPerSecondPerRpm * f.g.joint_circle_radius / 10,
             "a tenth of the speed of the joints: Coulomb friction would not reach its full value",
             {{1e-3, "in mm/s?"}, kTenth});
       }},
  };
}

}  // namespace bentaxis::study::checks
