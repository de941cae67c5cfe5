#include "bentaxis/study/hard_cases_document.h"

#include <array>

#include "document_parts.h"

namespace bentaxis::study {
namespace {

double digits(double loss) { return loss > 0 ? std::clamp(-std::log10(loss), 0.0, 16.0) : 16; }

const char* expected(const HardOutcome& outcome) {
  return outcome.refusal_expected ? "refused" : "accurate";
}

bool misjudged(const HardOutcome& outcome) {
  const auto ratio = outcome.worst_ratio();
  return ratio && (*ratio > kPredictionFactor || *ratio < 1 / kPredictionFactor);
}

std::size_t misjudged(const HardCaseStudy& study) {
  return report::count_of(study.runs,
                          [](const HardCaseRun& run) { return misjudged(run.outcome); });
}

std::size_t count(const HardCaseStudy& study, HardVerdict verdict) {
  return report::count_of(study.runs,
                          [&](const auto& run) { return run.outcome.verdict == verdict; });
}

bool bounded(const HardCaseStudy& study) { return !study.long_run || study.long_run->bounded(); }

std::string cell(const HardOutcome& o) {
  if (o.verdict == HardVerdict::refused) return "refused";
  const GroupLoss* worst = o.worst();
  if (worst == nullptr) return to_string(o.verdict);
  return fmt::format("{}{:.1f} ({:.1f})", o.verdict == HardVerdict::wrong ? "WRONG " : "",
                     digits(worst->measured), digits(worst->predicted));
}

report::HardCaseRow::Model record_of(const HardOutcome& o) {
  report::HardCaseRow::Model model{o.model,      expected(o),     to_string(o.verdict),
                                   o.message,    std::nullopt,    {},
                                   o.weak_point, o.worst_ratio(), o.seconds_per_angle * 1e6};
  if (o.worst() != nullptr) model.digits = digits(o.worst()->measured);
  for (const GroupLoss& g : o.groups) model.groups.push_back({g.group, g.measured, g.predicted});
  return model;
}

std::vector<report::HardCaseRow> records(const HardCaseStudy& study) {
  std::vector<report::HardCaseRow> rows;
  for (const auto& [hard, outcome] : study.runs) {
    if (rows.empty() || rows.back().name != hard.name)
      rows.push_back({hard.name, hard.group, hard.hard, hard.changes, {}});
    rows.back().models.push_back(record_of(outcome));
  }
  return rows;
}

// One block per group of cases, a row per case.
std::vector<report::Section> sections(const HardCaseStudy& study) {
  std::vector<report::NewSection> blocks;
  for (std::size_t i = 0; i < study.runs.size(); i += hard_models().size()) {
    const HardCase& hard = study.runs[i].hard;
    auto block = std::ranges::find(blocks, hard.group, &report::Section::title);
    if (block == blocks.end()) {
      block = blocks.emplace(
          block, hard.group,
          "Digits of the worst reaction, its name, and the predicted digits in brackets.");
      block->columns("case", "what is hard", "set to", hard_models(), "message");
    }
    std::vector<std::string> results, messages;
    for (std::size_t m = 0; m < hard_models().size(); ++m) {
      const HardOutcome& o = study.runs[i + m].outcome;
      results.push_back(o.worst() ? cell(o) + " " + o.worst()->group : cell(o));
      if (!o.message.empty()) messages.push_back(o.model + ": " + o.message);
    }
    block->row(hard.name, hard.hard, joined(hard.changes), results, joined(messages, "; "));
  }
  return {blocks.begin(), blocks.end()};
}

// Of one turn: constraints and their rate, gear phase, spin, work, reactions.
std::array<double, 6> errors_of(const LongRun::Turn& t) {
  return {t.record.position_error, t.record.velocity_error, t.record.gear_phase,
          t.record.spin_error,     t.record.work_residual,  t.reaction_error};
}

report::Section section_of(const LongRun& run) {
  report::NewSection section(
      fmt::format("{} turns integrated", run.turns),
      fmt::format("Real pistons spinning, accuracy {:g}; worst within the turn, work since the "
                  "start of {:.4g} J that the loads did. {:.3g} s a turn. Second half over "
                  "first half: constraint error {:.2g}, reaction error {:.2g}.",
                  run.accuracy, run.work_of_loads, run.seconds / run.turns,
                  run.position_error[1] / run.position_error[0],
                  run.reaction_error[1] / run.reaction_error[0]));
  section.columns("turn", "constraint error, m", "its rate, m/s", "gear phase, rad",
                  "spin error, rad/s", "work lost, J", "reaction error, of peak");
  for (const auto& t : run.shown) section.row(t.number, errors_of(t));
  return section;
}

std::string text_of(const LongRun& run) {
  std::string text = fmt::format(
      "\n{} turns integrated, accuracy {:g}, {:.3g} s a turn; worst within the turn:\n{:>6} {:>12} "
      "{:>12} {:>12} {:>12} {:>12} {:>12}\n",
      run.turns, run.accuracy, run.seconds / run.turns, "turn", "constraint/m", "rate/(m/s)",
      "phase/rad", "spin/(rad/s)", "work lost/J", "reaction");
  for (const auto& t : run.shown)
    text += fmt::format("{:>6} {:>12.1e}\n", t.number, fmt::join(errors_of(t), " "));
  return text;
}

}  // namespace

bool HardCaseStudy::good() const {
  return count(*this, HardVerdict::wrong) == 0 && misjudged(*this) == 0 && bounded(*this);
}

std::string HardCaseStudy::headline() const {
  std::string text = fmt::format(
      "{} cases, each by {} ways: {} accurate within the predicted loss, {} refused with a "
      "message, {} wrong. Losses above {:g} of peak that were not predicted within a factor of "
      "{:g}: {}.",
      runs.size() / hard_models().size(), hard_models().size(),
      count(*this, HardVerdict::as_predicted), count(*this, HardVerdict::refused),
      count(*this, HardVerdict::wrong), kNoticeableLoss, kPredictionFactor, misjudged(*this));
  if (long_run)
    text += fmt::format(" Over {} integrated turns errors {}.", long_run->turns,
                        bounded(*this) ? "do not grow" : "GROW");
  return text;
}

std::vector<std::string> HardCaseStudy::answers() const {
  std::vector<std::string> sentences;
  for (const auto& [hard, outcome] : runs)
    if (outcome.verdict == HardVerdict::wrong)
      sentences.push_back(fmt::format("Wrong: {} by {}: {}.", hard.name, outcome.model,
                                      outcome.message.empty() ? cell(outcome) : outcome.message));
  for (const std::string& model : hard_models()) {
    const HardCaseRun* run = report::largest_of(runs, [&](const HardCaseRun& r) {
      return r.outcome.model == model && r.outcome.worst() ? r.outcome.worst()->measured
                                                           : not_computed();
    });
    if (run == nullptr) continue;
    const GroupLoss& worst = *run->outcome.worst();
    sentences.push_back(fmt::format("Fewest digits by {}: {:.1f} of {} in {} ({}).", model,
                                    digits(worst.measured), worst.group, run->hard.name,
                                    run->hard.hard));
  }
  return sentences;
}

report::Document hard_cases_document(const HardCaseStudy& study, const report::Lines& program) {
  report::Document document;
  document.title = "Hard cases";
  document.program = program;
  document.verdict = {.agrees = study.good(),
                      .headline = study.headline(),
                      .word = study.good() ? "Holds" : "Fails",
                      .answers = study.answers()};
  document.meaning =
      "Digits are -log10 of the largest difference from the 50-digit curve over the peak of the "
      "reaction; predicted are the digits that remain after rounding of inputs and arithmetic "
      "(docs/trust.md).";
  document.hard_cases = records(study);
  document.runs = sections(study);
  if (study.long_run) {
    document.runs->push_back(section_of(*study.long_run));
    document.long_run = report::LongRunSection{document.runs->back(), bounded(study)};
  }
  return document;
}

std::string hard_cases_csv(const HardCaseStudy& study) {
  std::string text =
      "case,model,expected,verdict,group,loss_over_peak,predicted_over_peak,digits,us_per_angle\n";
  for (const auto& [hard, o] : study.runs) {
    text += fmt::format("{},{},{},{},", hard.name, o.model, expected(o), to_string(o.verdict));
    const GroupLoss* worst = o.worst();
    text += worst == nullptr
                ? ",,,,\n"
                : fmt::format("{},{},{},{:.1f},{:.1f}\n", worst->group,
                              number_text(worst->measured), number_text(worst->predicted),
                              digits(worst->measured), o.seconds_per_angle * 1e6);
  }
  return text;
}

std::string hard_cases_markdown(const HardCaseStudy& study) {
  std::string text = "| case | what is hard |";
  std::string rule = "|---|---|";
  for (const auto& model : hard_models()) {
    text += fmt::format(" {} |", model);
    rule += "---|";
  }
  text += fmt::format("\n{}\n", rule);
  for (std::size_t i = 0; i < study.runs.size(); i += hard_models().size()) {
    text += fmt::format("| `{}` | {} |", study.runs[i].hard.name, study.runs[i].hard.hard);
    for (std::size_t m = 0; m < hard_models().size(); ++m)
      text += fmt::format(" {} |", cell(study.runs[i + m].outcome));
    text += "\n";
  }
  return text;
}

std::string hard_cases_heading() {
  return fmt::format("{:<24} {:<10} {:<9} {:>7} {:>10} {:>9}  {}\n", "case", "model", "verdict",
                     "digits", "predicted", "us/angle", "lowest in, message");
}

std::string text_of(const HardCaseRun& run) {
  const HardOutcome& o = run.outcome;
  const GroupLoss* worst = o.worst();
  const std::string text =
      fmt::format("{:<24} {:<10} {:<9}", run.hard.name, o.model, to_string(o.verdict));
  if (worst == nullptr)
    return text + fmt::format(" {:>7} {:>10} {:>9}  {}\n", "", "", "", o.message);
  return text + fmt::format(" {:>7.1f} {:>10.1f} {:>9.1f}  {} {}\n", digits(worst->measured),
                            digits(worst->predicted), o.seconds_per_angle * 1e6, worst->group,
                            o.message);
}

std::string hard_cases_text(const HardCaseStudy& study) {
  std::string text =
      report::answers_text("", study.headline(), study.answers()) + hard_cases_heading();
  for (const HardCaseRun& run : study.runs) text += text_of(run);
  text += "\n";
  for (const auto& [hard, outcome] : study.runs)
    if (misjudged(outcome))
      text += fmt::format("{}, {}: measured over predicted loss {:.1e}\n", hard.name, outcome.model,
                          *outcome.worst_ratio());
  if (study.long_run) text += text_of(*study.long_run);
  return text;
}

}  // namespace bentaxis::study
