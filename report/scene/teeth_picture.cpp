// The teeth as a picture, from the case and what they do.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"
#include "bentaxis/results/teeth.h"
#include "bentaxis/study/teeth_section.h"
#include "bevel_tooth.h"

namespace bentaxis::study {
namespace {

using Eigen::Vector3d;
using report::DrawingFigure;

enum Stroke { kShaft, kBlock, kPlus, kMinus };

constexpr std::size_t kMaxFrames = 180;
constexpr double kReach = 1.8;         // pitches to either side of O4 that are drawn
constexpr int kPoints = 9;             // of a flank
constexpr double kLongestArrow = 0.5;  // pitches

// A gear's teeth as seen on the sphere about O2.
struct Wheel {
  Vector3d axis;      // of its cones
  Vector3d meridian;  // towards O4, across the axis
  Vector3d ahead;     // the way its teeth move where its angle grows
  double offset;      // of tooth 1 from O4 where its angle is 0, in pitches
};

class Mesh {
 public:
  explicit Mesh(const PumpParameters& pump)
      : teeth_(*pump.gear.teeth), tooth_(pump), distance_(tooth_.distance()) {
    const double alpha = pump.geometry.tilt;
    const double radius = pump.gear.pitch_diameter / 2;
    const Vector3d shaft_axis(0, 0, 1), block_axis(0, std::sin(alpha), std::cos(alpha));
    towards_o4_ = Vector3d(0, radius, -radius * std::tan(alpha / 2)).normalized();
    wheels_[0] = wheel(-shaft_axis, shaft_axis, 0);
    wheels_[1] = wheel(block_axis, block_axis, -0.5);
    up_ = (block_axis - block_axis.dot(towards_o4_) * towards_o4_).normalized();
    across_ = up_.cross(towards_o4_);
  }

  double pitch_length() const {
    return 1e3 * distance_ * std::sin(tooth_.pitch_cone()) * tooth_.pitch();
  }
  double distance() const { return 1e3 * distance_; }
  double face_width() const { return 1e3 * teeth_.face_width; }
  double depth() const { return 1e3 * (teeth_.addendum + teeth_.dedendum); }

  /// The outline of a gear's teeth near O4, on the plane that touches the sphere there, mm.
  DrawingFigure::Line outline(int gear, double angle) const {
    DrawingFigure::Line line;
    line.look = gear == 0 ? kShaft : kBlock;
    const Wheel& w = wheels_[gear];
    const double pitch = tooth_.pitch();
    const double at = angle / pitch + w.offset;  // pitches that tooth 1 is beyond O4
    const double nearest = at - std::round(at);
    const double tip = tooth_.tip();
    const double root = tooth_.root();
    const auto add = [&](double polar, double azimuth) {
      const Vector3d p =
          std::cos(polar) * w.axis +
          std::sin(polar) * (std::cos(azimuth) * w.meridian + std::sin(azimuth) * w.ahead);
      line.x.push_back(1e3 * distance_ * p.dot(across_) / p.dot(towards_o4_));
      line.y.push_back(1e3 * distance_ * p.dot(up_) / p.dot(towards_o4_));
    };
    for (int tooth = -3; tooth <= 3; ++tooth) {
      const double middle = (nearest + tooth) * pitch;
      for (int i = 0; i < kPoints; ++i) {
        const double polar = root + (tip - root) * i / (kPoints - 1);
        add(polar, middle - tooth_.half_angle(polar));
      }
      for (int i = kPoints; i-- > 0;) {
        const double polar = root + (tip - root) * i / (kPoints - 1);
        add(polar, middle + tooth_.half_angle(polar));
      }
    }
    // Its body closes the outline.
    const double deep = root - 0.6 * (tooth_.pitch_cone() - root);
    add(deep, (nearest + 3.4) * pitch);
    add(deep, (nearest - 3.4) * pitch);
    line.x.push_back(line.x.front());
    line.y.push_back(line.y.front());
    return line;
  }

  Vector3d seen(const Vector3d& v) const {
    return {v.dot(across_), v.dot(up_), v.dot(towards_o4_)};
  }

 private:
  Wheel wheel(const Vector3d& cone, const Vector3d& turn, double offset) const {
    const Vector3d meridian = (towards_o4_ - towards_o4_.dot(cone) * cone).normalized();
    return {cone, meridian, turn.cross(meridian).normalized(), offset};
  }
  const ToothData& teeth_;
  BevelTooth tooth_;
  double distance_;
  Vector3d towards_o4_, up_, across_;
  Wheel wheels_[2];
};

}  // namespace

report::Figure teeth_picture(const PumpParameters& pump, const ResultTable& table) {
  const Mesh mesh(pump);
  DrawingFigure drawing;
  drawing.looks = {{"shaft", 5, true},
                   {"block", 4, true},
                   {"contact and force on the block, flank +", 1, false},
                   {"flank -", 3, false}};
  const double half = kReach * mesh.pitch_length();
  const double height = 0.95 * mesh.depth();
  const double inside = mesh.distance() - mesh.face_width() / 2;
  const double more = 0.08 * mesh.face_width();
  drawing.panels = {
      {{"along the pitch circles at O4", "mm"}, {"across", "mm"}, -half, half, -height, height},
      {{"along the pitch circles", "mm"},
       {"distance from O2", "mm"},
       -half,
       half,
       inside - more,
       inside + mesh.face_width() + more}};
  double largest = 0;
  for (std::size_t c = 0; c < table.columns(); ++c)
    if (table.channels[c].group == "tooth_force")
      for (std::size_t row = 0; row < table.rows(); ++row)
        largest = std::max(largest, table.at(row, c));
  const std::size_t lag = table.find("lag_urad");
  // Frames that do not fall on the same place of the pitch again and again.
  const std::size_t every = std::max<std::size_t>(1, table.rows() / kMaxFrames);
  double shown = 0;
  for (std::size_t row = 0; row < table.rows(); row += every) {
    DrawingFigure::Frame frame;
    frame.theta_deg = table.theta_deg[row];
    const double theta = radians(frame.theta_deg);
    frame.lines.push_back(mesh.outline(0, theta));
    frame.lines.push_back(mesh.outline(1, theta - 1e-6 * table.at(row, lag)));
    double carried = 0;
    for (const auto& [flank, look] : {std::pair{"plus", kPlus}, {"minus", kMinus}})
      for (const char* which : {"at", "before", "after"}) {
        const std::string name = fmt::format("{}_{}_", flank, which);
        const std::size_t at = table.find(name + "force_N");
        const double force = table.at(row, at);
        if (!(force > 0)) continue;
        carried += force;
        const auto vector = [&](const std::string& first) {
          const std::size_t x = table.find(name + first);
          return Vector3d(table.at(row, x), table.at(row, x + 1), table.at(row, x + 2));
        };
        const Vector3d point = mesh.seen(vector("x1_mm"));
        const Vector3d normal = mesh.seen(vector("normal_x1"));
        const double x = mesh.distance() * point.x() / point.z();
        const double y = mesh.distance() * point.y() / point.z();
        const double length = kLongestArrow * mesh.pitch_length() * force / largest;
        frame.arrows.push_back({0, look, x, y, length * normal.x(), length * normal.y()});
        const double outside = inside + mesh.face_width();
        frame.lines.push_back({1,
                               look,
                               1.5 + 6 * force / largest,
                               {x * inside / mesh.distance(), x * outside / mesh.distance()},
                               {inside, outside}});
        frame.text += fmt::format("{}flank {}: {:.4g} N on shaft tooth {:.0f}",
                                  frame.text.empty() ? "" : ", ", look == kPlus ? "+" : "-", force,
                                  table.at(row, table.find(name + "shaft_tooth")));
      }
    if (carried > shown) {
      shown = carried;
      drawing.shown = drawing.frames.size();
    }
    drawing.frames.push_back(std::move(frame));
  }
  return {"teeth", "Teeth in mesh, seen from outside on O4 towards O2; below: lines of contact", "",
          std::move(drawing),
          "The plane touches the sphere about O2 through O4. Backlash and lag are drawn to scale. "
          "Arrows begin where the force acts; a line of contact is as thick as its pair's force."};
}

}  // namespace bentaxis::study
