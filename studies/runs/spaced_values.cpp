#include "bentaxis/study/spaced_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::study {

std::vector<double> spaced_values(const std::string& what, const std::string& text,
                                  const std::string& unit, double least, int most,
                                  const std::string& also) {
  const auto fail = [&](const std::string& why) {
    throw InputError(what + " " + text + ": must " + why);
  };
  const std::string forms = "be " + also + "FROM:TO:STEP, FROM:TO:#N or one number" +
                            (unit.empty() ? "" : ", in " + unit) +
                            (std::isfinite(least) ? ", >= " + number_text(least) : "");
  std::vector<double> numbers;
  bool counted = false;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(':', at), text.size());
    if (numbers.size() == 2 && at < end && text[at] == '#') {
      counted = true;
      ++at;
    }
    const auto value = number_in(std::string_view(text).substr(at, end - at));
    if (!value || (numbers.size() < 2 && *value < least)) fail(forms);
    numbers.push_back(*value);
    at = end + 1;
  }
  if (numbers.size() == 1) return numbers;
  if (numbers.size() != 3) fail(forms);
  const double from = numbers[0], to = numbers[1];
  double count = numbers[2];
  if (counted) {
    if (!(count >= 1 && count == std::floor(count))) fail("have N an integer >= 1");
    if (count == 1 ? to != from : !(to > from)) fail("have FROM < TO, or FROM = TO with #1");
  } else {
    if (!(numbers[2] > 0) || to < from) fail("have STEP > 0 and FROM <= TO");
    count = std::floor((to - from) / numbers[2] + 1e-9) + 1;
  }
  if (count > most) fail("not be more than " + std::to_string(most) + " points");
  const double step = !counted ? numbers[2] : count > 1 ? (to - from) / (count - 1) : 0;
  std::vector<double> values;
  // Of 0.1 + 2 x 0.1 the 0.3 that is meant: digits beyond these are round-off of the sum.
  for (int i = 1; i <= static_cast<int>(count); ++i) {
    if (i == 1)
      values.push_back(from);
    else if (counted && i == static_cast<int>(count))
      values.push_back(to);
    else
      values.push_back(number_in(fmt::format("{:.15g}", from + (i - 1) * step)).value());
  }
  return values;
}

}  // namespace bentaxis::study
