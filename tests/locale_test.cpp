// Numbers are read and written the same whatever locale the process has.
#include <gmock/gmock.h>

#include <cstdio>
#include <functional>
#include <string>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/comparison_document.h"
#include "bentaxis/study/friction_calibration.h"
#include "bentaxis/study/operating_points.h"
#include "bentaxis/study/pump_scene.h"
#include "comma_locale.h"
#include "support.h"

namespace bentaxis::test {
namespace {

Case rated() {
  Case c = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated.toml",
                     {"operation.samples_per_revolution=1_2", "pump.tilt_deg=+39.5e0"});
  return c;
}

// What the text is under a decimal comma, beside what it is without one.
void expect_same(const std::function<std::string()>& text) {
  const std::string usual = text();
  const CommaLocale locale;
  EXPECT_EQ(text(), usual);
}

// The locale is one that a number of the C library shows.
TEST(Locale, ChangesWhatTheCLibraryWrites) {
  const CommaLocale locale;
  char text[8];
  std::snprintf(text, sizeof text, "%.1f", 0.5);
  EXPECT_STREQ(text, "0,5");
  EXPECT_EQ(std::strtod("0.5", nullptr), 0);
}

TEST(Locale, LeavesNumbersForPeople) {
  const CommaLocale locale;
  EXPECT_EQ(rounded_text(3.4567), "3.46");
  EXPECT_EQ(rounded_down_text(3.4567), "3.45");
  EXPECT_EQ(rounded_up_text(-0.012345), "-0.0123");
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_in("0.1"), 0.1);
}

TEST(Locale, LeavesWhatACaseSays) {
  expect_same([] {
    std::string all = case_text(rated());
    for (const InputEntry& entry : rated().entries)
      all += entry.table + "." + entry.key + " = " + entry.value + "\n";
    return all;
  });
}

TEST(Locale, LeavesMessages) {
  const auto refused = [](const std::string& change) {
    return [change] {
      return refusal([&] {
        read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated.toml",
                  {change});
      });
    };
  };
  expect_same(refused("pump.piston_length_mm=12.5"));  // not to be assembled, with its lengths
  expect_same(refused("pump.tilt_deg=95.25"));
  expect_same([] {
    return refusal([] {
      read_input_file(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "README.md", {"a text", 2000});
    });
  });
}

TEST(Locale, LeavesReports) {
  expect_same([] {
    Case both = rated();
    both.pump.piston.contact = 0.9 * both.pump.geometry.piston_length;
    report::Document document = study::comparison_document(study::compare_models(both, both, {}),
                                                           {}, study::describe(both));
    for (report::ModelSection& model : *document.models) model.seconds = not_computed();
    return report::compact_json(document);
  });
}

TEST(Locale, LeavesShapesOfTheScene) {
  expect_same([] { return report::compact_json(*study::scene_of(study::describe(rated()))); });
}

TEST(Locale, LeavesCalibratedFriction) {
  Case c = rated();
  c.analytic.piston_friction = true;
  c.multibody.piston_friction = false;
  const study::PreparedCase ready = study::prepare(c);
  const auto torque = [&](study::Model model) {
    return study::mean(study::run_turn(ready, model, study::silent()), "Td_z1_Nm");
  };
  const study::MeanTorques wanted{torque(study::Model::analytic), torque(study::Model::multibody)};
  c.pump.friction.piston_coulomb *= 0.7;
  expect_same([&] {
    std::string all;
    for (const study::FrictionStep& step : study::calibrate_friction(c, wanted))
      all += number_text(step.piston_coulomb) + " " + number_text(step.torque_factor) + "\n";
    return all;
  });
}

}  // namespace
}  // namespace bentaxis::test
