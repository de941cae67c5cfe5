// Numbers at equal distances, as options and study files name them.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace bentaxis::study {

/// One number, FROM:TO:STEP, or `FROM:TO:#N` for N of them, both ends among them.
/// @param what   whose value it is, for messages: "--speeds"
/// @param unit   of the numbers, for messages
/// @param least  no number may be smaller; at most `most` values
/// @param also   further forms that the caller takes, for messages: "a list (0,100), "
/// @throws InputError naming `what`
std::vector<double> spaced_values(const std::string& what, const std::string& text,
                                  const std::string& unit, double least, int most,
                                  const std::string& also = {});
/// The same where any number is allowed.
inline std::vector<double> spaced_values(const std::string& what, const std::string& text,
                                         const std::string& unit, int most) {
  return spaced_values(what, text, unit, -std::numeric_limits<double>::infinity(), most);
}

}  // namespace bentaxis::study
