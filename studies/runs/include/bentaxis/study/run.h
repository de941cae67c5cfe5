// One call from a case to tables: the pressure of a case, and either model on it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/scene.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

enum class Model { analytic, multibody };
inline constexpr Model kModels[] = {Model::analytic, Model::multibody};
/// "analytic", "multibody": names of tables and files.
std::string to_string(Model model);

/// How the multibody model is run. The analytic model has no time to integrate over.
enum class Way {
  driven,      ///< reactions at given angles of one turn
  integrated,  ///< in time, over the case's revolutions
};

/// A case that the models can be run on, with what the hydraulic model found if it was asked.
struct PreparedCase {
  Case the_case;
  std::optional<hydraulics::SteadyState> hydraulics;  ///< of kind "hydraulic"
  PressureTrace pressure{PressureSpec{}};

  /// Angles and pressures of a run: one turn where driven, all revolutions (falling angles where
  /// the speed is negative) where integrated.
  Samples samples(Way way) const;
  /// What the case lets a model assume.
  const Assumptions& assumptions(Model model) const;
};
using ReadyCase [[deprecated("use PreparedCase")]] = PreparedCase;

/// Computes the chamber pressure of a case where its pressure is of kind "hydraulic" and puts it
/// into the case: one curve, which both models then get. The pressure of other cases is there.
/// @throws InputError, ComputationError
PreparedCase prepare(Case the_case, const PartProgress& progress_of = silent());

/// As prepare(), for oil that only starts there and then follows the motion: of a pump with a
/// universal joint or with pistons that carry the block, the periodic state is that of a block that
/// turns with the shaft.
PreparedCase prepare_start(Case the_case, const PartProgress& progress_of = silent());

/// The largest error of any reaction over its peak that an integrated run may have: integrator and
/// accuracy are chosen for it by a short calibration, and the run is verified.
struct ErrorTarget {
  double error = 0;                                ///< of peak
  std::vector<multibody::Integrator> integrators;  ///< to try; empty: all
};

struct RunOptions {
  Model model = Model::analytic;
  std::optional<Assumptions> assumptions = {};  ///< instead of the case's
  bool budget = false;  ///< torque by cause too; of a driven run of the full pump
  bool teeth = false;   ///< state of the teeth, too; likewise, where contact is resolved
  bool loads = false;   ///< all loads on the bodies too: those of the driven full pump at the
                        ///< samples also of a run that is integrated or of a smaller scene
  // Of the multibody model:
  Way way = Way::driven;
  multibody::SceneChoice scene = {};  ///< driven; an integrated run is of the full pump
  multibody::IntegrationOptions integration = {};  ///< integrated, without a target
  std::optional<ErrorTarget> target = {};          ///< integrated: chooses the integration instead
};

struct ModelRun {
  ResultTable table;
  std::optional<ResultTable> budget;                   ///< where asked for (results/budget.h)
  std::optional<ResultTable> teeth;                    ///< likewise (results/teeth.h)
  BodyLoadTable loads;                                 ///< likewise, a row per sample
  multibody::IntegrationOptions integration;           ///< of an integrated run: as it was run
  std::optional<multibody::IntegrationRecord> record;  ///< of an integrated run
  std::string choice;  ///< of a run to an error: what was chosen, and what it then did
};

/// What is kept of a run, and so how much memory a sample takes.
enum class Kept {
  table,      ///< one model's, and its text
  shown,      ///< one model's with all loads, figures and the page
  compared,   ///< both models' with figures and the page
  drawn,      ///< the same with a file of each figure, which has all rows
  lumped,     ///< of an inertia study, for each speed and once more
  simulated,  ///< one model's in time, with figures and the page
};
/// @param runs  that are kept at a time
/// @throws InputError where the samples of the case do not fit into the memory that is available
void require_memory(const Case& the_case, Kept kept, Way way, std::size_t runs = 1);
/// The same of the rows of a simulation by one or two models.
void require_memory(const Case& the_case, const DriveSpec& drive, std::size_t models);

/// Runs one model.
/// @throws InputError where the options contradict each other or the case refuses them (integrated
///         at standstill, say); ComputationError where a model fails
ModelRun run(const PreparedCase& ready, const RunOptions& options,
             const PartProgress& progress_of = silent());
/// The same at samples that are already there: of ready.samples(way).
ModelRun run(const PreparedCase& ready, const Samples& samples, const RunOptions& options,
             const PartProgress& progress_of = silent());

/// One turn's angles of a driven run, deg, in any order.
ResultTable run_at_angles(const PreparedCase& ready, const std::vector<double>& theta_deg,
                          const RunOptions& options, const PartProgress& progress_of = silent());

/// Reactions at given states of shaft and block, as options.model and options.assumptions say;
/// options.scene.method of the multibody model. The pump is whole.
/// @throws InputError where the options say something that has no effect on given states
/// @param teeth  if given: the state of the teeth there, table of results/teeth.h
/// @param loads  if given: all loads on the bodies there
MotionTable run_states(const PreparedCase& ready, const States& states, const RunOptions& options,
                       const PartProgress& progress_of = silent(), ResultTable* teeth = nullptr,
                       BodyLoadTable* loads = nullptr);

/// One turn by one model, driven, as the case assumes.
ResultTable run_turn(const PreparedCase& ready, Model model,
                     const PartProgress& progress_of = silent());

/// Whether a run computes a channel at all: a smaller scene leaves some out, and where the block's
/// speed is imposed there is no tooth force.
bool computes(const RunOptions& options, const Assumptions& assumptions, const Channel& channel);

/// Runs the analytic model over one turn and writes its curves as CSV, row by row: memory does not
/// grow with the number of samples. Only channels that are wanted.
void stream_analytic(const PreparedCase& ready, const Assumptions& assumptions,
                     const std::function<bool(const Channel&)>& wanted, OutputFolder::Stream& out,
                     const PartProgress& progress_of = silent());

/// All integrators there are.
std::vector<multibody::Integrator> all_integrators();

}  // namespace bentaxis::study
