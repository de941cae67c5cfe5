// Drive torque by cause: the closed form under one load at a time.
#pragma once

#include <memory>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/budget.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::analytic {

/// For a given motion every reaction is linear in the loads. So each cause's part of Td and of the
/// torque on the block is what (31)-(33), (38), (43) and (57) give where that load acts alone: no
/// part is found by subtraction. Where the bore forces do not act at B their work on the
/// play is a cause of its own, of every load's share less it. Teeth pass on every part at the ratio
/// of their torques on shaft and block, which is not quite 1 where a tip's edge carries.
class BudgetModel {
 public:
  /// @throws InputError as Model does
  BudgetModel(const PumpParameters& pump, const Assumptions& assumptions);
  ~BudgetModel();
  BudgetModel(BudgetModel&&) noexcept;
  BudgetModel& operator=(BudgetModel&&) noexcept;

  /// Whether the bore forces do work, so that Cause::ring is not 0.
  bool has_ring() const;
  /// Whether the teeth are resolved, so that there is Cause::teeth.
  bool has_teeth() const;

  /// @throws InputError as Model::reactions() does
  Budget evaluate(const Instant& instant);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// One turn of a case under the assumptions it gives this model, as a budget_table().
/// @throws ComputationError where a value is not finite.
ResultTable run_budget(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                       const Progress& progress = {});

}  // namespace bentaxis::analytic
