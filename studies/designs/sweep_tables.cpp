#include "bentaxis/designs/sweep_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "bentaxis/files/csv_rows.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "sweep_hdf5.h"

namespace bentaxis::designs {

bool has_hdf5() { return why_no_hdf5().empty(); }
namespace {

// "max:Rb1_z1_N" says its unit; "peak:Rb1" does not.
std::string heading_of(const Output& o) {
  if (o.unit.empty() || o.name.ends_with("_" + o.unit)) return csv_text(o.name);
  return csv_text(o.name + " [" + o.unit + "]");
}

std::string csv_head(const SweepPlan& plan) {
  std::string head = "design";
  for (const Varied& v : plan.varied) head += "," + csv_text(v.variable.name());
  for (const Output& o : plan.outputs) head += "," + heading_of(o);
  return head + ",reason\n";
}

std::string csv_rows(const SweepBlock& block, const SweepPlan& plan) {
  const std::size_t n = plan.varied.size(), m = plan.outputs.size();
  CsvRows csv;
  std::vector<std::string> values(n);
  std::vector<double> results(m);
  for (std::size_t i = 0; i < block.designs; ++i) {
    for (std::size_t k = 0; k < n; ++k)
      values[k] = plan.varied[k].variable.text(block.values[i * n + k]);
    for (std::size_t k = 0; k < m; ++k) results[k] = block.results[i * m + k];
    csv.row(block.first + i, values, results, block.reasons[i]);
  }
  return std::move(csv).text();
}

std::string checks_csv(const std::vector<SweepCheck>& checks, const SweepPlan& plan) {
  CsvRows csv("design,output,own,other,scale,error,agrees,own_reason,other_reason");
  for (const SweepCheck& c : checks)
    for (std::size_t k = 0; k < plan.outputs.size(); ++k) {
      const bool refused_by_one = c.own_reason.empty() != c.reason.empty();
      const auto if_compared = [&](double value) {
        return c.scales[k] != 0 ? value : not_computed();
      };
      csv.row(c.design, plan.outputs[k].name, c.own[k], c.values[k], if_compared(c.scales[k]),
              if_compared(c.error(k)),
              refused_by_one ? 0 : if_compared(c.error(k) <= kCheckTolerance ? 1 : 0), c.own_reason,
              c.reason);
    }
  return std::move(csv).text();
}

struct ReadBlock {
  std::optional<SweepBlock> block;  // none: it is missing
  std::string rows;                 // of sweep.csv
};

double bytes_expected(const Sweep& sweep) {
  constexpr double kBytesOfNumber = 18;
  const auto columns =
      static_cast<double>(sweep.plan().varied.size() + sweep.plan().outputs.size());
  return kBytesOfNumber * columns * static_cast<double>(sweep.designs());
}

// Which blocks cannot be taken, and why.
std::string missing_text(const SweepParts& parts, const std::vector<std::size_t>& missing) {
  const std::size_t blocks = parts.record().layout.blocks();
  const std::vector<std::size_t> misplaced = parts.misplaced(missing);
  std::vector<std::size_t> others;
  std::set_difference(missing.begin(), missing.end(), misplaced.begin(), misplaced.end(),
                      std::back_inserter(others));
  std::string text =
      fmt::format("{}: of {} blocks (0-{}) ", parts.folder().string(), blocks, blocks - 1);
  if (!misplaced.empty())
    text += fmt::format("{} hold the designs of another block: {}{}", misplaced.size(),
                        list_of(misplaced), others.empty() ? "" : "; ");
  if (!others.empty())
    text += fmt::format("{} are missing or damaged: {}", others.size(), list_of(others));
  return text;
}

// Appends what is shown of a block.
void take(SweepResult& result, SweepBlock& block) {
  const std::size_t n = result.plan.varied.size(), m = result.plan.outputs.size();
  for (std::size_t i = 0; i < block.designs; ++i) {
    if (!block.reasons[i].empty()) ++result.all_infeasible;
    if ((block.first + i) % result.every != 0) continue;
    if (!block.reasons[i].empty()) result.infeasible.emplace_back(result.designs, block.reasons[i]);
    const auto append = [i](std::vector<double>& to, const std::vector<double>& from,
                            std::size_t width) {
      const auto row = from.begin() + static_cast<std::ptrdiff_t>(i * width);
      to.insert(to.end(), row, row + static_cast<std::ptrdiff_t>(width));
    };
    append(result.values, block.values, n);
    append(result.results, block.results, m);
    ++result.designs;
  }
  std::move(block.checks.begin(), block.checks.end(), std::back_inserter(result.checks));
}

}  // namespace

SweepResult write_sweep(const Sweep& sweep, const SweepParts& parts, const SweepFormats& formats,
                        OutputFolder& folder, int threads, const Progress& progress,
                        std::size_t most) {
  SweepResult result;
  result.plan = sweep.plan();
  result.base = sweep.family().base();
  result.every = (sweep.designs() + most - 1) / most;
  OutputFolder::Stream* csv = formats.csv ? &folder.open("sweep.csv") : nullptr;
  if (csv != nullptr) {
    csv->expect(bytes_expected(sweep));
    csv->write(csv_head(result.plan));
  }
  std::unique_ptr<Hdf5File> hdf5;
  if (formats.hdf5)
    hdf5 = std::make_unique<Hdf5File>(folder.reserve("sweep.h5"), sweep, parts.record());
  const auto write = [&](const std::vector<ReadBlock>& some) {
    for (const ReadBlock& one : some) {
      if (csv != nullptr) csv->write(one.rows);
      if (hdf5) hdf5->add(*one.block);
    }
  };
  std::vector<std::size_t> missing;
  std::size_t counted = 0;  // designs so far: no block holds those of another one
  // Some blocks at a time are read and made text side by side; those before are written meanwhile.
  constexpr std::size_t kAtATime = 8;
  std::vector<ReadBlock> before, now;
  for (std::size_t first = 0; first < sweep.blocks(); first += kAtATime) {
    now.assign(std::min(kAtATime, sweep.blocks() - first), {});
    numerics::parallel_for(threads, 1 + now.size(), [&](std::size_t job) {
      if (job == 0) return write(before);
      ReadBlock& one = now[job - 1];
      one.block = parts.read(first + job - 1);
      if (one.block && csv != nullptr) one.rows = csv_rows(*one.block, result.plan);
    });
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (!now[i].block) {
        missing.push_back(first + i);
        continue;
      }
      counted += now[i].block->designs;
      take(result, *now[i].block);
    }
    before.swap(now);
    progress(static_cast<double>(first + before.size()) / static_cast<double>(sweep.blocks()));
    if (!missing.empty()) before.clear();
  }
  if (!missing.empty()) throw InputError(missing_text(parts, missing));
  if (counted != sweep.designs())
    throw ComputationError(fmt::format("{}: its blocks hold {} designs, but the plan has {}",
                                       parts.folder().string(), counted, sweep.designs()));
  write(before);
  if (hdf5) hdf5->finish(result.checks);
  if (!result.checks.empty())
    folder.add("sweep_checks.csv", checks_csv(result.checks, result.plan));
  result.best = validity_of_best(result);
  return result;
}

std::string sweep_csv(const SweepResult& result) {
  SweepBlock all{.first = 0,
                 .designs = result.designs,
                 .values = result.values,
                 .results = result.results,
                 .reasons = std::vector<std::string>(result.designs),
                 .checks = {}};
  for (const auto& [design, reason] : result.infeasible) all.reasons[design] = reason;
  return csv_head(result.plan) + csv_rows(all, result.plan);
}

std::string disagreements_text(const SweepResult& result) {
  std::string text;
  constexpr int kMax = 20;
  int lines = 0;
  const auto add = [&](const std::string& line) {
    if (lines++ < kMax) text += line + "\n";
  };
  for (const SweepCheck& c : result.checks) {
    if (c.own_reason.empty() != c.reason.empty())
      add(fmt::format("design {}: refused by one model alone: {}", c.design,
                      c.own_reason + c.reason));
    for (std::size_t k = 0; k < c.values.size(); ++k)
      if (const compare::Difference found = c.difference(k); !(c.error(k) <= result.tolerance))
        add(fmt::format("design {}, {}: {}", c.design, result.plan.outputs[k].name,
                        found.known()
                            ? fmt::format("{} against {}, {} of the peak", number_text(c.own[k]),
                                          number_text(c.values[k]), rounded_text(found.share()))
                            : found.why_unknown()));
  }
  if (lines > kMax) text += fmt::format("and {} more, in sweep_checks.csv\n", lines - kMax);
  return text;
}

}  // namespace bentaxis::designs
