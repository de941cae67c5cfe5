#include <fmt/format.h>

#include "bentaxis/files/csv_rows.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/report/picture.h"
#include "picture/axes.h"

namespace bentaxis::report {
namespace {

// Columns of equal length beside each other.
std::string beside(const std::vector<std::pair<std::string, const Values*>>& columns) {
  CsvRows csv;
  std::vector<std::string> names;
  for (const auto& [name, values] : columns) names.push_back(name);
  csv.row(names);
  for (std::size_t row = 0; row < columns.front().second->size(); ++row) {
    Values numbers;
    for (const auto& [name, values] : columns) numbers.push_back((*values)[row]);
    csv.row(numbers);
  }
  return std::move(csv).text();
}

std::string channels_csv(const std::vector<std::string>& channels, const Curves& curves,
                         const std::vector<Series>& extra) {
  std::vector<std::pair<std::string, const Values*>> columns = {
      {curves.axis.empty() ? "theta_deg" : curves.axis, &curves.theta_deg}};
  for (const std::string& channel : channels) {
    for (const auto& table : curves.tables)
      if (const Values* values = find(table.columns, channel))
        columns.emplace_back(channel + " " + table.name, values);
    if (const Values* values = find(curves.difference, channel))
      columns.emplace_back(
          fmt::format("{} {} minus {}", channel, curves.tables[1].name, curves.tables[0].name),
          values);
    if (!curves.reference) continue;
    for (const Curves::Held& held : curves.reference->held) {
      if (held.channel != channel) continue;
      const std::string& name = curves.reference->name;
      columns.emplace_back(channel + " " + name, &held.values);
      for (const auto& [table, values] : held.differences)
        columns.emplace_back(fmt::format("{} {} minus {}", channel, table, name), &values);
    }
  }
  for (const Series& series : extra) columns.emplace_back(series.label, &series.values);
  return beside(columns);
}

std::string numbers(const ChannelFigure& figure, const Curves& page) {
  return channels_csv(figure.channels, figure.curves ? *figure.curves : page, figure.extra);
}

std::string numbers(const PistonBars& figure, const Curves& page) {
  return channels_csv(figure.channels, page, {});
}

std::string numbers(const OwnFigure& figure, const Curves&) {
  std::vector<std::pair<std::string, const Values*>> columns = {{figure.axis, &figure.x}};
  for (const auto* list : {&figure.series, &figure.stack})
    for (const Series& series : *list) columns.emplace_back(series.label, &series.values);
  if (figure.right)
    for (const Series& series : figure.right->series)
      columns.emplace_back(picture::name_of({series.label, figure.right->unit}), &series.values);
  return beside(columns);
}

std::string numbers(const XyFigure& figure, const Curves&) {
  CsvRows csv;
  csv.row("series", picture::name_of(figure.x), picture::name_of(figure.y));
  for (const XySeries& series : figure.series)
    for (std::size_t i = 0; i < series.x.size(); ++i)
      csv.row(series.label, series.x[i], series.y[i]);
  return std::move(csv).text();
}

std::string numbers(const MapFigure& figure, const Curves&) {
  CsvRows csv;
  csv.row(picture::name_of(figure.x), picture::name_of(figure.y), picture::name_of(figure.z));
  for (std::size_t i = 0; i < figure.values.size(); ++i)
    for (std::size_t j = 0; j < figure.values[i].size(); ++j) {
      const double value = figure.values[i][j];
      if (!figure.classes.empty() && is_computed(value))
        csv.row(figure.x_values[j], figure.y_values[i],
                figure.classes.at(static_cast<std::size_t>(value)));
      else
        csv.row(figure.x_values[j], figure.y_values[i], value);
    }
  return std::move(csv).text();
}

std::string numbers(const ScatterFigure& figure, const Curves&) {
  CsvRows csv;
  csv.row("series", picture::name_of(figure.x), picture::name_of(figure.y), "note");
  for (const ScatterSeries& series : figure.series)
    for (const ScatterPoint& point : series.points)
      csv.row(series.name, point.x, point.y, point.note);
  return std::move(csv).text();
}

std::string numbers(const DrawingFigure& figure, const Curves&) {
  CsvRows csv;
  csv.row(figure.axis.empty() ? "theta_deg" : figure.axis, "panel", "look", "shape", "x", "y");
  const auto name = [&](int look) { return figure.looks[static_cast<std::size_t>(look)].label; };
  double shape = 0;
  const auto put = [&](const std::vector<DrawingFigure::Line>& lines, double theta_deg) {
    for (const DrawingFigure::Line& drawn : lines) {
      ++shape;
      for (std::size_t i = 0; i < drawn.x.size(); ++i)
        csv.row(theta_deg, drawn.panel + 1.0, name(drawn.look), shape, drawn.x[i], drawn.y[i]);
    }
  };
  put(figure.ground, not_computed());
  for (const DrawingFigure::Frame& frame : figure.frames) {
    shape = 0;
    put(frame.lines, frame.theta_deg);
    for (const DrawingFigure::Arrow& arrow : frame.arrows) {
      ++shape;
      csv.row(frame.theta_deg, arrow.panel + 1.0, name(arrow.look), shape, arrow.x, arrow.y);
      csv.row(frame.theta_deg, arrow.panel + 1.0, name(arrow.look), shape, arrow.x + arrow.dx,
              arrow.y + arrow.dy);
    }
  }
  return std::move(csv).text();
}

std::string numbers(const BarsFigure& figure, const Curves&) {
  CsvRows csv;
  csv.row(picture::name_of(figure.x), "low", "high", "from", "to", "note");
  for (const BarsFigure::Bar& bar : figure.bars) {
    const auto [from, to] = bar.interval.value_or(std::pair{not_computed(), not_computed()});
    csv.row(bar.label, bar.low, bar.high, from, to, bar.note);
  }
  return std::move(csv).text();
}

std::string numbers(const BandFigure& figure, const Curves&) {
  CsvRows csv;
  csv.row("series", picture::name_of(figure.x), picture::name_of(figure.y), "low", "high");
  for (const BandFigure::Band& band : figure.bands)
    for (std::size_t i = 0; i < figure.x_values.size(); ++i)
      csv.row(band.label, figure.x_values[i], band.middle[i], band.low[i], band.high[i]);
  for (const XySeries& series : figure.lines)
    for (std::size_t i = 0; i < series.x.size(); ++i)
      csv.row(series.label, series.x[i], series.y[i], not_computed(), not_computed());
  return std::move(csv).text();
}

std::string numbers(const ParallelFigure& figure, const Curves&) {
  CsvRows csv;
  std::vector<std::string> names;
  for (const auto& column : figure.columns)
    names.push_back(picture::name_of({column.label, column.unit}));
  csv.row(names, "marked");
  if (figure.columns.empty()) return std::move(csv).text();
  Values marked(figure.columns.front().values.size(), 0.0);
  for (const std::size_t design : figure.marked) marked.at(design) = 1;
  for (std::size_t row = 0; row < marked.size(); ++row) {
    std::vector<Cell> cells;
    for (const auto& column : figure.columns) {
      const double value = column.values[row];
      if (is_computed(value) && !column.words.empty())
        cells.emplace_back(column.words.at(static_cast<std::size_t>(value)));
      else
        cells.emplace_back(value);
    }
    csv.row(cells, marked[row]);
  }
  return std::move(csv).text();
}

}  // namespace

std::string csv_of(const Figure& figure, const Curves& curves) {
  return std::visit([&](const auto& content) { return numbers(content, curves); }, figure.content);
}

}  // namespace bentaxis::report
