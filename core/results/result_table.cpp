#include "bentaxis/results/result_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {
namespace {

// The loop of every table: each sample's row in the channels' units, checked, to the sink.
void evaluate_rows(const std::string& name, const ChannelLayout& layout, const Samples& samples,
                   const EvaluateRow& evaluate, const RowSink& sink, const Progress& progress) {
  const std::vector<Channel>& channels = layout.channels();
  const std::size_t rows = samples.theta_deg.size();
  Instant instant;
  std::vector<double> row(layout.size());
  for (std::size_t i = 0; i < rows; ++i) {
    samples.instant(i, instant);
    std::fill(row.begin(), row.end(), not_computed());
    evaluate(instant, row);
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (std::isinf(row[c]) || is_stray_nan(row[c]))
        throw ComputationError(name + " model: " + channels[c].name + " is not finite at " +
                               number_text(samples.theta_deg[i]) + " deg");
      row[c] /= channels[c].unit_in_si;
    }
    sink(samples.theta_deg[i], row);
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(rows));
  }
}

}  // namespace

std::size_t ResultTable::find(const std::string& channel_name) const {
  const auto it = std::find_if(channels.begin(), channels.end(), [&](const Channel& channel) {
    return channel.name == channel_name;
  });
  return static_cast<std::size_t>(it - channels.begin());
}

double ResultTable::peak(const std::string& group) const {
  // Components of one vector share group, frame and piston. What is named by its column alone, as
  // what a pair of teeth does, is no component of a vector.
  std::map<std::tuple<std::string, int, std::string>, std::vector<std::size_t>> vectors;
  for (std::size_t c = 0; c < columns(); ++c) {
    const Channel& channel = channels[c];
    if (channel.group != group) continue;
    const std::string alone = channel.quantity == channel.name ? channel.name : "";
    vectors[{channel.frame, channel.piston, alone}].push_back(c);
  }
  double peak = 0;
  for (const auto& [key, components] : vectors) {
    for (std::size_t row = 0; row < rows(); ++row) {
      double square = 0;
      for (const auto c : components) {
        const double value = at(row, c);
        if (is_computed(value)) square += value * value;
      }
      peak = std::max(peak, std::sqrt(square));
    }
  }
  return peak;
}

void ResultTable::for_each_row(const std::function<void(double, const double*)>& use) const {
  std::vector<double> row(columns());
  for (std::size_t i = 0; i < rows(); ++i) {
    for (std::size_t c = 0; c < columns(); ++c) row[c] = at(i, c);
    use(theta_deg[i], row.data());
  }
}

ResultTable tabulate(const std::string& name, const ChannelLayout& layout, const Samples& samples,
                     const EvaluateRow& evaluate, const Progress& progress) {
  ResultTable table;
  table.name = name;
  table.channels = layout.channels();
  table.theta_deg = samples.theta_deg;
  table.reserve_rows(samples.theta_deg.size());
  evaluate_rows(
      name, layout, samples, evaluate,
      [&](double, const std::vector<double>& row) {
        table.values.insert(table.values.end(), row.begin(), row.end());
      },
      progress);
  return table;
}

void stream_rows(const std::string& name, const ChannelLayout& layout, const Case& the_case,
                 const PressureTrace& pressure, const EvaluateRow& evaluate, const RowSink& sink,
                 const Progress& progress) {
  constexpr long long kHeld = 4096;
  const long long rows = the_case.operation.samples_per_revolution;
  for (long long first = 0; first < rows; first += kHeld) {
    const Samples part = sample_case(the_case, pressure, 1, false, {first, kHeld});
    const auto share = static_cast<double>(part.theta_deg.size()) / static_cast<double>(rows);
    evaluate_rows(name, layout, part, evaluate, sink, [&](double done) {
      if (progress) progress(static_cast<double>(first) / static_cast<double>(rows) + share * done);
    });
  }
}

ResultTable select_rows(const ResultTable& table, const std::vector<std::size_t>& rows) {
  ResultTable selected;
  selected.name = table.name;
  selected.channels = table.channels;
  selected.provenance = table.provenance;
  selected.reserve_rows(rows.size());
  for (const std::size_t row : rows) {
    selected.theta_deg.push_back(table.theta_deg[row]);
    for (std::size_t c = 0; c < table.columns(); ++c) selected.values.push_back(table.at(row, c));
  }
  return selected;
}

ResultTable every_row(const ResultTable& table, std::size_t step) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); row += step) rows.push_back(row);
  return select_rows(table, rows);
}

ResultTable select_channels(const ResultTable& table,
                            const std::function<bool(const Channel&)>& wanted) {
  ResultTable selected;
  selected.name = table.name;
  selected.theta_deg = table.theta_deg;
  selected.provenance = table.provenance;
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < table.columns(); ++column)
    if (wanted(table.channels[column])) {
      columns.push_back(column);
      selected.channels.push_back(table.channels[column]);
    }
  selected.reserve_rows(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (const std::size_t column : columns) selected.values.push_back(table.at(row, column));
  return selected;
}

}  // namespace bentaxis
