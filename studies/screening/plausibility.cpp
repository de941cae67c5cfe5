#include "bentaxis/study/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/timing.h"
#include "checks/check.h"

namespace bentaxis::study {
namespace {

// In the order of the case file.
const std::vector<checks::Check>& all_checks() {
  static const std::vector<checks::Check> all = [] {
    std::vector<checks::Check> list;
    for (const auto& part :
         {checks::dimensions(), checks::gear(), checks::transfer(), checks::bearings(),
          checks::piston(), checks::shaft_and_block(), checks::friction(), checks::operation(),
          checks::pressure(), checks::port_plate(), checks::film_and_flank(), checks::hydraulics()})
      append(list, part);
    return list;
  }();
  return all;
}

// "CODE: reason; CODE: reason"
std::vector<PlausibilityWarning> stated(const Case& the_case) {
  std::vector<std::string> codes = plausibility_codes();
  append(codes, timing_codes());
  std::vector<PlausibilityWarning> list;
  const std::string& text = the_case.meant;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(';', at), text.size());
    const std::string part(trimmed(std::string_view(text).substr(at, end - at)));
    at = end + 1;
    if (part.empty()) continue;
    const std::size_t colon = part.find(':');
    const std::string code(trimmed(std::string_view(part).substr(0, colon)));
    const std::string reason(
        colon == std::string::npos ? "" : trimmed(std::string_view(part).substr(colon + 1)));
    const std::string where = the_case.file.string() + ": [plausibility] meant: ";
    if (!contains(codes, code))
      throw InputError(where + "\"" + code +
                       "\" is not the code of a check (docs/plausibility.md and docs/hydraulics.md "
                       "list them); must be \"CODE: reason; CODE: reason\"");
    if (reason.empty())
      throw InputError(where + "\"" + code + "\" needs a reason: \"" + code + ": why\"");
    list.push_back({code, "", reason});
  }
  return list;
}

}  // namespace

std::string Plausibility::summary() const {
  return fmt::format(
      "{:.4g} cm3/rev: {:.4g} l/min at {:.6g} rpm, {:.4g} Nm at {:.4g} bar (ideal); mean piston "
      "speed {:.3g} m/s",
      displacement * 1e6, ideal_flow * 6e4, speed_rpm, ideal_torque, delivery / kPascalPerBar,
      mean_piston_speed);
}

Plausibility plausibility(const Case& the_case) {
  const std::vector<PlausibilityWarning> reasons = stated(the_case);
  const checks::Facts facts(the_case);
  Plausibility result;
  result.displacement = facts.derived.displacement;
  result.speed_rpm = the_case.operation.speed_rpm;
  result.ideal_flow = result.displacement * facts.speed / 60;
  result.delivery = facts.ports.delivery;
  result.ideal_torque = ideal_torque(result.displacement, facts.ports);
  result.mean_piston_speed = facts.piston_speed;
  for (const checks::Check& check : all_checks()) {
    const std::string text = check.found(facts);
    if (text.empty()) continue;
    const auto reason =
        std::find_if(reasons.begin(), reasons.end(),
                     [&](const PlausibilityWarning& d) { return d.code == check.code; });
    if (reason == reasons.end())
      result.warnings.push_back({check.code, text, ""});
    else
      result.meant.push_back({check.code, text, reason->reason});
  }
  return result;
}

double ideal_torque(double displacement, const PortPressures& ports) {
  const double torque = displacement * (ports.delivery - ports.suction) / (2 * kPi);
  return torque == 0 ? 0 : torque;
}

bool lacks_pressure(const PressureSpec& pressure) {
  return pressure.kind == PressureKind::hydraulic && !pressure.computed &&
         pressure.curve.theta_deg.empty();
}

std::string stated_reason(const Case& the_case, const std::string& code) {
  for (const PlausibilityWarning& doubt : stated(the_case))
    if (doubt.code == code) return doubt.reason;
  return "";
}

std::string plausibility_markdown() {
  std::string text = "| name | warns of |\n|---|---|\n";
  for (const checks::Check& check : all_checks())
    text += fmt::format("| `{}` | {} |\n", check.code, check.words());
  return text;
}

std::vector<std::string> plausibility_codes() {
  std::vector<std::string> codes;
  for (const checks::Check& check : all_checks()) codes.emplace_back(check.code);
  return codes;
}

}  // namespace bentaxis::study
