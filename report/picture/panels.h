// A picture: title, legend, panels below each other.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "picture/axes.h"
#include "picture/elements.h"

namespace bentaxis::report::picture {

struct Panel {
  Axis x, y;
  double height;
  Range xs = {}, ys = {};
  bool angle = false;
  Margin x_margin = Margin::none, y_margin = Margin::some;
  std::function<void(pugi::xml_node, const Scale&, const Scale&)> draw = {};
  std::string title = {};
  std::vector<Tick> x_ticks = {}, y_ticks = {};  ///< instead of numbers
  double left = kLeft;                           ///< px, where x begins
  bool bare = false;                             ///< draws its axes itself
  /// A second axis of values, on the right.
  struct Right {
    Axis axis;
    Range range;
    std::function<void(pugi::xml_node, const Scale&, const Scale&)> draw;
  };
  std::optional<Right> right = std::nullopt;
};

// A piece of line, a filled box or a mark, with a text.
struct Key {
  std::string label;
  std::function<void(pugi::xml_node, double x, double y)> draw;  ///< 30 px to the right of x
};
using Keys = std::vector<Key>;

Key line_key(const std::string& label, const std::string& colour, double width,
             const std::string& dash = "none", double opacity = 1);
/// A filled box.
Key shade_key(const std::string& label, const std::string& colour);
/// Five keys from one end of a scale to the other, behind the name of what is shown.
/// @param key  of a place in [0, 1]
Keys scale_keys(const std::string& name, const std::function<Key(double)>& key);

struct Picture {
  std::vector<Keys> legend;  ///< rows, broken where they are too long
  std::vector<Panel> panels;
};

/// As the text of an SVG file.
std::string drawn(const Figure& figure, const Picture& picture);

}  // namespace bentaxis::report::picture
