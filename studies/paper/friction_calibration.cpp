#include "bentaxis/study/friction_calibration.h"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/operating_points.h"

namespace bentaxis::study {
namespace {

constexpr int kSteps = 4;
constexpr double kFound = 1e-5;  // of the wanted torques: both parameters are found to six digits

}  // namespace

std::vector<FrictionStep> calibrate_friction(Case the_case, const MeanTorques& wanted,
                                             const PartProgress& progress_of) {
  Friction& friction = the_case.pump.friction;
  if (!(friction.piston_coulomb > 0))
    throw InputError(the_case.file.string() +
                     ": [friction] piston_coulomb_N = 0: must be > 0 to start from");
  the_case.analytic.piston_friction = true;
  the_case.multibody.piston_friction = false;
  // The pressure does not depend on friction: it is computed once.
  PreparedCase ready = prepare(the_case, progress_of);
  const std::string file = the_case.file.string();
  // What viscous friction adds, Nm times the factor: all the rest is in proportion to Fc.
  double viscous = 0;
  std::vector<FrictionStep> steps;
  for (int i = 0; i < kSteps; ++i) {
    ready.the_case.pump.friction = friction;
    const MeanTorques torques{mean(run_turn(ready, Model::analytic, progress_of), "Td_z1_Nm"),
                              mean(run_turn(ready, Model::multibody, progress_of), "Td_z1_Nm")};
    steps.push_back({friction.piston_coulomb, friction.shaft_torque_factor, torques});
    if (i == 0 && friction.piston_viscous > 0) {
      ready.the_case.pump.friction.piston_coulomb = 0;
      viscous = (mean(run_turn(ready, Model::analytic, progress_of), "Td_z1_Nm") -
                 torques.without_friction) *
                friction.shaft_torque_factor;
    }
    const double factor =
        friction.shaft_torque_factor * torques.without_friction / wanted.without_friction;
    if (!(factor > 0 && factor <= 1))
      throw InputError(
          fmt::format("{}: shaft_torque_factor would be {:.6g}: outside (0, 1]", file, factor));
    const double wanted_here = (wanted.with_friction - wanted.without_friction) * factor - viscous;
    const double here =
        (torques.with_friction - torques.without_friction) * friction.shaft_torque_factor - viscous;
    const double coulomb = friction.piston_coulomb * wanted_here / here;
    if (!(coulomb > 0))
      throw InputError(fmt::format(
          "{}: piston_coulomb_N would be {:.6g}: must be > 0. Piston friction is to add {:g} Nm to "
          "the "
          "mean torque; its viscous part (piston_viscous_N_s_per_m) alone adds {:.4g} Nm",
          file, coulomb, wanted.with_friction - wanted.without_friction, viscous / factor));
    friction.piston_coulomb = rounded(coulomb, 6);
    friction.shaft_torque_factor = rounded(factor, 6);
  }
  const MeanTorques& last = steps.back().torques;
  for (const auto& [name, found, asked] :
       {std::tuple{"with", last.with_friction, wanted.with_friction},
        {"without", last.without_friction, wanted.without_friction}})
    if (!(std::abs(found - asked) <= kFound * std::abs(asked)))
      throw ComputationError(fmt::format(
          "{}: calibration: after {} steps the mean torque {} piston friction is {:.6g} Nm instead "
          "of {:g} Nm: it is not in proportion to piston_coulomb_N",
          file, kSteps, name, found, asked));
  return steps;
}

}  // namespace bentaxis::study
