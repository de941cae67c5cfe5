#include "models.h"

#include <algorithm>
#include <utility>

#include "bentaxis/analytic/model.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "console.h"

namespace bentaxis::cli {

Samples samples_of(const Case& the_case, const PressureTrace& pressure, Way way) {
  if (way == Way::driven) return sample_case(the_case, pressure);
  return sample_case(the_case, pressure, the_case.operation.revolutions,
                     the_case.operation.speed_rpm < 0);
}

ResultTable run_model(const std::string& model, const Case& the_case,
                      const Assumptions& assumptions, const Samples& samples,
                      const PressureTrace& pressure, Way way,
                      const multibody::IntegrationOptions& integration,
                      multibody::IntegrationRecord* record, const multibody::SceneChoice& scene) {
  const Progress progress = progress_of(model);
  if (model == "analytic") return analytic::run(the_case, assumptions, samples, progress);
  if (way == Way::driven)
    return multibody::run_driven(the_case, assumptions, samples, progress, scene.scene,
                                 scene.method);
  if (scene.scene != multibody::Scene::full || scene.method != multibody::Method::multipliers)
    throw InputError(
        "--scene and --reactions are for --way driven: an integrated run is of the full "
        "pump, by its equations of motion");
  auto run =
      multibody::run_integrated(the_case, assumptions, samples, pressure, integration, progress);
  if (record != nullptr) *record = run.record;
  return std::move(run.table);
}

void stream_analytic(const Case& the_case, const Assumptions& assumptions,
                     const PressureTrace& pressure,
                     const std::function<bool(const Channel&)>& wanted, OutputFolder::Stream& out) {
  const analytic::Model model(the_case.pump, assumptions);
  std::vector<Channel> channels;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < model.layout().size(); ++c)
    if (wanted(model.layout().channels()[c])) {
      columns.push_back(c);
      channels.push_back(model.layout().channels()[c]);
    }
  out.write(csv_header(channels));
  std::string line;
  std::vector<double> values(columns.size());
  stream_rows(
      "analytic", model.layout(), the_case, pressure,
      [&](const Instant& instant, std::vector<double>& row) { model.evaluate(instant, row); },
      [&](double theta_deg, const std::vector<double>& row) {
        line.clear();
        for (std::size_t i = 0; i < columns.size(); ++i) values[i] = row[columns[i]];
        append_csv_row(line, theta_deg, values.data(), values.size());
        out.write(line);
      },
      progress_of("analytic"));
}

}  // namespace bentaxis::cli
