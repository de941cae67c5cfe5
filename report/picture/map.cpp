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

}  // namespace

// Shades and contours go by the logarithm of z, where it is not to be linear.
Picture picture_of(const MapFigure& figure, const Curves&) {
  Picture picture;
  std::vector<Values> z = figure.values;
  const bool linear = figure.linear || !figure.classes.empty();
  Range range, xs, ys;
  for (Values& row : z)
    for (double& v : row) {
      if (!linear) v = std::isfinite(v) && v > 0 ? std::log10(v) : not_computed();
      range.include(v);
    }
  if (range.empty()) return picture;
  if (linear) range.low = figure.z.from.value_or(std::min(range.low, 0.0));
  const Values x_edges = edges_of(figure.x, figure.x_values);
  const Values y_edges = edges_of(figure.y, figure.y_values);
  xs.include(x_edges);
  ys.include(y_edges);
  const auto text = [&figure, linear, range](double v) {
    if (!figure.classes.empty()) return figure.classes.at(static_cast<std::size_t>(v));
    return with_unit(linear ? distinct_number(v, range) : short_number(v), figure.z.unit);
  };
  const auto colour = [&figure, range](double v) {
    if (!is_computed(v)) return std::string("#fff");
    if (!figure.classes.empty()) return class_shade(v);
    return shade((v - range.low) / std::max(1e-12, range.high - range.low));
  };
  picture.legend.emplace_back();
  if (!figure.classes.empty()) {
    for (std::size_t k = 0; k < figure.classes.size(); ++k)
      picture.legend[0].push_back(
          shade_key(figure.classes[k], class_shade(static_cast<double>(k))));
  } else {
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const double v = range.low + t * (range.high - range.low);
      picture.legend[0].push_back(shade_key(text(linear ? v : std::pow(10, v)), shade(t)));
    }
    picture.legend[0][0].label = figure.z.label + ": " + picture.legend[0][0].label;
  }
  picture.legend.emplace_back();
  if (std::ranges::any_of(figure.reasons, [](const auto& row) {
        return std::ranges::any_of(row, [](const auto& reason) { return !reason.empty(); });
      }))
    picture.legend[1].push_back({"infeasible", [](pugi::xml_node root, double x, double y) {
                                   hatch(root, x, y - 6, 30, 12);
                                 }});
  for (std::size_t i = 0; i < figure.lines.size(); ++i)
    picture.legend[1].push_back(
        {figure.lines[i].label, [i](pugi::xml_node root, double x, double y) {
           draw_line_over(root, fmt::format("M{} {}L{} {}", px(x), px(y), px(x + 30), px(y)), i);
         }});
  if (figure.marks)
    picture.legend[1].push_back({figure.marks->label, [](pugi::xml_node root, double x, double y) {
                                   draw_dot_over(root, x + 15, y);
                                 }});
  Panel panel{figure.x, figure.y, figure.y_values.size() > 1 ? 330.0 : 180.0, xs, ys};
  panel.y_margin = Margin::none;
  // Beside a single value an axis has nothing to say.
  for (const auto& [values, ticks] :
       {std::pair{&figure.x_values, &panel.x_ticks}, std::pair{&figure.y_values, &panel.y_ticks}})
    if (values->size() == 1) *ticks = {{values->front(), fmt::format("{:.6g}", values->front())}};
  panel.draw = [=](pugi::xml_node root, const Scale& x, const Scale& y) {
    Values px_x, px_y;
    for (const double v : figure.x_values) px_x.push_back(x.place(v));
    for (const double v : figure.y_values) px_y.push_back(y.place(v));
    const auto in_frame = [](const Scale& s, double v) {
      return std::clamp(s.place(v), std::min(s.first, s.last), std::max(s.first, s.last));
    };
    for (std::size_t i = 0; i < z.size(); ++i)
      for (std::size_t j = 0; j < z[i].size(); ++j) {
        const double x1 = in_frame(x, x_edges[j]), x2 = in_frame(x, x_edges[j + 1]);
        const double y1 = in_frame(y, y_edges[i + 1]), y2 = in_frame(y, y_edges[i]);
        const std::string reason = figure.reasons.empty() ? "" : figure.reasons.at(i).at(j);
        pugi::xml_node cell = add(root, "rect",
                                  {{"x", px(x1)},
                                   {"y", px(y1)},
                                   {"width", px(x2 - x1 + 0.6)},
                                   {"height", px(y2 - y1 + 0.6)},
                                   {"fill", colour(z[i][j])}});
        cell.append_child("title").text() =
            fmt::format("{} {}, {} {}: {}", figure.x.label,
                        with_unit(short_number(figure.x_values[j]), figure.x.unit), figure.y.label,
                        with_unit(short_number(figure.y_values[i]), figure.y.unit),
                        is_computed(figure.values[i][j]) ? text(figure.values[i][j])
                        : reason.empty()                 ? "not computed"
                                                         : reason)
                .c_str();
        if (!is_computed(figure.values[i][j]) && !reason.empty())
          hatch(root, x1, y1, x2 - x1, y2 - y1);
      }
    const Attributes label = {{"text-anchor", "middle"}, {"font-weight", "bold"},
                              {"fill", "#7a0c0c"},       {"stroke", "#fff"},
                              {"stroke-width", "4"},     {"paint-order", "stroke"},
                              {"class", "label"}};
    std::vector<Pixel> labelled;
    for (const double level : figure.contours) {
      const auto pieces = contour(px_x, px_y, z, linear ? level : std::log10(level));
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
      const bool room = std::ranges::none_of(labelled, [&](const Pixel& other) {
        return std::abs(other[0] - at[0]) < 60 && std::abs(other[1] - at[1]) < 14;
      });
      if (!room) continue;
      labelled.push_back(at);
      add_text(root, std::clamp(at[0], kLeft + 24, kRight - 24), at[1] - 6, text(level), label);
    }
    for (std::size_t i = 0; i < figure.lines.size(); ++i) {
      const XySeries& line = figure.lines[i];
      const auto shown = [&](std::size_t k) {
        return k < line.x.size() && x.shows(line.x[k]) && y.shows(line.y[k]);
      };
      std::string path;
      for (std::size_t k = 0; k < line.x.size(); ++k) {
        if (!shown(k)) continue;
        const bool begins = k == 0 || !shown(k - 1);
        const double at_x = x.place(line.x[k]), at_y = y.place(line.y[k]);
        if (begins && !shown(k + 1)) {  // a place alone: across its row
          const auto row = std::ranges::upper_bound(y_edges, line.y[k]);
          if (row == y_edges.begin() || row == y_edges.end()) continue;
          path += fmt::format("M{0} {1}L{0} {2}", px(at_x), px(in_frame(y, *(row - 1))),
                              px(in_frame(y, *row)));
        } else {
          path += fmt::format("{}{} {}", begins ? "M" : "L", px(at_x), px(at_y));
        }
      }
      if (!path.empty()) draw_line_over(root, path, i);
    }
    if (figure.marks)
      for (std::size_t k = 0; k < figure.marks->x.size(); ++k)
        draw_dot_over(root, x.place(figure.marks->x[k]), y.place(figure.marks->y[k]));
    for (const NamedPoint& p : figure.points) {
      if (p.x < xs.low || p.x > xs.high || p.y < ys.low || p.y > ys.high) continue;
      add(root, "circle",
          {{"cx", px(x.place(p.x))},
           {"cy", px(y.place(p.y))},
           {"r", "4.5"},
           {"fill", "#e69f00"},
           {"stroke", "#000"}});
      add_text(root, x.place(p.x), y.place(p.y) - 9, p.label, label);
    }
  };
  picture.panels.push_back(std::move(panel));
  return picture;
}

}  // namespace bentaxis::report::picture
