#include "bentaxis/study/shown_pump.h"

#include <utility>

#include "bentaxis/pump/lists.h"
#include "bentaxis/study/timing.h"
#include "bentaxis/study/transfer_summary.h"
#include "bentaxis/study/turn_summary.h"

namespace bentaxis::study {

std::vector<std::string> pump_answers(const PreparedCase& ready, const ResultTable& table,
                                      const std::vector<analytic::ValidityLimit>& limits,
                                      const std::string& by) {
  const PumpParameters& pump = ready.the_case.pump;
  std::vector<std::string> sentences = TurnSummary(table).answers();
  append(sentences, TransferSummary(pump, table).answers());
  for (std::string& sentence : sentences) sentence.insert(0, by);
  if (std::string play = free_play_answer(pump); !play.empty())
    sentences.push_back(std::move(play));
  append(sentences, limit_answers(limits));
  if (ready.hydraulics)
    sentences.push_back(timing_answer(timing_rows(ready.the_case, *ready.hydraulics)));
  return sentences;
}

std::vector<std::string> ShownPump::answers() const {
  return pump_answers(ready, run.table, limits);
}

ShownPump show_pump(Case the_case, const PartProgress& progress_of) {
  require_memory(the_case, Kept::shown, Way::driven);
  ShownPump pump{prepare(std::move(the_case), progress_of), {}, {}, {}};
  const Case& ready = pump.ready.the_case;
  RunOptions options;
  options.loads = true;
  const Samples samples = pump.ready.samples(Way::driven);
  pump.run = run(pump.ready, samples, options, progress_of);
  pump.limits = analytic::check_validity(ready, ready.analytic, samples, pump.run.table);
  pump.description = describe(ready, progress_of, Described::without_turn);
  return pump;
}

}  // namespace bentaxis::study
