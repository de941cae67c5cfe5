// The oil.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/counted.h"
#include "bentaxis/pump/periodic_spline.h"
#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

constexpr double kCreep = 1;  // m/s, below it losses are no longer shares of the power

bool has_oil(const Facts& f) { return f.oil != nullptr; }
bool has_stroke_and_oil(const Facts& f) { return f.oil != nullptr && f.derived.stroke != 0; }

}  // namespace

std::vector<Check> hydraulics() {
  return {
      {"oil-density", "density outside {0:g} .. {1:g} kg/m3", "hydraulics", "density_kg_per_m3"},
      {"bulk-modulus", "bulk modulus outside {0:g} .. {1:g} MPa", "hydraulics", "bulk_modulus_MPa"},
      {"air-content", "air below {0:g} or above {1:g} per cent", "hydraulics", "air_percent"},
      {"atmosphere", "atmosphere outside {0:g} .. {1:g} bar", "hydraulics", "atmosphere_bar"},
      {"kidney",
       "kidney wider than the pitch 360/N or narrower than a fifth of the bore; higher than the "
       "bore "
       "or of less than 8 % of its area",
       has_oil,
       [](const Facts& f) {
         const double pitch = 360.0 / f.g.pistons;
         const double bore = 2 * deg(std::asin(std::min(1.0, f.bore / 2 / f.g.bore_circle_radius)));
         const double area = f.oil->kidney_width_deg * kRadPerDegree * f.g.bore_circle_radius *
                             f.oil->kidney_height;
         return first_of({outside(f, "hydraulics", "kidney_width_deg", bore / 5, pitch,
                                  fmt::format("a bore covers {:.3g} deg, the pitch of {} is {:.4g}",
                                              bore, counted(f.g.pistons, "kidney"), pitch),
                                  {kRadians, kTenfold, kTenth}),
                          outside(f, "hydraulics", "kidney_height_mm", 0, mm(f.bore),
                                  "a kidney is not higher than its bore", {kTenth, kMicrometres}),
                          outside("kidney_height_mm: kidney area", mm2(area), 0.08 * mm2(f.area),
                                  HUGE_VAL, "mm2",
                                  fmt::format("8 % of the bore's {:.4g} mm2 (height {:.4g} mm)",
                                              mm2(f.area), mm(f.oil->kidney_height)))});
       }},
      {"notch",
       "a notch of less than 1 deg, or of less than 2e-4 or more than 0.2 of the bore's area",
       has_oil,
       [](const Facts& f) {
         const double area = mm2(f.area);
         const auto one = [&](const std::string& port, const Notch& notch) -> std::string {
           if (notch.length_deg == 0 || notch.area == 0) return "";
           return first_of(
               {outside(f, "hydraulics", port + "_notch_deg", 1, 90,
                        "a silencing notch leads by 5 to 20 deg", {kRadians}),
                outside(f, "hydraulics", port + "_notch_area_mm2", 2e-4 * area, 0.2 * area,
                        fmt::format("a bore has {:.4g} mm2, a notch some", area),
                        {kSquareCm, kHundredth, kSquareM, kTenth})});
         };
         return first_of(
             {one("delivery", f.oil->delivery.notch), one("suction", f.oil->suction.notch)});
       }},
      {"discharge-coefficient", "Cd outside {0:g} .. {1:g}", "hydraulics", "discharge_coefficient",
       always,
       [](const Facts& f) {
         return first_of({implausible(f, "hydraulics", "discharge_coefficient"),
                          implausible(f, "hydraulics", "delivery_discharge_coefficient"),
                          implausible(f, "hydraulics", "suction_discharge_coefficient")});
       }},
      {"transition-pressure", "p_cr above 5 bar and a twentieth of the delivery pressure", has_oil,
       [](const Facts& f) {
         return outside(f, "hydraulics", "transition_pressure_bar", 0,
                        std::max(5.0, bar(f.ports.delivery) / 20),
                        "orifices are turbulent well below the delivery pressure",
                        {kPascals, kTenth});
       }},
      {"leakage", "chambers on delivery lose more than 15 % of the ideal flow (at 1 m/s at least)",
       has_stroke_and_oil,
       [](const Facts& f) -> std::string {
         const double lost = 0.5 * f.g.pistons * f.oil->leakage * std::max(0.0, f.ports.delivery);
         const double flow = f.g.pistons * f.area * std::max(f.piston_speed, kCreep) / 2;
         if (lost <= 0.15 * flow) return "";
         return fmt::format(
             "leakage_l_per_min_per_bar = {:.4g} loses {:.4g} l/min at {:.4g} bar, above 15 % of "
             "{:.4g} l/min",
             f.oil->leakage * 6e4 * kPascalPerBar, lost * 6e4, bar(f.ports.delivery), flow * 6e4);
       }},
      {"case-pressure", "case pressure above {1:g} bar", "hydraulics", "case_bar"},
      {"dead-volume", "V0 below 0.03 or above 5 times the stroke's volume", has_stroke_and_oil,
       [](const Facts& f) {
         const double stroke = f.area * f.derived.stroke * 1e6;
         return outside(
             f, "hydraulics", "dead_volume_cm3", 0.03 * stroke, 5 * stroke,
             fmt::format("a stroke displaces {:.4g} cm3", stroke),
             {{1e-3, "in mm3?"}, {1e3, "in litres?"}, {1e6, "in m3?"}, kTenfold, kHundredth});
       }},
      {"stroke-file", "the oil follows `stroke_file`, the forces the pump's own geometry",
       [](const Facts& f) { return f.oil != nullptr && !f.oil->stroke.theta_deg.empty(); },
       [](const Facts& f) {
         const StrokeTable& stroke = f.oil->stroke;
         const auto [least, greatest] = PeriodicSpline(stroke.theta_deg, stroke.value).extremes();
         const double displaced = (greatest - least) * (stroke.is_volume ? 1 : f.area);
         return fmt::format(
             "stroke_file: the oil's chambers displace {:.4g} cm3 per stroke by this file; forces, "
             "torque and efficiency are of pistons that displace {:.4g} cm3 by the pump's geometry",
             displaced * 1e6, f.area * f.derived.stroke * 1e6);
       }},
      {"delivery-volume", "delivery volume below 0.05 or above 1000 times the displacement",
       has_stroke_and_oil,
       [](const Facts& f) {
         const double turn = f.derived.displacement * 1e3;
         return outside(f, "hydraulics", "delivery_volume_l", 0.05 * turn, 1000 * turn,
                        fmt::format("a turn displaces {:.4g} l", turn),
                        {{1e-3, "in cm3?"}, {1e3, "in m3?"}});
       }},
      {"curve-points", "a spline of fewer than {0:g} points of the computed pressure in a turn",
       "pressure", "points",
       [](const Facts& f) {
         const PressureSpec& p = f.the_case.pressure;
         return p.kind == PressureKind::hydraulic && p.points != 0;
       }},
  };
}

}  // namespace bentaxis::study::checks
