#include "bentaxis/multibody/model.h"

#include <chrono>
#include <cmath>
#include <limits>

#include "bentaxis/multibody/pump_system.h"
#include "bentaxis/multibody/reactions.h"
#include "bentaxis/multibody/solver_guard.h"
#include "bentaxis/multibody/versions.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::multibody {

using SimTK::Stage;

struct Model::Implementation {
  Implementation(const PumpParameters& pump, const Assumptions& assumptions, double omega_sign)
      : layout(pump.geometry.pistons),
        system(pump, assumptions, omega_sign, Drive::given_acceleration) {
    system.inputs().chamber_pressure = [this](double, std::vector<double>& p) { p = pressure; };
  }

  void evaluate(const Instant& instant, std::vector<double>& values);

  ChannelLayout layout;
  PumpSystem system;
  std::vector<double> pressure;
  PumpSystem::Rank rank;
  double sign = 0;
};

Model::Model(const PumpParameters& pump, const Assumptions& assumptions, double omega_sign) {
  translate_simbody_errors(
      [&] { implementation_ = std::make_unique<Implementation>(pump, assumptions, omega_sign); });
  implementation_->sign = omega_sign < 0 ? -1 : 1;
}
Model::~Model() = default;
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model&&) noexcept = default;

const ChannelLayout& Model::layout() const { return implementation_->layout; }

void Model::evaluate(const Instant& instant, std::vector<double>& values) {
  Implementation& self = *implementation_;
  PumpSystem& system = self.system;
  if (instant.omega * self.sign < 0)
    throw InputError("multibody model: built for the other direction of rotation");
  if (instant.omega_dot != 0 &&
      !(system.pump().shaft.axial_inertia > 0 && system.pump().block.axial_inertia > 0))
    throw InputError("multibody model: changing speed needs axial inertias above 0");
  self.pressure = instant.chamber_pressure;
  system.inputs().ports = instant.ports;
  // At standstill the pistons' velocities are round-off of the projection, with any sign.
  system.inputs().rest_speed = instant.omega == 0
                                   ? std::numeric_limits<double>::infinity()
                                   : piston_rest_speed(system.pump().geometry, instant.omega);

  translate_simbody_errors([&] { self.evaluate(instant, values); });
}

void Model::Implementation::evaluate(const Instant& instant, std::vector<double>& values) {
  SimTK::State& state = system.dynamics();
  system.assemble(instant.theta, instant.omega);
  system.copy_assembly_to_dynamics();
  // At standstill the power balance is taken with a virtual turn of 1 rad/s.
  const double rate_omega = instant.omega != 0 ? instant.omega : 1;
  if (instant.omega == 0) system.assemble(instant.theta, rate_omega);
  system.set_acceleration(state, instant.omega_dot);
  system.system().realize(state, Stage::Acceleration);

  if (rank.equations == 0) {
    rank = system.constraint_rank(state);
    if (rank.rank < rank.equations)
      throw ComputationError("multibody model: " + std::to_string(rank.equations) +
                             " constraint equations have rank " + std::to_string(rank.rank) +
                             ": reactions cannot be told apart");
  }
  require_accurate_forces(system, state, instant.theta);
  read_channels(system, state, {system.assembly(), rate_omega}, instant.omega_dot, pressure, layout,
                values);
}

std::vector<std::pair<std::string, std::string>> scene_facts(const PumpParameters& pump,
                                                             const Assumptions& assumptions) {
  const bool mesh = assumptions.gear == GearScene::mesh;
  const int n = pump.geometry.pistons;
  return {
      {"method", "multibody, Simbody " + simbody_version()},
      {"scene", std::string("full pump, gear ") +
                    (mesh ? "in mesh (tooth force along z4 at O4)"
                          : "replaced by a speed imposed on the block's joint")},
      {"bodies", std::to_string(n + 2) + " (shaft, block, " + std::to_string(n) + " pistons)"},
      {"joints", "shaft spherical at C1, block pin about z2, pistons spherical at A to the shaft"},
      {"constraints",
       std::string("cylindrical bearing inline at C2 (2), speed of the shaft (1), ") +
           (mesh ? "gear (1), " : "") + "B on its bore axis (2 per piston)"}};
}

Provenance Model::provenance() const {
  const Implementation& self = *implementation_;
  Provenance provenance;
  provenance.facts = scene_facts(self.system.pump(), self.system.assumptions());
  auto& facts = provenance.facts;
  facts.insert(facts.begin() + 1,
               {"way",
                "driven: assembled at each angle by projection, accelerations and reactions "
                "solved, no time integration"});
  facts.emplace_back("mobilities", std::to_string(self.rank.mobilities));
  facts.emplace_back("constraint equations", std::to_string(self.rank.equations));
  facts.emplace_back("rank of the constraint matrix", std::to_string(self.rank.rank));
  return provenance;
}

ResultTable run_driven(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                       const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  Model model(the_case.pump, assumptions, samples.omega);
  ResultTable table = tabulate(
      "multibody", model.layout(), samples,
      [&](const Instant& instant, std::vector<double>& row) { model.evaluate(instant, row); },
      progress);
  table.provenance = model.provenance();
  table.provenance.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return table;
}

}  // namespace bentaxis::multibody
