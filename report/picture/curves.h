// Lines and bands over an axis.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "picture/panels.h"

namespace bentaxis::report::picture {

using Pixel = std::array<double, 2>;

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
  double opacity = 0.18;
};

/// Between two neighbours of a curve over angles nothing is drawn where one was not computed. What
/// lies beyond the ends of an axis is cut off; a triangle at the end says where values go on.
void draw_curve(pugi::xml_node root, const Scale& x, const Scale& y, const Curve& curve);

/// The panel of curves over one axis, as large as they.
Panel curve_panel(const Axis& x, const Axis& y, double height, std::vector<Curve> curves,
                  std::vector<Band> bands = {});
/// A turn is drawn whole, though its last step is missing.
void whole_turns(Panel& panel, const Values& theta);

bool any_drawn(const std::vector<Curve>& curves);
/// Whether one of them was computed.
bool any(const Values* values);

}  // namespace bentaxis::report::picture
