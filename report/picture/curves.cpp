#include "picture/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/number.h"

namespace bentaxis::report::picture {
namespace {

constexpr double kSimplified = 0.06;  // px, by which a drawn curve may be off

// Leaves out points that the line through their neighbours meets closely enough.
std::vector<Pixel> simplified(const std::vector<Pixel>& points) {
  if (points.size() < 3) return points;
  std::vector<Pixel> kept = {points.front()};
  std::size_t from = 0;
  for (std::size_t to = 2; to < points.size(); ++to) {
    const auto& [x0, y0] = points[from];
    const auto& [x1, y1] = points[to];
    bool close = x1 != x0 && to - from < 200;
    for (std::size_t i = from + 1; close && i < to; ++i)
      close =
          std::abs(y0 + (y1 - y0) * (points[i][0] - x0) / (x1 - x0) - points[i][1]) < kSimplified;
    if (close) continue;
    from = to - 1;
    kept.push_back(points[from]);
  }
  kept.push_back(points.back());
  return kept;
}

void draw_band(pugi::xml_node root, const Scale& x, const Scale& y, const Band& band) {
  std::vector<Pixel> low, high;
  for (std::size_t i = 0; i < band.x.size(); ++i)
    if (x.shows(band.x[i]) && y.shows(band.low[i]) && y.shows(band.high[i])) {
      low.push_back({x.place(band.x[i]), y.place(band.low[i])});
      high.push_back({x.place(band.x[i]), y.place(band.high[i])});
    }
  if (low.empty()) return;
  std::string points;
  for (const auto& [a, b] : simplified(low)) points += fmt::format("{:.1f},{:.2f} ", a, b);
  auto upper = simplified(high);
  std::reverse(upper.begin(), upper.end());
  for (const auto& [a, b] : upper) points += fmt::format("{:.1f},{:.2f} ", a, b);
  points.pop_back();
  add(root, "polygon",
      {{"points", points}, {"fill", band.colour}, {"opacity", "0.18"}, {"class", "band"}});
}

}  // namespace

void draw_curve(pugi::xml_node root, const Scale& x, const Scale& y, const Curve& curve) {
  std::vector<std::vector<Pixel>> pieces(1);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (x.shows(curve.x[i]) && y.shows(curve.y[i]))
      pieces.back().push_back({x.place(curve.x[i]), y.place(curve.y[i])});
    else if (!curve.sparse && !pieces.back().empty())
      pieces.emplace_back();
  }
  std::string path;
  for (const auto& piece : pieces) {
    char command = 'M';
    for (const auto& [px_x, px_y] : simplified(piece)) {
      path += command + fmt::format("{:.1f} {:.2f}", px_x, px_y);
      command = 'L';
    }
  }
  if (path.empty()) return;
  add(root, "path",
      {{"d", path},
       {"fill", "none"},
       {"stroke", curve.colour},
       {"stroke-width", px(curve.width)},
       {"stroke-dasharray", curve.dash},
       {"stroke-linejoin", "round"},
       {"opacity", fmt::format("{:g}", curve.opacity)}});
}

Panel curve_panel(const Axis& x, const Axis& y, double height, std::vector<Curve> curves,
                  std::vector<Band> bands) {
  Panel panel{x, y, height, {}, {}};
  for (const Curve& curve : curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) && (!x.log || curve.x[i] > 0) &&
          (!y.log || curve.y[i] > 0)) {
        panel.xs.include(curve.x[i]);
        panel.ys.include(curve.y[i]);
      }
  }
  for (const Band& band : bands) {
    panel.ys.include(band.low);
    panel.ys.include(band.high);
  }
  panel.draw = [curves = std::move(curves), bands = std::move(bands)](
                   pugi::xml_node root, const Scale& sx, const Scale& sy) {
    for (const Band& band : bands) draw_band(root, sx, sy, band);
    for (const Curve& curve : curves) draw_curve(root, sx, sy, curve);
  };
  return panel;
}

void whole_turns(Panel& panel, const Values& theta) {
  panel.angle = true;
  if (theta.size() < 2 || panel.xs.empty()) return;
  const double step = 1.01 * (panel.xs.high - panel.xs.low) / static_cast<double>(theta.size() - 1);
  const double low = 360 * std::floor(panel.xs.low / 360),
               high = 360 * std::ceil(panel.xs.high / 360);
  if (panel.xs.low - low <= step) panel.xs.low = low;
  if (high - panel.xs.high <= step) panel.xs.high = high;
}

bool any_drawn(const std::vector<Curve>& curves) {
  return std::any_of(curves.begin(), curves.end(), [](const Curve& curve) {
    return std::any_of(curve.y.begin(), curve.y.end(), is_computed);
  });
}
bool any(const Values* values) {
  return values != nullptr && std::any_of(values->begin(), values->end(), is_computed);
}

}  // namespace bentaxis::report::picture
