#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "picture/figures.h"

namespace bentaxis::report::picture {

namespace {
constexpr double kShortArrow = 18;       // px
constexpr std::size_t kMaxLetters = 96;  // of a line

// What stands over a frame: where it is and its text, in pieces where that is long.
std::vector<std::string> said_of(const DrawingFigure& figure, const DrawingFigure::Frame& frame) {
  std::vector<std::string> pieces = {figure.axis.empty()
                                         ? fmt::format("At {:g} deg", frame.theta_deg)
                                         : fmt::format("{} {:.6g}", figure.axis, frame.theta_deg)};
  if (frame.text.empty()) return pieces;
  if (pieces[0].size() + frame.text.size() < kMaxLetters) return {pieces[0] + ": " + frame.text};
  for (std::size_t from = 0; from < frame.text.size();) {
    const std::size_t end = std::min(frame.text.find(", ", from), frame.text.size());
    pieces.push_back(frame.text.substr(from, end - from));
    from = end + 2;
  }
  return pieces;
}

}  // namespace

// The frame that is shown; a length is as long across as up.
Picture picture_of(const DrawingFigure& figure, const Curves&) {
  Picture picture;
  if (figure.frames.empty()) return picture;
  const DrawingFigure::Frame& frame =
      figure.frames[std::min(figure.shown, figure.frames.size() - 1)];
  picture.legend.resize(2);
  for (const std::string& text : said_of(figure, frame))
    picture.legend[0].push_back({text, [](pugi::xml_node, double, double) {}});
  for (const DrawingFigure::Look& look : figure.looks)
    picture.legend[1].push_back(line_key(
        look.label, pick(kColours, static_cast<std::size_t>(look.colour)), look.filled ? 6 : 2.5));
  if (figure.shades)
    picture.legend.push_back(scale_keys(figure.shades->label, [&](double t) {
      const double value = figure.shades->low + t * (figure.shades->high - figure.shades->low);
      return shade_key(with_unit(short_number(value), figure.shades->unit), shade(t));
    }));
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const DrawingFigure::Panel& from = figure.panels[p];
    const double scale = (kRight - kLeft) / (from.x_high - from.x_low);
    Panel panel{from.x,
                from.y,
                scale * (from.y_high - from.y_low),
                {from.x_low, from.x_high},
                {from.y_low, from.y_high}};
    panel.y_margin = Margin::none;
    panel.draw = [=, looks = figure.looks, shades = figure.shades, ground = figure.ground](
                     pugi::xml_node root, const Scale& x, const Scale& y) {
      const auto colour = [&](int look) {
        return std::string(
            pick(kColours, static_cast<std::size_t>(looks[static_cast<std::size_t>(look)].colour)));
      };
      const auto draw = [&](const DrawingFigure::Line& line) {
        if (line.panel != static_cast<int>(p)) return;
        std::string path;
        for (std::size_t i = 0; i < line.x.size(); ++i)
          if (std::isfinite(line.x[i]) && std::isfinite(line.y[i]))
            path += fmt::format("{}{} {}", path.empty() ? "M" : "L",
                                px(std::clamp(x.place(line.x[i]), kLeft, kRight)),
                                px(std::clamp(y.place(line.y[i]), y.last, y.first)));
        const bool shaded = shades && line.value && std::isfinite(*line.value);
        const bool filled = looks[static_cast<std::size_t>(line.look)].filled;
        add(root, "path",
            {{"d", path},
             {"fill", shaded   ? shade((*line.value - shades->low) / (shades->high - shades->low))
                      : filled ? colour(line.look)
                               : "none"},
             {"fill-opacity", shaded   ? "1"
                              : filled ? "0.18"
                                       : "0"},
             {"stroke", colour(line.look)},
             {"stroke-width", px(line.width)}});
      };
      for (const DrawingFigure::Line& line : ground) draw(line);
      for (const DrawingFigure::Line& line : frame.lines) draw(line);
      for (const DrawingFigure::Arrow& arrow : frame.arrows) {
        if (arrow.panel != static_cast<int>(p)) continue;
        const double x1 = x.place(arrow.x), y1 = y.place(arrow.y);
        const double x2 = x.place(arrow.x + arrow.dx), y2 = y.place(arrow.y + arrow.dy);
        const double drawn_length = std::hypot(x2 - x1, y2 - y1);
        if (!(drawn_length >= 0.05)) continue;  // less than the digits of a place: round-off
        // The head of a short one is small too.
        const double size = std::min(1.0, drawn_length / kShortArrow);
        const double ux = size * (x2 - x1) / drawn_length, uy = size * (y2 - y1) / drawn_length;
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

}  // namespace bentaxis::report::picture
