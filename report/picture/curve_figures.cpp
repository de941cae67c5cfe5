#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/number.h"
#include "picture/curves.h"
#include "picture/figures.h"

namespace bentaxis::report::picture {
namespace {

const Axis kAngle{"shaft angle", "deg"};

// Ticks at the lower edge of a panel, in two rows.
void add_marks(Panel& panel, const std::vector<Curves::Mark>& marks) {
  panel.draw = [marks, curves = std::move(panel.draw)](pugi::xml_node root, const Scale& x,
                                                       const Scale& y) {
    constexpr double kHeight = 6, kGap = 2;
    for (const Curves::Mark& mark : marks) {
      const double foot = y.first - (mark.upper ? kHeight + kGap : 0);
      add(root, "line",
          {{"x1", px(x.place(mark.x))},
           {"x2", px(x.place(mark.x))},
           {"y1", px(foot)},
           {"y2", px(foot - kHeight)},
           {"stroke", "#555"},
           {"stroke-width", "0.8"}});
    }
    curves(root, x, y);
  };
}

// What a curve may be, widened by what is allowed; around the curve or its zero line.
Band band_of(const Values& theta, const Curves::Held& held, bool around_zero,
             const std::string& colour) {
  Band band{theta, held.low.empty() ? held.values : held.low,
            held.high.empty() ? held.values : held.high, colour};
  for (std::size_t i = 0; i < held.values.size(); ++i) {
    const double base = around_zero ? held.values[i] : 0;
    band.low[i] -= base + held.allowed;
    band.high[i] += held.allowed - base;
  }
  return band;
}

Axis with_ends(Axis axis, const std::optional<Ends>& ends) {
  if (ends) {
    axis.from = ends->low;
    axis.to = ends->high;
  }
  return axis;
}

// The stretches of a band that are no line, with a place on either side.
void add_stretches(std::vector<Band>& bands, const Band& all) {
  const auto wide = [&](std::size_t i) { return i < all.x.size() && all.low[i] != all.high[i]; };
  bool joined = false;
  for (std::size_t i = 0; i < all.x.size(); ++i) {
    const bool kept = wide(i) || wide(i + 1) || (i > 0 && wide(i - 1));
    if (kept) {
      if (!joined) bands.push_back({{}, {}, {}, all.colour, all.opacity});
      Band& band = bands.back();
      band.x.push_back(all.x[i]);
      band.low.push_back(all.low[i]);
      band.high.push_back(all.high[i]);
    }
    joined = kept;
  }
}

// Areas upon each other, above and below 0.
std::vector<Band> stacked(const Values& x, const std::vector<Series>& parts) {
  constexpr double kOpacity = 0.6;
  std::vector<Band> bands;
  Values above(x.size(), 0.0), below(x.size(), 0.0);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    Band up{x, above, above, pick(kColours, k), kOpacity};
    Band down{x, below, below, up.colour, kOpacity};
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double value = parts[k].values[i];
      if (value > 0) above[i] = up.high[i] += value;
      if (value < 0) below[i] = down.low[i] += value;
    }
    add_stretches(bands, up);
    add_stretches(bands, down);
  }
  return bands;
}

// The second axis of a panel with its curves, dashed.
Panel::Right right_of(const OwnFigure& figure, std::size_t first_colour, Keys& keys) {
  std::vector<Curve> lines;
  Range range;
  for (const Series& series : figure.right->series) {
    if (!any(&series.values)) continue;
    const char* colour = pick(kColours, first_colour + lines.size());
    lines.push_back({figure.x, series.values, colour, 1.9, 1, pick(kDashes, 1)});
    keys.push_back(line_key(series.label + " (right)", colour, 2.5, pick(kDashes, 1)));
    range.include(series.values);
  }
  return {{figure.right->value, figure.right->unit},
          range,
          [lines = std::move(lines)](pugi::xml_node root, const Scale& x, const Scale& y) {
            for (const Curve& line : lines) draw_curve(root, x, y, line);
          }};
}

// Both axes so that a unit is as long across as up, within the space there is.
void make_equal(Panel& panel) {
  constexpr double kMaxHeight = 430, kMinHeight = 120, kMargin = 0.06;  // px; of a span
  const auto widened = [&](Range range, const Axis& axis) {
    const double more = kMargin * (range.high - range.low);
    return Range{axis.from.value_or(range.low - more), axis.to.value_or(range.high + more)};
  };
  if (panel.xs.empty() || panel.ys.empty()) return;
  Range xs = widened(panel.xs, panel.x), ys = widened(panel.ys, panel.y);
  const double width = kRight - panel.left;
  const double unit = std::max((xs.high - xs.low) / width, (ys.high - ys.low) / kMaxHeight);
  if (!(unit > 0)) return;
  panel.height = std::max(kMinHeight, (ys.high - ys.low) / unit);
  const auto stretch = [](Range& range, double span, Axis& axis) {
    const double middle = (range.low + range.high) / 2;
    range = {middle - span / 2, middle + span / 2};
    axis.from = range.low;
    axis.to = range.high;
  };
  stretch(xs, unit * width, panel.x);
  stretch(ys, unit * panel.height, panel.y);
}

}  // namespace

Picture picture_of(const ChannelFigure& figure, const Curves& page) {
  const Curves& curves = figure.curves ? *figure.curves : page;
  const Values& theta = curves.theta_deg;
  const Axis axis = curves.axis.empty() ? kAngle : Axis{curves.axis};
  Picture picture;
  Keys channels, tables;
  std::vector<Curve> lines, differences, from_reference;
  std::vector<Band> bands, zero_bands;
  for (std::size_t c = 0; c < figure.channels.size(); ++c) {
    const std::string& channel = figure.channels[c];
    const std::string colour = pick(kColours, c);
    std::vector<const Values*> columns;
    for (const auto& table : curves.tables) columns.push_back(find(table.columns, channel));
    const bool alone = std::ranges::count_if(columns, any) < 2;
    bool shown = false;
    for (std::size_t t = 0; t < columns.size(); ++t) {
      if (!any(columns[t])) continue;
      shown = true;
      const bool pale = t == 0 && !alone;
      lines.push_back(
          {theta, *columns[t], colour, pale ? 4.5 : 1.9, pale ? 0.4 : 1, pick(kDashes, t)});
    }
    if (const Values* difference = find(curves.difference, channel); any(difference))
      differences.push_back({theta, *difference, colour, 1.4});
    if (curves.reference)
      for (const Curves::Held& held : curves.reference->held) {
        if (held.channel != channel) continue;
        shown = true;
        lines.push_back({theta, held.values, colour, 2.2, 1, pick(kDashes, 2), true});
        bands.push_back(band_of(theta, held, false, colour));
        zero_bands.push_back(band_of(theta, held, true, colour));
        for (std::size_t t = 0; t < held.differences.size(); ++t) {
          const bool pale = t == 0 && held.differences.size() > 1;
          from_reference.push_back({theta, held.differences[t].second, colour, pale ? 4.5 : 1.6,
                                    pale ? 0.4 : 1, pick(kDashes, t), true});
        }
      }
    if (shown) channels.push_back(line_key(channel, colour, 4));
  }
  for (std::size_t t = 0; t < curves.tables.size(); ++t)
    tables.push_back(line_key(curves.tables[t].name, "#444c55",
                              t == 0 && curves.tables.size() > 1 ? 4.5 : 1.9, pick(kDashes, t),
                              t == 0 && curves.tables.size() > 1 ? 0.4 : 1));
  if (!bands.empty()) {
    tables.push_back(line_key(curves.reference->name, "#444c55", 2.2, pick(kDashes, 2)));
    tables.push_back(line_key("allowed", "#444c55", 10, "none", 0.18));
  }
  for (std::size_t i = 0; i < figure.extra.size(); ++i) {
    if (!any(&figure.extra[i].values)) continue;
    const std::string colour = pick(kExtraColours, i);
    lines.push_back({theta, figure.extra[i].values, colour, 1.6, 1, "10 4 2 4"});
    tables.push_back(line_key(figure.extra[i].label, colour, 1.6, "10 4 2 4"));
  }
  if (lines.empty() || theta.size() < 2) return picture;  // one angle makes no curve
  picture.legend = {channels, tables};
  const bool three = !from_reference.empty();
  picture.panels.push_back(curve_panel(axis, with_ends({"value", figure.unit}, figure.ends),
                                       three ? 135 : 185, std::move(lines), std::move(bands)));
  if (!curves.marks.empty()) add_marks(picture.panels.back(), curves.marks);
  const bool exact = std::ranges::all_of(differences, [](const Curve& curve) {
    return std::ranges::all_of(curve.y, [](double v) { return !(v < 0 || v > 0); });
  });
  if (!exact) {
    picture.panels.push_back(
        curve_panel(axis, {"difference", figure.unit}, three ? 50 : 95, std::move(differences)));
    picture.panels.back().title =
        fmt::format("Difference: {} minus {}", curves.tables[1].name, curves.tables[0].name);
  }
  if (three) {
    picture.panels.push_back(curve_panel(axis, {"difference", figure.unit}, 78,
                                         std::move(from_reference), std::move(zero_bands)));
    picture.panels.back().title =
        fmt::format("Difference: each model minus {}", curves.reference->name);
  }
  for (Panel& panel : picture.panels) {
    panel.xs.include(theta);
    if (curves.axis.empty()) whole_turns(panel, theta);
  }
  for (std::size_t i = 0; i + 1 < picture.panels.size(); ++i) picture.panels[i].x = {};
  return picture;
}

Picture picture_of(const OwnFigure& figure, const Curves&) {
  Picture picture;
  std::vector<Curve> lines;
  Keys keys;
  for (std::size_t k = 0; k < figure.stack.size(); ++k)
    keys.push_back(shade_key(figure.stack[k].label, pick(kColours, k)));
  const bool over_stack = !figure.stack.empty();
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    if (!any(&figure.series[i].values)) continue;
    const char* colour = over_stack ? pick(kExtraColours, i) : pick(kColours, i);
    lines.push_back({figure.x, figure.series[i].values, colour});
    keys.push_back(line_key(figure.series[i].label, colour, 4));
  }
  std::optional<Panel::Right> right;
  if (figure.right) right = right_of(figure, figure.series.size(), keys);
  if (lines.empty() && figure.stack.empty()) return picture;
  picture.legend = {keys};
  picture.panels.push_back(curve_panel({figure.axis},
                                       with_ends({figure.value, figure.unit}, figure.ends), 230,
                                       std::move(lines), stacked(figure.x, figure.stack)));
  Panel& panel = picture.panels[0];
  panel.xs.include(figure.x);
  panel.right = std::move(right);
  if (figure.angle) whole_turns(panel, figure.x);
  return picture;
}

Picture picture_of(const XyFigure& figure, const Curves&) {
  Picture picture;
  std::vector<Curve> lines;
  Keys keys;
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    const XySeries& series = figure.series[i];
    lines.push_back({series.x, series.y, pick(kColours, i), 1.9, 1,
                     series.dashed ? pick(kDashes, 1) : pick(kDashes, i / kColours.size())});
    keys.push_back(line_key(series.label, pick(kColours, i), 3, lines.back().dash));
  }
  picture.legend = {keys};
  picture.panels.push_back(curve_panel(figure.x, figure.y, 250, lines));
  Panel& panel = picture.panels.back();
  for (const NamedPoint& point : figure.points) {
    panel.xs.include(point.x);
    panel.ys.include(point.y);
  }
  if (figure.equal) make_equal(panel);
  panel.draw = [=, names = figure.series, points = figure.points, curves = panel.draw](
                   pugi::xml_node root, const Scale& x, const Scale& y) {
    curves(root, x, y);
    for (std::size_t s = 0; s < lines.size(); ++s) {
      const Curve& line = lines[s];
      for (std::size_t i = 0; line.x.size() <= 60 && i < line.x.size(); ++i)
        if (x.shows(line.x[i]) && y.shows(line.y[i]))
          draw_mark(root, 0, x.place(line.x[i]), y.place(line.y[i]), line.colour,
                    fmt::format("{}: {} at {}", names[s].label, short_number(line.y[i]),
                                short_number(line.x[i])));
    }
    std::vector<Pixel> named;
    for (const NamedPoint& point : points) {
      if (!x.shows(point.x) || !y.shows(point.y)) continue;
      const Pixel at = {x.place(point.x), y.place(point.y)};
      draw_mark(root, 0, at[0], at[1], "#000000", point.label);
      // Where points crowd not every one has room for its name.
      const double width = kLetter * static_cast<double>(point.label.size()) + 14;
      if (std::ranges::any_of(named, [&](const Pixel& other) {
            return std::abs(other[0] - at[0]) < width && std::abs(other[1] - at[1]) < 12;
          }))
        continue;
      named.push_back(at);
      add_text(root, at[0] + 7, at[1] - 5, point.label,
               {{"class", "mark"},
                {"font-size", "11"},
                {"stroke", "#fff"},
                {"stroke-width", "3"},
                {"paint-order", "stroke"}});
    }
  };
  return picture;
}

Picture picture_of(const BandFigure& figure, const Curves&) {
  Picture picture;
  std::vector<Curve> curves;
  std::vector<Band> bands;
  picture.legend.resize(2);
  for (std::size_t i = 0; i < figure.bands.size(); ++i) {
    const BandFigure::Band& band = figure.bands[i];
    const std::string colour = pick(kColours, i);
    bands.push_back({figure.x_values, band.low, band.high, colour});
    curves.push_back({figure.x_values, band.middle, colour, 1.6});
    picture.legend[0].push_back({band.label, [=](pugi::xml_node root, double x, double y) {
                                   line_key("", colour, 12, "none", 0.18).draw(root, x, y);
                                   line_key("", colour, 1.6).draw(root, x, y);
                                 }});
  }
  for (std::size_t i = 0; i < figure.lines.size(); ++i) {
    const XySeries& line = figure.lines[i];
    const std::string colour = pick(kExtraColours, i);
    curves.push_back({line.x, line.y, colour, 1.6, 1, "8 4"});
    picture.legend[1].push_back(line_key(line.label, colour, 1.6, "8 4"));
  }
  if (!any_drawn(curves)) return picture;
  picture.panels.push_back(curve_panel(figure.x, figure.y, 250, std::move(curves), bands));
  Panel& panel = picture.panels.back();
  if (figure.angle) whole_turns(panel, figure.x_values);
  return picture;
}

}  // namespace bentaxis::report::picture
