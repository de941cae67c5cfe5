#include "bentaxis/pump/number.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace bentaxis {
namespace {

constexpr std::uint64_t kNotComputedBits = 0x7ff8'0000'0000'be57;

}  // namespace

double not_computed() {
  double value = 0;
  std::memcpy(&value, &kNotComputedBits, sizeof value);
  return value;
}

bool is_stray_nan(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return !is_computed(value) && bits != kNotComputedBits;
}

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

void append_number(std::string& text, double value) {
  if (!is_computed(value)) return;
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                    value == 0 ? 0.0 : value);  // no "-0"
  text.append(buffer.data(), result.ptr);
}

double rounded(double value, int digits) {
  const std::string text = rounded_text(value, digits);
  double result = value;
  std::from_chars(text.data(), text.data() + text.size(), result);
  return result;
}

std::string rounded_text(double value, int digits) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(),
                                    value == 0 ? 0.0 : value,  // no "-0"
                                    std::chars_format::general, digits);
  return {text.data(), result.ptr};
}

namespace {

// One unit of the third digit further where rounding went the wrong way.
std::string rounded_to(double value, double direction) {
  const double nearest = rounded(value, 3);
  if (!((nearest - value) * direction < 0)) return rounded_text(nearest);
  return rounded_text(nearest +
                      direction * std::pow(10, std::floor(std::log10(std::abs(value))) - 2));
}

}  // namespace

std::string rounded_down_text(double value) { return rounded_to(value, -1); }
std::string rounded_up_text(double value) { return rounded_to(value, 1); }

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

bool NumberRange::contains(double value) const {
  const auto beyond = [&](double bound) {
    return std::isfinite(bound) ? slack * std::abs(bound) : 0;
  };
  return std::isfinite(value) && (low_open ? value > low : value >= low - beyond(low)) &&
         (high_open ? value < high : value <= high + beyond(high));
}

std::string NumberRange::text() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (low == -kInfinity && high == kInfinity) return "a finite number";
  if (high == kInfinity) return (low_open ? "> " : ">= ") + number_text(low);
  return "in " + std::string(low_open ? "(" : "[") + number_text(low) + ", " + number_text(high) +
         (high_open ? ")" : "]");
}

std::string NumberRange::text_of(const std::string& kind) const {
  const std::string any = NumberRange{}.text();
  return text() == any ? any : kind + ", " + text();
}

}  // namespace bentaxis
