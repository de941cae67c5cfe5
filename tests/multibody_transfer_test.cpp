// The multibody model of pumps whose block is turned by a joint or by tapered pistons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/files/csv.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/results/max_abs.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using multibody::Method;

std::filesystem::path transfer_file(const std::string& name) {
  return std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "transfers" / name;
}

// A stored case and its curves, of 20 digits.
struct Stored {
  explicit Stored(const std::string& name)
      : the_case(read_case(transfer_file(name + "/case.toml"))),
        curves(read_numeric_csv(transfer_file(name + "/reference.csv"))) {}

  // Largest difference of each group from the curves, and its peak there.
  struct Off {
    double difference = 0, peak = 0;
  };
  std::map<std::string, Off> differences(const ResultTable& table) const {
    std::map<std::string, Off> off;
    for (std::size_t c = 0; c < curves.header.size(); ++c) {
      if (curves.header[c] == "theta_deg") continue;
      const std::size_t at = table.find(curves.header[c]);
      if (at == table.columns()) {
        ADD_FAILURE() << "no column " << curves.header[c];
        continue;
      }
      Off& of = off[table.channels[at].group];
      for (std::size_t row = 0; row < table.rows(); ++row) {
        update_max_abs(of.difference, table.at(row, at) - curves.rows[row][c]);
        update_max_abs(of.peak, curves.rows[row][c]);
      }
    }
    return off;
  }

  Case the_case;
  NumericTable curves;
};

ResultTable turn(const Case& the_case, std::optional<Method> method = {}) {
  const PressureTrace pressure(the_case.pressure);
  return multibody::run_driven(the_case, the_case.multibody, sample_case(the_case, pressure), {},
                               multibody::Scene::full, method);
}

// A wall's force is a stiffness times a small difference of lengths: round-off of the lengths.
double wall_round_off(const PumpParameters& pump) {
  constexpr double kEps = 2.2e-16;
  return pump.transfer.wall
             ? 4 * kEps * pump.geometry.joint_circle_radius * pump.transfer.wall->stiffness
             : 0;
}

// Of the peak of each reaction.
constexpr double kDriven = 1e-10;

class StoredTurn : public testing::TestWithParam<std::pair<const char*, Method>> {};

TEST_P(StoredTurn, agrees_with_the_curves) {
  const Stored stored(GetParam().first);
  const ResultTable table = turn(stored.the_case, GetParam().second);
  for (const auto& [group, off] : stored.differences(table)) {
    if (std::getenv("BENTAXIS_SHOW_RESIDUALS") != nullptr)
      std::cout << group << " " << off.difference << " of " << off.peak << "\n";
    EXPECT_LE(off.difference, kDriven * off.peak + wall_round_off(stored.the_case.pump)) << group;
  }
}

INSTANTIATE_TEST_SUITE_P(Multibody, StoredTurn,
                         testing::Values(std::pair{"constant_velocity", Method::multipliers},
                                         std::pair{"constant_velocity", Method::residual},
                                         std::pair{"cardan", Method::multipliers},
                                         std::pair{"cardan", Method::residual},
                                         std::pair{"pistons_seven", Method::multipliers},
                                         std::pair{"pistons_seven", Method::residual}));

}  // namespace
}  // namespace bentaxis::test
