#include "bentaxis/study/mapping_guess.h"

#include <algorithm>
#include <optional>

#include "bentaxis/pump/error.h"
#include "mapping_proposal.h"

namespace bentaxis::study {

std::size_t MappingGuess::recognised() const {
  std::size_t count = curve.columns.size();
  for (const auto& vector : curve.vectors)
    count +=
        3 - static_cast<std::size_t>(std::count(vector.theirs.begin(), vector.theirs.end(), ""));
  return count;
}

MappingGuess guess_mapping(const ForeignTable& table, const ResultTable& model,
                           const compare::FrameAxes& frames, double degrees_per_second,
                           const compare::ResultAt& model_at) {
  const mapping::ModelCurves curves(model, frames);
  mapping::Record record(table, degrees_per_second);
  std::optional<mapping::Phase> best;
  for (const mapping::AngleMap& choice : record.angle_choices()) {
    record.take_turn(choice);
    for (mapping::Phase& found : mapping::phases_of(record, curves)) {
      // A curve that is the same both ways turns forwards: round-off must not decide.
      constexpr double kTie = 1e-3;
      const double ahead = best ? (best->turning.sign - found.turning.sign) / 2 * kTie : 0;
      if (best && found.score >= best->score - ahead) continue;
      found.angle = choice;
      best = found;
    }
  }
  if (!best)
    throw InputError(table.file.string() +
                     ": no column resembles a curve of the model; is it a record of this case?");
  record.take_turn(best->angle);
  return mapping::proposal_of(record, curves, *best, model_at);
}

}  // namespace bentaxis::study
