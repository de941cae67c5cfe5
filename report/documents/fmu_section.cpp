#include "fmu_section.h"

#include "document_parts.h"

namespace bentaxis::study {
namespace {

constexpr double kMuch = 1e-2;  // of peak
constexpr std::size_t kMaxLines = 20;

std::string arrow(const Connection& c) {
  const auto with_unit = [](const std::string& name, const std::string& unit) {
    return unit.empty() || unit == "?" ? name : name + " (" + unit + ")";
  };
  const std::string unit =
      with_unit(c.unit.name, c.unit.unit.empty() && !c.pump_unit.empty() ? c.pump_unit + ", assumed"
                                                                         : c.unit.unit);
  const std::string pump = with_unit(c.pump, c.pump_unit);
  return (c.to_pump ? unit + " -> " + pump : pump + " -> " + unit) +
         (c.automatic ? ", by equal names" : "");
}

std::string drive_in_words(const UnitCoupling& coupling) {
  for (const Connection& c : coupling.connections()) {
    if (c.to_pump && c.pump == "drive_torque") return "a torque from the FMU, instead of [drive]";
    if (c.to_pump && c.pump == "drive_speed")
      return "a speed from the FMU, instead of [drive]; between communication points it is "
             "extrapolated with the acceleration";
  }
  return "as [drive] of the case says";
}

}  // namespace

report::Section coupling_section(const SimulationResult& r) {
  const UnitCoupling& coupling = *r.choice.unit;
  const fmu::UnitDescription& unit = coupling.unit().description();
  report::NewSection section(
      "Coupling to an FMU",
      "A Functional Mock-up Unit acts on the pump: it receives values of the pump at every "
      "communication point, and its outputs are held until the next. Each model has its own "
      "instance. The change is the difference from a run with half the communication step; because "
      "the error is proportional to the step, twice the change is the estimated error of the "
      "results shown.");
  section.fact("FMU", "{}: {}, FMI {}.0{}", coupling.unit().file().filename().string(),
               unit.model_name, unit.version, unit.tool.empty() ? "" : ", made by " + unit.tool);
  section.fact("communication step", "{:.6g} s", coupling.step());
  section.fact("what turns the shaft", drive_in_words(coupling));
  section.columns("group", "unit", "peak", "change at half the step, of peak", "at, s",
                  "estimated error, of peak");
  for (const auto& [variable, value] : coupling.parameters())
    section.fact("parameter " + variable.name, number_text(value) + unit_after(variable.unit));
  int number = 0;
  for (const Connection& c : coupling.connections())
    section.fact(fmt::format("connection {}", ++number), arrow(c));
  if (const auto loose = coupling.loose_inputs(); !loose.empty())
    section.fact("inputs of the FMU that keep their start values", joined(loose));
  if (const auto loose = coupling.loose_outputs(); !loose.empty())
    section.fact("outputs of the FMU that are not used", joined(loose));
  const std::vector<std::string> said = coupling.log();
  for (std::size_t i = 0; i < said.size() && i < kMaxLines; ++i)
    section.fact("message of the FMU", said[i]);
  for (const CouplingChange& change : r.coupling)
    section.row(change.group, change.unit, change.peak, change.change, change.time_s,
                change.error());
  return section;
}

std::vector<report::Warning> coupling_warnings(const SimulationResult& r) {
  if (r.coupling.empty() || r.coupling.front().error() <= kMuch) return {};
  const CouplingChange& worst = r.coupling.front();
  return {{"coarse coupling",
           fmt::format("exchanging values every {:.3g} s causes an estimated error of {:.1e} of "
                       "peak ({}, at {:.4g} s): choose a smaller --communication-step",
                       r.choice.unit->step(), worst.error(), worst.group, worst.time_s)}};
}

std::string coupling_text(const SimulationResult& r) {
  const UnitCoupling& coupling = *r.choice.unit;
  std::string text;
  for (const Connection& c : coupling.connections()) text += "FMU: " + arrow(c) + "\n";
  if (r.coupling.empty()) return text;
  text += fmt::format(
      "FMU: at half the communication step of {:.3g} s results change, of peak, by (estimated "
      "error: twice that)\n",
      coupling.step());
  for (const CouplingChange& change : r.coupling)
    text +=
        fmt::format("  {:<13} {:>8.1e} at {:.4g} s\n", change.group, change.change, change.time_s);
  return text;
}

}  // namespace bentaxis::study
