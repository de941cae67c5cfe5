#include "bentaxis/study/reference_set.h"

#include <fmt/format.h>

#include <cmath>
#include <variant>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/study/achieved_error.h"

namespace bentaxis::study {
namespace fs = std::filesystem;

std::vector<ReferencePlace> references_below(const fs::path& root) {
  std::vector<ReferencePlace> places;
  for (const auto& folder : compare::find_references(root)) {
    fs::path name = folder.lexically_relative(root);
    if (name == ".") name = fs::absolute(folder / ".").lexically_normal().parent_path().filename();
    if (has_control_characters(name, true))
      throw InputError(without_control_characters(folder.string()) +
                       ": the name of this directory contains a control character");
    places.push_back({folder, name.generic_string()});
  }
  return places;
}

std::vector<fs::path> files_of(const Case& the_case) {
  std::vector<fs::path> files;
  for (const Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters) {
      const auto* const curve = std::get_if<CurveField>(&parameter.field);
      if (curve == nullptr || !is_there(parameter, the_case)) continue;
      const fs::path* const file = curve->file.read(the_case);
      if (file->empty()) continue;
      if (file == &the_case.pressure.file && the_case.pressure.kind != PressureKind::curve)
        continue;
      add_once(files, *file);
    }
  return files;
}

namespace {

PreparedCase read(const compare::ReferenceDescription& description, const fs::path& file,
                  const PartProgress& progress_of) {
  PreparedCase ready = prepare(read_case(file), progress_of);
  if (description.samples_per_revolution)
    ready.the_case.operation.samples_per_revolution = *description.samples_per_revolution;
  return ready;
}

}  // namespace

std::string differing_keys(const Case& theirs, const Case& ours) {
  std::string text;
  for (const InputEntry& here : ours.entries)
    for (const InputEntry& entry : theirs.entries)
      if (entry.table == here.table && entry.key == here.key && entry.value != here.value &&
          !entry.table.empty() && entry.key != "file" && entry.key != "samples_per_revolution" &&
          entry.key != "revolutions")
        text += fmt::format("{}{}.{} = {} (here {})", text.empty() ? "" : ", ", entry.table,
                            entry.key, entry.value, here.value);
  return text;
}

compare::FrameAxes frames_of(const Case& the_case) {
  const double c = std::cos(the_case.pump.geometry.tilt), s = std::sin(the_case.pump.geometry.tilt);
  return {{"S1", compare::kNoTurn}, {"S2", {{{1, 0, 0}, {0, c, -s}, {0, s, c}}}}};
}

ReferenceCases::ReferenceCases(const compare::ReferenceDescription& description,
                               const PartProgress& progress_of)
    : analytic_(read(description, description.case_file, progress_of)) {
  if (description.multibody_case_file != description.case_file)
    multibody_ = read(description, description.multibody_case_file, progress_of);
}

ReferenceRun run_for_reference(const PreparedCase& ready, Model model,
                               const PartProgress& progress_of) {
  const Samples samples = ready.samples(Way::driven);
  return {run(ready, samples, {.model = model}, progress_of).table,
          zero_scales(ready.the_case, samples)};
}

}  // namespace bentaxis::study
