// Published numbers that a run is set against: windows of channels, read from a file.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/operating_points.h"

namespace bentaxis::cli {

/// One published number or window.
struct PublishedRow {
  std::string quantity;  ///< in words
  std::string channel;   ///< column of the result table
  enum class Statistic {
    range,      ///< all values of the turn lie in the window
    mean,       ///< the mean over the turn does
    magnitude,  ///< the largest magnitude does
    at          ///< the value at an angle does
  } statistic = Statistic::range;
  double theta_deg = 0;
  double low = 0, high = 0;  ///< channel's unit; infinite where open
  std::string paper;         ///< as printed
  std::string status;        ///< "used to infer", "calibrated" or "predicted"
  std::string where;
  bool piston_friction = true;  ///< false: with it switched off
  bool block_viscous = true;    ///< false: with Cc = 0
  bool find_pressure = false;   ///< also find the delivery pressure at which `low` is reached
};

/// Reads a file of published numbers (TOML, tables [[row]]; docs/command_line.md).
/// @throws InputError naming file and line
std::vector<PublishedRow> read_published(const std::string& file);

/// The statistic of one table. @throws InputError if the table lacks the channel
struct Measured {
  double low = 0, high = 0;  ///< equal but for a range
  bool inside(const PublishedRow& row) const { return low >= row.low && high <= row.high; }
};
Measured measure(const PublishedRow& row, const ResultTable& table);

/// What both models say of the rows, for the report and in words.
struct Verdicts {
  report::PublishedTable table;
  std::vector<std::string> lines;
  bool inside = true;  ///< every row, by both
};
Verdicts set_against(const std::vector<PublishedRow>& rows, const study::OperatingPoint& point);

/// "-10235 .. -9376" or one number, as JSON.
nlohmann::json shown(const Measured& measured);

}  // namespace bentaxis::cli
