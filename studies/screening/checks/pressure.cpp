// Pressures of the ports and curves of the pressure.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"
#include "bentaxis/results/samples.h"
#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

constexpr Slip kPsi{0.0689476, "in psi?"};

// The widest gap between points of a curve of pressure, if it is too wide.
std::string gap_of_curve(const PressureSpec& pressure) {
  constexpr double kWidest = 30;  // deg
  const std::vector<double>& theta = pressure.curve.theta_deg;
  if (theta.size() < 3) return "";
  double from = theta.back(), to = theta.front() + 360;
  for (std::size_t i = 1; i < theta.size(); ++i)
    if (theta[i] - theta[i - 1] > to - from) {
      from = theta[i - 1];
      to = theta[i];
    }
  if (to - from <= kWidest) return "";
  const PressureTrace trace(pressure);
  const auto [low, high] =
      std::minmax_element(pressure.curve.pressure.begin(), pressure.curve.pressure.end());
  double furthest = 0, at = from;  // beyond all points
  for (int i = 1; i < 100; ++i) {
    const double angle = from + (to - from) * i / 100, p = trace(angle);
    const double beyond = std::max(p - *high, *low - p);
    if (beyond > furthest) {
      furthest = beyond;
      at = angle;
    }
  }
  const double covered = theta.back() - theta.front();
  return fmt::format(
      "[pressure] file has no point from {:.5g} to {:.5g} deg: what acts there is what a spline "
      "makes "
      "of the points around{}{}",
      from, wrap_degrees(to),
      furthest > 0 ? fmt::format(", as {:.4g} bar at {:.4g} deg", bar(trace(at)), wrap_degrees(at))
                   : "",
      covered < 2 * kPi ? guess(covered, 180, 360, {kRadians}) : "");
}

}  // namespace

std::vector<Check> pressure() {
  return {
      {"pressure-beyond-1000-bar", "delivery, suction or the curve above 1000 bar",
       [](const Facts& f) {
         const auto one = [](const char* key, double p) {
           return outside(key, bar(p), -HUGE_VAL, bar(kMaxPressure), "bar",
                          "hydraulic pumps have at most 500 bar",
                          {kPascals, kKilopascals, kPsi, kTenth});
         };
         return first_of({one("delivery_bar", f.ports.delivery),
                          one("suction_bar", f.ports.suction),
                          f.turn && f.the_case.pressure.kind == PressureKind::curve
                              ? one("[pressure] file: its highest", f.turn->highest_pressure)
                              : std::string()});
       }},
      {"pressure-low",
       "0 < delivery < 3 bar, or delivery below -1.014 bar (absolute vacuum). 0 is no load and "
       "accepted",
       [](const Facts& f) { return f.ports.delivery != 0; },
       [](const Facts& f) {
         if (f.ports.delivery < 0)
           return outside(f, "pressure", "delivery_bar", -1.014, HUGE_VAL,
                          "absolute vacuum is at -1.013", {kSign});
         return outside(f, "pressure", "delivery_bar", 3, HUGE_VAL, "almost no load",
                        {{100, "in units of 100 bar?"}, {1000, "in kbar?"}});
       }},
      {"delivery-below-suction", "delivery pressure below suction pressure",
       [](const Facts& f) { return f.ports.delivery < f.ports.suction; },
       [](const Facts& f) {
         return fmt::format("delivery_bar = {:.6g} is below suction_bar = {:.6g}: exchanged?",
                            bar(f.ports.delivery), bar(f.ports.suction));
       }},
      {"suction-pressure",
       "suction below {0:g} bar (absolute vacuum), above {1:g} bar, or 1 atmosphere (pressures are "
       "gauge)",
       "pressure", "suction_bar", always,
       [](const Facts& f) -> std::string {
         const double suction = bar(f.ports.suction);
         if (std::abs(suction - 1.01325) < 1e-3)
           return fmt::format("suction_bar = {:.6g}: pressures are gauge; absolute?", suction);
         return implausible(f, "pressure", "suction_bar");
       }},
      {"transition", "0 < transition < {0:g} deg (0 is a step and accepted), or > {1:g} deg",
       "pressure", "transition_deg",
       [](const Facts& f) {
         const PressureSpec& p = f.the_case.pressure;
         return p.kind == PressureKind::ideal && p.transition_deg != 0;
       }},
      {"pressure-phase",
       "the pressure on a piston does less than 0.6 of the ideal work (delivery - suction) x A x "
       "stroke over a turn: it does not act while the chamber volume decreases (180 .. 360 deg)",
       [](const Facts& f) {
         return f.turn && f.ports.delivery - f.ports.suction >= kPascalPerBar &&
                f.derived.stroke >= 0.01 * f.g.joint_circle_radius && !(f.turn->work_ratio >= 0.6);
       },
       [](const Facts& f) {
         const bool ideal = f.the_case.pressure.kind == PressureKind::ideal;
         const double start = f.the_case.pressure.delivery_start_deg;
         return fmt::format(
             "{}: the pressure does {:.3g} of the ideal work over a turn; chamber volumes decrease "
             "from 180 to 360 deg{}",
             ideal ? fmt::format("delivery_start_deg = {:.6g}", start) : "[pressure] file",
             f.turn->work_ratio,
             ideal ? guess(start, 150, 210, {kRadians})
                   : "; another zero or sense of the angle, or "
                     "another unit of pressure?");
       }},
      {"curve-gap", "neighbouring points of the curve are more than 30 deg apart",
       [](const Facts& f) { return f.the_case.pressure.kind == PressureKind::curve; },
       [](const Facts& f) { return gap_of_curve(f.the_case.pressure); }},
      {"curve-pressure",
       "the highest pressure of the curve is not within 0.5 .. 2 times delivery_bar, the lowest "
       "is below absolute vacuum by more than 10 % of it, or the curve does more than 1.5 of the "
       "ideal work (delivery - suction) x A x stroke over a turn",
       [](const Facts& f) {
         return f.the_case.pressure.kind == PressureKind::curve && f.turn &&
                bar(f.ports.delivery) > 1;
       },
       [](const Facts& f) {
         const double delivery = bar(f.ports.delivery);
         return first_of(
             {outside("[pressure] file: its highest", bar(f.turn->highest_pressure), delivery / 2,
                      2 * delivery, "bar", fmt::format("delivery_bar = {:.6g}", delivery),
                      {{10, "in MPa?"}, kPascals, kKilopascals, kPsi}),
              outside(
                  "[pressure] file: its lowest", bar(f.turn->lowest_pressure),
                  -1.014 - delivery / 10, HUGE_VAL, "bar",
                  "absolute vacuum is at -1.013, and a spline may leave its points by a tenth of "
                  "delivery_bar",
                  f.turn->highest_pressure < -f.turn->lowest_pressure / 2 ? Slips{kSign} : Slips{}),
              outside("[pressure] file: its work in a turn over the ideal work", f.turn->work_ratio,
                      -HUGE_VAL, 1.5, "", fmt::format("with delivery_bar = {:.6g}", delivery))});
       }},
  };
}

}  // namespace bentaxis::study::checks
