#include "bentaxis/report/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <pugixml.hpp>
#include <sstream>

#include "bentaxis/pump/number.h"

namespace bentaxis::report {
namespace {

// ---- Looks; the curves' colours and dashes are those of page/elements.js.

constexpr double kWidth = 720, kLeft = 82, kRight = 704;  // px
constexpr double kLetter = 6.6;                           // px, of the legend, on average
constexpr std::array kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9",
                                 "#e69f00", "#000000", "#7f3b08", "#542788", "#5f6b75"};
constexpr std::array kExtraColours = {"#444c55", "#8a5a00", "#7a3b8f"};
constexpr std::array kDashes = {"none", "8 5", "2 4"};  // by table
constexpr double kSimplified = 0.06;                    // px, by which a drawn curve may be off

template <class Choices>
const char* pick(const Choices& choices, std::size_t i) {
  return choices[i % choices.size()];
}

// ---- Elements

std::string px(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

using Attributes = std::vector<std::pair<const char*, std::string>>;

pugi::xml_node add(pugi::xml_node parent, const char* name, const Attributes& attributes) {
  pugi::xml_node node = parent.append_child(name);
  for (const auto& [key, value] : attributes) node.append_attribute(key) = value.c_str();
  return node;
}

pugi::xml_node add_text(pugi::xml_node parent, double x, double y, const std::string& text,
                        Attributes attributes = {}) {
  attributes.insert(attributes.begin(), {{"x", px(x)}, {"y", px(y)}});
  pugi::xml_node node = add(parent, "text", attributes);
  node.text() = text.c_str();
  return node;
}

const Attributes kMiddle = {{"text-anchor", "middle"}};

void add_line(pugi::xml_node parent, double x1, double y1, double x2, double y2,
              const Attributes& attributes) {
  Attributes all = {{"x1", px(x1)}, {"y1", px(y1)}, {"x2", px(x2)}, {"y2", px(y2)}};
  all.insert(all.end(), attributes.begin(), attributes.end());
  add(parent, "line", all);
}

// ---- Axes

std::string scientific(double value, int digits) {
  std::string text = fmt::format("{:.{}e}", value, digits - 1);
  const auto e = text.find('e');
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') != std::string::npos) {
    mantissa.resize(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  return fmt::format("{}e{}", mantissa, std::stoi(text.substr(e + 1)));
}

// Three digits, as far as they say something.
std::string short_number(double value) {
  if (!std::isfinite(value)) return "not finite";
  const double size = std::abs(value);
  if (value != 0 && (size < 1e-3 || size >= 1e6)) return scientific(value, 3);
  const int digit = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(size)));
  std::string text = fmt::format("{:.{}f}", value, std::max(0, 2 - digit));
  if (text.find('.') != std::string::npos) {
    text.resize(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " " + unit;
}
std::string name_of(const Axis& axis) {
  return axis.unit.empty() ? axis.label : fmt::format("{} ({})", axis.label, axis.unit);
}

struct Range {
  double low = INFINITY, high = -INFINITY;
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void include(const Values& values) {
    for (const double value : values) include(value);
  }
  bool empty() const { return !(low <= high); }
};

struct Tick {
  double value;
  std::string label;
};

// Multiples of 1, 2 or 5 times a power of ten, three at least. No two read alike, none shows
// round-off.
std::vector<Tick> round_ticks(double low, double high, double most) {
  double step = 0;
  for (bool enough = false; !enough; most *= 1.5) {
    const double power = std::pow(10, std::floor(std::log10((high - low) / most)));
    step = 10 * power;
    for (const double m : {5, 2, 1})
      if (m * power * most >= high - low) step = m * power;
    enough = std::floor(high / step) - std::ceil(low / step) >= 2;
  }
  const double largest = std::max(std::abs(low), std::abs(high));
  const auto digit = [](double v) { return static_cast<int>(std::floor(std::log10(v) + 1e-9)); };
  const auto text = [&](double v) {
    if (largest >= 1e-2 && largest < 1e6)
      return fmt::format("{:.{}f}", v, std::max(0, -digit(step)));
    return scientific(v, 1 + std::max(0, digit(std::abs(v)) - digit(step)));
  };
  std::vector<Tick> ticks;
  for (double k = std::ceil(low / step); k * step <= high * (1 + 1e-12); ++k)
    ticks.push_back({k * step, k == 0 ? "0" : text(k * step)});
  return ticks;
}

// Fractions of a turn.
std::vector<Tick> angle_ticks(double low, double high) {
  double step = 15;
  for (const double next : {30., 45., 60., 90., 180., 360., 720., 1440., 3600., 7200., 36000.})
    if ((high - low) / step > 12) step = next;
  while ((high - low) / step > 12) step *= 10;
  std::vector<Tick> ticks;
  for (double k = std::ceil(low / step); k * step <= high; ++k)
    ticks.push_back({k * step, fmt::format("{:g}", k * step)});
  return ticks;
}

std::vector<Tick> log_ticks(double low, double high, double most) {
  const double decades = std::log10(high / low);
  const std::vector<double> digits = decades > 2   ? std::vector<double>{1}
                                     : decades > 1 ? std::vector<double>{1, 2, 5}
                                                   : std::vector<double>{1, 1.5, 2, 3, 4, 5, 6, 8};
  const int every = std::max(1, static_cast<int>(std::ceil(decades / most)));
  std::vector<Tick> ticks;
  for (int power = static_cast<int>(std::floor(std::log10(low))); power <= std::log10(high) + 1;
       ++power) {
    if (power % every != 0) continue;
    for (const double digit : digits) {
      const double v = digit * std::pow(10, power);
      if (v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9))
        ticks.push_back({v, decades > 2 ? fmt::format("1e{}", power) : short_number(v)});
    }
  }
  return ticks;
}

// An axis between two pixels.
struct Scale {
  std::string name;
  double low, high, first, last;
  bool log = false;
  std::vector<Tick> ticks;

  bool shows(double value) const { return std::isfinite(value) && (!log || value > 0); }
  double place(double value) const {
    const auto f = [&](double v) { return log ? std::log10(v) : v; };
    return first + (last - first) * (f(value) - f(low)) / (f(high) - f(low));
  }
};

// What differs by less over its size is drawn as one value: no ticks lie between.
constexpr double kSmallestSpan = 1e-12;

enum class Margin { none, some, decades };

Scale scale_of(const Axis& axis, Range range, double first, double last, Margin margin,
               bool angle = false) {
  if (axis.log && !range.empty())
    range = {std::max(range.low, 1e-290), std::max(range.high, 1e-290)};
  if (range.empty()) range = axis.log ? Range{0.1, 1} : Range{0, 1};
  if (axis.from) range.low = *axis.from;
  if (margin == Margin::decades && axis.log) {
    range = {std::pow(10, std::floor(std::log10(range.low) - 0.05)),
             std::pow(10, std::ceil(std::log10(range.high) + 0.05))};
  } else if (!(range.high - range.low >
                   kSmallestSpan * std::max(std::abs(range.low), std::abs(range.high)) &&
               range.high - range.low > 1e-290)) {
    range = axis.log ? Range{range.low / 2, range.low * 2}
                     : Range{range.low - std::max(1e-12, std::abs(range.low) / 2),
                             range.low + std::max(1e-12, std::abs(range.low) / 2)};
  } else if (margin != Margin::none && !axis.log) {
    const double more = 0.06 * (range.high - range.low);
    range = {axis.from ? range.low : range.low - more, range.high + more};
  }
  const double most = std::max(3.0, std::abs(last - first) / (first < last ? 80 : 32));
  return {name_of(axis),
          range.low,
          range.high,
          first,
          last,
          axis.log,
          angle      ? angle_ticks(range.low, range.high)
          : axis.log ? log_ticks(range.low, range.high, most)
                     : round_ticks(range.low, range.high, most)};
}

// ---- A picture: title, legend, panels below each other

struct Panel {
  Axis x, y;
  double height;
  Range xs = {}, ys = {};
  bool angle = false;
  Margin x_margin = Margin::none, y_margin = Margin::some;
  std::function<void(pugi::xml_node, const Scale&, const Scale&)> draw = {};
  std::string title = {};
  std::vector<Tick> x_ticks = {}, y_ticks = {};  ///< instead of numbers
  double left = kLeft;                           ///< px, where y begins
  bool bare = false;                             ///< draws its axes itself
};

// A piece of line, a filled box or a mark, with a text.
struct Key {
  std::string label;
  std::function<void(pugi::xml_node, double x, double y)> draw;  ///< 30 px to the right of x
};
using Keys = std::vector<Key>;

Key line_key(const std::string& label, const std::string& colour, double width,
             const std::string& dash = "none", double opacity = 1) {
  return {label, [=](pugi::xml_node root, double x, double y) {
            add_line(root, x, y, x + 30, y,
                     {{"stroke", colour},
                      {"stroke-width", px(width)},
                      {"stroke-dasharray", dash},
                      {"opacity", fmt::format("{:g}", opacity)}});
          }};
}

struct Picture {
  std::vector<Keys> legend;  ///< rows, broken where they are too long
  std::vector<Panel> panels;
};

double draw_legend(pugi::xml_node root, const std::vector<Keys>& rows, double y) {
  for (const Keys& keys : rows) {
    if (keys.empty()) continue;
    double x = 14;
    for (const Key& key : keys) {
      const double width = 38 + kLetter * static_cast<double>(key.label.size()) + 18;
      if (x > 14 && x + width > kWidth) {
        x = 14;
        y += 18;
      }
      key.draw(root, x, y - 4);
      add_text(root, x + 36, y, key.label);
      x += width;
    }
    y += 20;
  }
  return y;
}

void draw_panel(pugi::xml_node root, const Panel& panel, double top) {
  const double bottom = top + panel.height;
  Scale x = scale_of(panel.x, panel.xs, panel.left, kRight, panel.x_margin, panel.angle);
  if (!panel.x_ticks.empty()) x.ticks = panel.x_ticks;
  Scale y = scale_of(panel.y, panel.ys, bottom, top, panel.y_margin);
  if (!panel.y_ticks.empty()) y.ticks = panel.y_ticks;
  if (panel.bare) {
    panel.draw(root, x, y);
    return;
  }
  const Attributes grid = {{"stroke", "#e1e6ec"}, {"class", "grid"}};
  if (panel.x_ticks.empty())
    for (const Tick& tick : x.ticks)
      add_line(root, x.place(tick.value), top, x.place(tick.value), bottom, grid);
  if (panel.y_ticks.empty())
    for (const Tick& tick : y.ticks)
      add_line(root, panel.left, y.place(tick.value), kRight, y.place(tick.value),
               tick.value == 0 ? Attributes{{"stroke", "#67727e"}, {"class", "zero"}} : grid);
  panel.draw(root, x, y);
  for (const Tick& tick : x.ticks)
    add_text(root, x.place(tick.value), bottom + 16, tick.label, kMiddle);
  for (const Tick& tick : y.ticks)
    add_text(root, panel.left - 7, y.place(tick.value) + 4, tick.label, {{"text-anchor", "end"}});
  add_text(root, (panel.left + kRight) / 2, bottom + 33, x.name, kMiddle);
  const double middle = (top + bottom) / 2;
  add_text(
      root, 13, middle, y.name,
      {{"text-anchor", "middle"}, {"transform", fmt::format("rotate(-90 13 {})", px(middle))}});
}

std::string drawn(const Figure& figure, const Picture& picture) {
  pugi::xml_document document;
  pugi::xml_node root = add(document, "svg",
                            {{"xmlns", "http://www.w3.org/2000/svg"},
                             {"font-family", "DejaVu Sans, Arial, sans-serif"},
                             {"font-size", "12"},
                             {"fill", "#1c2733"},
                             {"role", "img"}});
  root.append_child("title").text() = figure.title.c_str();
  if (!figure.note.empty()) root.append_child("desc").text() = figure.note.c_str();
  add(root, "rect", {{"class", "ground"}, {"width", "100%"}, {"height", "100%"}, {"fill", "#fff"}});
  // A title too long for one line is broken once.
  const std::size_t most = 84;
  double y = 20;
  std::string title = figure.title;
  if (title.size() > most) {
    const std::size_t at = title.rfind(' ', most);
    const std::size_t cut = at == std::string::npos ? title.size() : at;
    add_text(root, 14, y, title.substr(0, cut),
             {{"class", "title"}, {"font-weight", "bold"}, {"font-size", "13"}});
    title = cut < title.size() ? title.substr(cut + 1) : "";
    y += 17;
  }
  add_text(root, 14, y, title, {{"class", "title"}, {"font-weight", "bold"}, {"font-size", "13"}});
  if (!figure.paper.empty()) {
    y += 17;
    add_text(root, 14, y, "paper: " + figure.paper, {{"class", "soft title"}, {"fill", "#4d5a67"}});
  }
  y = draw_legend(root, picture.legend, y + 20);
  y -= 8;
  for (const Panel& panel : picture.panels) {
    if (!panel.title.empty()) {
      y += 14;
      add_text(root, kLeft, y, panel.title, {{"class", "soft"}, {"fill", "#4d5a67"}});
      y += 6;
    }
    draw_panel(root, panel, y);
    y += panel.height + (panel.x.label.empty() ? 24 : 44);
  }
  if (picture.panels.empty()) add_text(root, 14, y + 14, "There is nothing to draw.");
  const double height = picture.panels.empty() ? y + 30 : y - 4;
  root.prepend_attribute("viewBox") = fmt::format("0 0 {} {}", px(kWidth), px(height)).c_str();
  root.append_attribute("width") = px(kWidth).c_str();
  root.append_attribute("height") = px(height).c_str();
  std::ostringstream text;
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
  return text.str() + "\n";
}

// ---- Curves

using Point = std::array<double, 2>;

// Leaves out points that the line through their neighbours meets closely enough.
std::vector<Point> simplified(const std::vector<Point>& points) {
  if (points.size() < 3) return points;
  std::vector<Point> kept = {points.front()};
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

struct Curve {
  Values x, y;
  std::string colour;
  double width = 1.9, opacity = 1;
  std::string dash = "none";
  bool sparse = false;  ///< has fewer points than the angles: they are joined
};

struct Band {
  Values x, low, high;
  std::string colour;
};

// Between two neighbours of a curve over angles nothing is drawn where one was not computed.
void draw_curve(pugi::xml_node root, const Scale& x, const Scale& y, const Curve& curve) {
  std::vector<std::vector<Point>> pieces(1);
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

void draw_band(pugi::xml_node root, const Scale& x, const Scale& y, const Band& band) {
  std::vector<Point> low, high;
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

// Symbols, as in the legend.
void draw_mark(pugi::xml_node root, std::size_t which, double x, double y,
               const std::string& colour, const std::string& note) {
  const Attributes looks = {{"fill", colour}, {"stroke", "#fff"}, {"class", "mark"}};
  pugi::xml_node node;
  if (which % 5 == 0) {
    node = add(root, "circle", {{"cx", px(x)}, {"cy", px(y)}, {"r", "4"}});
  } else {
    const std::string at = fmt::format("M{} {}", px(x), px(y));
    const std::array<std::string, 4> paths = {at + "m-4 -4h8v8h-8z", at + "m0 -5l4.8 8.2h-9.6z",
                                              at + "m0 -5.5l5.5 5.5l-5.5 5.5l-5.5 -5.5z",
                                              at + "m0 5l4.8 -8.2h-9.6z"};
    node = add(root, "path", {{"d", paths[which % 5 - 1]}});
  }
  for (const auto& [key, value] : looks) node.append_attribute(key) = value.c_str();
  if (!note.empty()) node.append_child("title").text() = note.c_str();
}

// The panel of curves over one axis, as large as they.
Panel curve_panel(const Axis& x, const Axis& y, double height, std::vector<Curve> curves,
                  std::vector<Band> bands = {}) {
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

// A turn is drawn whole, though its last step is missing.
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
    const bool alone = std::count_if(columns.begin(), columns.end(), any) < 2;
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
  picture.panels.push_back(curve_panel(axis, {"value", figure.unit}, three ? 135 : 185,
                                       std::move(lines), std::move(bands)));
  if (!curves.marks.empty()) add_marks(picture.panels.back(), curves.marks);
  const bool exact = std::all_of(differences.begin(), differences.end(), [](const Curve& curve) {
    return std::all_of(curve.y.begin(), curve.y.end(), [](double v) { return !(v < 0 || v > 0); });
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

Picture picture_of(const PistonBars& figure, const Curves& page) {
  Picture picture;
  Range all;
  all.include(0);
  std::vector<const Curves::Table*> tables;
  for (const auto& table : page.tables) {
    bool computed = false;
    for (const std::string& channel : figure.channels)
      if (const Values* values = find(table.columns, channel); any(values)) {
        all.include(*values);
        computed = true;
      }
    if (computed) tables.push_back(&table);
  }
  if (tables.empty() || page.theta_deg.empty()) return picture;
  const auto look = [](std::size_t table) {
    return Attributes{{"fill", table == 0 ? "#0072b2" : "#fff"},
                      {"stroke", "#0072b2"},
                      {"stroke-width", "1.4"},
                      {"stroke-dasharray", table == 0 ? "none" : "5 3"}};
  };
  picture.legend.emplace_back();
  for (std::size_t t = 0; t < tables.size(); ++t)
    picture.legend[0].push_back(
        {tables[t]->name, [=](pugi::xml_node root, double x, double y) {
           Attributes box = look(t);
           box.insert(box.end(),
                      {{"x", px(x)}, {"y", px(y - 5)}, {"width", "28"}, {"height", "10"}});
           add(root, "rect", box);
         }});
  const double n = static_cast<double>(figure.channels.size());
  for (const double angle : figure.angles) {
    std::size_t row = 0;
    for (std::size_t i = 0; i < page.theta_deg.size(); ++i)
      if (std::abs(page.theta_deg[i] - angle) < std::abs(page.theta_deg[row] - angle)) row = i;
    Panel panel{{"piston"}, {"share", figure.unit}, 125, {0, n}, all};
    panel.title = fmt::format("At {:g} deg", page.theta_deg[row]);
    const std::size_t every = 1 + figure.channels.size() / 25;
    for (std::size_t i = 0; i < figure.channels.size(); i += every)
      panel.x_ticks.push_back({static_cast<double>(i) + 0.5, fmt::format("{}", i + 1)});
    panel.draw = [=, channels = figure.channels](pugi::xml_node root, const Scale& x,
                                                 const Scale& y) {
      const double slot = (x.place(1) - x.place(0)),
                   bar = 0.72 * slot / static_cast<double>(tables.size());
      for (std::size_t i = 0; i < channels.size(); ++i)
        for (std::size_t t = 0; t < tables.size(); ++t) {
          const Values* values = find(tables[t]->columns, channels[i]);
          if (values == nullptr || !is_computed((*values)[row])) continue;
          Attributes box = look(t);
          const double v = (*values)[row];
          box.insert(box.end(), {{"x", px(x.place(static_cast<double>(i)) + 0.14 * slot +
                                          static_cast<double>(t) * bar + 1)},
                                 {"y", px(y.place(std::max(v, 0.0)))},
                                 {"width", px(std::max(1.0, bar - 2))},
                                 {"height", px(std::abs(y.place(v) - y.place(0)))}});
          add(root, "rect", box);
        }
    };
    picture.panels.push_back(std::move(panel));
  }
  return picture;
}

Picture picture_of(const OwnFigure& figure, const Curves&) {
  Picture picture;
  std::vector<Curve> lines;
  Keys keys;
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    if (!any(&figure.series[i].values)) continue;
    lines.push_back({figure.x, figure.series[i].values, pick(kColours, i)});
    keys.push_back(line_key(figure.series[i].label, pick(kColours, i), 4));
  }
  if (lines.empty()) return picture;
  picture.legend = {keys};
  picture.panels.push_back(
      curve_panel({figure.axis}, {"value", figure.unit}, 230, std::move(lines)));
  if (figure.angle) whole_turns(picture.panels[0], figure.x);
  return picture;
}

Picture picture_of(const XyFigure& figure, const Curves&) {
  Picture picture;
  std::vector<Curve> lines;
  Keys keys;
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    const XySeries& series = figure.series[i];
    lines.push_back(
        {series.x, series.y, pick(kColours, i), 1.9, 1, pick(kDashes, i / kColours.size())});
    keys.push_back(line_key(series.label, pick(kColours, i), 3, lines.back().dash));
  }
  picture.legend = {keys};
  picture.panels.push_back(curve_panel(figure.x, figure.y, 250, lines));
  Panel& panel = picture.panels.back();
  panel.draw = [=, names = figure.series, curves = panel.draw](pugi::xml_node root, const Scale& x,
                                                               const Scale& y) {
    curves(root, x, y);
    for (std::size_t s = 0; s < lines.size(); ++s) {
      const Curve& line = lines[s];
      for (std::size_t i = 0; line.x.size() <= 60 && i < line.x.size(); ++i)
        if (x.shows(line.x[i]) && y.shows(line.y[i]))
          draw_mark(root, 0, x.place(line.x[i]), y.place(line.y[i]), line.colour,
                    fmt::format("{}: {} at {}", names[s].label, short_number(line.y[i]),
                                short_number(line.x[i])));
    }
  };
  return picture;
}

Picture picture_of(const ScatterFigure& figure, const Curves&) {
  struct Shown {
    ScatterSeries series;
    std::size_t style;
    std::string colour;
  };
  const auto usable = [](const Axis& axis, double v) {
    return std::isfinite(v) && (!axis.log || v > 0);
  };
  std::vector<Shown> all;
  Panel panel{figure.x, figure.y, 330, {}, {}};
  panel.x_margin = panel.y_margin = Margin::decades;
  std::size_t next = 0;
  for (ScatterSeries series : figure.series) {
    std::erase_if(series.points, [&](const ScatterPoint& p) {
      return !usable(figure.x, p.x) || !usable(figure.y, p.y);
    });
    if (series.points.empty()) continue;
    for (const ScatterPoint& p : series.points) {
      panel.xs.include(p.x);
      panel.ys.include(p.y);
    }
    const std::size_t style = series.emphasis ? 0
                              : series.style  ? static_cast<std::size_t>(*series.style)
                                              : next++;
    all.push_back({series, style, series.emphasis ? "#67727e" : pick(kColours, style)});
  }
  Picture picture;
  if (all.empty()) return picture;
  picture.legend.emplace_back();
  for (const Shown& shown : all)
    picture.legend[0].push_back({shown.series.name, [=](pugi::xml_node root, double x, double y) {
                                   if (shown.series.line)
                                     line_key("", shown.colour, shown.series.emphasis ? 6 : 1.5,
                                              "none", shown.series.emphasis ? 0.35 : 1)
                                         .draw(root, x, y);
                                   if (!shown.series.emphasis)
                                     draw_mark(root, shown.style, x + 15, y, shown.colour, "");
                                 }});
  // What is emphasised lies broad and pale under the rest.
  std::stable_sort(all.begin(), all.end(), [](const Shown& a, const Shown& b) {
    return a.series.emphasis > b.series.emphasis;
  });
  panel.draw = [all, x_name = figure.x.label, y_name = figure.y.label](
                   pugi::xml_node root, const Scale& x, const Scale& y) {
    for (const Shown& shown : all) {
      Curve line{{},
                 {},
                 shown.colour,
                 shown.series.emphasis ? 8.0 : 1.3,
                 shown.series.emphasis ? 0.35 : 1};
      for (const ScatterPoint& p : shown.series.points) {
        line.x.push_back(p.x);
        line.y.push_back(p.y);
      }
      if (shown.series.line && line.x.size() > 1) draw_curve(root, x, y, line);
      if (shown.series.emphasis) continue;
      for (const ScatterPoint& p : shown.series.points)
        draw_mark(root, shown.style, x.place(p.x), y.place(p.y), shown.colour,
                  fmt::format("{}{}{} {}, {} {}", p.note, p.note.empty() ? "" : ", ", x_name,
                              short_number(p.x), y_name, short_number(p.y)));
    }
  };
  picture.panels.push_back(std::move(panel));
  return picture;
}

// ---- Maps

using Shades = std::array<std::array<double, 3>, 5>;

// Between the shades by t in [0, 1].
std::string between(const Shades& shades, double t) {
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(shades.size() - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(at), shades.size() - 2);
  std::array<int, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<int>(std::lround(shades[k][i] + (at - static_cast<double>(k)) *
                                                             (shades[k + 1][i] - shades[k][i])));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

// Light to dark: the order of the values survives a print without colour.
std::string shade(double t) {
  return between({{{247, 250, 252}, {190, 214, 235}, {107, 164, 207}, {33, 103, 166}, {8, 40, 88}}},
                 t);
}

// Dark to light, for lines: seen on white and on a dark ground.
std::string line_shade(double t) {
  return between({{{122, 40, 176}, {170, 35, 149}, {204, 71, 120}, {230, 108, 92}, {248, 149, 64}}},
                 t);
}

// Pieces of the line z = level over a grid, by marching squares, in pixels. Where a corner has no
// value there is no line.
std::vector<std::array<Point, 2>> contour(const Values& xs, const Values& ys,
                                          const std::vector<Values>& z, double level) {
  std::vector<std::array<Point, 2>> pieces;
  for (std::size_t i = 0; i + 1 < ys.size(); ++i)
    for (std::size_t j = 0; j + 1 < xs.size(); ++j) {
      const std::array<std::array<std::size_t, 2>, 4> corners = {
          {{j, i}, {j + 1, i}, {j + 1, i + 1}, {j, i + 1}}};
      if (std::any_of(corners.begin(), corners.end(),
                      [&](const auto& c) { return !is_computed(z[c[1]][c[0]]); }))
        continue;
      std::vector<Point> cuts;
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

Key shade_key(const std::string& label, const std::string& colour) {
  return {label, [=](pugi::xml_node root, double x, double y) {
            add(root, "rect",
                {{"x", px(x)},
                 {"y", px(y - 6)},
                 {"width", "30"},
                 {"height", "12"},
                 {"stroke", "#67727e"},
                 {"stroke-width", "0.6"},
                 {"fill", colour}});
          }};
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
  if (std::any_of(figure.reasons.begin(), figure.reasons.end(), [](const auto& row) {
        return std::any_of(row.begin(), row.end(),
                           [](const auto& reason) { return !reason.empty(); });
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
    std::vector<Point> labelled;
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
      const Point& at = pieces[pieces.size() / 2][0];
      // Where lines crowd not every one has room for its value.
      const bool room = std::none_of(labelled.begin(), labelled.end(), [&](const Point& other) {
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
          const auto row = std::upper_bound(y_edges.begin(), y_edges.end(), line.y[k]);
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
    for (const MapFigure::Point& p : figure.points) {
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

// The frame that is shown; a length is as long across as up.
Picture picture_of(const DrawingFigure& figure, const Curves&) {
  Picture picture;
  if (figure.frames.empty()) return picture;
  const DrawingFigure::Frame& frame =
      figure.frames[std::min(figure.shown, figure.frames.size() - 1)];
  picture.legend.resize(2);
  picture.legend[0].push_back(
      {fmt::format("At {:g} deg{}{}", frame.theta_deg, frame.text.empty() ? "" : ": ", frame.text),
       [](pugi::xml_node, double, double) {}});
  for (const DrawingFigure::Look& look : figure.looks)
    picture.legend[1].push_back(line_key(
        look.label, pick(kColours, static_cast<std::size_t>(look.colour)), look.filled ? 6 : 2.5));
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const DrawingFigure::Panel& from = figure.panels[p];
    const double scale = (kRight - kLeft) / (from.x_high - from.x_low);
    Panel panel{from.x,
                from.y,
                scale * (from.y_high - from.y_low),
                {from.x_low, from.x_high},
                {from.y_low, from.y_high}};
    panel.y_margin = Margin::none;
    panel.draw = [=, looks = figure.looks](pugi::xml_node root, const Scale& x, const Scale& y) {
      const auto colour = [&](int look) {
        return std::string(
            pick(kColours, static_cast<std::size_t>(looks[static_cast<std::size_t>(look)].colour)));
      };
      for (const DrawingFigure::Line& line : frame.lines) {
        if (line.panel != static_cast<int>(p)) continue;
        std::string path;
        for (std::size_t i = 0; i < line.x.size(); ++i)
          if (std::isfinite(line.x[i]) && std::isfinite(line.y[i]))
            path += fmt::format("{}{} {}", path.empty() ? "M" : "L",
                                px(std::clamp(x.place(line.x[i]), kLeft, kRight)),
                                px(std::clamp(y.place(line.y[i]), y.last, y.first)));
        const bool filled = looks[static_cast<std::size_t>(line.look)].filled;
        add(root, "path",
            {{"d", path},
             {"fill", filled ? colour(line.look) : "none"},
             {"fill-opacity", filled ? "0.18" : "0"},
             {"stroke", colour(line.look)},
             {"stroke-width", px(line.width)}});
      }
      for (const DrawingFigure::Arrow& arrow : frame.arrows) {
        const double length = std::hypot(arrow.dx, arrow.dy);
        if (arrow.panel != static_cast<int>(p) || !(length > 0)) continue;
        const double x1 = x.place(arrow.x), y1 = y.place(arrow.y);
        const double x2 = x.place(arrow.x + arrow.dx), y2 = y.place(arrow.y + arrow.dy);
        const double ux = (x2 - x1) / std::hypot(x2 - x1, y2 - y1);
        const double uy = (y2 - y1) / std::hypot(x2 - x1, y2 - y1);
        add_line(root, x1, y1, x2, y2, {{"stroke", colour(arrow.look)}, {"stroke-width", "2.2"}});
        add(root, "path",
            {{"d", fmt::format("M{} {}L{} {}L{} {}Z", px(x2 + 3 * ux), px(y2 + 3 * uy),
                               px(x2 - 7 * ux - 4 * uy), px(y2 - 7 * uy + 4 * ux),
                               px(x2 - 7 * ux + 4 * uy), px(y2 - 7 * uy - 4 * ux))},
             {"fill", colour(arrow.look)}});
      }
    };
    picture.panels.push_back(std::move(panel));
  }
  return picture;
}

// ---- Bars, bands, parallel axes

std::string cut(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most - 2;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // of a letter
  return text.substr(0, end) + "..";
}

Picture picture_of(const BarsFigure& figure, const Curves&) {
  constexpr std::size_t kMostLetters = 42;
  constexpr double kRow = 24, kBar = 15;  // px
  Picture picture;
  const double n = static_cast<double>(figure.bars.size());
  if (figure.bars.empty()) return picture;
  Axis axis = figure.x;
  axis.log = false;
  Panel panel{axis, {}, kRow * n, {0, 0}, {0, n}};
  panel.y_margin = Margin::none;
  std::size_t letters = 4;
  for (std::size_t i = 0; i < figure.bars.size(); ++i) {
    const BarsFigure::Bar& bar = figure.bars[i];
    const std::string label = cut(bar.label, kMostLetters);
    letters = std::max(letters, label.size());
    panel.y_ticks.push_back({n - 0.5 - static_cast<double>(i), label});
    for (const double end : {bar.low, bar.high}) panel.xs.include(end);
    if (bar.interval)
      for (const double end : {bar.interval->first, bar.interval->second}) panel.xs.include(end);
  }
  panel.left = 20 + kLetter * static_cast<double>(letters);
  // Room for the number beside the longest bar.
  const double more = 0.12 * (panel.xs.high - panel.xs.low);
  if (panel.xs.low < 0) panel.xs.low -= more;
  if (panel.xs.high > 0) panel.xs.high += more;
  panel.draw = [bars = figure.bars, unit = figure.x.unit, ticks = panel.y_ticks](
                   pugi::xml_node root, const Scale& x, const Scale& y) {
    for (std::size_t i = 0; i < bars.size(); ++i) {
      const BarsFigure::Bar& bar = bars[i];
      const double middle = y.place(ticks[i].value);
      const auto number = [&](double at, double value, const char* anchor) {
        add_text(root, at, middle + 4, short_number(value),
                 {{"text-anchor", anchor}, {"font-size", "11"}});
      };
      Range drawn{0, 0};
      for (const double end : {bar.low, bar.high}) {
        if (!std::isfinite(end) || end == 0) continue;
        drawn.include(end);
        const double from = x.place(std::min(end, 0.0)), to = x.place(std::max(end, 0.0));
        pugi::xml_node box = add(root, "rect",
                                 {{"class", "bar"},
                                  {"x", fmt::format("{:.2f}", from)},
                                  {"y", px(middle - kBar / 2)},
                                  {"width", fmt::format("{:.2f}", to - from)},
                                  {"height", px(kBar)},
                                  {"fill", end < 0 ? kColours[1] : kColours[0]}});
        box.append_child("title").text() =
            fmt::format("{}: {}{}{}", bar.label, with_unit(short_number(end), unit),
                        bar.note.empty() ? "" : "; ", bar.note)
                .c_str();
      }
      const Range ends = drawn;
      if (bar.interval && std::isfinite(bar.interval->first) &&
          std::isfinite(bar.interval->second)) {
        const double from = x.place(bar.interval->first), to = x.place(bar.interval->second);
        const Attributes looks = {{"class", "interval"}, {"stroke", "#000000"}};
        add_line(root, from, middle, to, middle, looks);
        for (const double end : {from, to}) add_line(root, end, middle - 4, end, middle + 4, looks);
        drawn.include(bar.interval->first);
        drawn.include(bar.interval->second);
      }
      const double right = x.place(drawn.high) + 5;
      if (ends.low < 0) number(x.place(drawn.low) - 5, ends.low, "end");
      if (!std::isfinite(bar.low) || !std::isfinite(bar.high))
        add_text(root, right, middle + 4, "not computed", {{"font-size", "11"}});
      else if (ends.high > 0 || ends.low == 0)
        number(right, ends.high, "start");
    }
    add_line(root, x.place(0), y.first, x.place(0), y.last,
             {{"stroke", "#67727e"}, {"class", "zero"}});
  };
  picture.panels.push_back(std::move(panel));
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

struct PlacedName {
  double x;         // of its middle, px
  std::size_t row;  // the first in which it has room
};

// Of names that stand evenly between the ends of the axis.
std::vector<PlacedName> placed(const std::vector<std::string>& names) {
  std::vector<PlacedName> places;
  std::vector<double> ends;  // of the rows, px
  for (std::size_t k = 0; k < names.size(); ++k) {
    const double half = kLetter * static_cast<double>(names[k].size()) / 2;
    const double x =
        kLeft + (kRight - kLeft) * static_cast<double>(k) / static_cast<double>(names.size() - 1);
    const double at = std::clamp(x, 6 + half, std::max(6 + half, kWidth - 4 - half));
    std::size_t row = 0;
    while (row < ends.size() && ends[row] > at - half - 8) ++row;
    if (row == ends.size()) ends.push_back(0);
    ends[row] = at + half;
    places.push_back({at, row});
  }
  return places;
}

Picture picture_of(const ParallelFigure& figure, const Curves&) {
  constexpr double kHeight = 300, kNameRow = 15;  // px
  Picture picture;
  const std::size_t count = figure.columns.size();
  if (count < 2) return picture;
  std::vector<Range> ranges(count);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& column = figure.columns[k];
    for (const double value : column.values)
      if (!column.log || value > 0) ranges[k].include(value);
    if (!column.words.empty())
      ranges[k] = {0, std::max(1.0, static_cast<double>(column.words.size()) - 1)};
    names.push_back(cut(name_of({column.label, column.unit}), 40));
  }
  if (std::all_of(ranges.begin(), ranges.end(), [](const Range& r) { return r.empty(); }))
    return picture;
  const auto scale = [&columns = figure.columns, ranges](std::size_t k, double first, double last) {
    const auto& column = columns[k];
    Scale made =
        scale_of({column.label, column.unit, column.log}, ranges[k], first, last, Margin::none);
    if (column.words.empty()) return made;
    made.ticks.clear();
    for (std::size_t w = 0; w < column.words.size(); ++w)
      made.ticks.push_back({static_cast<double>(w), column.words[w]});
    return made;
  };
  // Colours by the place on the axis of one column, in five steps named in the legend.
  const std::size_t by = std::min(figure.colour_by, count - 1);
  const Scale colours = scale(by, 0, 1);
  picture.legend.resize(2);
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double value = colours.log ? colours.low * std::pow(colours.high / colours.low, t)
                                     : colours.low + t * (colours.high - colours.low);
    picture.legend[0].push_back(
        line_key(with_unit(short_number(value), figure.columns[by].unit), line_shade(t), 3));
  }
  picture.legend[0][0].label = figure.columns[by].label + ": " + picture.legend[0][0].label;
  if (!figure.marked.empty())
    picture.legend[1].push_back(line_key(figure.marked_label, "#000000", 2));
  const std::vector<PlacedName> places = placed(names);
  std::size_t rows = 0;
  for (const PlacedName& place : places) rows = std::max(rows, place.row + 1);
  Panel panel{{},
              {},
              kHeight + kNameRow * static_cast<double>(rows),
              {0, static_cast<double>(count - 1)},
              {0, 1}};
  panel.bare = true;
  panel.y_margin = Margin::none;
  panel.draw = [=, columns = figure.columns, marked = figure.marked](
                   pugi::xml_node root, const Scale& x, const Scale& y) {
    const double top = y.last + 8, bottom = top + kHeight - 8;
    std::vector<Scale> axes;
    for (std::size_t k = 0; k < count; ++k) axes.push_back(scale(k, bottom, top));
    const auto draw = [&](std::size_t design, const std::string& colour, double width,
                          const char* opacity) {
      std::string path, note;
      bool joined = false;
      for (std::size_t k = 0; k < count; ++k) {
        const double value = columns[k].values[design];
        const bool shown = axes[k].shows(value);
        if (shown)
          path += fmt::format("{}{} {}", joined ? "L" : "M", px(x.place(static_cast<double>(k))),
                              px(axes[k].place(value)));
        joined = shown;
        const bool named = shown && !columns[k].words.empty();
        note += fmt::format("{}{} {}", note.empty() ? "" : ", ", columns[k].label,
                            named ? columns[k].words.at(static_cast<std::size_t>(value))
                            : is_computed(value) ? with_unit(short_number(value), columns[k].unit)
                                                 : "not computed");
      }
      if (path.empty()) return;
      pugi::xml_node node = add(root, "path",
                                {{"class", "design"},
                                 {"d", path},
                                 {"fill", "none"},
                                 {"stroke", colour},
                                 {"stroke-width", px(width)},
                                 {"stroke-linejoin", "round"},
                                 {"opacity", opacity}});
      node.append_child("title").text() = note.c_str();
    };
    for (std::size_t design = 0; design < columns[by].values.size(); ++design) {
      const double value = columns[by].values[design];
      draw(design, colours.shows(value) ? line_shade(colours.place(value)) : "#98a4af", 1.2, "0.6");
    }
    for (const std::size_t design : marked) draw(design, "#000000", 2, "1");
    for (std::size_t k = 0; k < count; ++k) {
      const double at = x.place(static_cast<double>(k));
      add_line(root, at, top, at, bottom, {{"stroke", "#67727e"}, {"class", "zero"}});
      for (const Tick& tick : axes[k].ticks)
        add_text(root, at - 5, axes[k].place(tick.value) + 4, tick.label,
                 {{"text-anchor", "end"},
                  {"font-size", "11"},
                  {"class", "mark"},
                  {"stroke", "#fff"},
                  {"stroke-width", "3"},
                  {"paint-order", "stroke"}});
    }
    for (std::size_t k = 0; k < count; ++k)
      add_text(root, places[k].x, bottom + 20 + kNameRow * static_cast<double>(places[k].row),
               names[k], kMiddle);
  };
  picture.panels.push_back(std::move(panel));
  return picture;
}

}  // namespace

std::string markup_of(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) < 0x20)
      out += ' ';
    else
      out += c;
  }
  return out;
}

std::string svg_of(const Figure& figure, const Curves& curves) {
  return drawn(figure, std::visit([&](const auto& content) { return picture_of(content, curves); },
                                  figure.content));
}

}  // namespace bentaxis::report
