// The mapping that is proposed for a foreign record, once its phase is known to within a piston.
#pragma once

#include "bentaxis/study/mapping_guess.h"
#include "mapping_phase.h"

namespace bentaxis::study::mapping {

// @param model_at  the same model at the record's angles
// @throws InputError where no column resembles a curve of the model
MappingGuess proposal_of(const Record& record, const ModelCurves& model, const Phase& phase,
                         const compare::ResultAt& model_at);

}  // namespace bentaxis::study::mapping
