// The port plate and the arcs of its ports.
#include <fmt/format.h>

#include <cmath>

#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

// The ports of the plate, then those of [hydraulics], up to the first that something is said of.
template <class Text>
std::string of_ports(const Facts& f, const Text& text) {
  std::string found;
  if (f.pump.port_plate)
    found = text("port_plate", f.pump.port_plate->delivery, f.pump.port_plate->suction);
  if (found.empty() && f.oil != nullptr)
    found = text("hydraulics", f.oil->delivery.arc, f.oil->suction.arc);
  return found;
}

}  // namespace

std::vector<Check> port_plate() {
  return {
      {"lands-off-bores",
       "the bore circle lies outside r1 .. r4, or the groove r2 .. r3 extends outside Rd -+ Dpi/2",
       [](const Facts& f) { return f.pump.port_plate.has_value(); },
       [](const Facts& f) -> std::string {
         const PortPlate& p = *f.pump.port_plate;
         const double rd = f.g.bore_circle_radius, half = f.bore / 2;
         if (p.r1 < rd && rd < p.r4 && p.r2 >= rd - half && p.r3 <= rd + half) return "";
         return fmt::format(
             "inner_land_mm = [{:.6g}, {:.6g}], outer_land_mm = [{:.6g}, {:.6g}]: the groove "
             "between "
             "them feeds bores that reach from {:.4g} to {:.4g} mm (Rd -+ Dpi/2){}",
             mm(p.r1), mm(p.r2), mm(p.r3), mm(p.r4), mm(rd - half), mm(rd + half),
             guess(mm(p.r2 + p.r3) / 2, 0.8 * mm(rd), 1.2 * mm(rd),
                   {kDiameter, kMetres, kCentimetres, kTenth, kInches}));
       }},
      {"port-arcs-exchanged",
       "delivery port over 0 .. 180 deg, where chambers fill, and suction port over 180 .. 360: by "
       "the y of their middles",
       // A pump that delivers elsewhere is the business of pressure-phase.
       [](const Facts& f) { return !f.turn || !(f.turn->work_ratio < 0.6); },
       [](const Facts& f) {
         return of_ports(f, [](const char* table, const PortArc& d, const PortArc& s) {
           const auto y = [](const PortArc& arc) {
             return std::sin((arc.from_deg + arc.to_deg) / 2 * kRadPerDegree);
           };
           return y(d) > y(s) ? fmt::format(
                                    "[{}] delivery_arc_deg = [{:.6g}, {:.6g}], "
                                    "suction_arc_deg = [{:.6g}, {:.6g}]: chambers fill from "
                                    "0 to 180 deg and deliver from 180 to 360: exchanged?",
                                    table, d.from_deg, d.to_deg, s.from_deg, s.to_deg)
                              : std::string();
         });
       }},
      {"port-arc", "a port of less than 30 or more than 180 deg",
       [](const Facts& f) {
         return of_ports(f, [](const char* table, const PortArc& delivery, const PortArc& suction) {
           const auto one = [&](const char* port, const PortArc& arc) {
             return outside(fmt::format("[{}] {}_arc_deg covers", table, port),
                            arc.to_deg - arc.from_deg, 30, 180, "deg",
                            fmt::format("from {:.6g} to {:.6g}; a port serves half a turn less the "
                                        "bridges",
                                        arc.from_deg, arc.to_deg),
                            {kRadians});
           };
           return first_of({one("delivery", delivery), one("suction", suction)});
         });
       }},
      {"port-arcs-overlap", "delivery and suction port share an angle",
       [](const Facts& f) {
         return of_ports(f,
                         [](const char* table, const PortArc& a, const PortArc& b) -> std::string {
                           const auto within = [](double angle, const PortArc& arc) {
                             double past = std::fmod(angle - arc.from_deg, 360);
                             if (past < 0) past += 360;
                             return past < arc.to_deg - arc.from_deg;
                           };
                           if (!within(a.from_deg, b) && !within(b.from_deg, a)) return "";
                           return fmt::format(
                               "[{}] delivery_arc_deg = [{:.6g}, {:.6g}] and suction_arc_deg = "
                               "[{:.6g}, {:.6g}] "
                               "overlap: the ports would be one",
                               table, a.from_deg, a.to_deg, b.from_deg, b.to_deg);
                         });
       }},
  };
}

}  // namespace bentaxis::study::checks
