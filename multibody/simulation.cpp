#include "bentaxis/multibody/simulation.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/stopwatch.h"
#include "integration/case_drive.h"
#include "integration/motion_run.h"
#include "reactions/solver_guard.h"
#include "scene_facts.h"

namespace bentaxis::multibody {

namespace {

// What is built, where it differs from a pump that is evaluated at instants.
std::vector<std::pair<std::string, std::string>> facts_of(const Case& the_case,
                                                          const Assumptions& assumptions) {
  const DriveKind drive = the_case.drive->kind;
  const TransferKind transfer = the_case.pump.transfer.kind;
  const bool gear = transfer == TransferKind::gear;
  const bool rigid = gear && the_case.pump.gear.contact == ToothContact::rigid;
  auto facts = scene_facts(the_case.pump, assumptions);
  for (auto& [name, fact] : facts) {
    if (name == "scene" && gear && !rigid)
      fact = "full pump, compliant tooth contact at O4 as a force element";
    if (name == "bodies" && drive == DriveKind::motor) fact += " and the motor's rotor";
    if (name == "constraints")
      fact = std::string("cylindrical bearing inline at C2 (2), ") +
             (drive == DriveKind::speed ? "angle of the shaft over time (1), " : "") +
             (the_case.pump.transfer.is_joint() ? "joint (1), "
              : rigid                           ? "gear (1), "
                                                : "") +
             "B on its bore axis (2 per piston)";
  }
  const char* const drives[] = {"angle of the shaft given over time", "torque on the shaft",
                                "rotor on a pin about z1, coupling as a force element"};
  facts.emplace_back("drive", drives[static_cast<std::size_t>(drive)]);
  return facts;
}

}  // namespace

// Measured on the stored motions: the tooth force of a stiff gear that rings is the reaction that
// needs it, others are a hundred times nearer.
double accuracy_for(double error) { return std::clamp(3e-4 * error, 1e-12, 1e-4); }

Trajectory simulate(const Case& the_case, const Assumptions& assumptions,
                    const PressureTrace& pressure, const SimulationOptions& options,
                    const Progress& progress, const SimulationMethod& method) {
  require_simulable(the_case, assumptions);
  refuse_teeth(the_case);
  const Stopwatch stopwatch;
  const IntegrationOptions integration{method.integrator,
                                       options.accuracy.value_or(accuracy_for(options.error))};
  Trajectory trajectory;
  translate_simbody_errors([&] {
    const ChannelLayout layout(the_case.pump);
    trajectory.table = trajectory_table("multibody", layout, *the_case.drive);
    trajectory.loads = BodyLoadTable::of(trajectory_times(*the_case.drive).size());
    MotionRun run(the_case, assumptions, pressure, integration, method.most_steps,
                  options.body_loads);
    run.run(trajectory, progress);
    trajectory.record.choice =
        integrator_names()[static_cast<std::size_t>(integration.integrator)] + ", accuracy " +
        rounded_text(integration.accuracy) + " per step" +
        (options.accuracy ? std::string() : " for an error of " + number_text(options.error));
    Provenance& provenance = trajectory.table.results.provenance;
    provenance.facts = facts_of(the_case, assumptions);
    provenance.facts.insert(provenance.facts.begin() + 1,
                            {"way", "integrated in time, " + trajectory.record.choice});
    const Rank rank = constraint_rank(run.system(), run.system().dynamics());
    provenance.facts.emplace_back("constraint equations", std::to_string(rank.equations));
    provenance.facts.emplace_back("rank of the constraint matrix", std::to_string(rank.rank));
  });
  trajectory.record.seconds = stopwatch.seconds();
  trajectory.table.results.provenance.seconds = trajectory.record.seconds;
  return trajectory;
}

}  // namespace bentaxis::multibody
