#include "pump_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bentaxis/pump/units.h"
#include "bevel_tooth.h"

namespace bentaxis::study {
namespace {

using report::Look;
using report::Shape;
using Corner = std::array<double, 2>;
using Line = std::vector<Corner>;

constexpr int kCirclePoints = 48;
constexpr int kBorePoints = 28;
constexpr double kDegreesPerPoint = 6;  // of an arc

Line circle(double radius, int points, Corner centre = {0, 0}) {
  Line line;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * kPi * i / points;
    line.push_back({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)});
  }
  return line;
}

// Where psi of a chamber is.
Corner on_circle(double radius, double psi) {
  return {-radius * std::sin(psi), radius * std::cos(psi)};
}

// Between two radii from one angle to another, as those of a port.
Line sector(double inner, double outer, double from_deg, double to_deg) {
  const int pieces =
      std::max(2, static_cast<int>(std::ceil((to_deg - from_deg) / kDegreesPerPoint)));
  Line line;
  const auto add = [&](double radius, int i) {
    line.push_back(on_circle(radius, radians(from_deg + (to_deg - from_deg) * i / pieces)));
  };
  for (int i = 0; i <= pieces; ++i) add(outer, i);
  for (int i = pieces; i >= 0; --i) add(inner, i);
  return line;
}

// Seen from the port plate, at this z.
report::Wire wire(const Line& line, double z) {
  report::Wire result{{}, true};
  for (const auto& [x, y] : line) result.points.push_back({x, y, z});
  return result;
}

class Shapes {
 public:
  Shapes(const Case& the_case, const PumpOutline& outline)
      : case_(the_case), p_(the_case.pump), g_(p_.geometry), o_(outline) {}

  PumpShapes all() {
    shapes_.note =
        std::string("To scale: joints, bores, pistons' length and bore, axes, ") +
        (o_.has_gear ? "gear, " : "") +
        "pin, centres of bearings"
        " and the ports and lands of the plate. Of no dimension in the case, so of a size chosen "
        "here: shaft and flange, ball joints, rods, outside and bottom of the block, thickness of "
        "the plate, bearings";
    shaft();
    piston();
    block();
    plate();
    bearings();
    transfer();
    pin();
    shapes_.note += ".";
    return std::move(shapes_);
  }

 private:
  void shaft();
  void piston();
  void block();
  void plate();
  void port(const PortArc& arc, Look look);
  void notches(const PlatePort& port, Look look);
  void bearings();
  void gear();
  void transfer();
  void pin();
  void line(std::vector<Shape>& shapes, Look look, double from, double to) {
    shapes.push_back({report::Wire{{{0, 0, from}, {0, 0, to}}, false}, look});
  }

  const Case& case_;
  const PumpParameters& p_;
  const Geometry& g_;
  const PumpOutline& o_;
  PumpShapes shapes_;
};

void Shapes::shaft() {
  const double r = o_.shaft_radius;
  // Its flange ends below the centres of the joints, which lie in it.
  const double face = -0.35 * o_.ball;
  const double behind = face - o_.flange;
  shapes_.shaft.push_back({report::Lathe{{{0, o_.shaft_end},
                                          {r, o_.shaft_end},
                                          {r, behind - 0.1 * o_.size},
                                          {o_.flange_radius, behind},
                                          {o_.flange_radius, face},
                                          {0, face}}},
                           Look::shaft});
  // Seats: rings about the balls.
  for (int k = 0; k < g_.pistons; ++k) {
    const Corner centre = on_circle(g_.joint_circle_radius, -2 * kPi * k / g_.pistons);
    const bool apart =
        g_.pistons == 1 || 2 * g_.joint_circle_radius * std::sin(kPi / g_.pistons) > 2.5 * o_.ball;
    if (apart)
      shapes_.shaft.push_back({report::Prism{circle(1.22 * o_.ball, kBorePoints, centre),
                                             {circle(o_.ball, kBorePoints, centre)},
                                             face,
                                             0},
                               Look::shaft});
  }
  line(shapes_.shaft, Look::axis, o_.shaft_end - 0.08 * o_.size, 0.35 * o_.size);
}

void Shapes::piston() {
  const double length = g_.piston_length, half = o_.bore / 2;
  const double ring = 0.97 * half, neck = 0.62 * o_.ball, collar = 0.18 * half;
  shapes_.piston.push_back({report::Ball{{0, 0, 0}, o_.ball}, Look::piston});
  shapes_.piston.push_back({report::Lathe{{{0, 0},
                                           {neck, 0},
                                           {0.86 * half, length - collar},
                                           {ring, length - collar / 2},
                                           {ring, length + collar / 2},
                                           {0.8 * ring, length + 0.1 * o_.bore},
                                           {0, length + 0.1 * o_.bore}}},
                            Look::piston});
}

void Shapes::block() {
  const Line outline = circle(o_.block_radius, kCirclePoints);
  std::vector<Line> bores;
  for (int k = 0; k < g_.pistons; ++k)
    bores.push_back(circle(o_.bore / 2, kBorePoints,
                           on_circle(g_.bore_circle_radius, -2 * kPi * k / g_.pistons)));
  // Bores that cut each other leave no block to draw.
  const bool apart =
      g_.pistons == 1 || 2 * g_.bore_circle_radius * std::sin(kPi / g_.pistons) > 1.02 * o_.bore;
  if (apart) {
    shapes_.block.push_back(
        {report::Prism{outline, bores, o_.block_from, o_.bore_bottom}, Look::block, true});
    shapes_.block.push_back(
        {report::Prism{outline, {}, o_.bore_bottom, o_.block_to}, Look::block, true});
  } else {
    for (const Line& bore : bores)
      for (const double z : {o_.block_from, o_.bore_bottom})
        shapes_.block.push_back({wire(bore, z), Look::block});
    shapes_.note += "; the bores cut each other, so that they are drawn alone";
  }
  line(shapes_.block, Look::axis, -0.2 * o_.size, o_.block_to + 0.5 * o_.bore);
}

// On the plate, whose z is 0 at its face to the block and grows away from it.
void Shapes::port(const PortArc& arc, Look look) {
  const PortPlate& plate = *p_.port_plate;
  const double end = std::min(arc.to_deg, arc.from_deg + 359.9);
  shapes_.plate.push_back(
      {report::Prism{
           sector(plate.r2, plate.r3, arc.from_deg, end), {}, 0.5 * o_.plate, 0.9 * o_.plate},
       look});
  shapes_.plate.push_back({wire(sector(plate.r2, plate.r3, arc.from_deg, end), 0), look});
  // Both lands beside it.
  shapes_.plate.push_back({wire(sector(plate.r1, plate.r4, arc.from_deg, end), 0), look});
}

// Silencing notches, grooves and holes of the hydraulic description, on the face of the plate.
void Shapes::notches(const PlatePort& port, Look look) {
  const double middle = (p_.port_plate->r2 + p_.port_plate->r3) / 2;
  const double half = (p_.port_plate->r3 - p_.port_plate->r2) / 2;
  const auto notch = [&](double root_deg, double length_deg) {
    if (length_deg == 0) return;
    const double psi = radians(root_deg), tip = radians(root_deg + length_deg);
    const auto at = [&](double r, double angle) {
      return report::Point{-r * std::sin(angle), r * std::cos(angle), 0};
    };
    shapes_.plate.push_back(
        {report::Wire{{at(middle - 0.3 * half, psi), at(middle, tip), at(middle + 0.3 * half, psi)},
                      false},
         look});
  };
  notch(port.arc.from_deg, -port.notch.length_deg);
  notch(port.arc.to_deg, port.trailing_notch.length_deg);
  if (port.groove.area > 0)
    shapes_.plate.push_back(
        {wire(sector(middle - port.groove.width / 2, middle + port.groove.width / 2,
                     port.groove.from_deg, port.groove.to_deg),
              0),
         look});
  for (const PlateHole& hole : port.holes)
    if (hole.diameter > 0)
      shapes_.plate.push_back(
          {wire(circle(hole.diameter / 2, kBorePoints,
                       on_circle(g_.bore_circle_radius, radians(hole.angle_deg))),
                0),
           look});
}

void Shapes::plate() {
  const bool fits = p_.port_plate && !o_.is_far(p_.port_plate->r4);
  const double radius =
      fits ? std::max(o_.block_radius, 1.06 * p_.port_plate->r4) : o_.block_radius;
  std::vector<Line> holes;
  if (fits)
    for (const PortArc& arc : {p_.port_plate->delivery, p_.port_plate->suction})
      if (arc.to_deg > arc.from_deg)
        holes.push_back(sector(p_.port_plate->r2, p_.port_plate->r3, arc.from_deg,
                               std::min(arc.to_deg, arc.from_deg + 359.9)));
  shapes_.plate.push_back(
      {report::Prism{circle(radius, kCirclePoints), holes, 0, o_.plate}, Look::plate, true});
  if (!p_.port_plate) {
    shapes_.note += "; the case has no port plate: a plain one is drawn";
    return;
  }
  if (!fits) {
    shapes_.note += "; the plate's ports are outside the picture";
    return;
  }
  port(p_.port_plate->delivery, Look::delivery);
  port(p_.port_plate->suction, Look::suction);
  if (!case_.hydraulics) return;
  notches(case_.hydraulics->delivery, Look::delivery);
  notches(case_.hydraulics->suction, Look::suction);
}

void Shapes::bearings() {
  const double low = o_.shaft_radius, high = low + o_.bearing_height, half = o_.bearing_half;
  for (const bool tapered : {true, false}) {
    const double z = tapered ? p_.bearings.tapered_z : p_.bearings.cylindrical_z;
    if (o_.is_far(z)) {
      shapes_.note += tapered ? "; the tapered bearing is outside the picture"
                              : "; the cylindrical bearing is outside the picture";
      continue;
    }
    // The tapered one leans.
    const double lean = tapered ? 0.3 * o_.bearing_height : 0;
    shapes_.housing.push_back({report::Lathe{{{low, z - half},
                                              {high - lean, z - half},
                                              {high, z + half},
                                              {low, z + half},
                                              {low, z - half}}},
                               Look::bearing, true});
  }
}

// A gear's teeth about its cone's axis, which is z times `up` away from O2; tooth 1 stands
// `ahead` pitches from O4 where its angle is 0, along growing angles.
report::Mesh teeth(const BevelTooth& tooth, double apex_z, double up, double ahead) {
  constexpr int kPoints = 5;  // of a flank
  const double pitch = 2 * kPi / tooth.count();
  report::Mesh mesh;
  const auto quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    // The cone's axis turned over turns the order of the corners with it.
    if (up > 0) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    } else {
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
  };
  for (int i = 0; i < tooth.count(); ++i) {
    const double middle = (i + ahead) * pitch;
    const std::size_t first = mesh.points.size();
    // One end after the other: up one flank, down the other. Growing angles go towards -x at O4.
    for (const double distance : {tooth.inside(), tooth.outside()})
      for (int j = 0; j < 2 * kPoints; ++j) {
        const int step = j < kPoints ? j : 2 * kPoints - 1 - j;
        const double polar = tooth.root() + (tooth.tip() - tooth.root()) * step / (kPoints - 1);
        const double azimuth = middle + (j < kPoints ? 1 : -1) * tooth.half_angle(polar);
        mesh.points.push_back({-distance * std::sin(polar) * std::sin(azimuth),
                               distance * std::sin(polar) * std::cos(azimuth),
                               apex_z + up * distance * std::cos(polar)});
      }
    const std::size_t other = first + 2 * kPoints;
    for (std::size_t j = 0; j + 1 < 2 * kPoints; ++j)
      quad(first + j, other + j, other + j + 1, first + j + 1);
    for (std::size_t j = 0; j + 1 < kPoints; ++j) {
      const std::size_t opposite = 2 * kPoints - 1 - j;
      quad(first + j, first + j + 1, first + opposite - 1, first + opposite);
      quad(other + j, other + opposite, other + opposite - 1, other + j + 1);
    }
  }
  return mesh;
}

// What turns the block: a gear, a joint at O2, or pistons that touch their bores at D.
void Shapes::transfer() {
  const double r = o_.transfer_radius(), thick = 0.06 * o_.size;
  // In a body's own axes, which turn with it.
  const auto arm = [&](std::vector<Shape>& shapes, double x, double y, double z) {
    shapes.push_back({report::Wire{{{-r * x, -r * y, z}, {r * x, r * y, z}}, false}, Look::gear});
    for (const double sign : {-1.0, 1.0})
      shapes.push_back({report::Ball{{sign * r * x, sign * r * y, z}, thick}, Look::gear});
  };
  switch (p_.transfer.kind) {
    case TransferKind::gear:
      return gear();
    case TransferKind::constant_velocity: {
      // Either half a bell about O2.
      const auto bell = [&](double centre, double up) {
        Line profile;
        constexpr int kPoints = 8;
        for (int i = 0; i <= kPoints; ++i) {
          const double at = kPi / 2 * i / kPoints;
          profile.push_back({r * std::cos(at), centre - up * r * std::sin(at)});
        }
        return report::Lathe{profile};
      };
      shapes_.shaft.push_back({bell(g_.axis_offset, 1), Look::gear, true});
      shapes_.block.push_back({bell(0, -1), Look::gear, true});
      shapes_.note += "; the constant-velocity joint is drawn as two bells";
      return;
    }
    case TransferKind::double_cardan: {
      // The arms that the forks of shaft and block hold, at the centres of their crosses.
      const double phase = p_.transfer.phase(), c = std::cos(phase), s = std::sin(phase);
      const double distance = p_.transfer.double_cardan->cross_distance;
      arm(shapes_.shaft, c, -s, g_.axis_offset - distance);
      arm(shapes_.block, c, -s, distance);
      shapes_.note +=
          "; of the double universal joint the arms in the forks of shaft and block are drawn";
      return;
    }
    case TransferKind::cardan: {
      const double phase = p_.transfer.phase(), c = std::cos(phase), s = std::sin(phase);
      arm(shapes_.shaft, c, -s, g_.axis_offset);
      arm(shapes_.block, s, c, 0);
      shapes_.note += "; of the universal joint the arms of both forks are drawn";
      return;
    }
    case TransferKind::pistons:
      break;
  }
  shapes_.piston.push_back({report::Ball{{0, 0, p_.transfer.wall->from_joint},
                                         o_.bore / 2 - p_.transfer.wall->clearance},
                            Look::gear});
  shapes_.note += "; green on each piston: the sphere that touches the wall of its bore";
}

void Shapes::gear() {
  if (o_.is_far(o_.gear_radius)) {
    shapes_.note += "; the gears are outside the picture";
    return;
  }
  // The cone of the shaft's gear opens from O2 towards -z1, that of the block's towards +z2.
  const double depth = o_.gear_radius * std::tan(g_.tilt / 2);
  if (!p_.gear.teeth) {
    const double back = PumpOutline::kGearFace;
    const double thick = 0.1 * o_.gear_radius;
    const auto rim = [&](double apex, double up) {
      return report::Lathe{{{back * o_.gear_radius, apex + up * back * depth},
                            {o_.gear_radius, apex + up * depth},
                            {o_.gear_radius, apex + up * (depth + thick)},
                            {back * o_.gear_radius, apex + up * (back * depth + thick)},
                            {back * o_.gear_radius, apex + up * back * depth}}};
    };
    shapes_.shaft.push_back({rim(g_.axis_offset, -1), Look::gear, true});
    shapes_.block.push_back({rim(0, 1), Look::gear, true});
    shapes_.note += "; gears are their pitch cones";
    return;
  }
  const BevelTooth tooth(p_);
  const auto rim = [&](double apex, double up) {
    const auto at = [&](double distance, double polar) {
      return Corner{distance * std::sin(polar), apex + up * distance * std::cos(polar)};
    };
    const Corner inside = at(tooth.inside(), tooth.root());
    const Corner outside = at(tooth.outside(), tooth.root());
    const double thick = up * 2 * (tooth.tip() - tooth.root()) * tooth.outside();
    return report::Lathe{{inside,
                          outside,
                          {outside[0], outside[1] + thick},
                          {inside[0], inside[1] + thick},
                          inside}};
  };
  shapes_.shaft.push_back({rim(g_.axis_offset, -1), Look::gear, true});
  shapes_.block.push_back({rim(0, 1), Look::gear, true});
  // At 0 a tooth of the shaft stands at O4 in a gap of the block (ToothErrors).
  shapes_.shaft.push_back({teeth(tooth, g_.axis_offset, -1, 0), Look::gear});
  shapes_.block.push_back({teeth(tooth, 0, 1, -0.5), Look::gear});
}

void Shapes::pin() {
  // It stands on the axis of the block.
  if (o_.is_far(p_.block.pin_z)) {
    shapes_.note += "; the pin is outside the picture";
    return;
  }
  const auto on_axis = [&](double z) {
    return report::Point{0, z * o_.sine, g_.axis_offset + z * o_.cosine};
  };
  shapes_.housing.push_back({report::Ball{on_axis(p_.block.pin_z), 0.1 * o_.size}, Look::pin});
  shapes_.housing.push_back(
      {report::Wire{{on_axis(0), on_axis(p_.block.pin_z)}, false}, Look::pin});
}

}  // namespace

PumpShapes pump_shapes(const Case& the_case, const PumpOutline& outline) {
  return Shapes(the_case, outline).all();
}

}  // namespace bentaxis::study
