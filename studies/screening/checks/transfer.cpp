// What carries the block: joints and walls of pistons.
#include <fmt/format.h>

#include <cmath>

#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

constexpr double kCardanTilt = 25;  // deg; the block's speed ripples by 20 %
constexpr double kWidePlay = 5;     // deg, of a block that pistons carry

bool has_walls(const Facts& f) { return f.walls.has_value(); }
bool has_cardan(const Facts& f) { return f.pump.transfer.is_uneven_joint(); }
bool has_double_cardan(const Facts& f) {
  return f.pump.transfer.kind == TransferKind::double_cardan;
}
// Data of walls in a pump whose pistons are not meant to touch them.
bool has_unused_walls(const Facts& f) {
  const auto& wall = f.pump.transfer.wall;
  return f.pump.transfer.kind != TransferKind::pistons && wall && wall->clearance > 0 &&
         wall->from_joint > 0;
}

}  // namespace

std::vector<Check> transfer() {
  return {
      {"cardan-tilt", "a single universal joint at a tilt above 25 deg", has_cardan,
       [](const Facts& f) {
         const double c = std::cos(f.g.tilt);
         return outside(
             "tilt_deg", deg(f.g.tilt), 0, kCardanTilt, "deg",
             fmt::format("one universal joint makes the block's speed ripple by {:.3g} % "
                         "of the shaft's, and its side couple reach {:.3g} of the torque",
                         100 * (1 / c - c), std::tan(f.g.tilt)));
       }},
      {"cross-distance",
       "the crosses of a double universal joint stand outside {0:g} .. {1:g} mm from O2",
       "transfer", "cross_distance_mm", has_double_cardan},
      {"wall-clearance",
       "pistons carry the block, and the clearance leaves it no free play at some angle, or more "
       "than 5 deg of it",
       has_walls,
       [](const Facts& f) -> std::string {
         const double clearance = mm(f.pump.transfer.wall->clearance);
         const double swing =
             f.walls->share * mm(f.g.joint_circle_radius) * (1 - std::cos(f.g.tilt)) / 2;
         if (is_computed(f.walls->without_deg))
           return fmt::format(
               "clearance_mm = {:.6g} leaves the block no free play at {:.4g} deg: it must exceed "
               "about {:.4g} mm, (1 - l_c/b1) Ra (1 - cos tilt)/2, and leave a piston that can "
               "touch{}",
               clearance, f.walls->without_deg, swing,
               guess(clearance, swing, 2 * swing,
                     {kTenfold, kTenth, kRadius, kDiameter, kMetres, kMicrometres}));
         if (deg(f.walls->widest) <= kWidePlay) return "";
         return fmt::format(
             "clearance_mm = {:.6g} leaves the block {:.3g} deg of free play at {:.4g} deg, above "
             "{:.4g}: the ports' timing would shift by as much; the pistons swing by about {:.4g} "
             "mm{}",
             clearance, deg(f.walls->widest), f.walls->widest_deg, kWidePlay, swing,
             guess(clearance, swing, 1.2 * swing, {kTenth, kDiameter}));
       }},
      {"wall-stiffness", "pistons carry the block on walls outside {0:g} .. {1:g} N/um", "transfer",
       "stiffness_N_per_um", has_walls},
      {"wall-damping",
       "a wall whose damping leaves no force where the piston that carries leaves it, at the "
       "case's "
       "speed",
       has_walls,
       [](const Facts& f) -> std::string {
         const double dissipation = f.pump.transfer.wall->dissipation;
         if (dissipation * f.walls->leaving < 1) return "";
         return fmt::format(
             "dissipation_s_per_m = {:.6g} leaves a wall no force where a piston leaves it faster "
             "than {:.4g} mm/s: the piston that carries does so at {:.4g} mm/s ({:.4g} deg, {:.6g} "
             "rpm)",
             dissipation, 1e3 / dissipation, 1e3 * f.walls->leaving, f.walls->leaving_deg, f.speed);
       }},
      {"wall-contact",
       "the contact point of the piston that carries outside of its bore, which begins where the "
       "joints come nearest to the block, or behind the ring, in the chamber",
       has_walls,
       [](const Facts& f) {
         const double ring = f.pump.piston.contact.value_or(f.g.piston_length);
         return outside(f, "transfer", "contact_from_joint_mm", mm(f.walls->outside), mm(ring),
                        fmt::format("the piston that carries stands {:.4g} mm out of a bore that "
                                    "begins where the joints come nearest to the block (theta = "
                                    "{:.4g} deg), and the ring is {:.4g} mm from A",
                                    mm(f.walls->outside), f.walls->outside_deg, mm(ring)),
                        {kTenfold, kCentimetres, kMetres, kTenth});
       }},
      {"piston-touches-bore",
       "a gear or a joint drives the block, and by contact_from_joint_mm and clearance_mm a piston "
       "tilts so far that it touches its bore",
       has_unused_walls,
       [](const Facts& f) -> std::string {
         const WallContact& wall = *f.pump.transfer.wall;
         const AssemblyMargin margin = assembly_margin(f.pump);
         const double off = (1 - wall.from_joint / f.g.piston_length) * margin.longest_distance;
         const double clearance = wall.smallest_clearance();
         if (off <= clearance) return "";
         return fmt::format(
             "a piston's axis is {:.4g} mm from that of its bore at {:.4g} deg, "
             "contact_from_joint_mm = {:.6g} from A: above {} = {:.6g}, the piston touches "
             "its bore, and [transfer] kind = \"{}\" leaves that out",
             mm(off), margin.theta_deg, mm(wall.from_joint),
             wall.deviation.empty() ? "clearance_mm" : "the smallest clearance in mm",
             mm(clearance), to_string(f.pump.transfer.kind));
       }},
  };
}

}  // namespace bentaxis::study::checks
