// Axes of a picture: from values to pixels, with ticks, and numbers as text.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/report/document.h"

namespace bentaxis::report::picture {

/// Three digits, as far as they say something.
std::string short_number(double value);
std::string with_unit(const std::string& text, const std::string& unit);
std::string name_of(const Axis& axis);
/// Its beginning, with two dots, where it has more than `most` bytes.
std::string cut(const std::string& text, std::size_t most);

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

enum class Margin { none, some, decades };

/// @param axis   label, unit; `from` and `to`, where its ends stand
/// @param range  of the values it is to show
/// @param first  px, of its low end
/// @param last   px, of its high end
Scale scale_of(const Axis& axis, Range range, double first, double last, Margin margin,
               bool angle = false);

}  // namespace bentaxis::report::picture
