#include "bentaxis/multibody/model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bentaxis/multibody/versions.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"
#include "pump_system.h"
#include "reactions.h"
#include "solver_guard.h"

namespace bentaxis::multibody {

using SimTK::Stage;

namespace {

Drive drive_of(Scene scene) {
  return scene == Scene::full ? Drive::given_acceleration : Drive::prescribed;
}

// The one-piston scene is the scene of a pump with one piston.
PumpParameters built_pump(const PumpParameters& pump, Scene scene) {
  PumpParameters built = pump;
  if (scene == Scene::piston) built.geometry.pistons = 1;
  return built;
}

}  // namespace

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names = {"full", "pistons", "piston"};
  return names;
}

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = {"multipliers", "residual"};
  return names;
}

bool computes(Scene scene, const Channel& channel) {
  return scene == Scene::full || channel.piston > 0;
}

Scene smallest_scene(const std::vector<Channel>& channels) {
  const bool of_pistons = std::all_of(channels.begin(), channels.end(), [](const Channel& channel) {
    return computes(Scene::piston, channel);
  });
  return of_pistons ? Scene::piston : Scene::full;
}

struct Model::Implementation {
  Implementation(const PumpParameters& pump, const Assumptions& assumptions, double omega_sign,
                 Scene the_scene, Method the_method)
      : layout(validate(pump).geometry.pistons),
        scene(the_scene),
        method(the_method),
        parameters(pump),
        system(built_pump(pump, the_scene), assumptions, omega_sign, drive_of(the_scene)),
        residual(system),
        sign(omega_sign < 0 ? -1 : 1) {
    system.inputs().chamber_pressure = [this](double, std::vector<double>& p) { p = pressure; };
    if (method == Method::multipliers) system.require_piston_inertia();
  }

  void check(const Instant& instant) const;
  void require_sizes(const Instant& instant, const std::vector<double>& values) const;
  void evaluate(const Instant& instant, std::vector<double>& values);
  void place_and_solve(double theta, const Instant& instant);
  void check_rank();

  ChannelLayout layout;
  Scene scene;
  Method method;
  PumpParameters parameters;
  PumpSystem system;
  ResidualSolver residual;
  Reactions reactions;
  Reactions by_inverse_dynamics;  // what the multipliers are held to
  std::vector<double> pressure;
  PumpSystem::Rank rank;
  long placements = 0;
  double sign;
};

Model::Model(const PumpParameters& pump, const Assumptions& assumptions, double omega_sign,
             Scene scene, Method method) {
  translate_simbody_errors([&] {
    implementation_ =
        std::make_unique<Implementation>(pump, assumptions, omega_sign, scene, method);
  });
}
Model::~Model() = default;
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model&&) noexcept = default;

const ChannelLayout& Model::layout() const { return implementation_->layout; }

void Model::Implementation::check(const Instant& instant) const {
  require_locked(instant, "multibody");
  if (scene != Scene::full) return;
  if (instant.shaft.speed * sign < 0)
    throw InputError("multibody model: built for the other direction of rotation");
  if (instant.shaft.acceleration != 0 &&
      !(system.pump().shaft.axial_inertia > 0 && system.pump().block.axial_inertia > 0))
    throw InputError("multibody model: changing speed needs axial inertias above 0");
}

void Model::Implementation::require_sizes(const Instant& instant,
                                          const std::vector<double>& values) const {
  if (instant.chamber_pressure.size() != static_cast<std::size_t>(layout.pistons()))
    throw InputError("multibody model: " + std::to_string(instant.chamber_pressure.size()) +
                     " chamber pressures for " + std::to_string(layout.pistons()) + " pistons");
  if (values.size() < layout.size())
    throw InputError("multibody model: room for " + std::to_string(values.size()) +
                     " values, needed are " + std::to_string(layout.size()));
}

void Model::Implementation::check_rank() {
  if (rank.equations > 0) return;
  rank = system.constraint_rank(system.dynamics());
  if (rank.rank < rank.equations)
    throw ComputationError("multibody model: " + std::to_string(rank.equations) +
                           " constraint equations have rank " + std::to_string(rank.rank) +
                           ": reactions cannot be told apart");
}

// Finds the reactions at an angle under the pressures in `pressure`.
void Model::Implementation::place_and_solve(double theta, const Instant& instant) {
  system.inputs().ports = instant.ports;
  // At standstill the pistons' velocities are round-off of the projection, with any sign.
  system.inputs().rest_speed = instant.shaft.speed == 0
                                   ? std::numeric_limits<double>::infinity()
                                   : piston_rest_speed(system.pump().geometry, instant.shaft.speed);
  ++placements;
  system.place(theta, instant.shaft.speed, instant.shaft.acceleration);
  SimTK::State& state = system.dynamics();
  if (method == Method::multipliers) {
    if (scene == Scene::full) system.set_acceleration(state, instant.shaft.acceleration);
    system.system().realize(state, Stage::Acceleration);
    check_rank();
    reactions_from_multipliers(system, state, reactions);
    residual.solve(by_inverse_dynamics);
    require_accurate_forces(force_difference(system, reactions, by_inverse_dynamics), theta);
  } else {
    residual.solve(reactions);
    check_rank();
  }
}

void Model::Implementation::evaluate(const Instant& instant, std::vector<double>& values) {
  check(instant);
  const int n = layout.pistons();
  if (scene == Scene::piston) {
    for (int k = 0; k < n; ++k) {
      pressure.assign(1, instant.chamber_pressure[k]);
      place_and_solve(instant.shaft.angle - 2 * kPi * k / n, instant);
      read_piston_channels(system, reactions, 0, k, instant.chamber_pressure[k], layout, values);
    }
    return;
  }
  pressure = instant.chamber_pressure;
  place_and_solve(instant.shaft.angle, instant);
  const SimTK::State& state = system.dynamics();
  for (int k = 0; k < n; ++k)
    read_piston_channels(system, reactions, k, k, instant.chamber_pressure[k], layout, values);
  if (scene != Scene::full) return;
  // At standstill the power balance is taken with a virtual turn of 1 rad/s.
  if (instant.shaft.speed == 0) system.assemble(instant.shaft.angle, 1);
  const WorkRate rate = instant.shaft.speed == 0 ? WorkRate{system.assembly(), 1}
                                                 : WorkRate{state, instant.shaft.speed};
  read_pump_channels(system, state, reactions, rate, instant.shaft.acceleration, pressure, layout,
                     values);
}

void Model::evaluate(const Instant& instant, std::vector<double>& values) {
  implementation_->require_sizes(instant, values);
  translate_simbody_errors([&] { implementation_->evaluate(instant, values); });
}

void Model::evaluate_one(const Instant& instant, std::vector<double>& values) {
  Implementation& self = *implementation_;
  if (self.scene != Scene::piston)
    throw std::logic_error("evaluate_one() is of the one-piston scene");
  self.require_sizes(instant, values);
  translate_simbody_errors([&] {
    self.check(instant);
    self.pressure.assign(1, instant.chamber_pressure[0]);
    self.place_and_solve(instant.shaft.angle, instant);
    read_piston_channels(self.system, self.reactions, 0, 0, instant.chamber_pressure[0],
                         self.layout, values);
  });
}

std::vector<std::pair<std::string, std::string>> scene_facts(const PumpParameters& pump,
                                                             const Assumptions& assumptions,
                                                             Scene scene) {
  const bool mesh = assumptions.gear == GearScene::mesh;
  const int n = scene == Scene::piston ? 1 : pump.geometry.pistons;
  const std::string pistons = n == 1 ? "1 piston" : std::to_string(n) + " pistons";
  const std::string bodies = std::to_string(n + 2) + " (shaft, block, " + pistons + ")";
  if (scene != Scene::full)
    return {{"method", "multibody, Simbody " + simbody_version()},
            {"scene", scene == Scene::pistons ? "pistons; shaft and block move as prescribed"
                                              : "one piston; shaft and block move as prescribed"},
            {"bodies", bodies},
            {"joints", "pistons spherical at A to the shaft"},
            {"constraints", "B on its bore axis (2 per piston)"}};
  return {
      {"method", "multibody, Simbody " + simbody_version()},
      {"scene", std::string("full pump, gear ") +
                    (mesh ? "in mesh (tooth force along z4 at O4)"
                          : "replaced by a speed imposed on the block's joint")},
      {"bodies", bodies},
      {"joints", "shaft spherical at C1, block pin about z2, pistons spherical at A to the shaft"},
      {"constraints",
       std::string("cylindrical bearing inline at C2 (2), speed of the shaft (1), ") +
           (mesh ? "gear (1), " : "") + "B on its bore axis (2 per piston)"}};
}

SceneSize scene_size(const PumpParameters& pump, const Assumptions& assumptions, Scene scene) {
  const PumpSystem system(built_pump(validate(pump), scene), assumptions, 1, drive_of(scene));
  const SimTK::State& state = system.dynamics();
  SceneSize size;
  size.bodies = system.matter().getNumBodies() - 1;  // without Ground
  size.mobilities = state.getNU();
  size.equations = state.getNMultipliers();
  return size;
}

Provenance Model::provenance() const {
  const Implementation& self = *implementation_;
  Provenance provenance;
  provenance.facts = scene_facts(self.parameters, self.system.assumptions(), self.scene);
  auto& facts = provenance.facts;
  facts.insert(
      facts.begin() + 1,
      {"way",
       "driven: pistons placed at each angle until the constraint equations hold to round-off, " +
           std::string(self.method == Method::multipliers
                           ? "accelerations and reactions solved together"
                           : "accelerations too, reactions by inverse dynamics") +
           ", no time integration"});
  facts.emplace_back("mobilities", std::to_string(self.rank.mobilities));
  facts.emplace_back("constraint equations", std::to_string(self.rank.equations));
  facts.emplace_back("rank of the constraint matrix", std::to_string(self.rank.rank));
  const auto& simbody = self.system.system();
  const auto per_angle = [&](Stage stage) {
    return number_text(std::round(100.0 * simbody.getNumRealizationsOfThisStage(stage) /
                                  static_cast<double>(std::max(self.placements, 1L))) /
                       100);
  };
  facts.emplace_back("realizations per angle", "positions " + per_angle(Stage::Position) +
                                                   ", velocities " + per_angle(Stage::Velocity) +
                                                   ", accelerations " +
                                                   per_angle(Stage::Acceleration));
  return provenance;
}

namespace {

// Row of the samples at which piston 1 stands where piston k + 1 stands in `row`.
std::size_t row_of_piston_one(std::size_t row, int k, std::size_t rows, int pistons) {
  return (row + rows - rows / pistons * k) % rows;
}

// Pressures that differ by less than this share of the largest are equal but for the rounding of
// the angle they were evaluated at.
constexpr double kSamePressure = 1e-13;

// Does every piston see, at each of its angles, the pressure that piston 1 sees there? Then piston
// 1 stands for all.
bool one_stands_for_all(const Samples& samples) {
  const std::size_t rows = samples.theta_deg.size();
  const int n = samples.pistons;
  if (rows == 0 || rows % n != 0) return false;
  double largest = 0;
  for (const double pressure : samples.chamber_pressure)
    largest = std::max(largest, std::abs(pressure));
  for (std::size_t row = 0; row < rows; ++row) {
    const double angle = 360.0 * static_cast<double>(row) / static_cast<double>(rows);
    if (std::abs(samples.theta_deg[row] - angle) > 1e-9) return false;
    for (int k = 1; k < n; ++k)
      if (std::abs(samples.chamber_pressure[row * n + k] -
                   samples.chamber_pressure[row_of_piston_one(row, k, rows, n) * n]) >
          kSamePressure * largest)
        return false;
  }
  return true;
}

}  // namespace

ResultTable run_driven(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                       const Progress& progress, Scene scene, Method method) {
  const auto start = std::chrono::steady_clock::now();
  validate(the_case);
  if (samples.pistons != the_case.pump.geometry.pistons)
    throw InputError("driven run: samples of " + std::to_string(samples.pistons) +
                     " pistons for a pump with " + std::to_string(the_case.pump.geometry.pistons));
  Model model(the_case.pump, assumptions, samples.omega, scene, method);
  const bool shared = scene == Scene::piston && one_stands_for_all(samples);
  std::vector<std::vector<double>> of_one;
  if (shared) {
    Instant instant;
    for (std::size_t row = 0; row < samples.theta_deg.size(); ++row) {
      samples.instant(row, instant);
      of_one.emplace_back(model.layout().size(), not_computed());
      model.evaluate_one(instant, of_one.back());
    }
  }
  std::size_t next = 0;
  const ChannelLayout& at = model.layout();
  const auto evaluate = [&](const Instant& instant, std::vector<double>& row) {
    if (!shared) {
      model.evaluate(instant, row);
      return;
    }
    for (int k = 0; k < at.pistons(); ++k) {
      const auto& one = of_one[row_of_piston_one(next, k, samples.theta_deg.size(), at.pistons())];
      for (int axis = 0; axis < 3; ++axis) row[at.Rs(k, axis)] = one[at.Rs(0, axis)];
      for (int axis = 0; axis < 2; ++axis) row[at.Rc(k, axis)] = one[at.Rc(0, axis)];
      for (int axis = 0; axis < 3; ++axis) row[at.Rs3(k, axis)] = one[at.Rs3(0, axis)];
      row[at.pressure(k)] = instant.chamber_pressure[k];
      row[at.zB(k)] = one[at.zB(0)];
      row[at.Tc(k)] = one[at.Tc(0)];
      row[at.axis_moment(k)] = one[at.axis_moment(0)];
    }
    ++next;
  };
  ResultTable table = tabulate("multibody", at, samples, evaluate, progress);
  table.provenance = model.provenance();
  if (scene == Scene::piston)
    table.provenance.facts.emplace_back("pistons",
                                        shared ? "one stands for all" : "evaluated one by one");
  table.provenance.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return table;
}

}  // namespace bentaxis::multibody
