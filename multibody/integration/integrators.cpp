#include "integration/integrators.h"

namespace bentaxis::multibody {

std::unique_ptr<SimTK::Integrator> make_integrator(const SimTK::MultibodySystem& system,
                                                   const IntegrationOptions& options) {
  std::unique_ptr<SimTK::Integrator> integrator;
  switch (options.integrator) {
    case Integrator::runge_kutta_merson:
      integrator = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system);
      break;
    case Integrator::runge_kutta_feldberg:
      integrator = std::make_unique<SimTK::RungeKuttaFeldbergIntegrator>(system);
      break;
    case Integrator::runge_kutta_3:
      integrator = std::make_unique<SimTK::RungeKutta3Integrator>(system);
      break;
    case Integrator::verlet:
      integrator = std::make_unique<SimTK::VerletIntegrator>(system);
      break;
    case Integrator::semi_explicit_euler:
      integrator = std::make_unique<SimTK::SemiExplicitEuler2Integrator>(system);
      break;
    case Integrator::cpodes:
      integrator = std::make_unique<SimTK::CPodesIntegrator>(system, SimTK::CPodes::BDF);
      break;
  }
  integrator->setAccuracy(options.accuracy);
  integrator->setConstraintTolerance(options.accuracy / 10);
  // Reports between steps would be interpolated, at the cost of far larger errors.
  integrator->setAllowInterpolation(false);
  return integrator;
}

std::pair<int, int> method_orders(Integrator kind) {
  const SimTK::MultibodySystem nothing;
  const auto integrator = make_integrator(nothing, {kind});
  return {integrator->getMethodMinOrder(), integrator->getMethodMaxOrder()};
}

}  // namespace bentaxis::multibody
