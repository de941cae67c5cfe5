#include "bentaxis/designs/duty_cycle.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/compare/comparison.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/study/reporting.h"
#include "bentaxis/study/run.h"

namespace bentaxis::designs {
namespace {

// TABLE.KEY of a key that only one table has; other names as they are.
std::string full_name(const std::string& name) {
  if (name.find('.') != std::string::npos) return name;
  std::string found;
  for (const Table& table : standard_registry().tables)
    for (const Parameter& p : table.parameters)
      if (p.key == name && !table.name.empty()) {
        if (!found.empty())
          throw InputError(name + ": is a key of several tables: " + found + ", " + table.name +
                           "." + name);
        found = table.name + "." + name;
      }
  return found.empty() ? name : found;
}

constexpr const char* kShare = "share";

// "theta_deg, pressure_bar", the first ones of many.
std::string names_of(const std::vector<std::string>& header) {
  constexpr std::size_t kNamed = 5;
  std::string text;
  for (std::size_t c = 0; c < std::min(kNamed, header.size()); ++c)
    text += (c == 0 ? "" : ", ") + header[c];
  return header.size() > kNamed ? text + ", .." : text;
}

}  // namespace

std::string DutyCycle::name_of(std::size_t row) const {
  std::string text = "row " + std::to_string(rows[row].number);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const std::string& name = variables[i].name();
    text += (i == 0 ? ": " : ", ") + name.substr(name.rfind('.') + 1) + " " +
            variables[i].text(rows[row].values[i]);
  }
  return text;
}

DutyCycle read_duty_cycle(const std::filesystem::path& file, const Case& base) {
  const NumericTable table = read_numeric_csv(file);
  DutyCycle duty;
  duty.file = file;
  duty.rows.clear();
  std::size_t share = table.header.size();
  // First, as a file without it is of another kind.
  if (!contains(table.header, kShare))
    throw InputError(file.string() + ":1: columns " + names_of(table.header) +
                     ": the column \"share\" is missing (share of the time of each row); a duty "
                     "cycle has it beside columns of parameters, such as speed_rpm or "
                     "pressure.delivery_bar");
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    if (table.header[c] == kShare) {
      if (share != table.header.size())
        throw InputError(file.string() + ":1: column \"share\" is a duplicate column");
      share = c;
      continue;
    }
    const std::string name = full_name(table.header[c]);
    if (std::any_of(duty.variables.begin(), duty.variables.end(),
                    [&](const Variable& v) { return v.name() == name; }))
      throw InputError(file.string() + ":1: column \"" + table.header[c] +
                       "\" is a duplicate column");
    try {
      duty.variables.emplace_back(name, base);
    } catch (const InputError& error) {
      throw InputError(file.string() + ": " + error.what());
    }
    columns.push_back(c);
  }
  if (table.rows.empty()) throw InputError(file.string() + ": has no row");
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    DutyCycle::Row row;
    row.line = table.lines[r];
    row.number = r + 1;
    row.share = table.rows[r][share];
    if (!(row.share > 0))
      throw InputError(file.string() + ":" + std::to_string(row.line) +
                       ": share = " + number_text(row.share) + ": must be > 0");
    for (const std::size_t c : columns) row.values.push_back(table.rows[r][c]);
    duty.rows.push_back(std::move(row));
  }
  return duty;
}

double LifeStudy::models_apart() const {
  compare::Difference apart;
  const auto largest_of = [](const std::vector<double>& loads) {
    double largest = 0;
    for (const double load : loads) largest = std::max(largest, load);
    return largest;
  };
  for (std::size_t row = 0; row < analytic.points.size(); ++row) {
    // A bearing that carries next to nothing has the round-off of what the other one carries.
    double largest = 0;
    for (const auto& loads : analytic.points[row].loads)
      largest = std::max(largest, largest_of(loads.equivalent));
    for (const study::Bearing bearing : study::kBearings) {
      const auto i = static_cast<std::size_t>(bearing);
      // Row by row: what one of them lacks must not hide in the sum.
      const auto& first = analytic.points[row].loads[i].equivalent;
      const auto& second = multibody.points[row].loads[i].equivalent;
      const double scale = compare::scale_of(largest_of(first), largest);
      for (std::size_t k = 0; k < std::max(first.size(), second.size()); ++k)
        apart.keep_larger(compare::difference(k < first.size() ? first[k] : not_computed(),
                                              k < second.size() ? second[k] : not_computed(),
                                              scale));
    }
  }
  return apart.share();
}

LifeStudy life_study(const Case& the_case, const DutyCycle& duty,
                     const study::PartProgress& progress_of) {
  LifeStudy result;
  result.the_case = the_case;
  result.duty = duty;
  const Family family(the_case, duty.variables);
  const std::size_t rows = duty.rows.size();
  result.analytic.points.resize(rows);
  result.multibody.points.resize(rows);
  std::vector<std::string> reasons(rows);
  study::for_each_of(rows, 0, progress_of("duty cycle"), [&](std::size_t row) {
    try {
      Case scratch = the_case;
      family.make(duty.rows[row].values, scratch);
      const study::PreparedCase ready = study::prepare(std::move(scratch));
      const double share = duty.rows[row].share;
      const Samples samples = ready.samples(study::Way::driven);
      for (const study::Model model : study::kModels) {
        auto& of = model == study::Model::analytic ? result.analytic : result.multibody;
        const ResultTable table = study::run(ready, samples, {.model = model}).table;
        study::LifePoint& point = of.points[row] = study::life_point(ready.the_case, table, share);
        point.validity =
            analytic::check_validity(ready.the_case, ready.assumptions(model), samples, table);
      }
    } catch (const InputError& error) {
      if (duty.file.empty()) throw;
      throw InputError(duty.file.string() + ":" + std::to_string(duty.rows[row].line) + ": " +
                       error.what());
    } catch (const ComputationError& error) {
      reasons[row] = error.what();
    }
  });
  result.failed = study::without_failed(
      reasons,
      [&](std::size_t row) {
        return study::FailedPoint{static_cast<double>(duty.rows[row].number), duty.name_of(row),
                                  ""};
      },
      [&](std::size_t from, std::size_t to) {
        if (from == to) return;
        result.duty.rows[to] = std::move(result.duty.rows[from]);
        for (LifeStudy::OfModel* of : {&result.analytic, &result.multibody})
          of->points[to] = std::move(of->points[from]);
      },
      rows > 1 ? "no row of the duty cycle" : "");
  result.duty.rows.resize(rows - result.failed.size());
  for (LifeStudy::OfModel* of : {&result.analytic, &result.multibody}) {
    of->points.resize(result.duty.rows.size());
    of->life = study::pump_life(the_case, of->points);
  }
  return result;
}

}  // namespace bentaxis::designs
