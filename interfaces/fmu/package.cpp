// The archive of a unit.
#include <algorithm>
#include <cmath>

#include "archive.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/kept_case.h"
#include "bentaxis/fmu/unit.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "dependencies.h"
#include "documentation.h"
#include "embedded.h"
#include "platforms.h"
#include "runtime/plant.h"
#include "terminals.h"

namespace bentaxis::fmu {
namespace {

constexpr const char* kDrives[] = {"speed", "torque", "case"};  // in the order of Drive

// 128 bits of the digest of all that makes this unit, as identifiers are usually written.
std::string token_of(const std::string& all) {
  std::string text = sha256_of(all).substr(0, 32);
  for (const std::size_t place : {20, 16, 12, 8}) text.insert(place, "-");
  return "{" + text + "}";
}

std::string choice_text(const UnitChoice& choice) {
  std::string text = std::string("drive ") + kDrives[static_cast<int>(choice.drive)] +
                     "\ntolerance " + number_text(choice.tolerance) + "\n";
  if (choice.si_outputs) text += "outputs si\n";
  if (choice.start_torque) text += "start_torque " + number_text(*choice.start_torque) + "\n";
  return text;
}

// Mean drive torque of a turn at the speed of [operation], Nm: what a unit starts with where its
// case does not say it.
double mean_torque(const Case& the_case) {
  Plant plant(the_case, {Drive::speed}, Plant::Kind::co_simulation);
  const std::vector<PlantColumn> columns = columns_of(the_case, {Drive::speed}).outputs;
  const auto torque = std::find_if(columns.begin(), columns.end(),
                                   [](const auto& c) { return c.name == "Td_z1_Nm"; });
  const auto place = static_cast<std::size_t>(torque - columns.begin());
  Inputs inputs = plant.first_inputs();
  inputs.speed = rad_per_second(the_case.operation.speed_rpm);
  const double turn = 2 * kPi / std::abs(inputs.speed);
  plant.start(inputs, turn);
  constexpr int kPoints = 720;
  double sum = 0;
  for (int i = 1; i <= kPoints; ++i) {
    plant.step(turn * i / kPoints);
    sum += plant.outputs().at(place);
  }
  return sum / kPoints;
}

// Four digits: those that differ between computers do not matter for a start.
double rounded(double value) {
  if (value == 0) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3);
  return unit >= 1 ? std::round(value / unit) * unit
                   : std::round(value / unit) / std::round(1 / unit);
}

// @param why_not  where the mean torque cannot be computed: why
UnitChoice choice_of(const Case& the_case, const UnitOptions& options, std::string& why_not) {
  UnitChoice choice{options.drive, options.tolerance, {}, options.si_outputs};
  const bool own = the_case.drive && the_case.drive->kind == DriveKind::torque;
  if (options.drive == Drive::torque && !own && the_case.operation.speed_rpm != 0) try {
      choice.start_torque = rounded(mean_torque(the_case));
    } catch (const InputError& error) {
      why_not = error.what();
    } catch (const ComputationError& error) {
      why_not = error.what();
    }
  return choice;
}

// What decides what the variables are and what they do.
std::string identity(const KeptCase& kept, const std::string& choice,
                     const std::vector<Variable>& variables) {
  std::string all = BENTAXIS_VERSION "\n" + choice + kept.text;
  for (const KeptCase::Curve& curve : kept.curves) all += curve.name + "\n" + curve.bytes;
  for (const Variable& variable : variables) all += variable.name + " " + variable.unit + "\n";
  return all;
}

Description description_of(const Case& the_case, const UnitOptions& options,
                           const UnitChoice& choice) {
  Description it;
  it.variables = variables_of(the_case, choice);
  it.dependencies = dependencies_of(the_case, choice, it.variables);
  it.model_name = options.model_name.empty() ? the_case.name : options.model_name;
  it.text = "Bent-axis axial piston pump with " + std::to_string(the_case.pump.geometry.pistons) +
            " pistons: motion, every reaction force and drive torque in closed form" +
            (the_case.hydraulics ? ", with its oil" : "");
  it.generated = options.generated;
  it.tolerance = options.tolerance;
  const Case driven = with_drive(the_case, options.drive);
  it.stop_time = driven.drive->duration;
  it.step = it.stop_time / driven.drive->samples;
  return it;
}

// A unit has no libraries of these formats.
void require_text(const KeptCase& kept) {
  for (const KeptCase::Curve& curve : kept.curves)
    if (curve.bytes.find('\0') != std::string::npos)
      throw InputError(curve.name.substr(curve.name.find('/') + 1) +
                       ": is a workbook or a .mat file, which an FMU cannot read: save it as CSV");
}

}  // namespace

std::string unit_archive(const Case& the_case, const UnitOptions& options) {
  Case alone = the_case;
  alone.uncertainty = {};  // a unit has one value of each
  const KeptCase kept = kept_case(alone);
  require_text(kept);
  const std::vector<PlatformLibrary> libraries =
      platform_libraries(options.version, options.platforms);
  std::string why_not;  // of unit_summary()
  const UnitChoice chosen = choice_of(the_case, options, why_not);
  Description description = description_of(the_case, options, chosen);
  const std::string choice = choice_text(chosen);
  description.token = token_of(identity(kept, choice, description.variables));
  std::vector<ArchiveFile> files;
  files.push_back({"modelDescription.xml", description_xml(options.version, description)});
  if (options.version == Version::fmi3)
    if (std::string terminals = terminals_fmi3(description.variables); !terminals.empty())
      files.push_back({"terminalsAndIcons/terminalsAndIcons.xml", std::move(terminals)});
  for (const PlatformLibrary& library : libraries)
    files.push_back({library.place, library.bytes, true});
  if (options.sources) append(files, source_files(options.version));
  files.push_back({"resources/case.toml", kept.text});
  for (const KeptCase::Curve& curve : kept.curves)
    files.push_back({"resources/" + curve.name, curve.bytes});
  files.push_back({"resources/unit.txt", choice + "token " + description.token + "\n"});
  files.push_back(
      {"documentation/index.html", documentation_page(description, options, needs_of(libraries))});
  files.push_back({"documentation/licenses/license.txt", embedded_licence()});
  std::string notices = embedded_notices();
  for (const PlatformLibrary& library : libraries) notices += library.licences;
  files.push_back({"documentation/licenses/third_party.txt", notices});
  return zip_archive(files);
}

UnitSummary unit_summary(const Case& the_case, const UnitOptions& options) {
  UnitSummary has;
  has.needs = needs_of(platform_libraries(options.version, options.platforms));
  const UnitChoice choice = choice_of(the_case, options, has.no_start_torque);
  for (const Variable& variable : variables_of(the_case, choice)) {
    if (variable.role == Role::input && variable.input == Input::torque)
      has.start_torque = variable.start;
    if (variable.causality == Causality::input) has.inputs.push_back(variable.name);
    if (variable.causality == Causality::output) ++has.outputs;
    if (variable.causality == Causality::parameter) ++has.parameters;
    if (variable.role == Role::state) ++has.states;
    if (variable.role == Role::indicator) ++has.indicators;
  }
  return has;
}

}  // namespace bentaxis::fmu
