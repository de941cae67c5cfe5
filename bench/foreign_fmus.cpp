// Imports FMUs of others and steps them through their default experiment, or through the times of a
// stored result beside them, with which they are compared (docs/external_benchmarks.md): a line of
// JSON for each.
//
//   foreign_fmus FILE.fmu..
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/files/csv.h"
#include "bentaxis/fmu/slave.h"

namespace {

using bentaxis::fmu::UnitVariable;

// A stored result of the same FMU beside it: NAME_ref.csv, NAME_cc.csv (of the compliance checker)
// or NAME_out.csv, with the columns time and names of variables.
std::optional<bentaxis::NumericTable> stored_result(std::filesystem::path file,
                                                    nlohmann::json& line) {
  const std::string stem = file.stem().string();
  if (std::filesystem::exists(file.replace_filename(stem + "_in.csv"))) return std::nullopt;
  for (const char* end : {"_ref.csv", "_cc.csv", "_out.csv"}) {
    file.replace_filename(stem + end);
    if (!std::filesystem::exists(file)) continue;
    line["reference"] = file.filename().string();
    return bentaxis::read_numeric_csv(file);
  }
  return std::nullopt;
}

// The largest difference from a stored result, over the column's peak there.
class Against {
 public:
  Against(const bentaxis::NumericTable& stored, const std::vector<UnitVariable>& variables)
      : stored_(stored) {
    for (std::size_t i = 1; i < stored.header.size(); ++i)
      for (const UnitVariable& v : variables)
        if (v.numeric() && (v.name == stored.header[i] || '"' + v.name + '"' == stored.header[i])) {
          columns_.push_back(i);
          variables_.push_back(&v);
        }
    peaks_.resize(columns_.size());
    for (const auto& row : stored.rows)
      for (std::size_t i = 0; i < columns_.size(); ++i)
        peaks_[i] = std::max(peaks_[i], std::abs(row[columns_[i]]));
  }

  void compare(bentaxis::fmu::Slave& slave, std::size_t row) {
    const std::vector<double> values = slave.get(variables_);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double off =
          std::abs(values[i] - stored_.rows[row][columns_[i]]) / (peaks_[i] > 0 ? peaks_[i] : 1);
      if (off <= worst_) continue;
      worst_ = off;
      where_ = stored_.header[columns_[i]] + " at " + std::to_string(stored_.rows[row][0]) + " s";
    }
    ++rows_;
  }

  nlohmann::json result() const {
    return {{"rows", rows_}, {"columns", columns_.size()}, {"worst", worst_}, {"where", where_}};
  }

 private:
  const bentaxis::NumericTable& stored_;
  std::vector<std::size_t> columns_;
  std::vector<const UnitVariable*> variables_;
  std::vector<double> peaks_;
  double worst_ = 0;
  std::string where_;
  int rows_ = 0;
};

// Times of communication: those of a stored result, else 100 steps.
std::vector<double> times_of(const std::optional<bentaxis::NumericTable>& stored, double start,
                             double stop) {
  constexpr int kSteps = 100;
  std::vector<double> times;
  if (stored)
    for (const auto& row : stored->rows) times.push_back(row[0]);
  else
    for (int i = 0; i <= kSteps; ++i) times.push_back(start + i * (stop - start) / kSteps);
  return times;
}

nlohmann::json tried(const std::string& file) {
  nlohmann::json line = {{"file", file}};
  std::string stage = "import";
  try {
    const bentaxis::fmu::ImportedUnit unit(file, {.call_seconds = 20});
    const auto& d = unit.description();
    line["fmi"] = d.version;
    line["tool"] = d.tool;
    line["variables"] = d.variables.size();
    const auto stored = stored_result(file, line);
    std::optional<Against> against;
    if (stored) against.emplace(*stored, d.variables);
    const std::vector<double> times = times_of(stored, d.start_time.value_or(0),
                                               d.stop_time.value_or(d.start_time.value_or(0) + 1));
    stage = "instantiate";
    const auto slave = unit.instantiate("foreign");
    stage = "initialise";
    slave->enter_initialisation(times.front(), times.back());
    slave->exit_initialisation();
    stage = "step";
    if (against) against->compare(*slave, 0);
    int steps = 0;
    for (std::size_t i = 1; i < times.size(); ++i) {
      const double step = times[i] - times[i - 1];
      if (step > 0) {  // not between both sides of an event
        slave->step(times[i - 1], step);
        ++steps;
      }
      // Of several rows of one time the last is after the event, as an FMU is after its step.
      if (against && (i + 1 == times.size() || times[i + 1] > times[i]))
        against->compare(*slave, i);
    }
    if (against) line["against"] = against->result();
    stage = "outputs";
    std::vector<const UnitVariable*> outputs;
    for (const UnitVariable& v : d.variables)
      if (v.causality == "output" && v.numeric()) outputs.push_back(&v);
    const std::vector<double> values = slave->get(outputs);
    for (std::size_t i = 0; i < values.size(); ++i) line["outputs"][outputs[i]->name] = values[i];
    stage = "end";
    slave->end();
    line["steps"] = steps;
    line["stop"] = times.back();
    stage = "";
  } catch (const std::exception& error) {
    line["why"] = error.what();
  }
  line["failed_at"] = stage;
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: foreign_fmus FILE.fmu..\n");
    return 2;
  }
  for (int i = 1; i < argc; ++i) {
    std::printf("%s\n", tried(argv[i]).dump().c_str());
    std::fflush(stdout);
  }
  return 0;
}
