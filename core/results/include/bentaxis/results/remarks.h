// What a study has to say beside its numbers: short lists of facts, warnings, assumptions, timing.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bentaxis {

/// Names and values of a short list of facts, in the order in which they are shown.
using Lines = std::vector<std::pair<std::string, std::string>>;

struct Warning {
  std::string name, text;
};

struct AssumptionRow {
  std::string name, first, second;  ///< the assumption, its value in either model
};

/// What the timing of the ports does, against its limit.
struct TimingRow {
  std::string code, quantity;
  double value = 0;
  std::string unit;
  std::optional<double> limit = std::nullopt;
  bool flagged = false;                                ///< exceeds the limit
  std::optional<double> theta_deg = std::nullopt;      ///< chamber angle of the value
  std::vector<std::pair<double, double>> angles = {};  ///< intervals of chamber angles it is about
  std::string meant = {};  ///< why it is intended, where the case says so, or ""
  std::string text = {};
  std::string bound = {};  ///< "> 12000": what is known of a value that was not found
};

}  // namespace bentaxis
