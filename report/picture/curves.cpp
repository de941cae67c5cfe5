#include "picture/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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
  std::ranges::reverse(upper);
  for (const auto& [a, b] : upper) points += fmt::format("{:.1f},{:.2f} ", a, b);
  points.pop_back();
  add(root, "polygon",
      {{"points", points},
       {"fill", band.colour},
       {"opacity", fmt::format("{:g}", band.opacity)},
       {"class", "band"}});
}

// An axis in pixels, and a hair beyond: rounding is no leaving.
struct Span {
  double low, high;
  explicit Span(const Scale& scale)
      : low(std::min(scale.first, scale.last) - kSimplified),
        high(std::max(scale.first, scale.last) + kSimplified) {}
  bool holds(double at) const { return at >= low && at <= high; }
};

// What of a piece of curve lies within both axes (Liang and Barsky).
std::vector<std::vector<Pixel>> within(const std::vector<Pixel>& piece, const Span& xs,
                                       const Span& ys) {
  const auto inside = [&](const Pixel& p) { return xs.holds(p[0]) && ys.holds(p[1]); };
  if (std::ranges::all_of(piece, inside)) return {piece};
  std::vector<std::vector<Pixel>> parts;
  bool joined = false;
  for (std::size_t i = 0; i + 1 < piece.size(); ++i) {
    const Pixel &a = piece[i], &b = piece[i + 1];
    double from = 0, to = 1;
    const auto cut = [&](double start, double along, const Span& span) {
      if (along == 0) {
        if (!span.holds(start)) to = -1;
        return;
      }
      const double low = (span.low - start) / along, high = (span.high - start) / along;
      from = std::max(from, std::min(low, high));
      to = std::min(to, std::max(low, high));
    };
    cut(a[0], b[0] - a[0], xs);
    cut(a[1], b[1] - a[1], ys);
    if (from > to) {
      joined = false;
      continue;
    }
    const auto at = [&](double t) -> Pixel {
      return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
    };
    if (!joined || from > 0) parts.push_back({at(from)});
    parts.back().push_back(at(to));
    joined = to == 1;
  }
  return parts;
}

// A triangle at the end of the axis for each stretch of a curve beyond it, where it is furthest.
void mark_leaving(pugi::xml_node root, const Scale& x, const Scale& y, const Curve& curve) {
  constexpr double kApart = 12;  // px; nearer stretches share one
  const Span ys(y), xs(x);
  std::optional<std::size_t> furthest;
  double last = -INFINITY;
  const auto beyond = [&](std::size_t i) {
    return std::max(ys.low - y.place(curve.y[i]), y.place(curve.y[i]) - ys.high);
  };
  const auto draw = [&] {
    if (!furthest) return;
    const double at = x.place(curve.x[*furthest]);
    const bool up = y.place(curve.y[*furthest]) < ys.low;
    const double end = up ? std::min(y.first, y.last) : std::max(y.first, y.last);
    pugi::xml_node node = add(root, "path",
                              {{"class", "beyond"},
                               {"d", fmt::format("M{} {}l5 {}h-10z", px(at), px(end), up ? 8 : -8)},
                               {"fill", curve.colour}});
    node.append_child("title").text() =
        fmt::format("outside the axis: {} at {}", short_number(curve.y[*furthest]),
                    short_number(curve.x[*furthest]))
            .c_str();
    furthest.reset();
  };
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!x.shows(curve.x[i]) || !y.shows(curve.y[i]) || !xs.holds(x.place(curve.x[i])) ||
        beyond(i) <= 0)
      continue;
    const double at = x.place(curve.x[i]);
    if (furthest && std::abs(at - last) > kApart) draw();
    if (!furthest || beyond(i) > beyond(*furthest)) furthest = i;
    last = at;
  }
  draw();
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
  for (const auto& piece : pieces)
    for (const auto& part : within(piece, Span(x), Span(y))) {
      char command = 'M';
      for (const auto& [px_x, px_y] : simplified(part)) {
        path += command + fmt::format("{:.1f} {:.2f}", px_x, px_y);
        command = 'L';
      }
    }
  mark_leaving(root, x, y, curve);
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
  return std::ranges::any_of(
      curves, [](const Curve& curve) { return std::ranges::any_of(curve.y, is_computed); });
}
bool any(const Values* values) {
  return values != nullptr && std::ranges::any_of(*values, is_computed);
}

}  // namespace bentaxis::report::picture
