#include "bentaxis/study/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bentaxis/analytic/body_loads.h"
#include "bentaxis/analytic/budget.h"
#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/calibration.h"
#include "bentaxis/study/memory.h"
#include "bentaxis/study/row_stream.h"

namespace bentaxis::study {
namespace {

// Options that say nothing to each other are mistakes of whoever set them.
void check(const RunOptions& options) {
  const bool integrated = options.way == Way::integrated;
  if (options.model == Model::analytic && integrated)
    throw InputError("the analytic model does not integrate in time: it is run driven only");
  if (options.target && !integrated)
    throw InputError("only an integrated run of the multibody model has an error to choose");
  if (integrated && (options.scene.scene != multibody::Scene::full ||
                     options.scene.method == multibody::Method::residual))
    throw InputError(
        "scenes and methods for reactions are for driven runs: an integrated run is of the full "
        "pump, by its equations of motion");
  if (options.budget && (integrated || options.scene.scene != multibody::Scene::full))
    throw InputError("a torque budget needs a driven run of the full pump");
  if (options.teeth && (integrated || options.scene.scene != multibody::Scene::full))
    throw InputError("tooth results need a driven run of the full pump");
}

// What lies in memory of every number of a model's table when most does: the tables, columns sorted
// apart, figures, and text. scripts/measure_memory measures them; of both models it is most with
// resolved teeth.
double copies_of(Kept kept, bool teeth) {
  switch (kept) {
    case Kept::table:
    case Kept::simulated:
      return 7;
    case Kept::shown:
      return 8;
    case Kept::compared:
      return teeth ? 10 : 5;
    case Kept::lumped:
      return 20;
    case Kept::drawn:
      break;
  }
  return teeth ? 34 : 10;
}

void require_rows(const Case& the_case, Kept kept, double rows, const std::string& because,
                  const std::string& advice) {
  const double columns = static_cast<double>(ChannelLayout(the_case.pump).size());
  const bool teeth = the_case.pump.gear.contact == ToothContact::teeth;
  const double needed = copies_of(kept, teeth) * rows * columns * sizeof(double);
  constexpr double kLittle = 5e7;  // not worth asking the system, which takes its time
  if (needed < kLittle) return;
  require_memory(
      needed, fmt::format("{}: {:.6g} samples of {:.0f} columns", because, rows, columns), advice);
}

}  // namespace

void require_memory(const Case& the_case, Kept kept, Way way, std::size_t runs) {
  const auto& operation = the_case.operation;
  const bool integrated = way == Way::integrated;
  require_rows(
      the_case, kept,
      static_cast<double>(runs) * static_cast<double>(operation.samples_per_revolution) *
          (integrated ? operation.revolutions : 1),
      fmt::format("[operation] samples_per_revolution = {}{}", operation.samples_per_revolution,
                  integrated ? fmt::format(", revolutions = {}", operation.revolutions) : ""),
      std::string("lower samples_per_revolution") + (integrated ? " or revolutions" : "") +
          ", or use run --model analytic, which writes row by row");
}

void require_memory(const Case& the_case, const DriveSpec& drive, std::size_t models) {
  require_rows(the_case, Kept::simulated, static_cast<double>(models) * (drive.samples + 1.0),
               fmt::format("[drive] samples = {}", drive.samples), "lower [drive] samples");
}

std::string to_string(Model model) { return model == Model::analytic ? "analytic" : "multibody"; }

Samples PreparedCase::samples(Way way) const {
  require_memory(the_case, Kept::table, way);
  if (way == Way::driven) return sample_case(the_case, pressure);
  return sample_case(the_case, pressure, the_case.operation.revolutions,
                     the_case.operation.speed_rpm < 0);
}

const Assumptions& PreparedCase::assumptions(Model model) const {
  return model == Model::analytic ? the_case.analytic : the_case.multibody;
}

ModelRun run(const PreparedCase& ready, const RunOptions& options,
             const PartProgress& progress_of) {
  check(options);
  return run(ready, ready.samples(options.way), options, progress_of);
}

ModelRun run(const PreparedCase& ready, const Samples& samples, const RunOptions& options,
             const PartProgress& progress_of) {
  check(options);
  const Case& the_case = ready.the_case;
  const Assumptions& assumptions =
      options.assumptions ? *options.assumptions : ready.assumptions(options.model);
  ModelRun result;
  const bool collects =
      options.loads && options.way == Way::driven && options.scene.scene == multibody::Scene::full;
  if (options.model == Model::analytic) {
    if (options.teeth) result.teeth.emplace();
    result.table = analytic::run(the_case, assumptions, samples, progress_of("analytic"),
                                 options.teeth ? &*result.teeth : nullptr);
    if (options.budget)
      result.budget =
          analytic::run_budget(the_case, assumptions, samples, progress_of("torque budget"));
    if (options.loads)
      result.loads = analytic::run_body_loads(the_case, assumptions, samples,
                                              progress_of("loads on the bodies"));
  } else if (options.way == Way::driven) {
    if (options.budget) result.budget.emplace();
    if (options.teeth) result.teeth.emplace();
    result.table = multibody::run_driven(
        the_case, assumptions, samples, progress_of("multibody"), options.scene.scene,
        options.scene.method, options.budget ? &*result.budget : nullptr,
        options.teeth ? &*result.teeth : nullptr, collects ? &result.loads : nullptr);
  } else if (options.target) {
    const auto& among = options.target->integrators;
    VerifiedRun verified =
        run_to_error(the_case, assumptions, samples, ready.pressure, options.target->error,
                     among.empty() ? all_integrators() : among, progress_of);
    result.choice = verified.text();
    result.integration = verified.calibration.chosen;
    result.table = std::move(verified.run.table);
    result.record = std::move(verified.run.record);
  } else {
    result.integration = options.integration;
    auto integrated = multibody::run_integrated(the_case, assumptions, samples, ready.pressure,
                                                options.integration, progress_of("multibody"));
    result.table = std::move(integrated.table);
    result.record = std::move(integrated.record);
  }
  if (options.loads && options.model == Model::multibody && !collects)
    multibody::run_driven(the_case, assumptions, samples, progress_of("loads on the bodies"),
                          multibody::Scene::full, {}, nullptr, nullptr, &result.loads);
  return result;
}

ResultTable run_at_angles(const PreparedCase& ready, const std::vector<double>& theta_deg,
                          const RunOptions& options, const PartProgress& progress_of) {
  if (options.way != Way::driven) throw InputError("given angles are not integrated");
  return run(ready, sample_angles(ready.the_case, ready.pressure, theta_deg), options, progress_of)
      .table;
}

MotionTable run_states(const PreparedCase& ready, const States& states, const RunOptions& options,
                       const PartProgress& progress_of, ResultTable* teeth, BodyLoadTable* loads) {
  check(options);
  if (options.way == Way::integrated)
    throw InputError("given states are not integrated: the motion is an input");
  if (options.budget || options.scene.scene != multibody::Scene::full)
    throw InputError("at given states the whole pump is evaluated, without a torque budget");
  const Assumptions& assumptions =
      options.assumptions ? *options.assumptions : ready.assumptions(options.model);
  if (options.model == Model::analytic) {
    if (loads != nullptr)
      *loads = analytic::run_body_loads(ready.the_case, assumptions, states,
                                        progress_of("loads on the bodies"));
    return analytic::run_states(ready.the_case, assumptions, states, progress_of("analytic"),
                                teeth);
  }
  return multibody::run_states(ready.the_case, assumptions, states, progress_of("multibody"),
                               options.scene.method, teeth, loads);
}

ResultTable run_turn(const PreparedCase& ready, Model model, const PartProgress& progress_of) {
  return run(ready, {.model = model}, progress_of).table;
}

bool computes(const RunOptions& options, const Assumptions& assumptions, const Channel& channel) {
  if (assumptions.gear == BlockDrive::imposed && channel.quantity == "Rcs") return false;
  return options.model == Model::analytic || options.way == Way::integrated ||
         multibody::computes(options.scene.scene, channel);
}

void stream_analytic(const PreparedCase& ready, const Assumptions& assumptions,
                     const std::function<bool(const Channel&)>& wanted, OutputFolder::Stream& out,
                     const RowVisitor& visit, const PartProgress& progress_of) {
  analytic::require_free_play(ready.the_case);
  const analytic::Model model(ready.the_case.pump, assumptions);
  std::vector<Channel> channels;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < model.layout().size(); ++c)
    if (const Channel& channel = model.layout().channels()[c];
        wanted(channel) && !is_of_given_motion(channel)) {
      columns.push_back(c);
      channels.push_back(channel);
    }
  out.write(csv_header(channels));
  std::string line;
  std::vector<double> values(columns.size());
  analytic::PlacedSamples placed(model, ready.the_case);
  stream_rows(
      "analytic", model.layout(), ready.the_case, ready.pressure,
      [&](const Instant& instant, std::vector<double>& row) {
        analytic::evaluate_at_constant_speed(model, placed.at(instant), row);
      },
      [&](double theta_deg, const std::vector<double>& row) {
        line.clear();
        if (visit) visit(theta_deg, row.data());
        for (std::size_t i = 0; i < columns.size(); ++i) values[i] = row[columns[i]];
        append_csv_row(line, theta_deg, values.data(), values.size());
        if (theta_deg == 0)
          out.expect(static_cast<double>(line.size()) *
                     ready.the_case.operation.samples_per_revolution);
        out.write(line);
      },
      progress_of("analytic"));
}

void stream_analytic(const PreparedCase& ready, const Assumptions& assumptions,
                     const std::function<bool(const Channel&)>& wanted, OutputFolder::Stream& out,
                     const PartProgress& progress_of) {
  stream_analytic(ready, assumptions, wanted, out, RowVisitor(), progress_of);
}

std::vector<multibody::Integrator> all_integrators() {
  std::vector<multibody::Integrator> all;
  for (std::size_t i = 0; i < multibody::integrator_names().size(); ++i)
    all.push_back(static_cast<multibody::Integrator>(i));
  return all;
}

}  // namespace bentaxis::study
