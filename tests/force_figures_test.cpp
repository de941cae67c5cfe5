// Diagrams of forces: what is drawn are the forces of the tables, and polygons close.
#include "bentaxis/study/force_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/body_loads.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/samples.h"

namespace bentaxis::study {
namespace {

using report::DrawingFigure;
using report::OwnFigure;

struct Turn {
  explicit Turn(const std::string& name, int samples = 72) : the_case(read(name, samples)) {
    const Samples at = sample_case(the_case, PressureTrace(the_case.pressure));
    table = analytic::run(the_case, the_case.analytic, at);
    loads = analytic::run_body_loads(the_case, the_case.analytic, at);
  }
  static Case read(const std::string& name, int samples) {
    Case found = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/" + name + ".toml");
    found.operation.samples_per_revolution = samples;
    return found;
  }
  DiagramRun run() const { return {the_case, table, &loads}; }
  double at(std::size_t row, const std::string& channel) const {
    return table.at(row, table.find(channel));
  }

  Case the_case;
  ResultTable table;
  BodyLoadTable loads;
};

const report::Figure& find(const std::vector<report::Figure>& figures, const std::string& id) {
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [&](const report::Figure& figure) { return figure.id == id; });
  if (found == figures.end()) throw std::out_of_range(id);
  return *found;
}

// Where the last arrow of a panel ends; every other begins where the one before it ends.
std::array<double, 2> end_of(const DrawingFigure::Frame& frame, int panel) {
  std::array<double, 2> at = {0, 0};
  for (const DrawingFigure::Arrow& arrow : frame.arrows) {
    if (arrow.panel != panel) continue;
    EXPECT_EQ(arrow.x, at[0]);
    EXPECT_EQ(arrow.y, at[1]);
    at = {arrow.x + arrow.dx, arrow.y + arrow.dy};
  }
  return at;
}

double largest(const DrawingFigure::Frame& frame) {
  double most = 0;
  for (const auto& arrow : frame.arrows) most = std::max(most, std::hypot(arrow.dx, arrow.dy));
  return most;
}

TEST(ForceFigures, PolygonsAreTipToTailAndClosed) {
  for (const char* name : {"bap63_rated", "bap63_teeth"}) {
    const Turn turn(name);
    for (const auto& [id, panels] : {std::pair{"polygon_piston", 3}, {"polygon_block", 2}}) {
      const auto figure = find(force_figures(turn.run()), id);
      const auto& drawing = std::get<DrawingFigure>(figure.content);
      ASSERT_EQ(drawing.frames.size(), 18U) << name;
      for (const DrawingFigure::Frame& frame : drawing.frames)
        for (int panel = 0; panel < panels; ++panel)
          for (const double open : end_of(frame, panel))
            EXPECT_LE(std::abs(open), 1e-12 * largest(frame)) << name << " " << id;
    }
  }
}

// Of piston 1 across the block, (36) to (38) of the tables: Rs and Rc by their names.
TEST(ForceFigures, ThePolygonHoldsTheReactionsOfTheTable) {
  const Turn turn("bap63_rated");
  const auto figure = find(force_figures(turn.run()), "polygon_piston");
  EXPECT_EQ(figure.paper, "Fig. 14b");
  const auto& drawing = std::get<DrawingFigure>(figure.content);
  const DrawingFigure::Frame& frame = drawing.frames[drawing.shown];
  EXPECT_EQ(frame.theta_deg, 280);
  const auto arrow = [&](const std::string& label, int panel) {
    for (const auto& found : frame.arrows)
      if (found.panel == panel &&
          drawing.looks[static_cast<std::size_t>(found.look)].label == label)
        return found;
    throw std::out_of_range(label);
  };
  const std::size_t row = 56;  // of 72
  for (const auto& [label, quantity] : {std::pair{"Rs by shaft", "Rs"}, {"Rc by block", "Rc"}}) {
    const std::string stem = std::string(quantity) + "_1_";
    EXPECT_NEAR(arrow(label, 2).dx, turn.at(row, stem + "x2_N"), 1e-9) << label;
    EXPECT_NEAR(arrow(label, 2).dy, turn.at(row, stem + "y2_N"), 1e-9) << label;
  }
  EXPECT_NEAR(arrow("Rs by shaft", 0).dx, turn.at(row, "Rs_1_z2_N"), 1e-9);
  EXPECT_NEAR(arrow("Rs by shaft", 0).dy, turn.at(row, "Rs_1_x2_N"), 1e-9);
  // Only what is given comes before what has to be found.
  EXPECT_EQ(drawing.looks.front().label, "Fp by oil");
  EXPECT_EQ(drawing.looks.back().label, "Rs by shaft");
}

TEST(ForceFigures, ALoadLeftOutOpensThePolygon) {
  Turn turn("bap63_rated");
  for (std::size_t i = 0; i < turn.loads.loads.size(); ++i)
    if (turn.loads.loads[i].on == "piston 1" && turn.loads.loads[i].symbol == "Fpf")
      for (std::size_t row = 0; row < turn.loads.rows(); ++row)
        turn.loads.values[row * turn.loads.loads.size() + i].force = {};
  const auto figure = force_polygon(turn.run(), "piston 1", {{2, 0}}, 280);
  const auto& drawing = std::get<DrawingFigure>(figure.content);
  const DrawingFigure::Frame& frame = drawing.frames[drawing.shown];
  // Friction of 25 N along z2.
  EXPECT_NEAR(std::abs(end_of(frame, 0)[0]), 25, 1e-3);
  EXPECT_THAT(frame.text, testing::HasSubstr("open by 1.1e-03"));
}

TEST(ForceFigures, SharesAddUpToTheirSumAndToTheTables) {
  const Turn turn("bap63_rated");
  const auto figure = find(force_figures(turn.run()), "moment_shares");
  const auto& shares = std::get<OwnFigure>(figure.content);
  ASSERT_EQ(shares.stack.size(), 5U);
  for (std::size_t row = 0; row < turn.table.rows(); ++row) {
    double sum = 0;
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_EQ(shares.stack[k].values[row],
                turn.at(row, "Tc_" + std::to_string(k + 1) + "_z2_Nm"));
      sum += shares.stack[k].values[row];
    }
    EXPECT_EQ(shares.series.at(0).values[row], sum);
  }
}

TEST(ForceFigures, TheChamberSweepsTheDisplacement) {
  const Turn turn("bap63_rated");
  const auto figure = find(force_figures(turn.run()), "chamber");
  const auto& chamber = std::get<OwnFigure>(figure.content);
  const auto& volume = chamber.series.at(0).values;
  // A fifth of 63.71 cm3/rev, from 0 deg (least) to 180 deg.
  EXPECT_NEAR(volume[0], 0, 1e-3);
  EXPECT_NEAR(*std::max_element(volume.begin(), volume.end()), 63.71 / 5, 1e-3);
  ASSERT_TRUE(chamber.right);
  EXPECT_EQ(chamber.right->series.at(0).values[56], turn.at(56, "p_1_bar"));
}

TEST(ForceFigures, ToothForceIsOnOneFlankAtATime) {
  Turn turn("bap63_rated");
  const auto figures = force_figures(turn.run());
  const auto& flanks = std::get<OwnFigure>(find(figures, "tooth_flanks").content);
  for (std::size_t row = 0; row < turn.table.rows(); ++row) {
    const double plus = flanks.series[0].values[row], minus = flanks.series[1].values[row];
    EXPECT_EQ(std::min(plus, minus), 0);
    EXPECT_EQ(plus - minus, turn.at(row, "Rcs_z4_N"));  // of a pump that turns forwards
  }
  const auto imposed = [&] {
    Turn other = turn;
    for (std::size_t row = 0; row < other.table.rows(); ++row)
      other.table.values[row * other.table.columns() + other.table.find("Rcs_z4_N")] = std::nan("");
    return force_figures(other.run());
  }();
  EXPECT_THROW(find(imposed, "tooth_flanks"), std::out_of_range);
  EXPECT_THROW(find(force_figures(Turn("bap63_teeth", 36).run()), "tooth_flanks"),
               std::out_of_range);
}

TEST(ForceFigures, LociGoThroughTheForcesAtQuarters) {
  const Turn turn("bap63_rated");
  const auto figure = find(force_figures(turn.run()), "bearing_loci");
  const auto& loci = std::get<report::XyFigure>(figure.content);
  EXPECT_TRUE(loci.equal);
  ASSERT_EQ(loci.series.size(), 2U);
  for (const auto& [series, name] : {std::pair{0, "Rb1"}, {1, "Rb2"}}) {
    const auto& curve = loci.series[static_cast<std::size_t>(series)];
    ASSERT_EQ(curve.x.size(), 73U);  // a turn, closed
    EXPECT_EQ(curve.x.front(), curve.x.back());
    for (std::size_t row = 0; row < 72; ++row) {
      EXPECT_NEAR(curve.x[row], 1e-3 * turn.at(row, std::string(name) + "_x1_N"), 0.00051);
      EXPECT_NEAR(curve.y[row], 1e-3 * turn.at(row, std::string(name) + "_y1_N"), 0.00051);
    }
  }
  ASSERT_EQ(loci.points.size(), 9U);  // 0 and four quarters of both
  EXPECT_NEAR(loci.points[2].y, 1e-3 * turn.at(18, "Rb1_y1_N"), 1e-12);
}

TEST(ForceFigures, ThePlateShowsThePressuresOfChambersAndPorts) {
  const Turn turn("bap63_rated");
  const auto figure = find(force_figures(turn.run()), "plate_pressure");
  const auto& drawing = std::get<DrawingFigure>(figure.content);
  const Geometry& g = turn.the_case.pump.geometry;
  ASSERT_TRUE(drawing.shades);
  EXPECT_NEAR(drawing.shades->high, 275, 0.1);
  for (std::size_t i = 0; i < drawing.frames.size(); ++i) {
    const auto& frame = drawing.frames[i];
    const std::size_t row = 4 * i;  // 18 frames of 72 rows
    EXPECT_EQ(frame.theta_deg, turn.table.theta_deg[row]);
    for (int k = 0; k < 5; ++k) {
      const auto& bore = frame.lines[static_cast<std::size_t>(k)];
      EXPECT_EQ(bore.value, turn.at(row, "p_" + std::to_string(k + 1) + "_bar"));
      double x = 0, y = 0;  // of its middle
      for (std::size_t j = 0; j + 1 < bore.x.size(); ++j) {
        x += bore.x[j] / static_cast<double>(bore.x.size() - 1);
        y += bore.y[j] / static_cast<double>(bore.x.size() - 1);
      }
      const double psi = (frame.theta_deg - 72.0 * k) * 3.14159265358979 / 180;
      EXPECT_NEAR(x, -1e3 * g.bore_circle_radius * std::sin(psi), 1e-3);
      EXPECT_NEAR(y, 1e3 * g.bore_circle_radius * std::cos(psi), 1e-3);
    }
  }
  // Of either port: full pressure between r2 and r3, two lands in four steps that fall to 0.
  ASSERT_EQ(drawing.ground.size(), 19U);  // and the path of the film force
  for (std::size_t i = 0; i < 72; ++i) {
    EXPECT_NEAR(drawing.ground[18].x[i], turn.at(i, "xh_x2_mm"), 0.00051);
    EXPECT_NEAR(drawing.ground[18].y[i], turn.at(i, "yh_y2_mm"), 0.00051);
  }
  const auto value = [&](std::size_t ring) { return drawing.ground[ring].value.value() / 275; };
  EXPECT_NEAR(value(8), 1, 1e-3);
  for (std::size_t ring = 0; ring < 8; ++ring)
    EXPECT_NEAR(value(ring), 0.875 - 0.25 * static_cast<double>(ring % 4), 1e-3);
}

// In time nothing is said of angles of a turn.
TEST(ForceFigures, RunsInTimeHaveTimeAsTheirAxis) {
  const Turn turn("bap63_rated");
  DiagramRun run = turn.run();
  for (std::size_t row = 0; row < turn.table.rows(); ++row)
    run.time_ms.push_back(0.5 * static_cast<double>(row));
  run.block_deg = turn.table.theta_deg;
  run.constant_ports = false;
  const auto figures = force_figures(run);
  const auto& polygon = std::get<DrawingFigure>(find(figures, "polygon_piston").content);
  EXPECT_EQ(polygon.axis, "time (ms)");
  EXPECT_EQ(polygon.frames[1].theta_deg, 2);
  const auto& shares = std::get<OwnFigure>(find(figures, "moment_shares").content);
  EXPECT_FALSE(shares.angle);
  EXPECT_EQ(shares.x, run.time_ms);
  // Ports whose pressure changes in time are not drawn; the path of the film force is.
  EXPECT_EQ(std::get<DrawingFigure>(find(figures, "plate_pressure").content).ground.size(), 1U);
  EXPECT_EQ(std::get<report::XyFigure>(find(figures, "bearing_loci").content).points.size(), 1U);
}

}  // namespace
}  // namespace bentaxis::study
