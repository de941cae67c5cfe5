// A table of results over the shaft angle, whoever computed it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/samples.h"

namespace bentaxis {

/// How a table came about, as lines for a report: bodies, equations, rank, times.
struct Provenance {
  std::vector<std::pair<std::string, std::string>> facts;
  double seconds = 0;  ///< wall-clock time of the run
};

/// Values of a table of very many rows, wherever they are (files/stored_values.h).
class StoredValues {
 public:
  static constexpr std::size_t kBlock = 1024;  ///< rows of a column that are read together

  StoredValues() = default;
  StoredValues(const StoredValues&) = delete;
  StoredValues& operator=(const StoredValues&) = delete;
  virtual ~StoredValues() = default;

  double at(std::size_t row, std::size_t column) const {
    return block(row / kBlock, column)[row % kBlock];
  }

 private:
  /// Until the next call in this thread.
  virtual const double* block(std::size_t number, std::size_t column) const = 0;
};

/// Values by row (shaft angle) and column (channel), in the channel's own unit.
struct ResultTable {
  std::string name;
  std::vector<Channel> channels;
  std::vector<double> theta_deg;
  /// Row-major, theta_deg.size() x channels.size(); empty where they are stored.
  std::vector<double> values;
  Provenance provenance;
  std::shared_ptr<const StoredValues> stored = {};

  /// Room for so many rows in all: appended one by one they then take no more than they need.
  void reserve_rows(std::size_t count) {
    theta_deg.reserve(count);
    values.reserve(count * columns());
  }
  std::size_t rows() const { return theta_deg.size(); }
  std::size_t columns() const { return channels.size(); }
  double at(std::size_t row, std::size_t column) const {
    return stored ? stored->at(row, column) : values[row * columns() + column];
  }
  /// Calls `use(theta_deg, values)` with every row, in the channels' order.
  void for_each_row(const std::function<void(double, const double*)>& use) const;
  /// Index of a column by name, or columns() where there is none.
  std::size_t find(const std::string& channel_name) const;
  /// Largest magnitude of the vectors of a group over the whole table; 0 where not computed.
  double peak(const std::string& group) const;
};

/// Reports a fraction done in [0, 1]; may throw Interrupted to stop the run.
using Progress = std::function<void(double)>;

/// Computes the row of an instant, SI, in the order of a ChannelLayout; what it leaves is marked as
/// not computed.
using EvaluateRow = std::function<void(const Instant&, std::vector<double>& row)>;

/// Takes a row in the channels' units.
using RowSink = std::function<void(double theta_deg, const std::vector<double>& row)>;

/// Fills a table: evaluates every sample, checks that every value is finite or marked as not
/// computed, and converts to the channels' units.
/// @throws ComputationError naming model, channel and angle where a value is not finite.
ResultTable tabulate(const std::string& name, const ChannelLayout& layout, const Samples& samples,
                     const EvaluateRow& evaluate, const Progress& progress = {});

/// The same row by row over one turn of a case, for turns of more samples than can be held.
void stream_rows(const std::string& name, const ChannelLayout& layout, const Case& the_case,
                 const PressureTrace& pressure, const EvaluateRow& evaluate, const RowSink& sink,
                 const Progress& progress = {});

/// The table with only those of its rows, whose values are in the memory.
ResultTable select_rows(const ResultTable& table, const std::vector<std::size_t>& rows);
/// Every `step`-th row, from the first.
ResultTable every_row(const ResultTable& table, std::size_t step);

/// The table with only those of its channels that are wanted.
ResultTable select_channels(const ResultTable& table,
                            const std::function<bool(const Channel&)>& wanted);

}  // namespace bentaxis
