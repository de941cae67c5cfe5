#include "key_figures.h"

#include "bentaxis/study/transfer_summary.h"
#include "bentaxis/study/turn_summary.h"
#include "document_parts.h"

namespace bentaxis::study {
namespace {

constexpr std::size_t kSectors = 2;  // of a piston that carries, that are key figures

using Row = report::KeyFigures::Row;
using Tables = std::vector<const ResultTable*>;

bool known(const Row& row) {
  return std::any_of(row.values.begin(), row.values.end(), is_computed);
}

void add(std::vector<Row>& rows, Row row) {
  if (known(row)) rows.push_back(std::move(row));
}

using Summaries = std::vector<TurnSummary>;

Summaries summaries_of(const Tables& tables) {
  return report::each_of(tables, [](const ResultTable* table) { return TurnSummary(*table); });
}

// Forces that are unknowns of the equilibrium, and where Fh acts.
std::vector<Row> peaks(const Summaries& summaries, const std::vector<double>& at) {
  std::vector<std::vector<TurnSummary::Peak>> of_tables;
  for (const TurnSummary& summary : summaries) of_tables.push_back(summary.peaks());
  std::vector<Row> rows;
  for (const TurnSummary::Peak& first : of_tables.front()) {
    const Channel& channel = first.channel;
    report::Values values;
    for (const auto& peaks : of_tables) {
      const auto found = std::find_if(peaks.begin(), peaks.end(), [&](const auto& peak) {
        return peak.channel.group == channel.group;
      });
      values.push_back(found == peaks.end() ? not_computed() : found->value);
    }
    const bool place = channel.unit == "mm";
    Row row = key_row(place ? channel.meaning + ", furthest from z2" : channel.meaning + ", peak",
                      place ? "xh, yh" : channel.group, channel.unit, std::move(values));
    if (is_computed(first.value)) {
      row.at = at.at(first.row);
      if (first.piston > 0) row.note = "piston " + std::to_string(first.piston);
    }
    add(rows, std::move(row));
  }
  return rows;
}

template <class Number>
Row torque_row(const Summaries& summaries, const std::string& quantity, const std::string& unit,
               const Number& number) {
  return key_row(quantity, "Td", unit, report::each_of(summaries, [&](const TurnSummary& summary) {
                   return number(summary.torque());
                 }));
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
  const Summaries summaries = summaries_of(tables);
  std::vector<Row> rows;
  add(rows, torque_row(summaries, "drive torque, mean", "Nm",
                       [](const TurnSummary::Torque& torque) { return torque.mean; }));
  add(rows, torque_row(summaries, "drive torque, maximum less minimum over the mean", "%",
                       [](const TurnSummary::Torque& torque) { return torque.ripple(); }));
  append(rows, peaks(summaries, tables.front()->theta_deg));
  return rows;
}

std::vector<Row> transfer_figures(const Tables& tables, const PumpParameters& pump) {
  std::vector<TransferSummary> summaries;
  for (const ResultTable* table : tables) summaries.emplace_back(pump, *table);
  std::vector<Row> rows;
  const auto put = [&](const char* quantity, const char* symbol, const char* unit,
                       const auto& number, std::optional<double> at = {}, std::string note = "") {
    report::Values values;
    for (const TransferSummary& summary : summaries) values.push_back(number(summary));
    Row row = key_row(quantity, symbol, unit, std::move(values));
    if (is_computed(row.values.front())) row.at = at;
    row.note = std::move(note);
    add(rows, std::move(row));
  };
  const TransferSummary& first = summaries.front();
  const bool walls = pump.transfer.kind == TransferKind::pistons;
  put(
      "lag of the block, smallest", "delta", "deg", [](const auto& s) { return s.lag().low; },
      first.lag().low_deg);
  put(
      "lag of the block, largest", "delta", "deg", [](const auto& s) { return s.lag().high; },
      first.lag().high_deg);
  put("speed of the block, maximum less minimum over the mean", "psi'", "%",
      [](const auto& s) { return s.speed_ripple(); });
  put(
      "side couple on the block, peak", "Tcs", "Nm",
      [](const auto& s) { return s.couple_on_block().value; }, first.couple_on_block().theta_deg);
  put(
      "side couple on the shaft, peak", "Tcs", "Nm",
      [](const auto& s) { return s.couple_on_shaft().value; }, first.couple_on_shaft().theta_deg);
  put(
      "side force of the joint at O2, peak", "Fcs", "N",
      [](const auto& s) { return s.side_force().value; }, first.side_force().theta_deg);
  if (walls) {
    put("hand-overs from piston to piston per turn", "", "",
        [](const auto& s) { return static_cast<double>(s.hand_overs()); });
    put("pistons that push at a time, at most", "", "",
        [](const auto& s) { return static_cast<double>(s.most_walls()); });
    const std::size_t sectors = std::min(kSectors, first.sectors_of_first().size());
    for (std::size_t i = 0; i < sectors; ++i) {
      const auto end_of = [i](const TransferSummary& s, double TransferSummary::Sector::*end) {
        const auto all = s.sectors_of_first();
        return i < all.size() ? all[i].*end : not_computed();
      };
      put("angle from which piston 1 carries most", "theta", "deg",
          [&](const auto& s) { return end_of(s, &TransferSummary::Sector::from_deg); });
      put("angle to which piston 1 carries most", "theta", "deg",
          [&](const auto& s) { return end_of(s, &TransferSummary::Sector::to_deg); });
    }
  }
  if (pump.transfer.kind == TransferKind::gear) return rows;
  put("inner dead centre, earliest of the pistons", "psi_k", "deg",
      [](const auto& s) { return s.inner_dead_centre().low; });
  put("inner dead centre, latest of the pistons", "psi_k", "deg",
      [](const auto& s) { return s.inner_dead_centre().high; });
  put("outer dead centre, earliest of the pistons", "psi_k", "deg",
      [](const auto& s) { return s.outer_dead_centre().low; });
  put("outer dead centre, latest of the pistons", "psi_k", "deg",
      [](const auto& s) { return s.outer_dead_centre().high; });
  return rows;
}

std::vector<Row> motion_figures(const Tables& tables, const std::vector<double>& at) {
  const Summaries summaries = summaries_of(tables);
  std::vector<Row> rows;
  add(rows, torque_row(summaries, "drive torque, peak", "Nm",
                       [](const TurnSummary::Torque& torque) { return torque.peak(); }));
  append(rows, peaks(summaries, at));
  return rows;
}

std::vector<Row> oil_figures(const hydraulics::Summary& s, std::size_t models) {
  const auto row = [&](const char* quantity, const char* unit, double value) {
    Row made{quantity, "", unit, report::Values(models, value)};
    if (models > 1) made.note = "of the oil, given to both models";
    return made;
  };
  Row least = row("chamber pressure, minimum", "bar", s.chamber_least / kPascalPerBar);
  Row greatest = row("chamber pressure, maximum", "bar", s.chamber_greatest / kPascalPerBar);
  for (Row* of_chamber : {&least, &greatest})
    of_chamber->note +=
        of_chamber->note.empty() ? "angle of the chamber" : "; angle of the chamber";
  least.at = s.chamber_least_deg;
  greatest.at = s.chamber_greatest_deg;
  Row flow = row("flow to the load, mean", "l/min", s.flow / kLitrePerMinute);
  flow.note += std::string(flow.note.empty() ? "" : "; ") + "at the density in the suction port";
  return {std::move(flow),
          row("flow to the load, maximum less minimum over the mean", "%", 100 * s.flow_ripple),
          row(s.motors() ? "volumetric efficiency as a motor" : "volumetric efficiency", "%",
              100 * s.volumetric_efficiency),
          std::move(least), std::move(greatest)};
}

}  // namespace bentaxis::study
