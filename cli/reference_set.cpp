#include "reference_set.h"

#include <algorithm>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/study/achieved_error.h"
#include "hydraulic_case.h"
#include "models.h"

namespace bentaxis::cli {
namespace fs = std::filesystem;

std::vector<ReferencePlace> references_below(const fs::path& root) {
  std::vector<ReferencePlace> places;
  for (const auto& folder : compare::find_references(root)) {
    fs::path name = folder.lexically_relative(root);
    if (name == ".") name = fs::absolute(folder / ".").lexically_normal().parent_path().filename();
    places.push_back({folder, name.generic_string()});
  }
  return places;
}

std::vector<fs::path> files_of(const Case& the_case) {
  if (the_case.pressure.kind != PressureKind::curve) return {};
  return {the_case.pressure.file};
}

ReferenceCases cases_of(const compare::ReferenceDescription& description) {
  const auto read = [&](const fs::path& file) {
    Case the_case = with_pressure(read_case(file)).the_case;
    if (description.samples_per_revolution)
      the_case.operation.samples_per_revolution = *description.samples_per_revolution;
    return the_case;
  };
  ReferenceCases cases{read(description.case_file), {}};
  cases.multibody = description.multibody_case_file == description.case_file
                        ? cases.analytic
                        : read(description.multibody_case_file);
  return cases;
}

ReferenceRun run_for_reference(const std::string& model, const Case& the_case) {
  const PressureTrace pressure(the_case.pressure);
  const Samples samples = samples_of(the_case, pressure, Way::driven);
  const Assumptions& assumptions = model == "analytic" ? the_case.analytic : the_case.multibody;
  return {run_model(model, the_case, assumptions, samples, pressure, Way::driven, {}),
          study::zero_scales(the_case, samples)};
}

}  // namespace bentaxis::cli
