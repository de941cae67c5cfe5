// Pressure on the port plate: ports, lands and chambers at angles over the run.
#include "bentaxis/results/channels.h"
#include "bentaxis/study/force_figures.h"
#include "document_parts.h"
#include "force_figures_pieces.h"

namespace bentaxis::study {
namespace {

using report::DrawingFigure;

enum Look { kPort, kChamber, kFilm, kPath };

constexpr double kMillimetresPerMetre = 1e3;  // of a metre
constexpr double kDegreesPerPoint = 6;        // of an arc
constexpr int kDiscPoints = 16;
constexpr std::size_t kPathPoints = 360;
constexpr int kRings = 4;         // that a land is drawn as
constexpr double kBeyond = 1.04;  // of the radius: a film force further out is said only

// A point to a micrometre: more is not seen.
void put(DrawingFigure::Line& line, double x, double y) {
  line.add(std::round(1e3 * x) / 1e3, std::round(1e3 * y) / 1e3);
}

// Between two radii (mm) and two angles from y2 towards -x2, closed.
DrawingFigure::Line sector(double inner, double outer, const PortArc& arc, double width) {
  DrawingFigure::Line line;
  line.look = kPort;
  line.width = width;
  const int pieces =
      std::max(2, static_cast<int>(std::ceil((arc.to_deg - arc.from_deg) / kDegreesPerPoint)));
  const auto add = [&](double radius, int i) {
    const double psi = radians(arc.from_deg + (arc.to_deg - arc.from_deg) * i / pieces);
    put(line, -radius * std::sin(psi), radius * std::cos(psi));
  };
  for (int i = 0; i <= pieces; ++i) add(outer, i);
  for (int i = pieces; i >= 0; --i) add(inner, i);
  add(outer, 0);
  return line;
}

// Full pressure between r2 and r3, falling linearly to 0 at r1 and r4, in rings of its mean there.
void add_port(DrawingFigure& drawing, const PortPlate& plate, const PortArc& arc, double bar) {
  const auto ring = [&](double inner, double outer, double share) {
    drawing.ground.push_back(
        sector(kMillimetresPerMetre * inner, kMillimetresPerMetre * outer, arc, 0.3));
    drawing.ground.back().value = share * bar;
  };
  const auto land = [&](double from, double to) {  // from full pressure to none
    for (int i = 0; i < kRings; ++i)
      ring(from + (to - from) * i / kRings, from + (to - from) * (i + 1) / kRings,
           1 - (i + 0.5) / kRings);
  };
  land(plate.r2, plate.r1);
  land(plate.r3, plate.r4);
  ring(plate.r2, plate.r3, 1);
}

}  // namespace

report::Figure plate_pressure(const DiagramRun& run) {
  constexpr std::size_t kMaxFrames = 18;
  const PumpParameters& pump = run.the_case.pump;
  const Geometry& g = pump.geometry;
  const ChannelLayout at(pump);
  const ResultTable& table = run.table;
  DrawingFigure drawing;
  drawing.looks = {{"edges of the ports", 9, false},
                   {"chambers", 5, false},
                   {"film force Fh", 1, false},
                   {"its path over the run", 3, false}};
  double radius = kMillimetresPerMetre * (g.bore_circle_radius + g.bore_diameter / 4);
  const bool ports = pump.port_plate && run.constant_ports;
  if (ports) radius = std::max(radius, kMillimetresPerMetre * pump.port_plate->r4);
  drawing.panels = {
      {{"x2", "mm"}, {"y2", "mm"}, -1.7 * radius, 1.7 * radius, -1.06 * radius, 1.06 * radius}};

  double low = 0, high = 0;  // bar
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (int k = 0; k < g.pistons; ++k) {
      const double bar = table.at(row, at.pressure(k));
      low = std::min(low, bar);
      high = std::max(high, bar);
    }
  if (ports) {
    const PortPressures& p = run.the_case.pressure.ports;
    for (const auto& [arc, pressure] : {std::pair{pump.port_plate->delivery, p.delivery},
                                        {pump.port_plate->suction, p.suction}}) {
      add_port(drawing, *pump.port_plate, arc, pressure / kPascalPerBar);
      low = std::min(low, pressure / kPascalPerBar);
      high = std::max(high, pressure / kPascalPerBar);
    }
  }
  drawing.shades = {"pressure", "bar", low, high > low ? high : low + 1};

  const auto near = [&](std::size_t row) {
    return std::hypot(table.at(row, at.xh()), table.at(row, at.yh())) < kBeyond * radius;
  };
  // The way of the film force, in pieces where it leaves the picture.
  bool joined = false;
  for (const std::size_t row : frame_rows(table.rows(), kPathPoints)) {
    const bool shown = near(row);
    if (shown && !joined) drawing.ground.push_back({0, kPath, 1.2, {}, {}});
    if (shown) put(drawing.ground.back(), table.at(row, at.xh()), table.at(row, at.yh()));
    joined = shown;
  }

  // As wide as the ports, so that these are seen.
  const double disc = ports ? (pump.port_plate->r3 - pump.port_plate->r2) / 2 : g.bore_diameter / 4;
  const std::vector<std::size_t> rows = frame_rows(table.rows(), kMaxFrames);
  for (const std::size_t row : rows) {
    DrawingFigure::Frame frame;
    frame.theta_deg = along(run, row);
    const double block = run.block_deg.empty() ? table.theta_deg[row] : run.block_deg[row];
    for (int k = 0; k < g.pistons; ++k) {
      const double psi = radians(block - 360.0 * k / g.pistons);
      DrawingFigure::Line edge{0, kChamber, 2, {}, {}};
      edge.value = table.at(row, at.pressure(k));
      for (int i = 0; i <= kDiscPoints; ++i) {
        const double turn = 2 * kPi * i / kDiscPoints;
        put(edge,
            kMillimetresPerMetre * (-g.bore_circle_radius * std::sin(psi) + disc * std::cos(turn)),
            kMillimetresPerMetre * (g.bore_circle_radius * std::cos(psi) + disc * std::sin(turn)));
      }
      frame.lines.push_back(std::move(edge));
    }
    const double force = table.at(row, at.Fh()), x = table.at(row, at.xh()),
                 y = table.at(row, at.yh());
    if (is_computed(force) && is_computed(x) && is_computed(y)) {
      frame.text = fmt::format("Fh {:.4g} N at ({:.3g}, {:.3g}) mm", force, x, y);
      const double arm = 0.04 * radius;
      if (near(row)) {
        for (const auto& [dx, dy] : {std::pair{arm, 0.0}, {0.0, arm}}) {
          DrawingFigure::Line stroke{0, kFilm, 3, {}, {}};
          put(stroke, x - dx, y - dy);
          put(stroke, x + dx, y + dy);
          frame.lines.push_back(std::move(stroke));
        }
      } else {
        frame.text += ", outside the picture";
      }
    }
    drawing.frames.push_back(std::move(frame));
  }
  drawing.shown = nearest_frame(run, rows, 0);
  if (!run.time_ms.empty()) drawing.axis = kTimeAxis;
  std::string note =
      "Seen from behind the plate, against z2. A disc is a chamber, at the angle of the block.";
  if (ports)
    note +=
        " Ports between r2 and r3 have the pressure of the port, lands fall linearly to 0 at r1 "
        "and r4: the models' law of the film, drawn in steps.";
  return {"plate_pressure", "Pressure on the port plate, and where the film force acts", "",
          std::move(drawing), note};
}

}  // namespace bentaxis::study
