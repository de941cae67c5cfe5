#include "bentaxis/designs/sweep_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "sweep_hdf5.h"

namespace bentaxis::designs {
namespace {

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + "\"";
}

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
  std::string text;
  for (std::size_t i = 0; i < block.designs; ++i) {
    text += std::to_string(block.first + i);
    for (std::size_t k = 0; k < n; ++k)
      text += "," + plan.varied[k].variable.text(block.values[i * n + k]);
    for (std::size_t k = 0; k < m; ++k) {
      text += ',';
      append_number(text, block.results[i * m + k]);
    }
    text += "," + csv_text(block.reasons[i]) + "\n";
  }
  return text;
}

std::string checks_csv(const std::vector<SweepCheck>& checks, const SweepPlan& plan) {
  std::string text = "design,output,own,other,scale,error,agrees,own_reason,other_reason\n";
  for (const SweepCheck& c : checks)
    for (std::size_t k = 0; k < plan.outputs.size(); ++k) {
      text += std::to_string(c.design) + "," + csv_text(plan.outputs[k].name);
      const bool compared = c.scales[k] > 0;
      for (const double value : {c.own[k], c.values[k], compared ? c.scales[k] : not_computed(),
                                 compared ? c.error(k) : not_computed()}) {
        text += ',';
        append_number(text, value);
      }
      const bool agrees = c.own_reason.empty() == c.reason.empty() && c.error(k) <= kCheckTolerance;
      text +=
          fmt::format(",{},{},{}\n", agrees ? 1 : 0, csv_text(c.own_reason), csv_text(c.reason));
    }
  return text;
}

double bytes_expected(const Sweep& sweep) {
  constexpr double kBytesOfNumber = 18;
  const auto columns =
      static_cast<double>(sweep.plan().varied.size() + sweep.plan().outputs.size());
  return kBytesOfNumber * columns * static_cast<double>(sweep.designs());
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
                        OutputFolder& folder, const Progress& progress, std::size_t most) {
  SweepResult result;
  result.plan = sweep.plan();
  result.base = sweep.base();
  result.every = (sweep.designs() + most - 1) / most;
  OutputFolder::Stream* csv = formats.csv ? &folder.open("sweep.csv") : nullptr;
  if (csv != nullptr) {
    csv->expect(bytes_expected(sweep));
    csv->write(csv_head(result.plan));
  }
  std::unique_ptr<Hdf5File> hdf5;
  if (formats.hdf5)
    hdf5 = std::make_unique<Hdf5File>(folder.reserve("sweep.h5"), sweep, parts.record());
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < sweep.blocks(); ++i) {
    auto block = parts.read(i);
    if (!block) {
      missing.push_back(i);
    } else if (missing.empty()) {
      if (csv != nullptr) csv->write(csv_rows(*block, result.plan));
      if (hdf5) hdf5->add(*block);
      take(result, *block);
    }
    progress(static_cast<double>(i + 1) / static_cast<double>(sweep.blocks()));
  }
  if (!missing.empty())
    throw InputError(fmt::format("{}: of {} blocks (0-{}) {} are missing or damaged: {}",
                                 parts.folder().string(), sweep.blocks(), sweep.blocks() - 1,
                                 missing.size(), list_of(missing)));
  if (hdf5) hdf5->finish(result.checks);
  if (!result.checks.empty())
    folder.add("sweep_checks.csv", checks_csv(result.checks, result.plan));
  return result;
}

std::string sweep_text(const SweepResult& result) {
  const std::size_t all = result.plan.size();
  std::string text =
      fmt::format("{} design{}, {} infeasible", all, all == 1 ? "" : "s", result.all_infeasible);
  std::map<std::string, std::size_t> reasons;  // without their numbers' places: as they are said
  for (const auto& [design, reason] : result.infeasible) ++reasons[reason];
  const auto most =
      std::max_element(reasons.begin(), reasons.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most != reasons.end()) text += fmt::format("; such as: {}", most->first);
  if (result.checks.empty()) return text;
  const std::string other =
      study::to_string(result.plan.model == study::Model::analytic ? study::Model::multibody
                                                                   : study::Model::analytic);
  double worst = 0;
  std::size_t differ = 0;
  std::string lines;
  constexpr std::size_t kMostLines = 20;
  for (const SweepCheck& c : result.checks) {
    const bool agrees = c.agrees(result.tolerance);
    if (!agrees) ++differ;
    if (c.own_reason.empty() != c.reason.empty() && differ <= kMostLines)
      lines += fmt::format("\n  design {}: refused by one model alone: {}", c.design,
                           c.own_reason + c.reason);
    for (std::size_t k = 0; k < c.values.size(); ++k) {
      worst = std::max(worst, c.error(k));
      if (!(c.error(k) <= result.tolerance) && differ <= kMostLines)
        lines += fmt::format("\n  design {}, {}: {} against {}, {} of the peak", c.design,
                             result.plan.outputs[k].name, number_text(c.own[k]),
                             number_text(c.values[k]), rounded_text(c.error(k)));
    }
  }
  return text + fmt::format(
                    "\n{} of them by the {} model too: {}, at most {} of the peak apart "
                    "(tolerance {}){}",
                    result.checks.size(), other,
                    differ == 0 ? "all agree" : fmt::format("{} differ", differ),
                    rounded_text(worst), number_text(result.tolerance), lines);
}

}  // namespace bentaxis::designs
