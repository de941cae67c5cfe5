// The numbers of a run that are asked for first.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/report/document.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// One number of one or two models, with what it is over (for the share of the difference).
report::KeyFigures::Row key_row(std::string quantity, std::string symbol, std::string unit,
                                report::Values values);

/// Mean and ripple of the drive torque over the rows (of a whole number of turns), and the peaks of
/// the forces and of the distance of Fh's point from the block's axis. A quantity that no table has
/// is left out.
/// @param tables  one or two, of the same rows
std::vector<report::KeyFigures::Row> turn_figures(const std::vector<const ResultTable*>& tables);

/// How the block of a transfer other than the gear moves against the shaft over a turn, side
/// couples of a joint, which piston carries when, and the dead centres of the pistons. None of a
/// gear.
std::vector<report::KeyFigures::Row> transfer_figures(const std::vector<const ResultTable*>& tables,
                                                      const PumpParameters& pump);

/// The same of a motion, whose torque has a peak instead of a mean. @param at  of the rows
std::vector<report::KeyFigures::Row> motion_figures(const std::vector<const ResultTable*>& tables,
                                                    const std::vector<double>& at);

/// What the oil does: flow, ripple, chamber pressures. Of one model, which both others are given.
/// @param models  how many columns the number stands in
std::vector<report::KeyFigures::Row> oil_figures(const hydraulics::Summary& summary,
                                                 std::size_t models);

}  // namespace bentaxis::study
