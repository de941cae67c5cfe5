#include "paper_drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bentaxis/pump/units.h"

namespace bentaxis::study {
namespace {

using report::DrawingFigure;
using Triple = std::array<double, 3>;

constexpr double kMillimetre = 1e-3;
constexpr double kForceArrow = 14;  // mm
constexpr int kOutlinePoints = 73;

// A channel at an angle, on the straight line between samples, as printed numbers are taken.
double at(const ResultTable& turn, const std::string& channel, double angle_deg) {
  const std::size_t column = turn.find(channel);
  const std::size_t rows = turn.rows();
  std::size_t after = 0;
  while (after < rows && turn.theta_deg[after] <= angle_deg) ++after;
  const std::size_t before = after - 1;
  const double end = after < rows ? turn.theta_deg[after] : 360;
  const double share = (angle_deg - turn.theta_deg[before]) / (end - turn.theta_deg[before]);
  const double first = turn.at(before, column);
  return first + share * (turn.at(after % rows, column) - first);
}

double piston_angle(const PumpParameters& pump, int piston, double angle_deg) {
  return radians(angle_deg - 360.0 * (piston - 1) / pump.geometry.pistons);
}

// A_k (9) in S2 (7), mm.
Triple joint(const Geometry& g, double theta) {
  const double y1 = g.joint_circle_radius * std::cos(theta), z1 = -g.axis_offset;  // from O2
  const double c = std::cos(g.tilt), s = std::sin(g.tilt);
  return {-g.joint_circle_radius * std::sin(theta) / kMillimetre, (c * y1 - s * z1) / kMillimetre,
          (s * y1 + c * z1) / kMillimetre};
}

// B_k (11) in S2, mm.
Triple ring(const Geometry& g, double theta, double z_mm) {
  const double r = g.bore_circle_radius / kMillimetre;
  return {-r * std::sin(theta), r * std::cos(theta), z_mm};
}

DrawingFigure::Line circle(double x, double y, double radius, int look, double width) {
  DrawingFigure::Line line;
  line.look = look;
  line.width = width;
  for (int i = 0; i < kOutlinePoints; ++i) {
    const double angle = 2 * kPi * i / (kOutlinePoints - 1);
    line.x.push_back(x + radius * std::cos(angle));
    line.y.push_back(y + radius * std::sin(angle));
  }
  return line;
}

// A frame of a drawing with equal scales whose contents are given.
void fit(DrawingFigure& drawing) {
  for (std::size_t p = 0; p < drawing.panels.size(); ++p) {
    DrawingFigure::Panel& panel = drawing.panels[p];
    double x_low = HUGE_VAL, x_high = -HUGE_VAL, y_low = HUGE_VAL, y_high = -HUGE_VAL;
    const auto hold = [&](double x, double y) {
      x_low = std::min(x_low, x);
      x_high = std::max(x_high, x);
      y_low = std::min(y_low, y);
      y_high = std::max(y_high, y);
    };
    for (const auto& frame : drawing.frames) {
      for (const auto& line : frame.lines)
        for (std::size_t i = 0; i < line.x.size(); ++i)
          if (line.panel == static_cast<int>(p)) hold(line.x[i], line.y[i]);
      for (const auto& arrow : frame.arrows)
        if (arrow.panel == static_cast<int>(p)) {
          hold(arrow.x, arrow.y);
          hold(arrow.x + arrow.dx, arrow.y + arrow.dy);
        }
    }
    const double margin = 0.06 * std::max(x_high - x_low, y_high - y_low);
    panel.x_low = x_low - margin;
    panel.x_high = x_high + margin;
    panel.y_low = y_low - margin;
    panel.y_high = y_high + margin;
  }
}

}  // namespace

DrawingFigure block_from_the_front(const PumpParameters& pump, const ResultTable& turn,
                                   const std::vector<double>& angles) {
  const Geometry& g = pump.geometry;
  const double bore = g.bore_diameter / 2 / kMillimetre;
  const double bores = g.bore_circle_radius / kMillimetre;
  DrawingFigure drawing;
  drawing.looks = {
      {"block", 4, false}, {"bore", 5, true}, {"force of a piston on the block, -Rc", 1, false}};
  drawing.panels = {{{"x2", "mm"}, {"y2", "mm"}}};
  double largest = 0;
  for (const double angle : angles)
    for (int k = 1; k <= g.pistons; ++k)
      largest = std::max(largest, std::hypot(at(turn, fmt::format("Rc_{}_x2_N", k), angle),
                                             at(turn, fmt::format("Rc_{}_y2_N", k), angle)));
  const double scale = largest > 0 ? kForceArrow / largest : 0;
  for (const double angle : angles) {
    DrawingFigure::Frame frame;
    frame.theta_deg = angle;
    frame.lines.push_back(circle(0, 0, bores + 1.25 * bore, 0, 2));
    double sum = 0;
    for (int k = 1; k <= g.pistons; ++k) {
      const Triple b = ring(g, piston_angle(pump, k, angle), 0);
      const double fx = -at(turn, fmt::format("Rc_{}_x2_N", k), angle);
      const double fy = -at(turn, fmt::format("Rc_{}_y2_N", k), angle);
      frame.lines.push_back(circle(b[0], b[1], bore, 1, 1));
      frame.arrows.push_back({0, 2, b[0], b[1], scale * fx, scale * fy});
      sum += at(turn, fmt::format("Tc_{}_z2_Nm", k), angle);
    }
    // Turning with the pump is turning from x2 to y2, which is counter-clockwise to this eye.
    frame.text = fmt::format("all pistons {:+.2f} Nm about z2, {}", sum,
                             sum < 0 ? "clockwise" : "counter-clockwise");
    drawing.frames.push_back(std::move(frame));
  }
  fit(drawing);
  return drawing;
}

report::BarsFigure pistons_shares(const PumpParameters& pump, const ResultTable& turn,
                                  double angle) {
  report::BarsFigure bars{{"torque on the block about z2", "Nm"}, {}};
  for (int k = 1; k <= pump.geometry.pistons; ++k) {
    const double torque = at(turn, fmt::format("Tc_{}_z2_Nm", k), angle);
    const double force = std::hypot(at(turn, fmt::format("Rc_{}_x2_N", k), angle),
                                    at(turn, fmt::format("Rc_{}_y2_N", k), angle));
    bars.bars.push_back({fmt::format("piston {}", k), std::min(0.0, torque), std::max(0.0, torque),
                         fmt::format("{:.1f} N, {:+.3f} Nm", force, torque)});
  }
  return bars;
}

DrawingFigure force_triangle(const PumpParameters& pump, const ResultTable& turn,
                             const std::vector<double>& angles) {
  const double area = kPi / 4 * pump.geometry.bore_diameter * pump.geometry.bore_diameter;
  DrawingFigure drawing;
  drawing.looks = {{"Fp, oil", 3, false}, {"Rs, shaft", 0, false}, {"Rc, block", 1, false}};
  drawing.panels = {{{"force along z2", "N"}, {"force along x2", "N"}}};
  for (const double angle : angles) {
    DrawingFigure::Frame frame;
    frame.theta_deg = angle;
    const double fp = -area * at(turn, "p_1_bar", angle) * kPascalPerBar;
    const double forces[3][2] = {{fp, 0},
                                 {at(turn, "Rs_1_z2_N", angle), at(turn, "Rs_1_x2_N", angle)},
                                 {0, at(turn, "Rc_1_x2_N", angle)}};
    double x = 0, y = 0;
    for (int i = 0; i < 3; ++i) {
      frame.arrows.push_back({0, i, x, y, forces[i][0], forces[i][1]});
      x += forces[i][0];
      y += forces[i][1];
    }
    frame.text =
        fmt::format("Fp {:.0f} N; Rs {:.0f} N (z2), {:.1f} N (x2); Rc {:.1f} N (x2); sum {:.1e} N",
                    forces[0][0], forces[1][0], forces[1][1], forces[2][1], std::hypot(x, y));
    drawing.frames.push_back(std::move(frame));
  }
  fit(drawing);
  return drawing;
}

DrawingFigure piston_in_two_planes(const PumpParameters& pump, const ResultTable& turn,
                                   const std::vector<double>& angles) {
  const Geometry& g = pump.geometry;
  DrawingFigure drawing;
  drawing.looks = {{"axis of the block, z2", 4, false},
                   {"piston from A to B", 5, false},
                   {"Rs, shaft on piston, at A", 1, false}};
  drawing.panels = {{{"z2", "mm"}, {"x2", "mm"}}, {{"z2", "mm"}, {"y2", "mm"}}};
  double largest = 0;
  for (const double angle : angles) largest = std::max(largest, at(turn, "Rs_1_z2_N", angle));
  for (const double angle : angles) {
    DrawingFigure::Frame frame;
    frame.theta_deg = angle;
    const double theta = radians(angle);
    const Triple a = joint(g, theta), b = ring(g, theta, at(turn, "zB_1_z2_mm", angle));
    const Triple rs = {at(turn, "Rs_1_x2_N", angle), at(turn, "Rs_1_y2_N", angle),
                       at(turn, "Rs_1_z2_N", angle)};
    const double scale = largest > 0 ? 2 * kForceArrow / largest : 0;
    for (int p = 0; p < 2; ++p) {
      const auto across = static_cast<std::size_t>(p);
      frame.lines.push_back({p, 0, 1, {std::min(0.0, a[2]), b[2]}, {0, 0}});
      frame.lines.push_back({p, 1, 3, {a[2], b[2]}, {a[across], b[across]}});
      // It pushes towards A: drawn with its head there, beside the piston that it holds up.
      frame.arrows.push_back({p, 2, a[2] - scale * rs[2], a[across] - scale * rs[across],
                              scale * rs[2], scale * rs[across]});
    }
    frame.text = fmt::format("Rs {:.0f} N (x2), {:.0f} N (y2), {:.0f} N (z2)", rs[0], rs[1], rs[2]);
    drawing.frames.push_back(std::move(frame));
  }
  fit(drawing);
  return drawing;
}

std::vector<report::Figure> paper_drawings(const PaperTurn& turn) {
  const PaperFigure& figure = turn.figure;
  const PumpParameters& pump = turn.pump;
  const ResultTable& table = turn.table;
  std::vector<report::Figure> drawings;
  const auto add = [&](DrawingFigure content) {
    drawings.push_back({figure.id(), figure.name() + ": " + figure.shows, figure.name(),
                        std::move(content), figure.note});
  };
  if (figure.kind == PaperKind::force_triangle) {
    add(force_triangle(pump, table, figure.angles));
  } else if (figure.kind == PaperKind::piston_in_two_planes) {
    add(piston_in_two_planes(pump, table, figure.angles));
  } else {
    add(block_from_the_front(pump, table, figure.angles));
    for (const double angle : figure.angles)
      drawings.push_back(
          {fmt::format("{}_shares_at_{:g}_deg", figure.id(), angle),
           fmt::format("{}: each piston's share of the torque at {:g} deg", figure.name(), angle),
           figure.name(), pistons_shares(pump, table, angle)});
  }
  return drawings;
}

}  // namespace bentaxis::study
