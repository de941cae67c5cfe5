#include "bentaxis/study/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <functional>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/plausibility.h"

namespace bentaxis::study {
namespace {

// Limits by convention (docs/hydraulics.md, "Timing").
constexpr double kShortCircuit = 0.005;  // of a stroke
constexpr double kBackflow = 1.5;        // over what fills the chamber, but at least
constexpr double kMinBackflow = 0.01;    // of a stroke
constexpr double kOvershoot = 0.1;       // of the mean delivery pressure, but at least
constexpr double kMinOvershoot = 10e5;   // Pa

constexpr double kLargestFillingLoss = 0.01;  // of a stroke
bool fills(double loss) { return loss <= kLargestFillingLoss; }

// The search for a speed.
constexpr double kFactor = 1.25;
constexpr double kMaxOverOwn = 8, kMinOverOwn = 0.05;
constexpr double kSpeedTolerance = 1e-3;
constexpr std::uintmax_t kMaxSolves = 20;  // between two speeds
constexpr double kSpeedCurveError = 1e-5;  // of peak; a hundredth of what the tolerance sees

double bar(double pascals) { return pascals / kPascalPerBar; }
double cm3(double volume) { return volume * 1e6; }

TimingRow row(const std::string& code, double value) {
  TimingRow r;
  for (const TimingQuantity& q : timing_quantities())
    if (q.code == code) {
      r.quantity = q.quantity;
      r.unit = q.unit;
    }
  r.code = code;
  r.value = value;
  return r;
}

void hold(TimingRow& r, double limit) {
  r.limit = limit;
  r.flagged = r.value > limit;
}

double extent(const std::vector<hydraulics::AngleInterval>& intervals) {
  double sum = 0;
  for (const auto& s : intervals) sum += s.to_deg - s.from_deg;
  return sum;
}

void add_angles(TimingRow& r, const std::vector<hydraulics::AngleInterval>& intervals) {
  for (const auto& s : intervals) r.angles.emplace_back(s.from_deg, s.to_deg);
}

template <class Parts>
std::vector<hydraulics::AngleInterval> where_of(const Parts& parts) {
  std::vector<hydraulics::AngleInterval> all;
  for (const auto& part : parts) all.push_back(part.where);
  return all;
}

TimingRow below(const std::string& code, const std::vector<hydraulics::AngleInterval>& where,
                double pressure, const hydraulics::Summary& s) {
  TimingRow r = row(code, extent(where));
  add_angles(r, where);
  hold(r, 0);
  r.text = fmt::format("{:.3g} % of the turn below {:.4g} bar", r.value / 3.6, bar(pressure));
  if (r.flagged) {
    r.theta_deg = s.chamber_least_deg;
    r.text += fmt::format("; minimum {:.4g} bar at {:.4g} deg", bar(s.chamber_least),
                          s.chamber_least_deg);
  }
  return r;
}

void add_connections(const hydraulics::Timing& t, double stroke, std::vector<TimingRow>& rows) {
  const auto where = where_of(t.connected);
  TimingRow open = row("ports-connected", extent(where));
  add_angles(open, where);
  hold(open, 0);
  open.text = where.empty() ? "never" : fmt::format("{:.3g} % of the turn", open.value / 3.6);
  const hydraulics::Timing::Connection* widest = nullptr;
  for (const auto& c : t.connected)
    if (widest == nullptr || c.largest_area > widest->largest_area) widest = &c;
  TimingRow area = row("connected-area", widest == nullptr ? 0 : widest->largest_area * 1e6);
  if (widest != nullptr) area.theta_deg = widest->largest_area_deg;
  area.text = "both openings in series";
  TimingRow volume = row("short-circuit", cm3(t.through()));
  for (const auto& c : t.connected)
    if (c.through > 0) volume.angles.emplace_back(c.where.from_deg, c.where.to_deg);
  hold(volume, kShortCircuit * cm3(stroke));
  volume.text = fmt::format("{:.3g} % of a stroke", 100 * t.through() / stroke);
  rows.insert(rows.end(), {open, area, volume});
}

TimingRow backflow(const hydraulics::Timing& t, double stroke) {
  TimingRow r = row("backflow", cm3(t.backflow));
  add_angles(r, t.backflow_where);
  hold(r, cm3(std::max(kBackflow * t.filling, kMinBackflow * stroke)));
  if (t.backflow > 0) r.theta_deg = t.largest_backflow_deg;
  r.text = fmt::format(
      "maximum {:.4g} l/min at {:.4g} deg; to bring a full chamber to delivery pressure takes "
      "{:.3g} cm3",
      t.largest_backflow / kLitrePerMinute, t.largest_backflow_deg, cm3(t.filling));
  return r;
}

double overshoot_limit(const hydraulics::Summary& s) {
  return bar(std::max(kOvershoot * s.delivery_mean, kMinOvershoot));
}

TimingRow trapped(const hydraulics::Timing& t, const hydraulics::Summary& s) {
  TimingRow r = row("trapped-oil", 0);
  add_angles(r, where_of(t.trapped));
  for (const auto& one : t.trapped) {
    const double over = bar(one.greatest - s.delivery_mean);
    if (over > r.value) {
      r.value = over;
      r.theta_deg = one.greatest_deg;
    }
    r.text += fmt::format(
        "{}{:.4g} to {:.4g} deg: {:.3g} cm3 swept, {:.4g} bar at {:.4g} deg to {:.4g} bar at "
        "{:.4g} deg",
        r.text.empty() ? "" : "; ", one.where.from_deg, one.where.to_deg, cm3(one.swept),
        bar(one.least), one.least_deg, bar(one.greatest), one.greatest_deg);
  }
  if (t.trapped.empty()) r.text = "never closed to both";
  hold(r, overshoot_limit(s));
  return r;
}

TimingRow filling(const hydraulics::Timing::Filled& filled) {
  TimingRow r = row("filling", 100 * filled.loss);
  r.theta_deg = filled.at_deg;
  r.limit = 100 * kLargestFillingLoss;
  r.flagged = !fills(filled.loss);
  r.text =
      fmt::format("{}: the chamber holds {:.4g} % of the oil it would hold at suction pressure",
                  r.flagged ? "not filled" : "filled", 100 * filled.ratio);
  return r;
}

std::string value_text(const TimingRow& r) {
  if (!r.bound.empty()) return r.bound;
  if (!is_computed(r.value)) return "none";
  const std::string text = fmt::format("{:.4g}", r.value);
  // As many digits as show that the limit is not kept.
  return r.flagged && r.limit && text == fmt::format("{:.4g}", *r.limit)
             ? fmt::format("{:.7g}", r.value)
             : text;
}

// Whether the limit is the smallest value allowed: a speed that is searched for must reach the
// case's own.
bool is_minimum(const TimingRow& r) {
  const auto& all = timing_quantities();
  return std::any_of(all.begin(), all.end(),
                     [&](const TimingQuantity& q) { return q.code == r.code && q.searched; });
}

// "limit 0.5", "at least 1500", or "" where there is none.
std::string limit_text(const TimingRow& r) {
  return r.limit ? fmt::format("{} {:.4g}", is_minimum(r) ? "at least" : "limit", *r.limit) : "";
}

std::string angles_text(const TimingRow& r) {
  const std::string text = joined(r.angles, ", ", [](const auto& range) {
    return fmt::format("{:.4g}..{:.4g}", range.first, range.second);
  });
  if (!text.empty()) return text + " deg";
  return r.theta_deg ? fmt::format("{:.4g} deg", *r.theta_deg) : "";
}

}  // namespace

const std::vector<TimingQuantity>& timing_quantities() {
  static const std::vector<TimingQuantity> all = {
      {"below-saturation", "chamber below saturation pressure: dissolved air is released",
       "deg per turn"},
      {"below-vapour", "chamber below vapour pressure: cavitation with oil vapour", "deg per turn"},
      {"ports-connected", "chamber open to both ports", "deg per turn"},
      {"connected-area", "largest opening from port to port through a chamber", "mm2"},
      {"short-circuit", "oil from the delivery to the suction port", "cm3 per chamber and turn"},
      {"backflow", "oil from the delivery port into a chamber", "cm3 per chamber and turn"},
      {"trapped-oil", "chamber closed to both ports: pressure above mean delivery", "bar"},
      {"overshoot", "maximum chamber pressure above mean delivery", "bar"},
      {"filling", "stroke lost by incomplete filling", "% of a stroke"},
      {"suction-speed", "largest speed at which no chamber falls below a pressure", "rpm", true},
      {"filling-speed", "largest speed at which the chambers fill", "rpm", true}};
  return all;
}

std::vector<std::string> timing_codes() {
  std::vector<std::string> codes;
  for (const TimingQuantity& q : timing_quantities())
    if (q.code != "connected-area") codes.push_back(q.code);  // never beyond a limit
  return codes;
}

std::vector<TimingRow> timing_rows(const Case& the_case, const hydraulics::SteadyState& state) {
  const hydraulics::Summary& s = state.summary;
  const hydraulics::Timing& t = state.timing;
  const double stroke = s.displacement / the_case.pump.geometry.pistons;
  std::vector<TimingRow> rows = {below("below-saturation", t.below_saturation, s.saturation, s),
                                 below("below-vapour", t.below_vapour, s.vapour, s)};
  add_connections(t, stroke, rows);
  // Backwards oil comes out of the delivery port: that is no backflow.
  if (the_case.operation.speed_rpm > 0) rows.push_back(backflow(t, stroke));
  rows.push_back(trapped(t, s));
  TimingRow over = row("overshoot", bar(s.overshoot));
  over.theta_deg = s.chamber_greatest_deg;
  hold(over, overshoot_limit(s));
  over.text = fmt::format("{:.4g} bar", bar(s.chamber_greatest));
  rows.push_back(over);
  if (t.filled) rows.push_back(filling(*t.filled));
  for (TimingRow& r : rows) r.meant = stated_reason(the_case, r.code);
  return rows;
}

std::vector<Warning> timing_warnings(const std::vector<TimingRow>& rows) {
  std::vector<Warning> warnings;
  for (const TimingRow& r : rows) {
    if (!r.flagged || !r.meant.empty()) continue;
    const std::string where = angles_text(r);
    warnings.push_back(
        {r.code, fmt::format("{}: {} {}{}, {}; {}.", r.quantity, value_text(r), r.unit,
                             where.empty() ? "" : " (" + where + ")", limit_text(r), r.text)});
  }
  return warnings;
}

std::optional<Warning> accuracy_warning(const hydraulics::AccuracyLog::Record& record) {
  if (record.count == 0) return std::nullopt;
  const hydraulics::InaccurateState& worst = record.worst;
  const std::string point = fmt::format(
      "at delivery_bar = {:.6g}, speed_rpm = {:.6g} the estimated error of the "
      "computed chamber pressure is {:.1e} of its peak",
      bar(worst.delivery), worst.speed_rpm, worst.error);
  return Warning{
      "curve-error",
      fmt::format("{}: {}{}, above [hydraulics] curve_error = {:.3g}. A smaller [hydraulics] "
                  "tolerance may reduce it; a larger curve_error accepts it.",
                  worst.file.string(),
                  record.count == 1
                      ? ""
                      : fmt::format("{} operating points exceed the allowed error; the worst: ",
                                    record.count),
                  point, worst.limit)};
}

std::optional<Warning> accuracy_warning(const Case& the_case,
                                        const hydraulics::SteadyState& state) {
  if (hydraulics::is_accurate(the_case, state)) return std::nullopt;
  return accuracy_warning({1, hydraulics::inaccurate_state(the_case, state)});
}

std::string timing_text(const std::vector<TimingRow>& rows) {
  std::string text;
  for (const TimingRow& r : rows)
    text += fmt::format("{:<17} {:>9} {:<25}{:<14}{:<8} {}\n", r.code, value_text(r), r.unit,
                        limit_text(r),
                        !r.limit           ? ""
                        : !r.flagged       ? "holds"
                        : !r.meant.empty() ? "meant"
                        : is_minimum(r)    ? "TOO LOW"
                                           : "EXCEEDED",
                        angles_text(r));
  return text;
}

namespace {

// To the digits that the search finds and that are stated.
double rounded_down(double rpm) {
  const double step = std::pow(10, std::floor(std::log10(rpm)) - 3);
  return std::floor(rpm / step) * step;
}

// Above 0 where the speed is below the one sought.
using Margin = std::function<double(const hydraulics::SteadyState&)>;

SuctionSpeed search_speed(const Case& the_case, SuctionSpeed found, const Margin& margin_of,
                          const Progress& progress) {
  if (!(the_case.operation.speed_rpm > 0))
    throw InputError(the_case.file.string() +
                     ": [operation] speed_rpm = " + number_text(the_case.operation.speed_rpm) +
                     ": must be > 0 to find the largest speed with complete filling");
  const double own = the_case.operation.speed_rpm;
  Case at = the_case;
  at.pressure.points = 0;
  const auto alive = [&](double) {
    if (progress) progress(std::min(0.95, 0.04 * found.solves));
  };
  const auto margin = [&](double rpm) {
    at.operation.speed_rpm = rpm;
    // At the case's own speed as accurate as the case's state: the same loss, the same verdict.
    at.hydraulics->curve_error = rpm == own
                                     ? the_case.hydraulics->curve_error
                                     : std::max(the_case.hydraulics->curve_error, kSpeedCurveError);
    const auto state = hydraulics::steady_state(at, {}, alive);
    ++found.solves;
    found.least = state.summary.chamber_least;
    if (state.timing.filled) found.losses.emplace_back(rpm, state.timing.filled->loss);
    return margin_of(state);
  };
  double speed = own, here = margin(own);
  found.searched_from = found.searched_to = own;
  const bool up = here >= 0;
  const double end = own * (up ? kMaxOverOwn : kMinOverOwn);
  double before = speed, there = here;
  const auto stop = [&](double rpm, const std::exception& error) {
    found.stopped = fmt::format("at {:.5g} rpm: {}", rpm, error.what());
  };
  while ((here >= 0) == up && speed != end) {
    before = speed;
    there = here;
    speed = up ? std::min(end, speed * kFactor) : std::max(end, speed / kFactor);
    try {
      here = margin(speed);
    } catch (const ComputationError& error) {
      stop(speed, error);
    } catch (const InputError& error) {  // a load that takes more than the pump displaces
      stop(speed, error);
    }
    if (!found.stopped.empty()) break;
    (up ? found.searched_to : found.searched_from) = speed;
  }
  if ((here >= 0) != up) {
    std::uintmax_t solves = kMaxSolves;
    const auto close = [](double a, double b) {
      return std::abs(b - a) <= kSpeedTolerance * std::abs(a);
    };
    // The largest speed known to keep the limit: the result where the search breaks off.
    double kept = up ? before : speed;
    const auto noted = [&](double rpm) {
      const double m = margin(rpm);
      if (m >= 0) kept = std::max(kept, rpm);
      return m;
    };
    try {
      const auto [low, high] =
          up ? boost::math::tools::toms748_solve(noted, before, speed, there, here, close, solves)
             : boost::math::tools::toms748_solve(noted, speed, before, here, there, close, solves);
      found.rpm = low;  // below it the limit is kept
      static_cast<void>(high);
    } catch (const ComputationError& error) {
      found.rpm = kept;
      stop(at.operation.speed_rpm, error);
    }
    // In the digits that are stated, so that the limit is kept at what is stated too.
    found.rpm = std::max(rounded_down(*found.rpm), up ? own : 0);
  }
  if (progress) progress(1);
  return found;
}

std::string percent_of_stroke(double loss) {
  return fmt::format("{:.3g} % of a stroke", 100 * loss);
}

}  // namespace

SuctionSpeed suction_speed(const Case& the_case, double limit, const Progress& progress) {
  SuctionSpeed search;
  search.limit = limit;
  // Least pressure above the limit, over the pressure between limit and absolute zero.
  return search_speed(
      the_case, search,
      [limit](const hydraulics::SteadyState& state) {
        return (state.summary.chamber_least - limit) / state.summary.atmosphere;
      },
      progress);
}

SuctionSpeed filling_speed(const Case& the_case, const Progress& progress) {
  SuctionSpeed search;
  search.filling = true;
  search.limit = kLargestFillingLoss;
  return search_speed(
      the_case, search,
      [&](const hydraulics::SteadyState& state) {
        if (!state.timing.filled)
          throw ComputationError(the_case.file.string() +
                                 ": filling: no chamber is ever open to the suction port alone");
        return kLargestFillingLoss - state.timing.filled->loss;
      },
      progress);
}

TimingRow suction_speed_row(const Case& the_case, const SuctionSpeed& found) {
  TimingRow r =
      found.filling ? row("filling-speed", not_computed()) : row("suction-speed", not_computed());
  r.value = found.rpm.value_or(not_computed());
  if (!found.rpm)
    r.bound = found.searched_from < the_case.operation.speed_rpm
                  ? fmt::format("< {:.4g}", found.searched_from)
                  : fmt::format("> {:.4g}", found.searched_to);
  const double own = the_case.operation.speed_rpm;
  r.limit = own;
  r.flagged = found.rpm ? *found.rpm < own : found.searched_from < own;
  r.meant = stated_reason(the_case, r.code);
  const std::string range =
      fmt::format("all speeds from {:.4g} to {:.4g} rpm", found.searched_from, found.searched_to);
  if (found.filling) {
    const std::string limit = percent_of_stroke(found.limit);
    r.text = found.rpm ? fmt::format("up to it incomplete filling costs at most {}", limit)
                       : fmt::format("incomplete filling costs {} than {} at {}",
                                     r.flagged ? "more" : "less", limit, range);
  } else {
    const double limit = bar(found.limit);
    r.text = found.rpm ? fmt::format("no chamber below {:.4g} bar up to it", limit)
                       : fmt::format("a chamber is {} {:.4g} bar at {}",
                                     r.flagged ? "below" : "never below", limit, range);
    // What the limit on the pressure does not say.
    if (!found.losses.empty() && found.rpm) {
      const auto& nearest = *std::min_element(
          found.losses.begin(), found.losses.end(), [&](const auto& a, const auto& b) {
            return std::abs(a.first - *found.rpm) < std::abs(b.first - *found.rpm);
          });
      r.text += nearest.second <= 0 ? "; at it the chambers fill"
                                    : fmt::format("; at it incomplete filling costs {}{}",
                                                  percent_of_stroke(nearest.second),
                                                  fills(nearest.second) ? "" : ": not filled");
    }
  }
  if (!found.stopped.empty()) r.text += "; the search ends " + found.stopped;
  return r;
}

}  // namespace bentaxis::study
