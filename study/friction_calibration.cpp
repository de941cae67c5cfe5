#include "bentaxis/study/friction_calibration.h"

#include <fmt/format.h>

#include <cstdlib>

#include "bentaxis/pump/error.h"
#include "bentaxis/study/operating_points.h"

namespace bentaxis::study {
namespace {

constexpr int kSteps = 4;

double six_digits(double value) {
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

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
  ReadyCase ready = prepare(the_case, progress_of);
  std::vector<FrictionStep> steps;
  for (int i = 0; i < kSteps; ++i) {
    ready.the_case.pump.friction = friction;
    const MeanTorques torques{mean(run_turn(ready, Model::analytic, progress_of), "Td_z1_Nm"),
                              mean(run_turn(ready, Model::multibody, progress_of), "Td_z1_Nm")};
    steps.push_back({friction.piston_coulomb, friction.shaft_torque_factor, torques});
    const double factor =
        friction.shaft_torque_factor * torques.without_friction / wanted.without_friction;
    if (!(factor > 0 && factor <= 1))
      throw InputError(fmt::format("{}: shaft_torque_factor would be {:.6g}: outside (0, 1]",
                                   the_case.file.string(), factor));
    const double coulomb =
        friction.piston_coulomb * (wanted.with_friction - wanted.without_friction) * factor /
        ((torques.with_friction - torques.without_friction) * friction.shaft_torque_factor);
    friction.piston_coulomb = six_digits(coulomb);
    friction.shaft_torque_factor = six_digits(factor);
  }
  return steps;
}

}  // namespace bentaxis::study
