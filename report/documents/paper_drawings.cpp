#include "paper_drawings.h"

#include <array>
#include <cmath>

#include "document_parts.h"

namespace bentaxis::study {
namespace {

using report::DrawingFigure;
using Triple = std::array<double, 3>;

constexpr double kMillimetre = 1e-3;
constexpr double kForceArrow = 14;  // mm
constexpr int kOutlinePoints = 73;

DrawingFigure::Line circle(double x, double y, double radius, int look, double width) {
  DrawingFigure::Line line{0, look, width, {}, {}};
  for (int i = 0; i < kOutlinePoints; ++i) {
    const double angle = 2 * kPi * i / (kOutlinePoints - 1);
    line.add(x + radius * std::cos(angle), y + radius * std::sin(angle));
  }
  return line;
}

// Panels of equal scales that show all that the frames draw.
void fit(DrawingFigure& drawing) {
  for (std::size_t p = 0; p < drawing.panels.size(); ++p) {
    const int number = static_cast<int>(p);
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
          if (line.panel == number) hold(line.x[i], line.y[i]);
      for (const auto& arrow : frame.arrows)
        if (arrow.panel == number) {
          hold(arrow.x, arrow.y);
          hold(arrow.x + arrow.dx, arrow.y + arrow.dy);
        }
    }
    const double margin = 0.06 * std::max(x_high - x_low, y_high - y_low);
    DrawingFigure::Panel& panel = drawing.panels[p];
    panel = {panel.x, panel.y, x_low - margin, x_high + margin, y_low - margin, y_high + margin};
  }
}

// A turn of the model as the paper draws it.
class Drawings {
 public:
  explicit Drawings(const PaperTurn& turn)
      : figure_(turn.figure), g_(turn.pump.geometry), table_(turn.table) {}

  std::vector<report::Figure> all() const {
    if (figure_.kind == PaperKind::force_triangle) return {figure(force_triangle())};
    if (figure_.kind == PaperKind::piston_in_two_planes) return {figure(piston_in_two_planes())};
    std::vector<report::Figure> figures = {figure(block_from_the_front())};
    for (const double angle : figure_.angles)
      figures.push_back(
          {fmt::format("{}_shares_at_{:g}_deg", figure_.id(), angle),
           fmt::format("{}: each piston's share of the torque at {:g} deg", figure_.name(), angle),
           figure_.name(), pistons_shares(angle)});
    return figures;
  }

 private:
  report::Figure figure(DrawingFigure content) const {
    return {figure_.id(), figure_.name() + ": " + figure_.shows, figure_.name(), std::move(content),
            figure_.note};
  }

  // A channel at an angle, on the straight line between samples, as printed numbers are taken.
  double at(const std::string& channel, double angle_deg) const {
    const std::size_t column = table_.find(channel);
    const std::size_t rows = table_.rows();
    const std::vector<double>& theta = table_.theta_deg;
    const auto after =
        static_cast<std::size_t>(std::ranges::upper_bound(theta, angle_deg) - theta.begin());
    const std::size_t before = after - 1;
    const double end = after < rows ? theta[after] : 360;
    const double share = (angle_deg - theta[before]) / (end - theta[before]);
    const double first = table_.at(before, column);
    return first + share * (table_.at(after % rows, column) - first);
  }
  // Rc on a piston across z2, N: x2, y2.
  std::array<double, 2> bore_force(int piston, double angle) const {
    return {at(fmt::format("Rc_{}_x2_N", piston), angle),
            at(fmt::format("Rc_{}_y2_N", piston), angle)};
  }
  double torque(int piston, double angle) const {
    return at(fmt::format("Tc_{}_z2_Nm", piston), angle);
  }
  // A_k (9) in S2 (7), mm.
  Triple joint(double theta) const {
    const double y1 = g_.joint_circle_radius * std::cos(theta), z1 = -g_.axis_offset;  // from O2
    const double c = std::cos(g_.tilt), s = std::sin(g_.tilt);
    return {-g_.joint_circle_radius * std::sin(theta) / kMillimetre,
            (c * y1 - s * z1) / kMillimetre, (s * y1 + c * z1) / kMillimetre};
  }
  // B_k (11) in S2, mm.
  Triple ring(double theta, double z_mm) const {
    const double r = g_.bore_circle_radius / kMillimetre;
    return {-r * std::sin(theta), r * std::cos(theta), z_mm};
  }

  // A frame for each angle, filled by fill(frame, angle).
  DrawingFigure drawing(std::vector<DrawingFigure::Look> looks,
                        std::vector<DrawingFigure::Panel> panels, const auto& fill) const {
    DrawingFigure drawing;
    drawing.looks = std::move(looks);
    drawing.panels = std::move(panels);
    for (const double angle : figure_.angles) {
      DrawingFigure::Frame& frame = drawing.frames.emplace_back();
      frame.theta_deg = angle;
      fill(frame, angle);
    }
    fit(drawing);
    return drawing;
  }

  DrawingFigure block_from_the_front() const;
  report::BarsFigure pistons_shares(double angle) const;
  DrawingFigure force_triangle() const;
  DrawingFigure piston_in_two_planes() const;

  const PaperFigure& figure_;
  const Geometry& g_;
  const ResultTable& table_;
};

// z2 towards the eye: the pistons' forces on the block, with their torque about z2.
DrawingFigure Drawings::block_from_the_front() const {
  const double bore = g_.bore_diameter / 2 / kMillimetre;
  const double bores = g_.bore_circle_radius / kMillimetre;
  double largest = 0;
  for (const double angle : figure_.angles)
    for (int k = 1; k <= g_.pistons; ++k) {
      const auto [x, y] = bore_force(k, angle);
      largest = std::max(largest, std::hypot(x, y));
    }
  const double scale = largest > 0 ? kForceArrow / largest : 0;
  const auto fill = [&](DrawingFigure::Frame& frame, double angle) {
    frame.lines.push_back(circle(0, 0, bores + 1.25 * bore, 0, 2));
    double sum = 0;
    for (int k = 1; k <= g_.pistons; ++k) {
      const Triple b = ring(radians(angle - 360.0 * (k - 1) / g_.pistons), 0);
      const auto [x, y] = bore_force(k, angle);
      frame.lines.push_back(circle(b[0], b[1], bore, 1, 1));
      frame.arrows.push_back({0, 2, b[0], b[1], scale * -x, scale * -y});
      sum += torque(k, angle);
    }
    // Turning with the pump is turning from x2 to y2, which is counter-clockwise to this eye.
    frame.text = fmt::format("all pistons {:+.2f} Nm about z2, {}", sum,
                             sum < 0 ? "clockwise" : "counter-clockwise");
  };
  return drawing(
      {{"block", 4, false}, {"bore", 5, true}, {"force of a piston on the block, -Rc", 1, false}},
      {{{"x2", "mm"}, {"y2", "mm"}}}, fill);
}

// Each piston's share of that torque at an angle (deg).
report::BarsFigure Drawings::pistons_shares(double angle) const {
  report::BarsFigure bars{{"torque on the block about z2", "Nm"}, {}};
  for (int k = 1; k <= g_.pistons; ++k) {
    const auto [x, y] = bore_force(k, angle);
    const double share = torque(k, angle);
    bars.bars.push_back({fmt::format("piston {}", k), std::min(0.0, share), std::max(0.0, share),
                         fmt::format("{:.1f} N, {:+.3f} Nm", std::hypot(x, y), share)});
  }
  return bars;
}

// Fp, Rs and Rc on piston 1 tip to tail in the plane x2-z2, of a turn without inertia and friction
// of the piston and without weight: they close then.
DrawingFigure Drawings::force_triangle() const {
  const double area = kPi / 4 * g_.bore_diameter * g_.bore_diameter;
  const auto fill = [&](DrawingFigure::Frame& frame, double angle) {
    const double fp = -area * at("p_1_bar", angle) * kPascalPerBar;
    const double forces[3][2] = {
        {fp, 0}, {at("Rs_1_z2_N", angle), at("Rs_1_x2_N", angle)}, {0, at("Rc_1_x2_N", angle)}};
    double x = 0, y = 0;
    for (int i = 0; i < 3; ++i) {
      frame.arrows.push_back({0, i, x, y, forces[i][0], forces[i][1]});
      x += forces[i][0];
      y += forces[i][1];
    }
    frame.text =
        fmt::format("Fp {:.0f} N; Rs {:.0f} N (z2), {:.1f} N (x2); Rc {:.1f} N (x2); sum {:.1e} N",
                    forces[0][0], forces[1][0], forces[1][1], forces[2][1], std::hypot(x, y));
  };
  return drawing({{"Fp, oil", 3, false}, {"Rs, shaft", 0, false}, {"Rc, block", 1, false}},
                 {{{"force along z2", "N"}, {"force along x2", "N"}}}, fill);
}

// Piston 1 from A to B with Rs in the planes x2-z2 and y2-z2.
DrawingFigure Drawings::piston_in_two_planes() const {
  double largest = 0;
  for (const double angle : figure_.angles) largest = std::max(largest, at("Rs_1_z2_N", angle));
  const double scale = largest > 0 ? 2 * kForceArrow / largest : 0;
  const auto fill = [&](DrawingFigure::Frame& frame, double angle) {
    const double theta = radians(angle);
    const Triple a = joint(theta), b = ring(theta, at("zB_1_z2_mm", angle));
    const Triple rs = {at("Rs_1_x2_N", angle), at("Rs_1_y2_N", angle), at("Rs_1_z2_N", angle)};
    for (int p = 0; p < 2; ++p) {
      const auto across = static_cast<std::size_t>(p);
      frame.lines.push_back({p, 0, 1, {std::min(0.0, a[2]), b[2]}, {0, 0}});
      frame.lines.push_back({p, 1, 3, {a[2], b[2]}, {a[across], b[across]}});
      // It pushes towards A: drawn with its head there, beside the piston that it holds up.
      frame.arrows.push_back({p, 2, a[2] - scale * rs[2], a[across] - scale * rs[across],
                              scale * rs[2], scale * rs[across]});
    }
    frame.text = fmt::format("Rs {:.0f} N (x2), {:.0f} N (y2), {:.0f} N (z2)", rs[0], rs[1], rs[2]);
  };
  return drawing({{"axis of the block, z2", 4, false},
                  {"piston from A to B", 5, false},
                  {"Rs, shaft on piston, at A", 1, false}},
                 {{{"z2", "mm"}, {"x2", "mm"}}, {{"z2", "mm"}, {"y2", "mm"}}}, fill);
}

}  // namespace

std::vector<report::Figure> paper_drawings(const PaperTurn& turn) { return Drawings(turn).all(); }

}  // namespace bentaxis::study
