#include "key_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bentaxis/pump/units.h"

namespace bentaxis::study {
namespace {

using Row = report::KeyFigures::Row;
using Tables = std::vector<const ResultTable*>;

// What is larger by no more than this is the same peak, at the next piston or a part of a turn
// later.
constexpr double kSamePeak = 1e-9;

struct Peak {
  double value = not_computed();
  std::size_t row = 0;
  int piston = 0;
};

// Channels that together are one vector, by piston.
std::map<int, std::vector<std::size_t>> vectors_of(const ResultTable& table,
                                                   const Channel& channel) {
  std::map<int, std::vector<std::size_t>> vectors;
  for (std::size_t c = 0; c < table.columns(); ++c) {
    const Channel& other = table.channels[c];
    if (other.group == channel.group && other.kind == channel.kind && other.frame == channel.frame)
      vectors[other.piston].push_back(c);
  }
  return vectors;
}

Peak peak_of(const ResultTable& table, const Channel& channel) {
  Peak peak;
  for (const auto& [piston, columns] : vectors_of(table, channel))
    for (std::size_t row = 0; row < table.rows(); ++row) {
      double square = 0;
      for (const std::size_t c : columns) square += table.at(row, c) * table.at(row, c);
      const double value = std::sqrt(square);
      if (is_computed(value) && (!is_computed(peak.value) || value > peak.value * (1 + kSamePeak)))
        peak = {value, row, piston};
    }
  return peak;
}

bool known(const Row& row) {
  return std::any_of(row.values.begin(), row.values.end(), is_computed);
}

void add(std::vector<Row>& rows, Row row) {
  if (known(row)) rows.push_back(std::move(row));
}

Row peak_row(const Tables& tables, const Channel& channel, const std::vector<double>& at) {
  report::Values values;
  for (const ResultTable* table : tables) values.push_back(peak_of(*table, channel).value);
  const bool place = channel.unit == "mm";
  Row row = key_row(place ? channel.meaning + ", furthest from z2" : channel.meaning + ", peak",
                    place ? "xh, yh" : channel.group, channel.unit, std::move(values));
  if (const Peak first = peak_of(*tables.front(), channel); is_computed(first.value)) {
    row.at = at.at(first.row);
    if (first.piston > 0) row.note = "piston " + std::to_string(first.piston);
  }
  return row;
}

// Forces that are unknowns of the equilibrium, and where Fh acts.
std::vector<Row> peaks(const Tables& tables, const std::vector<double>& at) {
  std::vector<Row> rows;
  std::vector<std::string> seen;
  for (const Channel& channel : tables.front()->channels) {
    const bool force = channel.kind == ChannelKind::reaction && channel.unit == "N";
    if (!force && channel.group != "xh_yh") continue;
    if (std::find(seen.begin(), seen.end(), channel.group) != seen.end()) continue;
    seen.push_back(channel.group);
    add(rows, peak_row(tables, channel, at));
  }
  return rows;
}

struct Torque {
  double mean = not_computed(), ripple = not_computed(), peak = not_computed();
};
Torque torque_of(const ResultTable& table) {
  const std::size_t column = table.find("Td_z1_Nm");
  if (column == table.columns() || table.rows() == 0) return {};
  double sum = 0, least = table.at(0, column), greatest = least;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double value = table.at(row, column);
    sum += value;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  Torque torque;
  torque.mean = sum / static_cast<double>(table.rows());
  torque.peak = std::max(std::abs(least), std::abs(greatest));
  if (std::abs(torque.mean) > kSamePeak * torque.peak)
    torque.ripple = 100 * (greatest - least) / std::abs(torque.mean);
  return torque;
}

Row torque_row(const Tables& tables, const std::string& quantity, const std::string& unit,
               double Torque::*which) {
  report::Values values;
  for (const ResultTable* table : tables) values.push_back(torque_of(*table).*which);
  return key_row(quantity, "Td", unit, std::move(values));
}

void append(std::vector<Row>& rows, std::vector<Row> more) {
  for (Row& row : more) rows.push_back(std::move(row));
}

}  // namespace

Row key_row(std::string quantity, std::string symbol, std::string unit, report::Values values) {
  Row row{std::move(quantity), std::move(symbol), std::move(unit), std::move(values)};
  if (row.values.size() < 2 || !is_computed(row.values[0]) || !is_computed(row.values[1]))
    return row;
  row.difference = row.values[1] - row.values[0];
  if (row.values[0] != 0) row.over_value = std::abs(*row.difference / row.values[0]);
  return row;
}

std::vector<Row> turn_figures(const Tables& tables) {
  std::vector<Row> rows;
  add(rows, torque_row(tables, "drive torque, mean", "Nm", &Torque::mean));
  add(rows,
      torque_row(tables, "drive torque, greatest less least over the mean", "%", &Torque::ripple));
  append(rows, peaks(tables, tables.front()->theta_deg));
  return rows;
}

std::vector<Row> motion_figures(const Tables& tables, const std::vector<double>& at) {
  std::vector<Row> rows;
  add(rows, torque_row(tables, "drive torque, peak", "Nm", &Torque::peak));
  append(rows, peaks(tables, at));
  return rows;
}

std::vector<Row> oil_figures(const hydraulics::Summary& s, std::size_t models) {
  const auto row = [&](const char* quantity, const char* unit, double value) {
    Row made{quantity, "", unit, report::Values(models, value)};
    if (models > 1) made.note = "of the oil, given to both models";
    return made;
  };
  Row least = row("chamber pressure, least", "bar", s.chamber_least / kPascalPerBar);
  Row greatest = row("chamber pressure, greatest", "bar", s.chamber_greatest / kPascalPerBar);
  for (Row* of_chamber : {&least, &greatest})
    of_chamber->note +=
        of_chamber->note.empty() ? "angle of the chamber" : "; angle of the chamber";
  least.at = s.chamber_least_deg;
  greatest.at = s.chamber_greatest_deg;
  Row flow = row("flow to the load, mean", "l/min", s.flow / kLitrePerMinute);
  flow.note += std::string(flow.note.empty() ? "" : "; ") + "at the density in the suction port";
  return {std::move(flow),
          row("flow to the load, greatest less least over the mean", "%", 100 * s.flow_ripple),
          row("volumetric efficiency", "%", 100 * s.volumetric_efficiency), std::move(least),
          std::move(greatest)};
}

}  // namespace bentaxis::study
