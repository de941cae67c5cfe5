// Duty cycles: what a pump goes through over its life, and the life of its bearings under it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bentaxis/designs/variable.h"
#include "bentaxis/study/bearing_life.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::designs {

/// Parts of the time at values of some parameters.
struct DutyCycle {
  std::filesystem::path file;  ///< empty of the case itself, all the time
  std::vector<Variable> variables;
  struct Row {
    double share = 1;            ///< of the time, in proportion
    std::vector<double> values;  ///< one per variable, in the file's unit
    unsigned line = 0;           ///< of the file
    std::size_t number = 1;      ///< of the row, from 1 on
  };
  std::vector<Row> rows = {Row()};

  /// "row 2: speed_rpm 1500, delivery_bar 275"
  std::string name_of(std::size_t row) const;
};

/// Reads a duty cycle: CSV with a column `share` (> 0, of any sum) and columns of parameters by the
/// name that --set takes, or by the key alone where only one table has it.
/// @throws InputError naming file, line, column and value
DutyCycle read_duty_cycle(const std::filesystem::path& file, const Case& base);

/// What the two models may differ by in the equivalent loads, of the largest of a bearing and row.
inline constexpr double kLifeModelsAgree = 1e-9;

struct LifeStudy {
  Case the_case;
  DutyCycle duty;
  struct OfModel {
    std::vector<study::LifePoint> points;  ///< one per row
    study::PumpLife life;
  };
  OfModel analytic, multibody;
  /// Rows that could not be computed, by number: they are neither in `duty` nor in the points, and
  /// the lives are those of the other rows alone.
  std::vector<study::FailedPoint> failed;

  /// Largest difference of an equivalent load, of the largest of its bearing and row.
  double models_apart() const;
  bool agrees() const { return models_apart() <= kLifeModelsAgree; }
};

/// Both models through a duty cycle; rows are computed side by side. A row whose computation fails
/// is left out and named.
/// @throws InputError where the case has no ratings or a row is none it can have; ComputationError
///         where every row fails
LifeStudy life_study(const Case& the_case, const DutyCycle& duty,
                     const study::PartProgress& progress_of = study::silent());

}  // namespace bentaxis::designs
