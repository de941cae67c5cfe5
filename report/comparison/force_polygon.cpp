// Force polygons, from all loads on a body.
#include <array>

#include "bentaxis/pump/error.h"
#include "bentaxis/study/force_figures.h"
#include "document_parts.h"
#include "force_figures_pieces.h"

namespace bentaxis::study {
namespace {

using report::DrawingFigure;
using Force = std::array<double, 3>;  // N, in S2

constexpr double kNothing = 1e-9;  // of the largest force: what is less all the time is left out
constexpr double kMargin = 0.05;   // of what is drawn, beside it
constexpr double kWide = 622;      // px of a panel, with the next two the least and the greatest
constexpr double kLow = 90, kHigh = 300;  // px of its height

double size_of(const Force& force) { return std::hypot(force[0], force[1], force[2]); }

// Loads of one name on a body.
struct Family {
  std::string symbol, label;
  ForceKind kind = ForceKind::applied;
  std::vector<std::size_t> loads;  // of the table
  double peak = 0;                 // N, of one of them
};

std::string acting(const std::string& by) { return by.starts_with("piston ") ? "the pistons" : by; }

// In the order in which they are put tip to tail: what is given from large to small, then what has
// to be found from small to large, so that the largest reaction closes the polygon.
std::vector<Family> families_of(const BodyLoadTable& table, const std::string& body) {
  std::vector<Family> families;
  double largest = 0;
  for (std::size_t i = 0; i < table.loads.size(); ++i) {
    const BodyLoad& load = table.loads[i];
    if (load.on != body) continue;
    auto family = std::ranges::find_if(
        families, [&](const Family& f) { return f.symbol == load.symbol && f.kind == load.kind; });
    if (family == families.end()) {
      const std::string label = load.kind == ForceKind::inertia
                                    ? load.symbol
                                    : fmt::format("{} by {}", load.symbol, acting(load.by));
      families.push_back({load.symbol, label, load.kind, {}});
      family = std::prev(families.end());
    }
    family->loads.push_back(i);
    for (std::size_t row = 0; row < table.rows(); ++row)
      family->peak = std::max(family->peak, size_of(table.at(row, i).force));
    largest = std::max(largest, family->peak);
  }
  std::erase_if(families, [&](const Family& f) { return f.peak <= kNothing * largest; });
  const auto place = [](const Family& f) {
    const bool found = f.kind == ForceKind::reaction;
    return std::pair{found, found ? f.peak : -f.peak};
  };
  std::ranges::stable_sort(families,
                           [&](const Family& a, const Family& b) { return place(a) < place(b); });
  return families;
}

// The polygon at a row whose loads are kept: of each family its reactions one after the other, or
// all else as one.
struct Polygon {
  std::vector<std::vector<Force>> forces;  // by family
  double open = 0;                         // of the sum of magnitudes
};

Polygon polygon_at(const DiagramRun& run, const std::vector<Family>& families,
                   const std::string& body, std::size_t row) {
  const double tilt = run.the_case.pump.geometry.tilt;
  Polygon polygon;
  for (const Family& family : families) {
    polygon.forces.emplace_back();
    Force sum = {};
    for (const std::size_t load : family.loads) {
      const auto& f = run.loads->at(row / run.loads->step, load).force;
      const Force turned = {f[0], std::cos(tilt) * f[1] - std::sin(tilt) * f[2],
                            std::sin(tilt) * f[1] + std::cos(tilt) * f[2]};
      if (family.kind == ForceKind::reaction) polygon.forces.back().push_back(turned);
      for (std::size_t i = 0; i < 3; ++i) sum[i] += turned[i];
    }
    if (family.kind != ForceKind::reaction) polygon.forces.back().push_back(sum);
  }
  for (const BodySum& sum : sums_of(run.loads->row(row / run.loads->step)))
    if (sum.body == body) polygon.open = sum.force_over_sum;
  return polygon;
}

constexpr const char* kAxes[] = {"x2", "y2", "z2"};

// One scale, of a height that is neither a stripe nor a tower.
DrawingFigure::Panel panel_of(std::pair<int, int> plane, const std::vector<Polygon>& polygons) {
  std::array<double, 2> low = {0, 0}, high = {0, 0};
  for (const Polygon& polygon : polygons) {
    Force at = {};
    for (const auto& family : polygon.forces)
      for (const Force& force : family) {
        for (std::size_t i = 0; i < 3; ++i) at[i] += force[i];
        for (const auto& [side, axis] : {std::pair{0, plane.first}, {1, plane.second}}) {
          low[side] = std::min(low[side], at[axis]);
          high[side] = std::max(high[side], at[axis]);
        }
      }
  }
  for (int side = 0; side < 2; ++side) {
    const double more = kMargin * std::max(high[side] - low[side], 1e-9);
    low[side] -= more;
    high[side] += more;
  }
  const auto widen = [&](int side, double span) {
    const double more = std::max(0.0, span - (high[side] - low[side])) / 2;
    low[side] -= more;
    high[side] += more;
  };
  widen(0, (high[1] - low[1]) * kWide / kHigh);
  widen(1, (high[0] - low[0]) * kLow / kWide);
  return {{kAxes[plane.first], "N"}, {kAxes[plane.second], "N"}, low[0], high[0], low[1], high[1]};
}

std::string said_of(const std::vector<Family>& families, const Polygon& polygon) {
  std::string text;
  for (std::size_t f = 0; f < families.size(); ++f) {
    Force sum = {};
    for (const Force& force : polygon.forces[f])
      for (std::size_t i = 0; i < 3; ++i) sum[i] += force[i];
    const double size = size_of(sum);
    text += size < 1000 ? fmt::format("{} {:.4g} N, ", families[f].symbol, size)
                        : fmt::format("{} {:.0f} N, ", families[f].symbol, size);
  }
  return text + fmt::format("open by {:.1e} of all magnitudes", polygon.open);
}

}  // namespace

report::Figure force_polygon(const DiagramRun& run, const std::string& body,
                             const std::vector<std::pair<int, int>>& planes, double shown_deg) {
  constexpr std::size_t kMaxFrames = 18;
  const std::vector<Family> families = families_of(*run.loads, body);
  DrawingFigure drawing;
  for (std::size_t f = 0; f < families.size(); ++f)
    drawing.looks.push_back({families[f].label, static_cast<int>(f), false});
  std::vector<std::size_t> rows = frame_rows(run.loads->rows(), kMaxFrames);
  for (std::size_t& row : rows) row *= run.loads->step;
  std::vector<Polygon> polygons;
  for (const std::size_t row : rows) polygons.push_back(polygon_at(run, families, body, row));
  for (const auto& plane : planes) drawing.panels.push_back(panel_of(plane, polygons));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    DrawingFigure::Frame frame{along(run, rows[i]), said_of(families, polygons[i]), {}, {}};
    for (std::size_t p = 0; p < planes.size(); ++p) {
      const auto [across, up] = planes[p];
      Force at = {};
      for (std::size_t f = 0; f < families.size(); ++f)
        for (const Force& force : polygons[i].forces[f]) {
          frame.arrows.push_back({static_cast<int>(p), static_cast<int>(f), at[across], at[up],
                                  force[across], force[up]});
          for (std::size_t k = 0; k < 3; ++k) at[k] += force[k];
        }
    }
    drawing.frames.push_back(std::move(frame));
  }
  drawing.shown = nearest_frame(run, rows, shown_deg);
  if (!run.time_ms.empty()) drawing.axis = kTimeAxis;
  const bool piston = body != "block";
  return {
      piston ? "polygon_piston" : "polygon_block",
      fmt::format("Force polygon of {}, tip to tail, in S2", piston ? body : "the block"),
      piston ? "Fig. 14b" : "", std::move(drawing),
      fmt::format("All forces on the body, by the {} model: first the given loads, then the "
                  "reactions, which close the polygon; a number is the sum of all forces of that "
                  "name. Forces that are always below {:g} of the largest force are left out.",
                  run.table.name, kNothing)};
}

}  // namespace bentaxis::study
