// Reference data: reading, mapping, resampling and judging of stored curves, and printed numbers.
// Made-up tables with known answers; no model is run here.
#include "bentaxis/compare/reference.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bentaxis/compare/published.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/periodic_spline.h"
#include "bentaxis/report/document.h"
#include "bentaxis/report/junit.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using namespace compare;
using testing::HasSubstr;
namespace fs = std::filesystem;

// What a curve in 17 digits loses by a unit conversion: a few units of round-off.
constexpr double kConversion = 1e-15;

Channel channel(const std::string& name, const std::string& group, const std::string& unit) {
  Channel c;
  c.name = name;
  c.quantity = c.group = group;
  c.unit = unit;
  c.unit_in_si = unit == "mm" ? 1e-3 : unit == "bar" ? 1e5 : 1;
  return c;
}

const std::vector<Channel> kChannels = {channel("X_x_N", "X", "N"), channel("X_y_N", "X", "N"),
                                        channel("T_Nm", "T", "Nm")};

double wave(double deg, int order, double phase_deg = 0) {
  return std::cos(order * radians(deg - phase_deg));
}
double x_of(double deg) { return 100 * wave(deg, 3) + 20 * wave(deg, 1, 30); }
double y_of(double deg) { return 80 * wave(deg, 2, 17) + 10; }
double t_of(double deg) { return 50 + 5 * wave(deg, 5); }

ResultTable result_at(const std::vector<double>& theta_deg) {
  ResultTable t;
  t.name = "model";
  t.channels = kChannels;
  t.theta_deg = theta_deg;
  for (const double deg : theta_deg)
    for (const double value : {x_of(deg), y_of(deg), t_of(deg)}) t.values.push_back(value);
  return t;
}

std::vector<double> angles(int samples) {
  std::vector<double> all;
  for (int i = 0; i < samples; ++i) all.push_back(360.0 * i / samples);
  return all;
}

ResultTable result(int samples) { return result_at(angles(samples)); }

std::string thrown(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing";
}

class ReferenceFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bentaxis_reference_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    write("case.toml", "");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  // A description with one curve file; `more` belongs to the curve.
  ReferenceDescription description(int points, const std::string& more = "",
                                   const std::string& tolerance = "relative = 1e-9",
                                   const std::string& kind = "external") const {
    write("description.toml", "schema = 1\nkind = \"" + kind +
                                  "\"\ncase = \"case.toml\"\nsource = \"s\"\nhow_made = \"h\"\n"
                                  "who_may_change = \"w\"\ndigits = 12\n[tolerance]\n" +
                                  tolerance + "\n[[curve]]\nfile = \"curve.csv\"\npoints = " +
                                  std::to_string(points) + "\n" + more);
    return read_description(folder_, "r");
  }
  ReferenceCurve curve(const ReferenceDescription& d) const {
    return read_reference_curve(d, d.curves.at(0), kChannels, 9000);
  }
  static Finding finding(const Judgement& judgement, const std::string& name) {
    for (const auto& c : judgement.channels)
      if (c.comparison.channel.name == name) return c.finding;
    throw std::logic_error(name);
  }
  static std::string hint(const Judgement& judgement, const std::string& name) {
    for (const auto& c : judgement.channels)
      if (c.comparison.channel.name == name) return c.hint;
    throw std::logic_error(name);
  }

  // A curve file of all three channels as functions of its own angle.
  void write_curve(int rows, const std::function<std::array<double, 4>(double)>& row,
                   const std::string& header = "theta_deg,X_x_N,X_y_N,T_Nm") const {
    std::string text = header + "\n";
    for (int i = 0; i < rows; ++i) {
      const auto values = row(360.0 * i / rows);
      for (std::size_t c = 0; c < values.size(); ++c) {
        if (c > 0) text += ',';
        append_number(text, values[c]);
      }
      text += '\n';
    }
    write("curve.csv", text);
  }
  void write_plain(int rows) const {
    write_curve(rows, [](double a) -> std::array<double, 4> {
      return {a, x_of(a), y_of(a), t_of(a)};
    });
  }

  fs::path folder_;
};

TEST_F(ReferenceFolder, EqualAnglesAreComparedWithoutASpline) {
  write_plain(36);
  const auto d = description(36);
  const Judgement j = judge(d, {curve(d)}, result(36), {});
  EXPECT_TRUE(j.agrees());
  EXPECT_FALSE(j.resampled);
  for (const auto& c : j.channels) {
    EXPECT_EQ(c.comparison.largest, 0) << c.comparison.channel.name;
    EXPECT_EQ(c.comparison.digits, 12) << "capped by the digits of the reference";
  }
}

TEST_F(ReferenceFolder, ColumnsUnitsSignAndAngleAreMapped) {
  // Their angle runs backwards in radians from a quarter turn: theta = -angle + 90.
  write_curve(
      36,
      [](double a) -> std::array<double, 4> {
        const double deg = 90 - a;
        return {radians(a), -x_of(deg) / 1e3, y_of(deg) * 2, t_of(deg) * 1e3};
      },
      "phi,fx,fy,torque");
  const auto d =
      description(36,
                  "[curve.angle]\ncolumn = \"phi\"\nunit = \"rad\"\nsign = -1\noffset_deg = 90\n"
                  "[[curve.column]]\ntheirs = \"fx\"\nours = \"X_x_N\"\nunit = \"kN\"\nsign = -1\n"
                  "[[curve.column]]\ntheirs = \"fy\"\nours = \"X_y_N\"\nfactor = 0.5\n"
                  "[[curve.column]]\ntheirs = \"torque\"\nours = \"T_Nm\"\nunit = \"Nmm\"\n",
                  "relative = 1e-12");
  const ReferenceCurve c = curve(d);
  for (std::size_t row = 0; row < c.table.rows(); ++row) {
    const double deg = c.table.theta_deg[row];
    EXPECT_NEAR(c.table.at(row, 0), x_of(deg), 120 * 1e2 * kConversion);
    EXPECT_NEAR(c.table.at(row, 1), y_of(deg), 90 * 1e2 * kConversion);
    EXPECT_NEAR(c.table.at(row, 2), t_of(deg), 55 * 1e2 * kConversion);
  }
  EXPECT_TRUE(judge(d, {c}, result(36), {}).agrees());
}

TEST_F(ReferenceFolder, OtherAnglesAreResampledBySplineOfFourthOrder) {
  std::vector<double> errors;
  for (const int rows : {50, 100, 200}) {
    write_plain(rows);
    const auto d = description(rows, "", "relative = 1");
    const Judgement j = judge(d, {curve(d)}, result(36), {});
    EXPECT_TRUE(j.resampled);
    double worst = 0;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t row = 0; row < 36; ++row)
        worst = std::max(worst, std::abs(j.reference.at(row, c) - result(36).at(row, c)) /
                                    result(36).peak(kChannels[c].group));
    EXPECT_GT(j.resampling_error, worst);
    EXPECT_LT(j.resampling_error, 80 * worst) << "48 times in the limit, where it is worst";
    errors.push_back(worst);
  }
  // Halving the step of a smooth curve divides the error by 16.
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 4, 0.3);
}

// Gaps of 30 deg are the largest allowed: a twelfth of a turn.
TEST_F(ReferenceFolder, ResampledCurvesMayNotHaveLargerGapsThanSaid) {
  const auto judged = [&](int rows) {
    write_plain(rows);
    const auto d = description(rows, "", "relative = 1");
    return thrown([&] { judge(d, {curve(d)}, result(36), {}); });
  };
  EXPECT_EQ(judged(12), "nothing");
  EXPECT_THAT(judged(11), HasSubstr("must cover the turn with gaps of at most 30 deg"));
}

TEST_F(ReferenceFolder, JumpIsResampledWithTheUncertaintyItHas) {
  // A friction force reverses between two points of the reference, wherever that is between them.
  constexpr double kJump = 30;
  for (const double reversal : {100.0, 100.1, 101.2, 102.5, 103.9, 104.8, 106.3, 108.0}) {
    const auto with_friction = [&](double deg) {
      const double share = deg == reversal || deg == 300 ? 0.5
                           : deg < reversal || deg > 300 ? 0
                                                         : 1;
      return x_of(deg) + share * kJump;
    };
    write_curve(72, [&](double a) -> std::array<double, 4> {
      return {a, with_friction(a), y_of(a), t_of(a)};
    });
    ResultTable fine = result(720);
    for (std::size_t row = 0; row < fine.rows(); ++row)
      fine.values[row * 3] = with_friction(fine.theta_deg[row]);
    const auto d = description(72, "", "relative = 1e-4");
    const Judgement j = judge(d, {curve(d)}, fine, {});
    EXPECT_EQ(finding(j, "X_x_N"), Finding::agrees) << reversal;
    EXPECT_GT(j.resampling_error, 0.3 * kJump / 120);
    EXPECT_LT(j.resampling_error, 2 * kJump / 120);
    // Far from the jump nothing is forgiven.
    fine.values[3 * 400] += 0.002 * 120;
    EXPECT_EQ(finding(judge(d, {curve(d)}, fine, {}), "X_x_N"), Finding::differs) << reversal;
  }
}

// A model that can be run anywhere is held to a record where that has points.
class OwnAngles : public ReferenceFolder {
 protected:
  Judgement judged(const ReferenceDescription& d, const ResultAt& model = result_at) const {
    return judge(d, {curve(d)}, model, angles(360), {});
  }
};

TEST_F(OwnAngles, NothingIsResampledAndNothingForgiven) {
  for (const int rows : {14, 50, 77, 720}) {
    write_plain(rows);
    const auto d = description(rows, "", "relative = 1e-10");
    const Judgement j = judged(d);
    EXPECT_TRUE(j.agrees());
    EXPECT_FALSE(j.resampled);
    EXPECT_TRUE(j.at_own_angles);
    EXPECT_TRUE(j.gaps.empty());
    EXPECT_EQ(j.reference.rows(), static_cast<std::size_t>(rows));
    EXPECT_EQ(j.result.theta_deg, j.reference.theta_deg);
    for (const auto& c : j.channels) EXPECT_EQ(c.comparison.largest, 0);
  }
  write_plain(72);  // a fifth of the case's own
  EXPECT_FALSE(judged(description(72)).at_own_angles);
}

TEST_F(OwnAngles, OneWrongValueOfARoughRecordIsFoundWithItsSize) {
  // A spike that a spline through the others would excuse as its own error.
  const auto row = [](double a, double by) -> std::array<double, 4> {
    return {a, x_of(a) + (a > 150 && a < 158 ? by : 0), y_of(a), t_of(a)};
  };
  write_curve(50, [&](double a) { return row(a, 25); });
  const auto d = description(50, "", "relative = 1e-3");
  EXPECT_TRUE(judge(d, {curve(d)}, result(360), {}).agrees()) << "resampled it is forgiven";
  const Judgement j = judged(d);
  EXPECT_EQ(finding(j, "X_x_N"), Finding::differs);
  EXPECT_NEAR(j.channels.at(0).comparison.largest, 25, 1e-9);
  EXPECT_NEAR(j.channels.at(0).comparison.theta_of_largest_deg, 151.2, 1e-9);
  EXPECT_NEAR(j.channels.at(0).comparison.allowed, 1e-3 * j.channels.at(0).comparison.peak, 1e-12);
  EXPECT_EQ(finding(j, "X_y_N"), Finding::agrees);
}

TEST_F(OwnAngles, AGapIsNotJudgedAndNamed) {
  std::string text = "theta_deg,X_x_N,X_y_N,T_Nm\n";
  int rows = 0;
  for (double a = 0; a < 360; a += 5) {
    if (a > 60 && a < 85) continue;
    ++rows;
    for (const double value : {a, x_of(a), y_of(a)}) {
      append_number(text, value);
      text += ',';
    }
    append_number(text, t_of(a));
    text += '\n';
  }
  write("curve.csv", text);
  const Judgement j = judged(description(rows, "", "relative = 1e-10"));
  EXPECT_TRUE(j.agrees());
  ASSERT_EQ(j.gaps.size(), 1u);
  EXPECT_EQ(j.gaps[0].from_deg, 60);
  EXPECT_EQ(j.gaps[0].to_deg, 85);
  // Too wide a one is refused, but of the angles that the case itself has.
  write_plain(11);
  EXPECT_THAT(thrown([&] { judged(description(11)); }), HasSubstr("gaps of at most 30 deg"));
  const auto d = description(11);
  EXPECT_TRUE(judge(d, {curve(d)}, ResultAt(result_at), angles(11), {}).agrees());
}

TEST_F(OwnAngles, RoundedAnglesAllowWhatTheModelChangesWithin) {
  // Steps of 3.6 deg, written as whole degrees.
  write_curve(100, [](double a) -> std::array<double, 4> {
    return {std::round(a), x_of(a), y_of(a), t_of(a)};
  });
  const auto with = [&](const std::string& rounding) {
    return description(100, "[curve.angle]\nrounding_deg = " + rounding + "\n", "relative = 1e-3");
  };
  EXPECT_FALSE(judged(with("0")).agrees());
  EXPECT_TRUE(judged(with("0.5")).agrees());
  // A shift by twice that is none of it.
  const Judgement shifted = judged(with("0.5"), [](const std::vector<double>& theta_deg) {
    std::vector<double> later = theta_deg;
    for (double& angle : later) angle += 1;
    ResultTable table = result_at(later);
    table.theta_deg = theta_deg;
    return table;
  });
  EXPECT_EQ(finding(shifted, "X_x_N"), Finding::differs);
  EXPECT_THAT(thrown([&] { curve(with("1.6")); }),
              HasSubstr("rounding_deg = 1.6: must be at most half of the smallest step between two "
                        "angles, 3 deg"));
}

TEST_F(OwnAngles, CurvesOfOtherAnglesEachAreHeldToTheirs) {
  const auto file = [&](const char* name, const char* column, int rows, double (*of)(double)) {
    std::string text = std::string("theta_deg,") + column + "\n";
    for (int i = 0; i < rows; ++i) {
      append_number(text, 360.0 * i / rows);
      text += ',';
      append_number(text, of(360.0 * i / rows));
      text += '\n';
    }
    write(name, text);
  };
  file("curve.csv", "X_x_N", 50, x_of);
  file("torque.csv", "T_Nm", 33, t_of);
  const auto d = description(50, "[[curve]]\nfile = \"torque.csv\"\npoints = 33\n");
  const auto held = [&](const ResultAt& model) {
    return judge(d, {curve(d), read_reference_curve(d, d.curves.at(1), kChannels, 9000)}, model,
                 angles(360), {});
  };
  const Judgement j = held(result_at);
  EXPECT_EQ(finding(j, "X_x_N"), Finding::agrees);
  EXPECT_EQ(finding(j, "T_Nm"), Finding::agrees);
  EXPECT_EQ(finding(j, "X_y_N"), Finding::missing);
  EXPECT_EQ(j.reference.rows(), 82u);  // 0 is of both
  for (std::size_t row = 0; row < j.reference.rows(); ++row) {
    const double deg = j.reference.theta_deg[row];
    const double x = j.reference.at(row, j.reference.find("X_x_N"));
    const double t = j.reference.at(row, j.reference.find("T_Nm"));
    EXPECT_TRUE(is_computed(x) || is_computed(t));
    if (is_computed(x)) {
      EXPECT_EQ(x, x_of(deg));
    }
    if (is_computed(t)) {
      EXPECT_EQ(t, t_of(deg));
    }
    EXPECT_EQ(j.result.at(row, 2), t_of(deg));
  }
  const auto off = [](const std::vector<double>& theta_deg) {
    ResultTable table = result_at(theta_deg);
    for (std::size_t row = 0; row < table.rows(); ++row) table.values[3 * row + 2] += 1;
    return table;
  };
  EXPECT_EQ(finding(held(off), "T_Nm"), Finding::differs);
  EXPECT_EQ(finding(held(off), "X_x_N"), Finding::agrees);
}

TEST_F(ReferenceFolder, ToleranceIsAbsolutePlusRelativeToThePeakOfTheVector) {
  write_curve(36, [](double a) -> std::array<double, 4> {
    return {a, x_of(a), y_of(a) + 1, t_of(a)};
  });
  const double peak = result(36).peak("X");
  EXPECT_GT(peak, 120);
  const auto with = [&](const std::string& tolerance) {
    const auto d = description(36, "", tolerance);
    return finding(judge(d, {curve(d)}, result(36), {}), "X_y_N");
  };
  EXPECT_EQ(with("relative = 1e-3"), Finding::differs);
  EXPECT_EQ(with("relative = 1e-3\nabsolute_N = 1"), Finding::agrees);
  EXPECT_EQ(with("relative = 1e-3\nabsolute_Nm = 1"), Finding::differs);
  EXPECT_EQ(with("relative = 0.01"), Finding::agrees);
}

TEST_F(ReferenceFolder, ZeroReactionIsHeldToTheLoadScale) {
  write_curve(36, [](double a) -> std::array<double, 4> { return {a, 0, 0, t_of(a)}; });
  const auto d = description(36, "", "relative = 1e-3");
  ResultTable small = result(36);
  for (std::size_t row = 0; row < small.rows(); ++row)
    for (std::size_t c = 0; c < 2; ++c) small.values[row * 3 + c] = 1e-6;
  EXPECT_FALSE(judge(d, {curve(d)}, small, {}).agrees());
  EXPECT_TRUE(judge(d, {curve(d)}, small, {{"N", 1e4}}).agrees());
}

TEST_F(ReferenceFolder, TubeAllowsWhatTheReferenceSpansAroundTheAngle) {
  write_curve(360, [](double a) -> std::array<double, 4> {
    return {a, a < 180.2 ? 0.0 : 100.0, y_of(a), t_of(a)};
  });
  ResultTable step = result(360);
  for (std::size_t row = 0; row < step.rows(); ++row)
    step.values[row * 3] = step.theta_deg[row] < 181.2 ? 0 : 100;  // one sample later
  const auto with = [&](const std::string& tolerance) {
    const auto d = description(360, "", tolerance);
    return finding(judge(d, {curve(d)}, step, {}), "X_x_N");
  };
  EXPECT_EQ(with("relative = 1e-3"), Finding::differs);
  EXPECT_EQ(with("relative = 1e-3\ntube_deg = 1"), Finding::agrees);
  step.values[3 * 10] = 5;  // far from the edge nothing is forgiven
  EXPECT_EQ(with("relative = 1e-3\ntube_deg = 1"), Finding::differs);
}

TEST_F(ReferenceFolder, MissingIsNeitherAgreeingNorDiffering) {
  std::string text = "theta_deg,T_Nm\n";
  for (int i = 0; i < 36; ++i)
    text += std::to_string(10 * i) + "," + number_text(t_of(10.0 * i)) + "\n";
  write("curve.csv", text);
  const auto d = description(36);
  const Judgement j = judge(d, {curve(d)}, result(36), {});
  EXPECT_EQ(finding(j, "X_x_N"), Finding::missing);
  EXPECT_EQ(finding(j, "T_Nm"), Finding::agrees);
  EXPECT_TRUE(j.agrees());
  // What claims to be complete must be.
  const auto golden = description(36, "", "relative = 1e-9", "golden");
  const Judgement strict = judge(golden, {curve(golden)}, result(36), {});
  EXPECT_EQ(finding(strict, "X_x_N"), Finding::incomplete);
  EXPECT_FALSE(strict.agrees());
  // Nothing compared is no agreement.
  ResultTable other = result(36);
  for (auto& c : other.channels) c.name = "other_" + c.name;
  EXPECT_FALSE(judge(d, {curve(d)}, other, {}).agrees());
}

TEST_F(ReferenceFolder, HintsNameWhatHappened) {
  const auto judged = [&](const std::function<std::array<double, 4>(double)>& row) {
    write_curve(72, row);
    const auto d = description(72);
    return judge(d, {curve(d)}, result(72), {});
  };
  using Row = std::array<double, 4>;
  auto j = judged([](double a) -> Row { return {a, -x_of(a), y_of(a), t_of(a)}; });
  EXPECT_THAT(hint(j, "X_x_N"), HasSubstr("opposite sign"));
  j = judged([](double a) -> Row { return {a, y_of(a), x_of(a), t_of(a)}; });
  EXPECT_THAT(hint(j, "X_x_N"), HasSubstr("as X_y_N"));
  EXPECT_THAT(hint(j, "X_y_N"), HasSubstr("as X_x_N"));
  j = judged([](double a) -> Row { return {a, x_of(a), y_of(a), 1e-3 * t_of(a)}; });
  EXPECT_THAT(hint(j, "T_Nm"), HasSubstr("1000 times"));
  j = judged([](double a) -> Row { return {a, x_of(a + 0.5), y_of(a), t_of(a)}; });
  EXPECT_THAT(hint(j, "X_x_N"), HasSubstr("shifted by about +0.50 deg"));
  j = judged([](double a) -> Row { return {a, x_of(a + 0.37), y_of(a), t_of(a)}; });
  EXPECT_THAT(hint(j, "X_x_N"), HasSubstr("shifted by about +0.37 deg"));
  j = judged([](double a) -> Row { return {a, x_of(a) + wave(a, 7), y_of(a), t_of(a)}; });
  EXPECT_EQ(hint(j, "X_x_N"), "");
  j = judged([](double a) -> Row { return {a, x_of(a), y_of(a), t_of(a) + 12}; });
  EXPECT_THAT(hint(j, "T_Nm"), HasSubstr("the reference less 12 Nm at every angle"));
  j = judged([](double a) -> Row { return {a, x_of(a) - 0.5, y_of(a), t_of(a)}; });
  EXPECT_THAT(hint(j, "X_x_N"), HasSubstr("the reference plus 0.5 N at every angle"));
  // A curve that repeats every 72 deg is moved by 5 deg as well as by 149 the other way.
  const auto repeats = [](double a) { return 100 + 5 * wave(a, 5) + 2 * wave(a + 3, 10); };
  ResultTable of_ripple = result(72);
  for (std::size_t row = 0; row < of_ripple.rows(); ++row)
    of_ripple.values[row * 3 + 2] = repeats(of_ripple.theta_deg[row]);
  for (const auto& [moved, text] :
       {std::pair{5.0, "+5.00"}, std::pair{-5.0, "-5.00"}, std::pair{3.2, "+3.20"}}) {
    write_curve(72, [&, by = moved](double a) -> Row {
      return {a, x_of(a), y_of(a), repeats(a + by)};
    });
    const auto d = description(72);
    EXPECT_THAT(hint(judge(d, {curve(d)}, of_ripple, {}), "T_Nm"),
                HasSubstr(std::string("shifted by about ") + text + " deg"));
  }
  // A rig's noise, within what is allowed, hides no exchange of columns.
  write_curve(72, [](double a) -> Row {
    return {a, y_of(a) + 3 * wave(a, 7), x_of(a) - 3 * wave(a, 9), t_of(a)};
  });
  const auto noisy = description(72, "", "relative = 0.04");
  j = judge(noisy, {curve(noisy)}, result(72), {});
  EXPECT_THAT(hint(j, "X_x_N"), HasSubstr("as X_y_N"));
  EXPECT_THAT(hint(j, "X_y_N"), HasSubstr("as X_x_N"));
}

// Of two turns the one that was asked for, and nothing of the other.
TEST_F(ReferenceFolder, OneTurnOfALongerRecord) {
  write_curve(72, [](double a) -> std::array<double, 4> {
    const double angle = 2 * a, other = angle < 180 || angle > 540 ? 5 : 0;
    return {angle, x_of(angle) + other, y_of(angle), t_of(angle)};
  });
  const auto judged = [&](const std::string& from) {
    const auto d = description(72, "[curve.angle]\nturn_from_deg = " + from + "\n");
    const ReferenceCurve c = curve(d);
    EXPECT_EQ(c.table.rows(), 36U);
    return judge(d, {c}, result(36), {}).agrees();
  };
  EXPECT_TRUE(judged("180"));
  EXPECT_THAT(thrown([&] { judged("170"); }), HasSubstr("not periodic"));
}

// A vector of three components, of which the models have two.
TEST_F(ReferenceFolder, NotesAPartThatTheModelsLack) {
  std::vector<Channel> channels = {kChannels[0], kChannels[1]};
  for (Channel& c : channels) c.frame = "S1";
  channels[0].axis = "x1";
  channels[1].axis = "y1";
  const auto notes = [&](double along_z) {
    write_curve(
        36,
        [&](double a) -> std::array<double, 4> {
          return {a, x_of(a), y_of(a), along_z};
        },
        "theta_deg,a,b,c");
    const auto d = description(
        36, "[[curve.vector]]\ntheirs = [\"a\", \"b\", \"c\"]\nours = \"X\"\n", "relative = 1e-3");
    return read_reference_curve(d, d.curves.at(0), channels, 9000).notes;
  };
  const double peak = result(36).peak("X");
  EXPECT_THAT(notes(0.9e-3 * peak), testing::IsEmpty());
  EXPECT_THAT(notes(-2e-3 * peak),
              testing::ElementsAre(HasSubstr("X along z1 up to 2.00e-03 of its peak")));
}

// By their definitions: pound-force 0.45359237 kg x 9.80665 m/s2, inch 25.4 mm.
TEST(ForeignUnits, HaveTheirSizeInSi) {
  constexpr double kPound = 0.45359237 * 9.80665, kInch = 0.0254;
  const std::map<std::string, std::map<std::string, double>> families = {
      {"N", {{"N", 1}, {"kN", 1e3}, {"MN", 1e6}, {"daN", 10}, {"kgf", 9.80665}, {"lbf", kPound}}},
      {"Nm",
       {{"Nm", 1},
        {"kNm", 1e3},
        {"Nmm", 1e-3},
        {"lbf in", kPound * kInch},
        {"lbf ft", kPound * 0.3048}}},
      {"mm", {{"m", 1}, {"cm", 0.01}, {"mm", 1e-3}, {"um", 1e-6}, {"in", kInch}}},
      {"bar",
       {{"Pa", 1},
        {"kPa", 1e3},
        {"MPa", 1e6},
        {"bar", 1e5},
        {"mbar", 100},
        {"psi", kPound / (kInch * kInch)}}}};
  for (const auto& [family, units] : families)
    for (const auto& [unit, si] : units) {
      ASSERT_NE(find_unit(unit), nullptr) << unit;
      EXPECT_EQ(find_unit(unit)->family, family) << unit;
      EXPECT_NEAR(find_unit(unit)->si, si, 1e-14 * si) << unit;
    }
  EXPECT_EQ(find_unit("furlong"), nullptr);
  for (const auto& [unit, degrees] : std::map<std::string, double>{{"deg", 1},
                                                                   {"rad", 180 / kPi},
                                                                   {"mrad", 0.18 / kPi},
                                                                   {"turn", 360},
                                                                   {"gon", 0.9},
                                                                   {"s", 0}})
    EXPECT_NEAR(degrees_per(unit), degrees, 1e-13) << unit;
  for (const auto& [unit, seconds] :
       std::map<std::string, double>{{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"min", 60}, {"deg", 0}})
    EXPECT_NEAR(seconds_per(unit), seconds, 1e-16) << unit;
}

TEST(CurveDescriptions, SayWhatWasAssumedOfTheAngle) {
  CurveDescription c;
  c.guessed = true;
  c.file = "rig.csv";
  c.angle.column = "ANGLE";
  c.angle.unit = "deg";
  c.angle.offset_deg = -30;
  EXPECT_THAT(assumptions_of(c).at(0), HasSubstr("theta = ANGLE in deg - 30 deg"));
  c.angle.offset_deg = 12.5;
  EXPECT_THAT(assumptions_of(c).at(0), HasSubstr("theta = ANGLE in deg + 12.5 deg"));
}

TEST_F(ReferenceFolder, RefusesWhatCannotBeMeant) {
  write_plain(36);
  const auto refusal = [&](int points, const std::string& more) {
    return thrown([&] { curve(description(points, more)); });
  };
  EXPECT_EQ(refusal(36, ""), "nothing");
  EXPECT_THAT(refusal(37, ""), HasSubstr("has 36 rows"));
  EXPECT_THAT(refusal(36, "[curve.angle]\ncolumn = \"angle\"\n"), HasSubstr("no column \"angle\""));
  EXPECT_THAT(refusal(36, "[[curve.column]]\ntheirs = \"X_x_N\"\nours = \"Y\"\n"),
              HasSubstr("\"Y\", which is not a column of a result"));
  EXPECT_THAT(refusal(36, "[[curve.column]]\ntheirs = \"X_x_N\"\nours = \"T_Nm\"\n"),
              HasSubstr("two columns stand for T_Nm"));
  EXPECT_THAT(refusal(36, "[[curve.column]]\ntheirs = \"X_x_N\"\nours = \"X_x_N\"\nsign = 0\n"),
              HasSubstr("sign"));
  EXPECT_THAT(
      refusal(36, "[[curve.column]]\ntheirs = \"X_x_N\"\nours = \"X_x_N\"\nunit = \"Nm\"\n"),
      HasSubstr("cannot become N"));
  EXPECT_THAT(refusal(36, "models = [\"other\"]\n"), HasSubstr("models"));
  write_curve(36, [](double a) -> std::array<double, 4> { return {2 * a, 1, 2, 3}; });
  EXPECT_THAT(refusal(36, ""), HasSubstr("more than a turn"));
  EXPECT_EQ(refusal(36, "[curve.angle]\nturn_from_deg = 180\n"), "nothing");
  EXPECT_THAT(refusal(36, "[curve.angle]\nturn_from_deg = 500\n"), HasSubstr("covers"));
  write_curve(36, [](double a) -> std::array<double, 4> { return {a < 100 ? a : 90, 1, 2, 3}; });
  EXPECT_THAT(refusal(36, ""), HasSubstr("strictly"));
}

// Axes in every position: a rotation is taken, its image in a mirror is not.
TEST_F(ReferenceFolder, AxesAreRightHanded) {
  write_plain(36);
  const auto refusal = [&](const Eigen::Matrix3d& axes) {
    std::string text = "[curve.frame]\n";
    for (int i = 0; i < 3; ++i)
      text += fmt::format("{} = [{:.9f}, {:.9f}, {:.9f}]\n", "xyz"[i], axes(i, 0), axes(i, 1),
                          axes(i, 2));
    return thrown([&] { curve(description(36, text)); });
  };
  for (const double a : {0.0, 0.5, 2.0, 4.0, 5.5})
    for (const double b : {0.0, 1.0, 2.5, 4.5})
      for (const double c : {0.0, 1.5, 3.0}) {
        const Eigen::Matrix3d axes = (Eigen::AngleAxisd(a, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(b, Eigen::Vector3d::UnitX()) *
                                      Eigen::AngleAxisd(c, Eigen::Vector3d::UnitY()))
                                         .toRotationMatrix();
        EXPECT_THAT(refusal(axes), testing::Not(HasSubstr("right-handed"))) << axes;
        for (int row = 0; row < 3; ++row) {
          Eigen::Matrix3d mirrored = axes;
          mirrored.row(row) *= -1;
          EXPECT_THAT(refusal(mirrored), HasSubstr("right-handed")) << mirrored;
        }
      }
}

TEST_F(ReferenceFolder, FolderIsTheManifest) {
  write_plain(36);
  const auto d = description(36);
  EXPECT_NO_THROW(check_files(d, {}));
  write("pressure.csv", "x\n");
  EXPECT_THAT(thrown([&] { check_files(d, {}); }), HasSubstr("pressure.csv: is not used"));
  EXPECT_NO_THROW(check_files(d, {folder_ / "pressure.csv"}));
}

TEST(PeriodicSplineTest, MeetsItsPointsAndIsPeriodic) {
  const std::vector<double> x = {5, 40, 170, 200, 330}, y = {1, -2, 3, 0, 7};
  const PeriodicSpline spline(x, y);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(spline(x[i]), y[i], 1e-14);
    EXPECT_NEAR(spline(x[i] - 720), y[i], 1e-12);
  }
  EXPECT_NEAR(spline(5 - 1e-7), spline(5 + 1e-7), 1e-6);
  EXPECT_THROW(PeriodicSpline({0, 1}, {0, 0}), InputError);
  EXPECT_THROW(PeriodicSpline({0, 1, 1}, {0, 0, 0}), InputError);
  EXPECT_THROW(PeriodicSpline({0, 100, 360}, {0, 0, 0}), InputError);
}

TEST(Junit, HoldsTextThatIsNoMarkup) {
  report::TestSuite suite{"a<b>&\"c\"", 0.5, {{"k", "v\x01"}}, {}};
  suite.cases = {{"one", "c", 0.1, report::TestOutcome::passed, "", "fine"},
                 {"two", "c", 0.1, report::TestOutcome::failed, "why <", "a\nb"},
                 {"three", "c", 0.1, report::TestOutcome::error, "what", ""},
                 {"four", "c", 0.1, report::TestOutcome::skipped, "", ""}};
  const std::string xml = report::junit_xml("all", {suite});
  EXPECT_THAT(xml, HasSubstr("a&lt;b>&amp;&quot;c&quot;"));
  EXPECT_THAT(xml, HasSubstr("tests=\"4\" failures=\"1\" errors=\"1\" skipped=\"1\""));
  EXPECT_EQ(xml.find('\x01'), std::string::npos);
}

TEST(Junit, SaysHowEachTestEndedAndTheTimesAddUp) {
  using report::TestOutcome;
  const std::vector<report::TestCase> cases = {
      {"fine", "c", 0.25, TestOutcome::passed, "", "its figures"},
      {"plain", "c", 0, TestOutcome::passed, "", ""},
      {"off", "c", 0, TestOutcome::failed, "too far", "by 2"},
      {"broken", "c", 0, TestOutcome::error, "no file", ""},
      {"left out", "c", 0, TestOutcome::skipped, "not here", ""}};
  const std::string xml =
      report::junit_xml("all", {{"first", 0.5, {}, cases}, {"second", 2, {}, {}}});
  for (const char* part :
       {"<testsuites name=\"all\" tests=\"5\" failures=\"1\" errors=\"1\" skipped=\"1\" "
        "time=\"2.500000\">",
        "<testcase name=\"fine\" classname=\"c\" time=\"0.250000\">\n   <system-out>its "
        "figures</system-out>",
        "<testcase name=\"plain\" classname=\"c\" time=\"0.000000\" />",
        "<failure message=\"too far\" type=\"out of tolerance\">by 2</failure>",
        "<error message=\"no file\" type=\"error\" />", "<skipped message=\"not here\" />"})
    EXPECT_THAT(xml, HasSubstr(part));
}

// ---- Printed numbers
// -----------------------------------------------------------------------------

class PublishedNumbers : public ReferenceFolder {
 protected:
  // Rows of the section for one number.
  nlohmann::json row(const std::string& number, const Facts& facts = {{"speed_rpm", 1500}}) {
    write("numbers.toml",
          "schema = 1\npump = \"P\"\n[identity]\nspeed_rpm = [0, 2000]\n"
          "[[condition]]\nname = \"rated\"\ntext = \"at 1500\"\nfacts = { speed_rpm = [1500, 1500] "
          "}\n"
          "[[variant]]\nname = \"v\"\ntext = \"without\"\nset = { friction = 0 }\n"
          "[[number]]\nquantity = \"q\"\nwhere = \"Fig. 1\"\n" +
              number);
    published_ = read_published(folder_ / "numbers.toml");
    section_ = judge_published(published_, {"model"},
                               [&](const std::string&, const PublishedVariant& variant) {
                                 ran_.push_back(variant.name);
                                 Facts all = facts;
                                 for (const auto& [name, value] : variant.set) all[name] = value;
                                 return PublishedRun{&table_, all};
                               });
    report::Document document;
    document.published = report::PublishedTable{"", section_};
    const auto rows = nlohmann::json::parse(report::json_text(document))["published"]["rows"];
    return rows.empty() ? nlohmann::json() : rows[0];
  }

  ResultTable table_ = result(360);
  Published published_;
  PublishedSection section_;
  std::vector<std::string> ran_;
};

// The largest of many alike, far above those before it, beside a mean of a thousand times its size.
TEST_F(PublishedNumbers, TheMainOrderIsTheLargestOfAll) {
  for (const int main : {1, 7, 100, 179}) {
    for (std::size_t i = 0; i < table_.rows(); ++i) {
      double& value = table_.values[i * table_.columns() + table_.find("T_Nm")];
      value = 1000;
      for (int order = 1; order < 180; ++order)
        value +=
            (order == main ? 1.01 : 1) * std::cos(order * radians(table_.theta_deg[i]) + order);
    }
    EXPECT_EQ(row("status = \"predicted\"\nchannels = [\"T_Nm\"]\nwindow = [0, 200]\nmeasure = "
                  "\"main_order\"\n")["model"],
              main);
  }
}

TEST_F(PublishedNumbers, MeasuresOfACurve) {
  const std::string t =
      "status = \"predicted\"\nchannels = [\"T_Nm\"]\nwindow = [40, 60]\nmeasure = ";
  EXPECT_NEAR(row(t + "\"mean\"\n")["model"].get<double>(), 50, 1e-12);
  EXPECT_NEAR(row(t + "\"maximum\"\n")["model"].get<double>(), 55, 1e-12);
  EXPECT_NEAR(row(t + "\"minimum\"\n")["model"].get<double>(), 45, 1e-12);
  EXPECT_EQ(row(t + "\"range\"\n")["model"], "45 to 55");
  EXPECT_NEAR(row(t + "\"at\"\nat_deg = 36\n")["model"].get<double>(), 45, 1e-12);
  EXPECT_EQ(row(t + "\"main_order\"\n")["model"], 5);
  EXPECT_EQ(row(t + "\"sign_changes\"\n")["model"], 0);
  EXPECT_NEAR(row(t + "\"maximum\"\nover_deg = [30, 42]\n")["model"].get<double>(),
              50 - 5 * std::sqrt(0.75), 1e-4);
  EXPECT_NEAR(row(t + "\"mean\"\nfactor = -2\ntimes = \"speed_rpm\"\n")["model"].get<double>(),
              -150000, 1e-6);
  EXPECT_EQ(row("status = \"predicted\"\nmeasure = \"fact\"\nfact = \"speed_rpm\"\nfactor = "
                "-2\nabove = -4000\n")["model"],
            -3000);
  // Several channels: the magnitude of the vector.
  const double magnitude = std::hypot(x_of(0), y_of(0));
  EXPECT_NEAR(row("status = \"predicted\"\nmeasure = \"at\"\nat_deg = 0\nabove = 0\n"
                  "channels = [\"X_x_N\", \"X_y_N\"]\n")["model"]
                  .get<double>(),
              magnitude, 1e-3);
}

TEST_F(PublishedNumbers, VerdictAndCount) {
  const std::string t = "measure = \"range\"\nchannels = [\"T_Nm\"]\n";
  EXPECT_EQ(row(t + "status = \"predicted\"\nwindow = [45, 56]\n")["verdict"], "inside");
  EXPECT_EQ(section_.summary.predicted_inside, 1);
  EXPECT_EQ(row(t + "status = \"predicted\"\nwindow = [46, 56]\n")["verdict"], "outside");
  EXPECT_EQ(section_.summary.predicted_inside, 0);
  EXPECT_EQ(section_.summary.predicted_comparable, 1);
  EXPECT_EQ(row(t + "status = \"calibrated\"\nwindow = [45, 56]\n")["verdict"], "inside");
  EXPECT_EQ(section_.summary.predicted, 0) << "only predicted rows are validation";
  row(t + "status = \"predicted\"\nwindow = [45, 56]\nrepeats = true\n");
  EXPECT_EQ(section_.summary.predicted, 0);
  EXPECT_EQ(
      row(t + "status = \"predicted\"\nwindow = [45, 56]\nnot_comparable = \"why\"\n")["verdict"],
      "not comparable");
  EXPECT_EQ(row("measure = \"mean\"\nchannels = [\"none\"]\nstatus = \"predicted\"\nabove = 0\n")
                ["verdict"],
            "not comparable");
}

TEST_F(PublishedNumbers, ConditionsDecideAndNothingIsRunInVain) {
  const std::string t =
      "status = \"predicted\"\nmeasure = \"mean\"\nchannels = [\"T_Nm\"]\nabove = 0\n"
      "condition = \"rated\"\n";
  EXPECT_EQ(row(t)["verdict"], "inside");
  const auto other = row(t, {{"speed_rpm", 1000}});
  EXPECT_EQ(other["verdict"], "not comparable");
  EXPECT_THAT(other["where"].get<std::string>(), HasSubstr("speed_rpm is 1000, there 1500"));
  ran_.clear();
  row(t + "variant = \"v\"\n", {{"speed_rpm", 1000}});
  EXPECT_THAT(ran_, testing::Each(""));
  row(t + "variant = \"v\"\n");
  EXPECT_THAT(ran_, testing::Contains("v"));
  EXPECT_TRUE(published_.describes({{"speed_rpm", 1}}));
  EXPECT_FALSE(published_.describes({{"speed_rpm", 2001}}));
  EXPECT_FALSE(published_.describes({}));
}

TEST_F(PublishedNumbers, OneVariantMinusAnother) {
  const std::string t =
      "status = \"predicted\"\nmeasure = \"mean\"\nchannels = [\"T_Nm\"]\nvariant = \"v\"\n"
      "minus = \"v\"\n";
  EXPECT_EQ(row(t + "below = 1\n")["model"], 0);
  EXPECT_EQ(row(t + "below = 1\n")["at"], "without minus without");
  EXPECT_EQ(row(t + "above = 1\n")["verdict"], "outside");
}

TEST_F(PublishedNumbers, AStudyJudgesItsOwn) {
  const std::string t = "status = \"predicted\"\nmeasure = \"mean\"\nchannels = [\"T_Nm\"]\n";
  EXPECT_TRUE(row(t + "above = 0\nstudy = \"s\"\n").is_null());
  const auto run = [&](const std::string&, const PublishedVariant&) {
    return PublishedRun{&table_, {}};
  };
  EXPECT_EQ(judge_published(published_, {"model"}, run, "s").rows.size(), 1U);
  EXPECT_EQ(judge_published(published_, {"model"}, run, "r").rows.size(), 0U);
}

TEST_F(PublishedNumbers, OnlyACalibratedNumberMustBeMet) {
  const std::string t = "measure = \"mean\"\nchannels = [\"T_Nm\"]\nstatus = ";
  row(t + "\"calibrated\"\nabove = 49\n");
  EXPECT_TRUE(section_.calibrated());
  row(t + "\"calibrated\"\nabove = 51\n");
  EXPECT_FALSE(section_.calibrated());
  row(t + "\"predicted\"\nabove = 51\n");
  EXPECT_TRUE(section_.calibrated());
  row(t + "\"calibrated\"\nabove = 51\ncondition = \"rated\"\n", {{"speed_rpm", 1000}});
  EXPECT_TRUE(section_.calibrated()) << "not comparable";
}

TEST_F(PublishedNumbers, RefusesWhatIsIncomplete) {
  const auto refusal = [&](const std::string& number) { return thrown([&] { row(number); }); };
  const std::string t = "measure = \"mean\"\nchannels = [\"T_Nm\"]\n";
  EXPECT_THAT(refusal(t + "status = \"guessed\"\nabove = 0\n"), HasSubstr("status"));
  EXPECT_THAT(refusal(t + "status = \"predicted\"\n"), HasSubstr("value, window, above, below"));
  EXPECT_THAT(refusal(t + "status = \"predicted\"\nvalue = 1\n"), HasSubstr("tolerance"));
  EXPECT_THAT(refusal(t + "status = \"predicted\"\nvalue = 1\ntolerance = 1\n"),
              HasSubstr("tolerance_reason"));
  EXPECT_THAT(refusal(t + "status = \"predicted\"\nbelow = 1\nfind_pressure = true\n"),
              HasSubstr("needs above > 0"));
  EXPECT_THAT(refusal(t + "status = \"predicted\"\nabove = 0\ncondition = \"x\"\n"),
              HasSubstr("not defined"));
  EXPECT_THAT(refusal(t + "status = \"predicted\"\nabove = 0\nminus = \"x\"\n"),
              testing::AllOf(HasSubstr("minus"), HasSubstr("not defined")));
  EXPECT_THAT(refusal("measure = \"fact\"\nstatus = \"predicted\"\nabove = 0\n"),
              HasSubstr("fact"));
}

TEST(ShippedPublishedData, CanBeRead) {
  const fs::path folder = fs::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "published" / "bap63";
  const Published published = read_published(folder / "numbers.toml");
  EXPECT_GT(published.numbers.size(), 30U);
  const auto description = read_description(folder, "bap63");
  EXPECT_EQ(description.kind, ReferenceKind::published);
  check_files(description, {});
}

}  // namespace
}  // namespace bentaxis::test
