// The pump in space as the page gets it: bodies stand and loads act where docs/theory.md has them,
// read back from the page's own block.
#include "bentaxis/study/pump_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "bentaxis/analytic/body_loads.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/comparison_document.h"
#include "bentaxis/study/plausibility_section.h"
#include "bentaxis/study/pump_picture.h"
#include "bentaxis/study/simulation.h"
#include "bentaxis/study/simulation_document.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Json = nlohmann::json;

// Channels and numbers are exact in the block, series are floats.
constexpr double kExact = 1e-12;
constexpr double kFloat = 1e-6;

Vector3d vector(const Json& json) {
  return Vector3d(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
}

std::vector<float> floats(const std::string& base64) {
  static const std::string kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t held = 0;
  int bits = 0;
  for (const char digit : base64) {
    if (digit == '=') break;
    held = held << 6 | static_cast<std::uint32_t>(kDigits.find(digit));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(held >> bits));
  }
  std::vector<float> values;
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4)
    values.push_back(std::bit_cast<float>(bytes[i] | std::uint32_t{bytes[i + 1]} << 8 |
                                          std::uint32_t{bytes[i + 2]} << 16 |
                                          std::uint32_t{bytes[i + 3]} << 24));
  return values;
}

// The block as a program reads it that knows its format alone.
class Reader {
 public:
  Reader(const report::Scene& scene, std::vector<const ResultTable*> tables,
         std::vector<double> axis)
      : json(Json::parse(report::compact_json(scene))),
        tables_(std::move(tables)),
        axis_(std::move(axis)) {
    for (const Json& one : json["series"]) {
      series_.push_back(floats(one));
      EXPECT_EQ(series_.back().size(), json["rows"].get<std::size_t>());
    }
  }

  double scalar(const Json& one, std::size_t row, std::size_t model) const {
    if (one.is_number()) return one;
    const Json& source = one[2];
    double value = 0;
    if (source.is_number())
      value = series_.at(source.get<std::size_t>()).at(row);
    else if (source == "theta_deg")
      value = axis_.at(row);
    else
      value = tables_.at(model)->at(row, tables_[model]->find(source));
    return one[0].get<double>() + one[1].get<double>() * value;
  }
  Vector3d sum(const Json& terms, std::size_t row, std::size_t model) const {
    Vector3d whole = Vector3d::Zero();
    for (const Json& term : terms) whole += scalar(term[3], row, model) * vector(term);
    return whole;
  }
  Vector3d place(const Json& one, std::size_t row, std::size_t model) const {
    Vector3d at = sum(one["at"], row, model);
    if (!one.contains("body")) return at;
    const auto [origin, axes] = stand(one["body"], row);
    return origin + axes * at;
  }
  // Where a body's origin is, and its axes, in S1.
  std::pair<Vector3d, Matrix3d> stand(const std::string& name, std::size_t row) const {
    for (const Json& body : json["bodies"]) {
      if (body["name"] != name) continue;
      Matrix3d axes;
      for (int i = 0; i < 3; ++i) axes.col(i) = vector(body["axes"][i]);
      if (body.contains("turns"))
        return {vector(body["origin"]),
                axes * Eigen::AngleAxisd(scalar(body["turns"], row, 0), Vector3d::UnitZ())};
      if (!body.contains("from")) return {vector(body["origin"]), axes};
      const Vector3d from = place(body["from"], row, 0);
      const Vector3d to = place(body["to"], row, 0);
      // Turned the shortest way from z.
      const Vector3d axis = Vector3d::UnitZ().cross(to - from);
      const double angle = std::atan2(axis.norm(), (to - from).z());
      return {from,
              Eigen::AngleAxisd(angle, axis.norm() > 0 ? axis.normalized() : Vector3d::UnitX())
                  .toRotationMatrix()};
    }
    ADD_FAILURE() << "no body " << name;
    return {};
  }
  const Json& load(const std::string& id) const {
    for (const Json& one : json["loads"])
      if (one["id"] == id) return one;
    ADD_FAILURE() << "no load " << id;
    static const Json kNone;
    return kNone;
  }
  // Of a load's list, one per model or one for all.
  static const Json& of(const Json& list, std::size_t model) {
    return list.size() == 1 ? list[0] : list[model];
  }

  Json json;

 private:
  std::vector<const ResultTable*> tables_;
  std::vector<double> axis_;
  std::vector<std::vector<float>> series_;
};

// Points and axes of docs/theory.md, section Kinematics, in S1.
struct Theory {
  Theory(const Geometry& geometry, double shaft, double block, int k) : g(geometry) {
    const double theta = shaft - 2 * kPi * (k - 1) / g.pistons;
    const double psi = block - 2 * kPi * (k - 1) / g.pistons;
    const double c = std::cos(g.tilt), s = std::sin(g.tilt);
    turn << 1, 0, 0, 0, c, s, 0, -s, c;
    o2 = {0, 0, g.axis_offset};
    a = {-g.joint_circle_radius * std::sin(theta), g.joint_circle_radius * std::cos(theta), 0};
    const Vector3d a2 = turn.transpose() * (a - o2);
    Vector3d b2(-g.bore_circle_radius * std::sin(psi), g.bore_circle_radius * std::cos(psi), 0);
    const double u2 = std::pow(b2.x() - a2.x(), 2) + std::pow(b2.y() - a2.y(), 2);
    b2.z() = a2.z() + std::sqrt(g.piston_length * g.piston_length - u2);
    b = turn * b2 + o2;
  }
  const Geometry& g;
  Matrix3d turn;  // from S2 to S1
  Vector3d o2, a, b;
};

// All that stands and acts at a row against the tables; of a turn at constant speed.
void expect_theory(const Reader& scene, const Case& the_case,
                   const std::vector<const ResultTable*>& tables, std::size_t row) {
  const PumpParameters& p = the_case.pump;
  const double theta = radians(tables[0]->theta_deg[row]);
  // A universal joint and pistons let the block stand apart from the shaft.
  const std::size_t own = tables[0]->find("psi_deg");
  const double psi = own < tables[0]->columns() ? radians(tables[0]->at(row, own)) : theta;
  const double size = p.geometry.piston_length;
  const auto near = [&](const Vector3d& found, const Vector3d& wanted, double scale,
                        const std::string& what) {
    EXPECT_LE((found - wanted).norm(), scaled(kExact) * scale)
        << what << " at row " << row << ": " << found.transpose() << ", not " << wanted.transpose();
  };
  for (std::size_t model = 0; model < tables.size(); ++model) {
    const ResultTable& table = *tables[model];
    const auto value = [&](const std::string& name) { return table.at(row, table.find(name)); };
    const auto force = [&](const std::string& id) {
      return scene.sum(Reader::of(scene.load(id)["force"], model), row, model);
    };
    const auto at = [&](const std::string& id) {
      return scene.place(Reader::of(scene.load(id)["at"], model), row, model);
    };
    for (int k = 1; k <= p.geometry.pistons; ++k) {
      const std::string n = std::to_string(k);
      const Theory points(p.geometry, theta, psi, k);
      const auto [origin, axes] = scene.stand("piston " + n, row);
      near(origin, points.a, size, "A" + n);
      near(axes.col(2), (points.b - points.a).normalized(), 1, "axis of piston " + n);
      near(at("Rs_" + n), points.a, size, "place of Rs");
      near(at("Rs_" + n + ".shaft"), points.a, size, "place of Rs on the shaft");
      const double contact = p.piston.contact.value_or(size) / size;
      near(at("Rc_" + n), points.a + contact * (points.b - points.a), size, "place of Rc");
      const Vector3d rs =
          points.turn * Vector3d(value("Rs_" + n + "_x2_N"), value("Rs_" + n + "_y2_N"),
                                 value("Rs_" + n + "_z2_N"));
      const Vector3d rc =
          points.turn * Vector3d(value("Rc_" + n + "_x2_N"), value("Rc_" + n + "_y2_N"), 0);
      near(force("Rs_" + n), rs, table.peak("Rs"), "Rs");
      near(force("Rs_" + n + ".shaft"), -rs, table.peak("Rs"), "Rs on the shaft");
      near(force("Rc_" + n), rc, table.peak("Rc"), "Rc");
      near(force("Rc_" + n + ".block"), -rc, table.peak("Rc"), "Rc on the block");
    }
    const Theory points(p.geometry, theta, psi, 1);
    const auto in_s2 = [&](double x, double y, double z) -> Vector3d {
      return points.turn * Vector3d(x, y, z);
    };
    near(force("Fh"), in_s2(0, 0, value("Fh_z2_N")), table.peak("Fh"), "Fh");
    near(force("Rcn"), in_s2(value("Rcn_x2_N"), value("Rcn_y2_N"), 0), table.peak("Rcn"), "Rcn");
    near(at("Rcn"), points.o2 + in_s2(0, 0, p.block.pin_z), size, "place of Rcn");
    near(force("Rb1"), {value("Rb1_x1_N"), value("Rb1_y1_N"), value("Rb1_z1_N")}, table.peak("Rb1"),
         "Rb1");
    near(at("Rb1"), {0, 0, p.bearings.tapered_z}, size, "C1");
    near(force("Rb2"), {value("Rb2_x1_N"), value("Rb2_y1_N"), 0}, table.peak("Rb2"), "Rb2");
    near(at("Rb2"), {0, 0, p.bearings.cylindrical_z}, size, "C2");
    near(scene.sum(Reader::of(scene.load("Td")["moment"], model), row, model),
         {0, 0, value("Td_z1_Nm")}, table.peak("Td"), "Td");
    if (p.transfer.is_joint())
      near(scene.sum(Reader::of(scene.load("Tcs")["moment"], model), row, model),
           in_s2(value("Tcs_x2_Nm"), value("Tcs_y2_Nm"), value("Tcs_z2_Nm")), table.peak("Tcs"),
           "Tcs");
    if (p.transfer.kind == TransferKind::double_cardan) {
      near(force("Fcs"), in_s2(value("Fcs_x2_N"), value("Fcs_y2_N"), value("Fcs_z2_N")),
           table.peak("Fcs"), "Fcs");
      near(at("Fcs"), points.o2, size, "place of Fcs");
    }
    if (p.transfer.kind == TransferKind::pistons)
      for (int k = 1; k <= p.geometry.pistons; ++k) {
        const std::string n = std::to_string(k);
        const Theory of(p.geometry, theta, psi, k);
        near(force("Rw_" + n), in_s2(value("Rw_" + n + "_x2_N"), value("Rw_" + n + "_y2_N"), 0),
             table.peak("Rw"), "Rw");
        near(at("Rw_" + n), of.a + p.transfer.wall->from_joint / size * (of.b - of.a), size,
             "D" + n);
      }
    if (p.transfer.kind == TransferKind::gear && p.gear.contact == ToothContact::rigid &&
        p.gear.flanks == Flanks::one && the_case.analytic.gear == BlockDrive::mesh &&
        table.peak("Rcs") > 0) {
      const double half = p.geometry.tilt / 2, sign = the_case.operation.speed_rpm < 0 ? -1 : 1;
      const double across = std::sin(p.gear.pressure_angle);
      const Vector3d k4 = sign * Vector3d(-std::cos(p.gear.pressure_angle), across * std::sin(half),
                                          across * std::cos(half));
      near(force("Rcs"), value("Rcs_z4_N") * k4, table.peak("Rcs"), "Rcs");
      near(force("Rcs.shaft"), -value("Rcs_z4_N") * k4, table.peak("Rcs"), "Rcs on the shaft");
      near(at("Rcs"),
           {0, p.gear.pitch_diameter / 2,
            p.geometry.axis_offset - p.gear.pitch_diameter / 2 * std::tan(half)},
           size, "O4");
    }
    // Where Fh acts, where it is shown: on its line.
    const Vector3d off =
        points.turn.transpose() * (scene.place(scene.json["film_point"], row, model) - points.o2);
    near({off.x(), off.y(), 0}, {value("xh_x2_mm") * 1e-3, value("yh_y2_mm") * 1e-3, 0}, size,
         "film point");
  }
}

// Forces and moments of all loads on each body, as the page adds them.
void expect_balance(const Reader& scene, std::size_t models, std::size_t row) {
  for (std::size_t model = 0; model < models; ++model) {
    struct Sum {
      Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
      double forces = 0, moments = 0;
    };
    std::map<std::string, Sum> sums;
    for (const Json& load : scene.json["loads"]) {
      Sum& sum = sums[load["on"]];
      const Vector3d at = scene.place(Reader::of(load["at"], model), row, model);
      if (load.contains("force")) {
        const Vector3d f = scene.sum(Reader::of(load["force"], model), row, model);
        sum.force += f;
        sum.moment += at.cross(f);
        sum.forces += f.norm();
        sum.moments += at.norm() * f.norm();
      }
      if (load.contains("moment")) {
        const Vector3d m = scene.sum(Reader::of(load["moment"], model), row, model);
        sum.moment += m;
        sum.moments += m.norm();
      }
    }
    for (const auto& [body, sum] : sums) {
      EXPECT_LE(sum.force.norm(), scaled(kFloat) * sum.forces) << body << " at row " << row;
      EXPECT_LE(sum.moment.norm(), scaled(kFloat) * sum.moments) << body << " at row " << row;
    }
  }
}

Case shipped_case(const std::string& name) {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / (name + ".toml"));
}

std::optional<report::Scene> alone(const Case& the_case) {
  return study::scene_of(study::describe(the_case));
}

void expect_scene_of(Case the_case) {
  SCOPED_TRACE(the_case.name);
  the_case.operation.samples_per_revolution = 45;
  study::ComparisonOptions options;
  options.loads = true;
  const study::ComparisonResult r = study::compare_models(std::move(the_case), {}, options);
  const report::Document document = study::comparison_document(r, {}, study::describe(r));
  ASSERT_TRUE(document.scene);
  const std::vector<const ResultTable*> tables = {&r.analytic, &r.multibody};
  const Reader scene(*document.scene, tables, r.analytic.theta_deg);
  EXPECT_EQ(scene.json["models"], Json({"analytic", "multibody"}));
  EXPECT_EQ(scene.json["sums"].size(), r.first.the_case.pump.geometry.pistons + 2u);
  std::set<std::string> ids;
  for (const Json& load : scene.json["loads"])
    EXPECT_TRUE(ids.insert(load["id"]).second) << load["id"] << " twice";
  for (std::size_t row = 0; row < r.analytic.rows(); row += 4) {
    expect_theory(scene, r.first.the_case, tables, row);
    expect_balance(scene, 2, row);
  }
}

TEST(PumpScene, StandsAndActsAsInTheTables) {
  for (const char* name :
       {"bap63_rated", "bap63_as_compared_in_the_paper", "bap63_teeth", "bap63_constant_velocity",
        "bap63_cardan", "bap63_double_cardan", "bap63_tapered_pistons"})
    expect_scene_of(shipped_case(name));
  for (const std::string& name : reference_cases()) expect_scene_of(reference_case(name));
}

TEST(PumpScene, LoadLeftOutShowsInTheSums) {
  Case the_case = shipped_case("bap63_rated");
  the_case.operation.samples_per_revolution = 12;
  const Samples samples = one_turn(the_case);
  const ResultTable table = analytic::run(the_case, the_case.analytic, samples);
  const BodyLoadTable all = analytic::run_body_loads(the_case, the_case.analytic, samples);
  BodyLoadTable loads;
  for (std::size_t row = 0; row < all.rows(); ++row) {
    std::vector<BodyLoad> some = all.row(row);
    for (BodyLoad& load : some)
      if (load.symbol == "Fm" && load.on == "block") load.force = {};
    loads.append(some);
  }
  const report::Scene scene = study::pump_scene(the_case, {{table, loads}});
  for (const report::SceneSum& sum : scene.sums)
    EXPECT_EQ(sum.force_over_sum[0] > 1e-6, sum.body == "block") << sum.body;
}

// One that keeps its curves, whatever the document's are.
TEST(PumpScene, AloneBringsItsCurves) {
  const auto scene = alone(shipped_case("bap63_rated"));
  ASSERT_TRUE(scene);
  ASSERT_TRUE(scene->curves);
  EXPECT_EQ(scene->rows, 120u);
  EXPECT_EQ(scene->curves->theta_deg.size(), 120u);
  EXPECT_EQ(scene->models, std::vector<std::string>{"analytic"});
  const Json json = Json::parse(report::compact_json(*scene));
  std::set<std::string> named;
  for (const Json& load : json["loads"])
    for (const Json& vector : load.value("force", Json::array()))
      for (const Json& term : vector)
        if (term[3].is_array() && term[3][2].is_string()) named.insert(term[3][2]);
  EXPECT_GT(named.size(), 20u);
  for (const std::string& name : named)
    EXPECT_TRUE(json["curves"]["tables"][0]["columns"].contains(name)) << name;
}

// Fh's path is drawn closer than few rows have it, and each row is on it: every N-th of a turn
// repeats.
TEST(PumpScene, FilmPathIsDenseAndHasEveryRow) {
  for (const char* name : {"bap63_rated", "bap63_as_compared_in_the_paper"}) {
    const Case the_case = shipped_case(name);
    const auto scene = alone(the_case);
    ASSERT_TRUE(scene) << name;
    const Reader reader(*scene, {}, scene->curves->theta_deg);
    const auto& columns = scene->curves->tables.at(0).columns;
    const auto column = [&](const std::string& wanted) -> const report::Values& {
      for (const auto& [key, values] : columns)
        if (key == wanted) return values;
      throw std::runtime_error(wanted);
    };
    const report::Values &x = column("xh_x2_mm"), &y = column("yh_y2_mm");
    ASSERT_EQ(x.size(), 120U);
    std::size_t points = 0;
    for (const Json& piece : reader.json["film_path"]) points += piece.size();
    EXPECT_GE(points, 288U) << name;
    for (std::size_t row = 0; row < x.size(); ++row) {
      double nearest = HUGE_VAL;
      for (const Json& piece : reader.json["film_path"])
        for (const Json& point : piece)
          nearest = std::min(nearest, std::hypot(point[0].get<double>() - x[row] * 1e-3,
                                                 point[1].get<double>() - y[row] * 1e-3));
      EXPECT_LE(nearest, 1e-9) << name << ", row " << row;  // it is rounded to the nanometre
    }
  }
}

TEST(PumpScene, ComputesThePressureThatItNeeds) {
  const Case hydraulic = shipped_case("bap63_rated_hydraulic");
  const auto scene = alone(hydraulic);
  const auto prepared = alone(study::prepare(hydraulic).the_case);
  ASSERT_TRUE(scene && prepared);
  EXPECT_EQ(report::compact_json(*scene), report::compact_json(*prepared));
  // Without a periodic state there is none.
  Case standing = hydraulic;
  standing.operation.speed_rpm = 0;
  EXPECT_FALSE(alone(standing));
}

TEST(CaseDescription, FailureIsAWarningOfTheReport) {
  Case standing = shipped_case("bap63_rated_hydraulic");
  standing.operation.speed_rpm = 0;
  const study::CaseDescription description = study::describe(standing);
  report::Document document;
  study::put_description(document, description);
  EXPECT_FALSE(document.scene);
  ASSERT_EQ(document.warnings.value().size(), 1U);
  EXPECT_EQ(document.warnings->front().name, "description-incomplete");
  EXPECT_THAT(document.warnings->front().text,
              testing::AllOf(testing::HasSubstr("the chamber pressure of the pump in space"),
                             testing::HasSubstr(description.failed.at(0).reason)));
  document = {};
  study::put_description(document, study::describe(shipped_case("bap63_rated")));
  EXPECT_TRUE(document.scene);
  EXPECT_FALSE(document.warnings);
}

// Where the oil is to be solved a user who stops waits no longer than elsewhere.
TEST(CaseDescription, EndsWhenInterrupted) {
  const study::PartProgress stop = [](const std::string&) {
    return Progress([](double) { throw Interrupted(); });
  };
  EXPECT_THROW(study::describe(shipped_case("bap63_rated_hydraulic"), stop), Interrupted);
}

TEST(CaseDescription, HasWhatTheStudyDoesNotCompute) {
  const Case rated = shipped_case("bap63_rated");
  const auto parts = [&](const Case& the_case, study::Described what) {
    const study::CaseDescription found = study::describe(the_case, study::silent(), what);
    EXPECT_TRUE(found.failed.empty());
    EXPECT_GT(found.plausibility.displacement, 0);
    return std::pair(found.turn.has_value(), found.film_path.has_value());
  };
  EXPECT_EQ(parts(rated, study::Described::all), std::pair(true, true));
  EXPECT_EQ(parts(rated, study::Described::without_turn), std::pair(false, true));
  EXPECT_EQ(parts(rated, study::Described::inputs), std::pair(false, false));
  EXPECT_EQ(parts(shipped_case("bap63_teeth"), study::Described::all), std::pair(true, false));
}

TEST(PumpScene, ShaftAndBlockStandAsSimulated) {
  Case the_case = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" /
                            "motion" / "rattle" / "case.toml");
  study::SimulationChoice choice;
  choice.only = study::Model::analytic;
  const study::SimulationResult r =
      study::simulate(study::prepare_simulation(the_case, choice), choice);
  const report::Document document = study::simulation_document(r, {}, {});
  ASSERT_TRUE(document.scene);
  ASSERT_FALSE(document.scene->curves) << "choose a shorter case: this one is thinned";
  const ResultTable& table = r.analytic->table.results;
  const Reader scene(*document.scene, {&table}, {});
  const Geometry& g = the_case.pump.geometry;
  double apart = 0;
  for (std::size_t row = 0; row < table.rows(); row += 7) {
    const double theta = radians(r.analytic->table.state(row, 1));
    const double psi = theta - r.analytic->lag[row];
    apart = std::max(apart, std::abs(theta - psi));
    for (int k = 1; k <= g.pistons; ++k) {
      const Theory points(g, theta, psi, k);
      const auto [origin, axes] = scene.stand("piston " + std::to_string(k), row);
      EXPECT_LE((origin - points.a).norm(), scaled(kFloat) * g.piston_length);
      EXPECT_LE((axes.col(2) - (points.b - points.a).normalized()).norm(), scaled(kFloat));
    }
    expect_balance(scene, 1, row);
  }
  EXPECT_GT(apart, 0);
}

TEST(PumpScene, ManyRowsAreThinned) {
  Case the_case = shipped_case("bap63_rated");
  the_case.operation.samples_per_revolution = 3 * 1440;
  const Samples samples = one_turn(the_case);
  const ResultTable table = analytic::run(the_case, the_case.analytic, samples);
  const BodyLoadTable loads = analytic::run_body_loads(the_case, the_case.analytic, samples);
  const report::Scene scene = study::pump_scene(the_case, {{table, loads}});
  ASSERT_TRUE(scene.curves);
  ASSERT_EQ(scene.rows, 1440u);
  ASSERT_EQ(scene.curves->theta_deg.size(), 1440u);
  EXPECT_EQ(scene.curves->theta_deg[7], table.theta_deg[21]);
  const report::Values* pressure = report::find(scene.curves->tables[0].columns, "p_1_bar");
  ASSERT_NE(pressure, nullptr);
  EXPECT_EQ(pressure->at(700), table.at(2100, table.find("p_1_bar")));
}

// What stands where is said by the case: seats on the joints' circle and bores on theirs, where
// pistons are at theta = 0; ports between their radii and angles.
TEST(PumpScene, SeatsBoresAndPortsAreWhereTheCaseSays) {
  const Case the_case = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml");
  const auto scene = alone(the_case);
  ASSERT_TRUE(scene);
  const auto prisms = [&](const std::string& body) {
    std::vector<report::Prism> found;
    for (const report::SceneBody& b : scene->bodies)
      if (b.name == body)
        for (const report::Shape& shape : b.shapes)
          if (const auto* prism = std::get_if<report::Prism>(&shape.form)) found.push_back(*prism);
    return found;
  };
  using Hole = std::vector<std::array<double, 2>>;
  const auto expect_circle = [](const Hole& hole, double x, double y, double radius) {
    double mean_x = 0, mean_y = 0;
    for (const auto& point : hole) {
      mean_x += point[0] / static_cast<double>(hole.size());
      mean_y += point[1] / static_cast<double>(hole.size());
      EXPECT_NEAR(std::hypot(point[0] - x, point[1] - y), radius, 1e-12);
    }
    EXPECT_NEAR(mean_x, x, 1e-12);
    EXPECT_NEAR(mean_y, y, 1e-12);
  };
  // Piston k + 1 is 72 k degrees behind the first, which is at y = R.
  std::vector<std::array<double, 2>> at;
  for (int k = 0; k < 5; ++k) at.push_back({std::sin(radians(72 * k)), std::cos(radians(72 * k))});
  std::vector<Hole> bores, seats;
  for (const report::Prism& prism : prisms("block"))
    bores.insert(bores.end(), prism.holes.begin(), prism.holes.end());
  for (const report::Prism& prism : prisms("shaft"))
    seats.insert(seats.end(), prism.holes.begin(), prism.holes.end());
  ASSERT_EQ(bores.size(), 5U);
  ASSERT_EQ(seats.size(), 5U);
  const double seat = std::hypot(seats[0][0][0], seats[0][0][1] - 0.02492);
  EXPECT_GT(seat, 0.004);
  for (std::size_t k = 0; k < 5; ++k) {
    expect_circle(bores[k], 0.022 * at[k][0], 0.022 * at[k][1],
                  the_case.pump.geometry.bore_diameter / 2);
    expect_circle(seats[k], 0.02492 * at[k][0], 0.02492 * at[k][1], seat);
  }
  // Angles about z from y on, of delivery and of suction.
  const std::vector<Hole> ports = prisms("plate").at(0).holes;
  ASSERT_EQ(ports.size(), 2U);
  const std::array<std::array<double, 2>, 2> arcs = {{{189, 345}, {12, 168}}};
  for (std::size_t port = 0; port < 2; ++port) {
    double least = 1e9, most = -1e9, inner = 1e9, outer = 0;
    for (const auto& [x, y] : ports[port]) {
      double angle = std::atan2(-x, y) * 180 / kPi;
      if (angle < 0) angle += 360;
      least = std::min(least, angle);
      most = std::max(most, angle);
      inner = std::min(inner, std::hypot(x, y));
      outer = std::max(outer, std::hypot(x, y));
    }
    EXPECT_NEAR(least, arcs[port][0], 1e-9);
    EXPECT_NEAR(most, arcs[port][1], 1e-9);
    EXPECT_NEAR(inner, 0.019, 1e-12);
    EXPECT_NEAR(outer, 0.0242, 1e-12);
  }
}

// What turns the block is drawn, and nothing else: no gear of a pump that has none.
TEST(PumpScene, ShowsTheTransferOfThePump) {
  const std::pair<const char*, const char*> kWords[] = {
      {"bap63_rated", "gears are their pitch cones"},
      {"bap63_constant_velocity", "the constant-velocity joint is drawn"},
      {"bap63_cardan", "the arms of both forks"},
      {"bap63_double_cardan", "the arms in the forks of shaft and block"},
      {"bap63_tapered_pistons", "the sphere that touches the wall"}};
  for (const auto& [name, words] : kWords) {
    SCOPED_TRACE(name);
    const Case the_case = shipped_case(name);
    const bool gear = std::string(name) == "bap63_rated";
    const auto scene = alone(the_case);
    ASSERT_TRUE(scene);
    EXPECT_NE(scene->note.find(words), std::string::npos) << scene->note;
    EXPECT_EQ(scene->note.find("gear") != std::string::npos, gear);
    const bool has_s4 = std::any_of(scene->frames.begin(), scene->frames.end(),
                                    [](const auto& frame) { return frame.first == "S4"; });
    EXPECT_EQ(has_s4, gear);
    const std::string picture = study::pump_picture(the_case);
    EXPECT_EQ(picture.find("pitch circle") != std::string::npos, gear);
    EXPECT_EQ(picture.find("O4") != std::string::npos, gear);
    EXPECT_EQ(picture.find(">D<") != std::string::npos,
              std::string(name) == "bap63_tapered_pistons");
    EXPECT_EQ(picture.find("joint at O2") != std::string::npos, the_case.pump.transfer.is_joint());
  }
}

// Both arms of a universal joint stay at right angles all round.
TEST(PumpScene, ArmsOfAUniversalJointStayAtRightAngles) {
  Case the_case = shipped_case("bap63_cardan");
  the_case.pump.transfer.cardan->phase = radians(25);
  the_case.operation.samples_per_revolution = 36;
  study::ComparisonOptions options;
  options.loads = true;
  const study::ComparisonResult r = study::compare_models(the_case, {}, options);
  const report::Document document = study::comparison_document(r, {}, study::describe(r));
  ASSERT_TRUE(document.scene);
  const Reader scene(*document.scene, {&r.analytic, &r.multibody}, r.analytic.theta_deg);
  std::map<std::string, Vector3d> arms;
  for (const Json& body : scene.json["bodies"])
    for (const Json& shape : body["shapes"])
      if (shape.contains("wire") && shape["look"] == "gear") {
        const Json& p = shape["wire"]["points"];
        arms[body["name"]] = vector({p[3], p[4], p[5]}) - vector({p[0], p[1], p[2]});
      }
  ASSERT_EQ(arms.size(), 2U);
  for (std::size_t row = 0; row < r.analytic.rows(); ++row) {
    const Vector3d shaft = scene.stand("shaft", row).second * arms["shaft"].normalized();
    const Vector3d block = scene.stand("block", row).second * arms["block"].normalized();
    EXPECT_NEAR(shaft.dot(block), 0, 1e-6) << row;
  }
}

// Shapes of any pump: finite, and meshes of corners that there are.
TEST(PumpScene, ShapesOfOddPumps) {
  for (const std::string name : {"pistons_1", "pistons_15", "pump_of_1_mm", "pump_of_1_m",
                                 "tilt_89.9", "tilt_0", "offset_plus"}) {
    SCOPED_TRACE(name);
    const Case the_case = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" /
                                    "hard" / name / "case.toml");
    const auto scene = alone(the_case);
    ASSERT_TRUE(scene);
    const std::string text = report::compact_json(*scene);
    const Json json = Json::parse(text);
    EXPECT_GT(json["radius"], 0);
    for (const Json& body : json["bodies"])
      for (const Json& shape : body["shapes"]) {
        EXPECT_EQ(shape.dump().find("null"), std::string::npos) << shape.dump();
        if (!shape.contains("mesh")) continue;
        const std::size_t points = shape["mesh"]["points"].size() / 3;
        for (const Json& corner : shape["mesh"]["triangles"])
          EXPECT_LT(corner.get<std::size_t>(), points);
      }
  }
}

}  // namespace
}  // namespace bentaxis::test
