#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/number.h"
#include "picture/curves.h"
#include "picture/figures.h"

namespace bentaxis::report::picture {
namespace {

// Pieces of the line z = level over a grid, by marching squares, in pixels. Where a corner has no
// value there is no line.
std::vector<std::array<Pixel, 2>> contour(const Values& xs, const Values& ys,
                                          const std::vector<Values>& z, double level) {
  std::vector<std::array<Pixel, 2>> pieces;
  for (std::size_t i = 0; i + 1 < ys.size(); ++i)
    for (std::size_t j = 0; j + 1 < xs.size(); ++j) {
      const std::array<std::array<std::size_t, 2>, 4> corners = {
          {{j, i}, {j + 1, i}, {j + 1, i + 1}, {j, i + 1}}};
      if (std::ranges::any_of(corners, [&](const auto& c) { return !is_computed(z[c[1]][c[0]]); }))
        continue;
      std::vector<Pixel> cuts;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& [a, b] = corners[k];
        const auto& [c, d] = corners[(k + 1) % 4];
        const double from = z[b][a], to = z[d][c];
        if ((from < level) == (to < level)) continue;
        const double t = (level - from) / (to - from);
        cuts.push_back({xs[a] + t * (xs[c] - xs[a]), ys[b] + t * (ys[d] - ys[b])});
      }
      for (std::size_t k = 0; k + 1 < cuts.size(); k += 2) pieces.push_back({cuts[k], cuts[k + 1]});
    }
  return pieces;
}

// Of classes, light to dark too.
std::string class_shade(double k) {
  constexpr std::array kClassShades = {"#f3f7e9", "#b9d7a8", "#e58a2b", "#5e1f63"};
  return pick(kClassShades, static_cast<std::size_t>(k));
}

// Three strokes over a box.
void hatch(pugi::xml_node root, double x, double y, double width, double height) {
  std::string path;
  for (const double t : {0.5, 1.0, 1.5}) {
    const double low = std::max(0.0, t - 1), high = std::min(1.0, t);
    path += fmt::format("M{} {}L{} {}", px(x + low * width), px(y + high * height),
                        px(x + high * width), px(y + low * height));
  }
  add(root, "path",
      {{"d", path}, {"class", "hatch"}, {"stroke", "#8a939d"}, {"pointer-events", "none"}});
}

// A line or a dot that is seen on any shade.
void draw_line_over(pugi::xml_node root, const std::string& path, std::size_t which) {
  const Attributes common = {{"d", path}, {"fill", "none"}, {"stroke-linejoin", "round"}};
  Attributes ground = common, line = common;
  ground.insert(ground.end(), {{"stroke", "#fff"}, {"stroke-width", "5"}});
  line.insert(line.end(), {{"class", "boundary"},
                           {"stroke", "#000"},
                           {"stroke-width", "2.2"},
                           {"stroke-dasharray", pick(kDashes, which)}});
  add(root, "path", ground);
  add(root, "path", line);
}

void draw_dot_over(pugi::xml_node root, double x, double y) {
  add(root, "circle",
      {{"cx", px(x)}, {"cy", px(y)}, {"r", "2.4"}, {"fill", "#fff"}, {"stroke", "#000"}});
}

// Where the cells of a map begin and end: half way between its values, and at either end as far
// from them as there. A single value's cell is a band about it.
Values edges_of(const Axis& axis, const Values& values) {
  Values at = values;
  if (axis.log)
    for (double& v : at) v = std::log10(v);
  Values edges;
  for (std::size_t k = 0; k + 1 < at.size(); ++k) edges.push_back((at[k] + at[k + 1]) / 2);
  if (edges.empty()) {
    for (const double v : at) edges = {v - 0.5, v + 0.5};
  } else {
    edges.insert(edges.begin(), 2 * at.front() - edges.front());
    edges.push_back(2 * at.back() - edges.back());
  }
  if (axis.log)
    for (double& v : edges) v = std::pow(10, v);
  return edges;
}

// Digits enough to tell values apart that are a part of the range.
std::string distinct_number(double value, const Range& range) {
  const double part = (range.high - range.low) / 8, size = std::abs(value);
  if (!(part > 0) || size < 1e-3 || size >= 1e6) return short_number(value);
  const int decimals = -static_cast<int>(std::floor(std::log10(part)));
  const std::string text = short_number(value);
  const auto point = text.find('.');
  const int shown = point == std::string::npos ? 0 : static_cast<int>(text.size() - point) - 1;
  return decimals <= std::max(shown, 0) ? text : fmt::format("{:.{}f}", value, decimals);
}

const Attributes kLabel = {
    {"text-anchor", "middle"}, {"font-weight", "bold"},   {"fill", "#7a0c0c"}, {"stroke", "#fff"},
    {"stroke-width", "4"},     {"paint-order", "stroke"}, {"class", "label"}};

// A place within the frame.
double in_frame(const Scale& scale, double value) {
  return std::clamp(scale.place(value), std::min(scale.first, scale.last),
                    std::max(scale.first, scale.last));
}

// A map with what is drawn of it. Shades and contours go by the logarithm of z, where it is not to
// be linear.
class Map {
 public:
  explicit Map(const MapFigure& figure)
      : figure_(figure),
        linear_(figure.linear || !figure.classes.empty()),
        z_(figure.values),
        x_edges_(edges_of(figure.x, figure.x_values)),
        y_edges_(edges_of(figure.y, figure.y_values)) {
    for (Values& row : z_)
      for (double& v : row) {
        if (!linear_) v = std::isfinite(v) && v > 0 ? std::log10(v) : not_computed();
        range_.include(v);
      }
    if (linear_) range_.low = figure.z.from.value_or(std::min(range_.low, 0.0));
    xs_.include(x_edges_);
    ys_.include(y_edges_);
  }

  bool empty() const { return range_.empty(); }
  std::vector<Keys> legend() const { return {shades(), marks()}; }

  // With the picture's own copy of the map, which outlives the figure.
  Panel panel() const {
    Panel panel{figure_.x, figure_.y, figure_.y_values.size() > 1 ? 330.0 : 180.0, xs_, ys_};
    panel.y_margin = Margin::none;
    // Beside a single value an axis has nothing to say.
    for (const auto& [values, ticks] : {std::pair{&figure_.x_values, &panel.x_ticks},
                                        std::pair{&figure_.y_values, &panel.y_ticks}})
      if (values->size() == 1) *ticks = {{values->front(), fmt::format("{:.6g}", values->front())}};
    panel.draw = [map = *this](pugi::xml_node root, const Scale& x, const Scale& y) {
      map.draw_cells(root, x, y);
      map.draw_contours(root, x, y);
      map.draw_lines(root, x, y);
      map.draw_places(root, x, y);
    };
    return panel;
  }

 private:
  std::string text(double v) const {
    if (!figure_.classes.empty()) return figure_.classes.at(static_cast<std::size_t>(v));
    return with_unit(linear_ ? distinct_number(v, range_) : short_number(v), figure_.z.unit);
  }
  std::string colour(double v) const {
    if (!is_computed(v)) return "#fff";
    if (!figure_.classes.empty()) return class_shade(v);
    return shade((v - range_.low) / std::max(1e-12, range_.high - range_.low));
  }
  std::string reason(std::size_t i, std::size_t j) const {
    return figure_.reasons.empty() ? "" : figure_.reasons.at(i).at(j);
  }

  Keys shades() const;
  Keys marks() const;
  void draw_cells(pugi::xml_node root, const Scale& x, const Scale& y) const;
  void draw_contours(pugi::xml_node root, const Scale& x, const Scale& y) const;
  void draw_lines(pugi::xml_node root, const Scale& x, const Scale& y) const;
  void draw_places(pugi::xml_node root, const Scale& x, const Scale& y) const;

  MapFigure figure_;
  bool linear_;
  std::vector<Values> z_;
  Values x_edges_, y_edges_;
  Range range_, xs_, ys_;  // of z_ and of the edges
};

Keys Map::shades() const {
  if (figure_.classes.empty())
    return scale_keys(figure_.z.label, [&](double t) {
      const double v = range_.low + t * (range_.high - range_.low);
      return shade_key(text(linear_ ? v : std::pow(10, v)), shade(t));
    });
  Keys keys;
  for (std::size_t k = 0; k < figure_.classes.size(); ++k)
    keys.push_back(shade_key(figure_.classes[k], class_shade(static_cast<double>(k))));
  return keys;
}

Keys Map::marks() const {
  Keys keys;
  if (std::any_of(figure_.reasons.begin(), figure_.reasons.end(), [](const auto& row) {
        return std::any_of(row.begin(), row.end(),
                           [](const auto& reason) { return !reason.empty(); });
      }))
    keys.push_back({"infeasible", [](pugi::xml_node root, double x, double y) {
                      hatch(root, x, y - 6, 30, 12);
                    }});
  for (std::size_t i = 0; i < figure_.lines.size(); ++i)
    keys.push_back({figure_.lines[i].label, [i](pugi::xml_node root, double x, double y) {
                      draw_line_over(
                          root, fmt::format("M{} {}L{} {}", px(x), px(y), px(x + 30), px(y)), i);
                    }});
  if (figure_.marks)
    keys.push_back({figure_.marks->label, [](pugi::xml_node root, double x, double y) {
                      draw_dot_over(root, x + 15, y);
                    }});
  return keys;
}

void Map::draw_cells(pugi::xml_node root, const Scale& x, const Scale& y) const {
  for (std::size_t i = 0; i < z_.size(); ++i)
    for (std::size_t j = 0; j < z_[i].size(); ++j) {
      const double x1 = in_frame(x, x_edges_[j]), x2 = in_frame(x, x_edges_[j + 1]);
      const double y1 = in_frame(y, y_edges_[i + 1]), y2 = in_frame(y, y_edges_[i]);
      const double value = figure_.values[i][j];
      const std::string why = reason(i, j);
      pugi::xml_node cell = add(root, "rect",
                                {{"x", px(x1)},
                                 {"y", px(y1)},
                                 {"width", px(x2 - x1 + 0.6)},
                                 {"height", px(y2 - y1 + 0.6)},
                                 {"fill", colour(z_[i][j])}});
      cell.append_child("title").text() =
          fmt::format("{} {}, {} {}: {}", figure_.x.label,
                      with_unit(short_number(figure_.x_values[j]), figure_.x.unit), figure_.y.label,
                      with_unit(short_number(figure_.y_values[i]), figure_.y.unit),
                      is_computed(value) ? text(value)
                      : why.empty()      ? "not computed"
                                         : why)
              .c_str();
      if (!is_computed(value) && !why.empty()) hatch(root, x1, y1, x2 - x1, y2 - y1);
    }
}

void Map::draw_contours(pugi::xml_node root, const Scale& x, const Scale& y) const {
  Values px_x, px_y;
  for (const double v : figure_.x_values) px_x.push_back(x.place(v));
  for (const double v : figure_.y_values) px_y.push_back(y.place(v));
  std::vector<Pixel> labelled;
  for (const double level : figure_.contours) {
    const auto pieces = contour(px_x, px_y, z_, linear_ ? level : std::log10(level));
    if (pieces.empty()) continue;
    std::string path;
    for (const auto& [a, b] : pieces)
      path += fmt::format("M{} {}L{} {}", px(a[0]), px(a[1]), px(b[0]), px(b[1]));
    add(root, "path",
        {{"d", path}, {"stroke", "#fff"}, {"stroke-width", "4"}, {"stroke-linecap", "round"}});
    add(root, "path",
        {{"class", "contour"},
         {"d", path},
         {"stroke", "#a11212"},
         {"stroke-width", "1.8"},
         {"stroke-linecap", "round"}});
    const Pixel& at = pieces[pieces.size() / 2][0];
    // Where lines crowd not every one has room for its value.
    if (std::any_of(labelled.begin(), labelled.end(), [&](const Pixel& other) {
          return std::abs(other[0] - at[0]) < 60 && std::abs(other[1] - at[1]) < 14;
        }))
      continue;
    labelled.push_back(at);
    add_text(root, std::clamp(at[0], kLeft + 24, kRight - 24), at[1] - 6, text(level), kLabel);
  }
}

void Map::draw_lines(pugi::xml_node root, const Scale& x, const Scale& y) const {
  for (std::size_t i = 0; i < figure_.lines.size(); ++i) {
    const XySeries& line = figure_.lines[i];
    const auto shown = [&](std::size_t k) {
      return k < line.x.size() && x.shows(line.x[k]) && y.shows(line.y[k]);
    };
    std::string path;
    for (std::size_t k = 0; k < line.x.size(); ++k) {
      if (!shown(k)) continue;
      const bool begins = k == 0 || !shown(k - 1);
      const double at_x = x.place(line.x[k]), at_y = y.place(line.y[k]);
      if (begins && !shown(k + 1)) {  // a place alone: across its row
        const auto row = std::upper_bound(y_edges_.begin(), y_edges_.end(), line.y[k]);
        if (row == y_edges_.begin() || row == y_edges_.end()) continue;
        path += fmt::format("M{0} {1}L{0} {2}", px(at_x), px(in_frame(y, *(row - 1))),
                            px(in_frame(y, *row)));
      } else {
        path += fmt::format("{}{} {}", begins ? "M" : "L", px(at_x), px(at_y));
      }
    }
    if (!path.empty()) draw_line_over(root, path, i);
  }
}

// Dots, and places by name.
void Map::draw_places(pugi::xml_node root, const Scale& x, const Scale& y) const {
  if (figure_.marks)
    for (std::size_t k = 0; k < figure_.marks->x.size(); ++k)
      draw_dot_over(root, x.place(figure_.marks->x[k]), y.place(figure_.marks->y[k]));
  for (const NamedPoint& p : figure_.points) {
    if (p.x < xs_.low || p.x > xs_.high || p.y < ys_.low || p.y > ys_.high) continue;
    add(root, "circle",
        {{"cx", px(x.place(p.x))},
         {"cy", px(y.place(p.y))},
         {"r", "4.5"},
         {"fill", "#e69f00"},
         {"stroke", "#000"}});
    add_text(root, x.place(p.x), y.place(p.y) - 9, p.label, kLabel);
  }
}

}  // namespace

Picture picture_of(const MapFigure& figure, const Curves&) {
  const Map map(figure);
  if (map.empty()) return {};
  return {map.legend(), {map.panel()}};
}

}  // namespace bentaxis::report::picture
