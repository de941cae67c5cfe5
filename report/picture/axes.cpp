#include "picture/axes.h"

#include <fmt/format.h>

#include <algorithm>

#include "bentaxis/pump/text.h"

namespace bentaxis::report::picture {
namespace {

// Without zeros at the end of its decimals.
std::string shortest(std::string number) {
  if (number.find('.') == std::string::npos) return number;
  number.resize(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number;
}

std::string scientific(double value, int digits) {
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);
  const auto e = text.find('e');
  return fmt::format("{}e{}", shortest(text.substr(0, e)), std::stoi(text.substr(e + 1)));
}

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

// What differs by less over its size is drawn as one value: no ticks lie between.
constexpr double kSmallestSpan = 1e-12;

}  // namespace

std::string short_number(double value) {
  if (!std::isfinite(value)) return "not finite";
  const double size = std::abs(value);
  if (value != 0 && (size < 1e-3 || size >= 1e6)) return scientific(value, 3);
  const int digit = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(size)));
  return shortest(fmt::format("{:.{}f}", value, std::max(0, 2 - digit)));
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return text + unit_after(unit);
}
std::string name_of(const Axis& axis) {
  return axis.unit.empty() ? axis.label : fmt::format("{} ({})", axis.label, axis.unit);
}

std::string cut(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most - 2;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // of a letter
  return text.substr(0, end) + "..";
}

Scale scale_of(const Axis& axis, Range range, double first, double last, Margin margin,
               bool angle) {
  if (axis.log && !range.empty())
    range = {std::max(range.low, 1e-290), std::max(range.high, 1e-290)};
  if (range.empty()) range = axis.log ? Range{0.1, 1} : Range{0, 1};
  if (axis.from) range.low = *axis.from;
  if (axis.to) range.high = *axis.to;
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
    range = {axis.from ? range.low : range.low - more, axis.to ? range.high : range.high + more};
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

}  // namespace bentaxis::report::picture
