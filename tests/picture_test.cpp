// Figures as SVG, CSV and PNG: what is drawn is where it belongs, and nothing breaks a picture.
#include "bentaxis/report/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <pugixml.hpp>
#include <random>
#include <regex>
#include <sstream>

#include "bentaxis/pump/number.h"

namespace bentaxis::report {
namespace {

using testing::HasSubstr;
using testing::Not;

pugi::xml_document read(const std::string& svg) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(svg.c_str())) << svg.substr(0, 200);
  return document;
}

// Values of the middle of a table, over a turn in steps of `step` deg.
Curves curves_of(const std::vector<std::pair<std::string, Values>>& columns, double step) {
  Curves curves;
  for (std::size_t i = 0; i < columns[0].second.size(); ++i)
    curves.theta_deg.push_back(step * static_cast<double>(i));
  curves.tables = {{"analytic", columns}};
  return curves;
}

// Points of the curves drawn, in pixels.
std::vector<std::vector<std::array<double, 2>>> drawn(const std::string& svg) {
  std::vector<std::vector<std::array<double, 2>>> curves;
  const auto document = read(svg);
  for (const auto& found : document.select_nodes("//path[@fill='none']")) {
    std::string text = found.node().attribute("d").value();
    for (char& c : text)
      if (c == 'M' || c == 'L') c = ' ';
    std::istringstream in(text);
    curves.emplace_back();
    for (double x = 0, y = 0; in >> x >> y;) curves.back().push_back({x, y});
  }
  return curves;
}

TEST(Picture, CurveLiesWhereItsValuesAre) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1, 1);
  Values smooth, rough, line;
  for (int i = 0; i < 720; ++i) {
    smooth.push_back(1000 * std::sin(i * 0.0349));
    rough.push_back(noise(random));
    line.push_back(3.0 * i);
  }
  for (const auto& [curve, tolerance] :
       {std::pair{smooth, 0.6}, std::pair{rough, 25.0}, std::pair{line, 0.2}}) {
    const Values& values = curve;
    const auto curves =
        drawn(svg_of({"id", "t", "", ChannelFigure{"N", {"R"}}}, curves_of({{"R", values}}, 0.5)));
    ASSERT_EQ(curves.size(), 1U);
    const auto& points = curves[0];
    // Both axes are linear: fixed by two points of the curve, the ends and the extremes.
    const auto low = std::min_element(values.begin(), values.end());
    const auto high = std::max_element(values.begin(), values.end());
    double top = 1e9, bottom = -1e9;
    for (const auto& p : points) {
      top = std::min(top, p[1]);
      bottom = std::max(bottom, p[1]);
    }
    const auto x_of = [&](double i) {
      return points.front()[0] + (points.back()[0] - points.front()[0]) * i / 719;
    };
    const auto y_of = [&](double v) {
      return bottom + (top - bottom) * (v - *low) / (*high - *low);
    };
    std::size_t k = 0;
    double worst = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double x = x_of(static_cast<double>(i));
      while (k + 2 < points.size() && points[k + 1][0] < x - 0.05) ++k;
      const double share = (x - points[k][0]) / (points[k + 1][0] - points[k][0]);
      worst = std::max(worst, std::abs(points[k][1] + share * (points[k + 1][1] - points[k][1]) -
                                       y_of(values[i])));
    }
    // What is left out, and x rounded to a tenth of a pixel on a steep curve.
    EXPECT_LT(worst, tolerance);
    EXPECT_LE(points.size(), 720U);
  }
  EXPECT_EQ(
      drawn(svg_of({"id", "t", "", ChannelFigure{"N", {"R"}}}, curves_of({{"R", line}}, 0.5)))[0]
          .size(),
      5U);  // straight: a point each 200
}

TEST(Picture, GapsStayGapsButOfASparseReference) {
  Curves curves = curves_of({{"R", {1, 2, not_computed(), 4, 5}}}, 90);
  const Figure figure{"id", "t", "", ChannelFigure{"N", {"R"}}};
  const auto moves = [&] {
    const std::string svg = svg_of(figure, curves);
    std::vector<long> counts;
    const auto document = read(svg);
    for (const auto& found : document.select_nodes("//path[@fill='none']")) {
      const std::string d = found.node().attribute("d").value();
      counts.push_back(std::count(d.begin(), d.end(), 'M'));
    }
    return counts;
  };
  EXPECT_THAT(moves(), testing::ElementsAre(2));
  const double gap = not_computed();
  curves.reference = {
      "rig", {{"R", {1, gap, 3, gap, 5}, 0.5, {}, {}, {{"analytic", {0, gap, 1, gap, 0}}}}}};
  EXPECT_THAT(moves(), testing::ElementsAre(2, 1, 1));
}

TEST(Picture, TheBandIsWhatIsAllowed) {
  Curves curves = curves_of({{"R", {0, 10, 0, 10}}}, 90);
  curves.reference = {"rig", {{"R", {0, 10, 0, 10}, 2, {}, {}, {{"analytic", {0, 0, 0, 0}}}}}};
  const auto document = read(svg_of({"id", "t", "", ChannelFigure{"N", {"R"}}}, curves));
  const auto bands = document.select_nodes("//polygon[@class='band']");
  ASSERT_EQ(bands.size(), 2U);  // around the curve, around zero
  std::string text = bands[1].node().attribute("points").value();
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  double low = 1e9, high = -1e9;
  for (double x = 0, y = 0; in >> x >> y;) {
    low = std::min(low, y);
    high = std::max(high, y);
  }
  // The axis shows -2 to 2 and 6 % more at either end, over 78 px.
  EXPECT_NEAR(high - low, 78 / 1.12, 0.1);
}

std::vector<std::string> texts(const std::string& svg) {
  std::vector<std::string> all;
  const auto document = read(svg);
  for (const auto& found : document.select_nodes("//text"))
    all.emplace_back(found.node().text().get());
  return all;
}

TEST(Picture, NumbersOfALogarithmicAxis) {
  const auto at = [](const Values& x) {
    const auto all =
        texts(svg_of({"id", "t", "", XyFigure{{"x", "", true}, {"y"}, {{"s", x, {3000, 4000}}}}}));
    std::vector<double> numbers;  // below those of y
    for (const std::string& text : all)
      if (!text.empty() && text.find_first_not_of("0123456789.e") == std::string::npos &&
          std::stod(text) < 2000)
        numbers.push_back(std::stod(text));
    return numbers;
  };
  EXPECT_THAT(at({1, 100}), testing::ElementsAre(1, 2, 5, 10, 20, 50, 100));
  EXPECT_THAT(at({1.4, 4.4}), testing::ElementsAre(1.5, 2, 3, 4));
}

TEST(Picture, NumbersOfAnAxisStandAtTheirPlaces) {
  const auto places = [](double end, bool angle) {
    std::map<std::string, double> at;
    const auto document = read(svg_of(
        {"id", "t", "", OwnFigure{"N", "x", angle, {0, end / 2, end}, {{"s", {-7, -8, -9}}}}}));
    for (const auto& found : document.select_nodes("//text[@text-anchor='middle']"))
      at[found.node().text().get()] = found.node().attribute("x").as_double();
    return at;
  };
  auto angles = places(360, true), values = places(40, false);
  ASSERT_THAT(angles, testing::Contains(testing::Key("360")));
  EXPECT_NEAR(angles["90"] - angles["0"], (angles["360"] - angles["0"]) / 4, 0.1);
  EXPECT_GT(angles["360"] - angles["0"], 500);
  ASSERT_THAT(values, testing::Contains(testing::Key("40")));
  EXPECT_NEAR(values["10"] - values["0"], (values["40"] - values["0"]) / 4, 0.1);
  EXPECT_NEAR(values["40"], angles["360"], 0.1);
}

// Beside the only value of an axis there is its number, and no other.
TEST(Picture, MapOfOneRow) {
  const auto all = texts(svg_of(
      {"id", "t", "", MapFigure{{"x"}, {"y"}, {"z"}, {1, 2, 3}, {275}, {{5, 6, 7}}, {}, {}}}));
  EXPECT_THAT(all, testing::Contains("275"));
  EXPECT_THAT(all, Not(testing::Contains("276")));
  EXPECT_THAT(all, Not(testing::Contains("275.0")));
  EXPECT_THAT(all, Not(testing::Contains("275.2")));
  EXPECT_THAT(all, testing::IsSupersetOf({"1.0", "2.0", "3.0"}));
}

TEST(Picture, LegendNamesWhatIsShownAndStaysOnThePage) {
  std::vector<std::pair<std::string, Values>> columns;
  std::vector<std::string> names;
  for (int i = 0; i < 12; ++i) {
    names.push_back("a channel of number " + std::to_string(10 + i));
    columns.push_back({names.back(), {0, 1.0 * i, 0, 1}});
  }
  Curves curves = curves_of(columns, 90);
  names.emplace_back("a channel of the rig alone");
  curves.reference = {"rig", {{names.back(), {1, 2, 3, 4}, 0.5, {}, {}, {}}}};
  names.emplace_back("a channel without values");
  const auto document = read(svg_of({"id", "t", "", ChannelFigure{"N", names}}, curves));
  const double width = document.first_child().attribute("width").as_double();
  int named = 0;
  for (const auto& found : document.select_nodes("//text")) {
    const std::string text = found.node().text().get();
    if (text.rfind("a channel", 0) != 0) continue;
    ++named;
    EXPECT_NE(text, names.back());
    // A letter is at least 5 px wide.
    EXPECT_LT(found.node().attribute("x").as_double() + 5.0 * static_cast<double>(text.size()),
              width)
        << text;
  }
  EXPECT_EQ(named, 13);
}

// The first of two models is drawn pale and broad below the second, here and in the legend; a
// model alone is not.
TEST(Picture, TheFirstOfTwoModelsIsPale) {
  const auto pale = [](const Curves& curves) {
    const auto document = read(svg_of({"id", "t", "", ChannelFigure{"N", {"R"}}}, curves));
    return std::pair{document.select_nodes("//line[@opacity='0.4']").size(),
                     document.select_nodes("//path[@fill='none'][@opacity='0.4']").size()};
  };
  Curves curves = curves_of({{"R", {0, 1, 0}}}, 180);
  EXPECT_EQ(pale(curves), (std::pair{std::size_t{0}, std::size_t{0}}));
  curves.tables.push_back({"multibody", {{"R", {0, 1, 0}}}});
  EXPECT_EQ(pale(curves), (std::pair{std::size_t{1}, std::size_t{1}}));
}

// Where one points at a mark it says what it is; those of the legend say nothing.
TEST(Picture, MarksOfPointsSayTheirValues) {
  ScatterSeries series;
  series.name = "designs";
  series.points = {{1, 20, "the best"}, {2, 30, ""}};
  const Figure figure{"id", "t", "", ScatterFigure{{"mass", "kg"}, {"loss", "W"}, {series}}};
  const auto document = read(svg_of(figure));
  std::vector<std::string> said;
  for (const auto& found : document.select_nodes("//*[@class='mark']"))
    said.emplace_back(found.node().child("title").text().get());
  EXPECT_THAT(said,
              testing::UnorderedElementsAre("", "the best, mass 1, loss 20", "mass 2, loss 30"));
}

// Everything that a document can hold without being refused.
std::vector<Figure> odd_figures() {
  const double gap = not_computed(), inf = std::numeric_limits<double>::infinity();
  const Axis log{"x", "s", true}, linear{"y"};
  std::vector<Figure> figures;
  const auto add = [&](auto content) {
    figures.push_back(
        {"id", "a <b> & \"c\" </script>", "Fig. 1", std::move(content), "<i>note</i>"});
  };
  for (const Values& values :
       {Values{}, Values{1}, Values{0, 0, 0}, Values{gap, gap, gap}, Values{inf, 1, -inf},
        Values{1, 1 + 1e-16, 1}, Values{1e-320, 0, 2e-320}, Values{1e300, -1e300, 0},
        Values{1e5, 1e5 + 1e-9, 1e5}, Values{-1, -2, -3}}) {
    Values x;
    for (std::size_t i = 0; i < values.size(); ++i) x.push_back(static_cast<double>(i));
    add(OwnFigure{"N", "x", false, x, {{"s", values}}});
    add(OwnFigure{"N", "x", true, values, {{"s", x}}});
    for (const auto& [a, b] :
         {std::pair{log, linear}, {linear, log}, {Axis{"z", "", false, 0}, linear}}) {
      add(XyFigure{a, b, {{"s", values, x}, {"r", x, values}}});
      ScatterSeries series{"s", std::nullopt, true, false, {}};
      for (std::size_t i = 0; i < values.size(); ++i)
        series.points.push_back({x[i], values[i], "n"});
      add(ScatterFigure{a, b, {series}});
      add(MapFigure{a,
                    b,
                    {"z", "%"},
                    {1, 2, 3},
                    {1},
                    {values.size() == 3 ? values : Values{1, 2, gap}},
                    {1},
                    {{"p", 2, 1}}});
    }
    Curves own = curves_of({{"R", values}}, 1e5);
    add(ChannelFigure{"N", {"R", "missing"}, {}, own});
  }
  add(PistonBars{"Nm", {"R", "missing"}, {0, 38}});
  add(DrawingFigure{});
  const DrawingFigure::Panel panel{{"x", "mm"}, {"y", "mm"}, -1, 1, 0, 1};
  add(DrawingFigure{
      {{"tooth", 0, true}, {"force", 1}},
      {panel},
      {{38, "one pair", {{0, 0, 2, {0, gap, 1e300}, {0, 1, 1}}}, {{0, 1, 0, 0, 0, 0}}}},
      5});
  add(BarsFigure{});
  add(BandFigure{});
  add(ParallelFigure{});
  add(ParallelFigure{{{"a", "", {gap}}, {"b", "", {gap}}}});
  for (const auto& [low, high] :
       {std::pair{0., 0.}, {gap, gap}, {-inf, inf}, {gap, 1.}, {1e300, -1e300}, {1e-320, 0.}})
    add(BarsFigure{log, {{std::string(99, 'x'), low, high, "n", std::pair{high, low}}}});
  const std::vector<double> values = {1, gap, inf, -1e300, 0};
  for (const Axis& axis : {log, linear})
    add(BandFigure{
        axis, axis, true, values, {{"b", values, values, values}}, {{"l", {gap, 1}, {1, gap}}}});
  add(ParallelFigure{{{"a", "", values, true},
                      {"b", "", values},
                      {"c", "", {0, 1, gap, 0, 1}, false, {"no", "yes"}}},
                     9,
                     {1, 4},
                     "m"});
  return figures;
}

TEST(Picture, NothingBreaksAPicture) {
  for (const Figure& figure : odd_figures()) {
    const std::string svg = svg_of(figure, curves_of({{"R", {1, -2, not_computed()}}}, 120));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
    EXPECT_LT(svg.size(), 30000U);
    const auto document = read(svg);
    EXPECT_STREQ(document.first_child().child("title").text().get(), figure.title.c_str());
    EXPECT_FALSE(csv_of(figure, curves_of({{"R", {1, -2, not_computed()}}}, 120)).empty());
  }
}

TEST(Picture, CsvQuotesAndLeavesOut) {
  EXPECT_EQ(csv_of({"id", "t", "",
                    OwnFigure{"N", "x, mm", false, {1, 2}, {{"a \"b\"", {0.1, not_computed()}}}}}),
            "\"x, mm\",\"a \"\"b\"\"\"\n1,0.1\n2,\n");
  EXPECT_EQ(csv_of({"id", "t", "",
                    MapFigure{{"n", "rpm"}, {"m"}, {"e", "%"}, {1, 2}, {3}, {{5, 6}}, {}, {}}}),
            "n (rpm),m,e (%)\n1,3,5\n2,3,6\n");
}

TEST(Picture, DrawingShowsOneFrameToScaleAndHandsOutAll) {
  DrawingFigure drawing{{{"tooth", 0, true}, {"force", 1}},
                        {{{"x", "mm"}, {"y", "mm"}, 0, 10, 0, 5}},
                        {{0, "first", {}, {}}, {38, "second", {{0, 0, 2, {1, 3}, {1, 2}}}, {}}},
                        1};
  drawing.frames[1].arrows.push_back({0, 1, 2, 2, 0, 1});
  const Figure figure{"teeth", "t", "", drawing};
  const std::string svg = svg_of(figure);
  EXPECT_THAT(svg, HasSubstr("At 38 deg: second"));
  EXPECT_THAT(svg, Not(HasSubstr("first")));
  // 2 mm across are as long as 2 mm up: the box is 622 px wide and 10 mm.
  EXPECT_THAT(svg, HasSubstr("M144.2 "));
  std::smatch path;
  ASSERT_TRUE(
      std::regex_search(svg, path, std::regex(R"(M([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+)\")")));
  EXPECT_NEAR(std::stod(path[3]) - std::stod(path[1]),
              2 * (std::stod(path[2]) - std::stod(path[4])), 0.21);
  EXPECT_EQ(csv_of(figure),
            "theta_deg,panel,look,shape,x,y\n38,1,tooth,1,1,1\n38,1,tooth,1,3,2\n"
            "38,1,force,2,2,2\n38,1,force,2,2,3\n");
}

// A force that is round-off has a length, but is no step on paper.
TEST(Picture, AnArrowOfRoundOffIsNotDrawn) {
  DrawingFigure drawing{
      {{"force", 0}}, {{{"z2", "N"}, {"x2", "N"}, 0, 1e4, 0, 5e3}}, {{0, "", {}, {}}}, 0};
  drawing.frames[0].arrows = {{0, 0, 9e3, 1e3, 0, 9e-13}, {0, 0, 9e3, 1e3, 0, 1e3}};
  const std::string svg = svg_of({"polygon", "t", "", drawing});
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  const std::regex head(R"(<path d="M\S+ \S+L\S+ \S+L\S+ \S+Z)");
  EXPECT_EQ(std::distance(std::sregex_iterator(svg.begin(), svg.end(), head), {}), 1);
}

TEST(Picture, ABandThatWasNotComputedLeavesTheOthers) {
  const double gap = not_computed();
  const auto curves = [&](const Values& second) {
    return drawn(svg_of({"id", "t", "",
                         BandFigure{{"time", "s"},
                                    {"R", "N"},
                                    false,
                                    {0, 1},
                                    {{"none", {gap, gap}, {gap, gap}, {gap, gap}},
                                     {"one", second, second, second}}}}));
  };
  const auto all = curves({1, 2});
  EXPECT_TRUE(
      std::any_of(all.begin(), all.end(), [](const auto& curve) { return curve.size() == 2; }));
  EXPECT_TRUE(curves({gap, gap}).empty());
}

// Places of the curve's ends and marks are counted in pixels: 622 across from 82, 185 or 230 up.
TEST(Picture, ACurveThatLeavesFixedEndsIsCutAndMarkedThere) {
  Curves curves = curves_of({{"R", {0, 4, 0, -4, 0}}}, 90);
  ChannelFigure content{"N", {"R"}};
  const auto heights = [&] {
    double top = 1e9, bottom = -1e9;
    for (const auto& curve : drawn(svg_of({"id", "t", "", content}, curves)))
      for (const auto& point : curve) {
        top = std::min(top, point[1]);
        bottom = std::max(bottom, point[1]);
      }
    return std::pair{top, bottom};
  };
  const auto marks = [&] {
    const auto document = read(svg_of({"id", "t", "", content}, curves));
    std::vector<std::string> texts;
    for (const auto& found : document.select_nodes("//path[@class='beyond']/title"))
      texts.emplace_back(found.node().text().get());
    return texts;
  };
  EXPECT_TRUE(marks().empty());
  content.ends = Ends{-5, 5};
  const auto [wide_top, wide_bottom] = heights();
  EXPECT_NEAR(wide_bottom - wide_top, 185 * 8.0 / 10, 0.02);  // the axis has no margin beyond them
  EXPECT_TRUE(marks().empty());
  content.ends = Ends{-2, 5};
  const auto [top, bottom] = heights();
  EXPECT_NEAR(bottom - top, 185 * 6.0 / 7, 0.13);  // 4 above 0, 2 below; cut within a hair
  EXPECT_THAT(marks(), testing::ElementsAre("outside the axis: -4 at 270"));
  content.ends = Ends{-2, 3};
  EXPECT_THAT(marks(),
              testing::ElementsAre("outside the axis: 4 at 90", "outside the axis: -4 at 270"));
  // Cut where it crosses: half way between 180 and 270 deg it is at -2.
  content.ends = Ends{-2, 5};
  const std::string cut_curve = svg_of({"id", "t", "", content}, curves);
  const auto pieces = drawn(cut_curve)[0];
  double lowest = -1e9, at = 0;
  for (const auto& point : pieces)
    if (point[1] > lowest + 1e-9) {
      lowest = point[1];
      at = point[0];
    }
  EXPECT_NEAR(at, 82 + 622 * 225.0 / 360, 0.3);
  // What lies within hangs together: one stretch before it leaves, one after.
  const auto document = read(cut_curve);
  const std::string path =
      document.select_node("//path[@fill='none']").node().attribute("d").value();
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2) << path;
  // What is level is there as a whole or not at all: 1 up to 90 deg, -4 from 180 to 270.
  curves = curves_of({{"R", {1, 1, -4, -4, 1}}}, 90);
  double first = 1e9;
  for (const auto& part : drawn(svg_of({"id", "t", "", content}, curves)))
    for (const auto& point : part) {
      const double angle = (point[0] - 82) * 360 / 622;
      first = std::min(first, angle);
      EXPECT_TRUE(angle < 145 || angle > 305) << angle;
    }
  EXPECT_NEAR(first, 0, 0.2);
}

TEST(Picture, AnAxisOfAPlaneEndsWhereItIsTold) {
  XyFigure content{
      {"a", "m", false, 0.0, 10.0}, {"b", "N", false, 0.0, 4.0}, {{"s", {0, 10}, {0, 4}}}};
  const auto curve = drawn(svg_of({"id", "t", "", content})).at(0);
  EXPECT_NEAR(curve[0][0], 82, 0.06);
  EXPECT_NEAR(curve[1][0], 704, 0.06);
  EXPECT_NEAR(curve[0][1] - curve[1][1], 250, 0.06);
}

// A straight line that comes in from beyond one corner and leaves beyond the other.
TEST(Picture, ALineIsCutWhereItCrossesTheFrame) {
  XyFigure content{
      {"a", "m", false, 0.0, 10.0}, {"b", "N", false, 0.0, 4.0}, {{"s", {-10, 30}, {-1, 7}}}};
  const auto curve = drawn(svg_of({"id", "t", "", content})).at(0);  // b = 1 + a / 5
  ASSERT_EQ(curve.size(), 2U);
  const auto height = [&](std::size_t i) { return 4 * (curve[0][1] - curve[i][1]) / 250; };
  EXPECT_NEAR(curve[0][0], 82, 0.5);
  EXPECT_NEAR(curve[1][0], 704, 0.5);
  EXPECT_NEAR(height(1), 2, 0.02);
  content.series[0] = {"s", {30, -10}, {11, -5}};  // b = 0.4 a - 1, the other way
  const auto back = drawn(svg_of({"id", "t", "", content})).at(0);
  ASSERT_EQ(back.size(), 2U);
  EXPECT_NEAR(back[0][0], 704, 0.5);
  EXPECT_NEAR(back[1][0], 82 + 622 * 0.25, 1);
  EXPECT_NEAR(back[1][1] - back[0][1], 250 * 3.0 / 4, 0.5);
}

TEST(Picture, EqualAxesDrawACircleRound) {
  XyFigure content{{"x", "N"}, {"y", "N"}, {{"circle", {}, {}}}};
  for (int i = 0; i <= 360; ++i) {
    content.series[0].x.push_back(3 * std::cos(i * 3.14159265358979 / 180));
    content.series[0].y.push_back(3 * std::sin(i * 3.14159265358979 / 180));
  }
  content.points = {{"start", 3, 0}, {"further", 9, 0}};
  const auto span = [&] {
    std::array<double, 4> box = {1e9, -1e9, 1e9, -1e9};
    const auto curve = drawn(svg_of({"id", "t", "", content})).at(0);
    for (const auto& point : curve) {
      box = {std::min(box[0], point[0]), std::max(box[1], point[0]), std::min(box[2], point[1]),
             std::max(box[3], point[1])};
    }
    return std::pair{box[1] - box[0], box[3] - box[2]};
  };
  EXPECT_GT(span().first, 1.2 * span().second);
  content.equal = true;
  EXPECT_NEAR(span().first, span().second, 0.3);
  const std::string svg = svg_of({"id", "t", "", content});
  EXPECT_THAT(svg, HasSubstr(">start<"));
  // A point belongs to what is seen: 9 N right of 0 is within the frame.
  const auto document = read(svg);
  double rightmost = 0;
  for (const auto& found : document.select_nodes("//circle"))
    rightmost = std::max(rightmost, found.node().attribute("cx").as_double());
  EXPECT_LT(rightmost, 704);
  EXPECT_GT(rightmost, 82 + span().first);
}

TEST(Picture, CurvesOnTheRightHaveTheirOwnAxis) {
  OwnFigure content{"cm3", "time (ms)", false, {0, 1, 2}, {{"volume", {0, 6, 12}}}};
  content.value = "volume";
  content.right = OwnFigure::Right{"pressure", "bar", {{"chamber", {250, 125, 0}}}};
  const Figure figure{"id", "t", "", content};
  const std::string svg = svg_of(figure);
  const auto curves = drawn(svg);
  ASSERT_EQ(curves.size(), 2U);
  // Each fills its own axis: they cross in the middle of the panel, at both ends they are apart.
  EXPECT_NEAR(curves[0].front()[1], curves[1].back()[1], 0.02);
  EXPECT_NEAR(curves[0].back()[1], curves[1].front()[1], 0.02);
  EXPECT_GT(curves[0].front()[1] - curves[0].back()[1], 190);
  for (const char* text :
       {">volume (cm3)<", ">pressure (bar)<", ">chamber (right)<", ">250<", ">12<"})
    EXPECT_THAT(svg, HasSubstr(text));
  EXPECT_EQ(csv_of(figure), "time (ms),volume,chamber (bar)\n0,0,250\n1,6,125\n2,12,0\n");
}

TEST(Picture, StackedAreasLieUponEachOtherByTheirSign) {
  OwnFigure content{"Nm", "time (ms)", false, {0, 1}, {{"sum", {3, -1}}}};
  content.stack = {{"a", {1, 2}}, {"b", {2, -4}}, {"c", {0, 1}}};
  const Figure figure{"id", "t", "", content};
  const auto document = read(svg_of(figure));
  std::vector<std::vector<double>> heights;  // of the corners, lower edge there and upper edge back
  for (const auto& found : document.select_nodes("//polygon[@class='band']")) {
    std::string text = found.node().attribute("points").value();
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream in(text);
    heights.emplace_back();
    for (double x = 0, y = 0; in >> x >> y;) heights.back().push_back(y);
  }
  ASSERT_EQ(heights.size(), 4U);  // of a and of c there is nothing below 0
  const double zero = heights[0][0];
  const double unit = zero - heights[0][3];  // a at 0 is 1
  const auto value = [&](std::size_t band, std::size_t corner) {
    return (zero - heights[band][corner]) / unit;
  };
  const std::vector<std::array<double, 4>> expected = {
      {0, 0, 2, 1},  // a: low at 0, low at 1, high at 1, high at 0
      {1, 2, 2, 3},
      {0, -4, 0, 0},  // b: 2 upon a, then 4 below 0
      {3, 2, 3, 3}};
  for (std::size_t band = 0; band < expected.size(); ++band)
    for (std::size_t corner = 0; corner < 4; ++corner)
      EXPECT_NEAR(value(band, corner), expected[band][corner], 0.01) << band << " " << corner;
  EXPECT_EQ(csv_of(figure), "time (ms),sum,a,b,c\n0,3,1,2,0\n1,-1,2,-4,1\n");
}

TEST(Picture, AShadeOfADrawingSaysItsValue) {
  DrawingFigure drawing{
      {{"port", 9}}, {{{"x", "mm"}, {"y", "mm"}, 0, 10, 0, 5}}, {{4, "", {}, {}}}};
  drawing.shades = DrawingFigure::Shades{"pressure", "bar", 0, 200};
  drawing.axis = "time (ms)";
  const auto box = [](double from, double value) {
    return DrawingFigure::Line{0, 0, 1, {from, from + 1, from + 1, from}, {1, 1, 2, 1}, value};
  };
  drawing.ground = {box(1, 0)};
  drawing.frames[0].lines = {box(3, 200), box(5, 100)};
  const Figure figure{"id", "t", "", drawing};
  const std::string svg = svg_of(figure);
  const auto document = read(svg);
  std::vector<std::string> fills, keys;
  for (const auto& found : document.select_nodes("//path[@fill-opacity='1']"))
    fills.emplace_back(found.node().attribute("fill").value());
  for (const auto& found : document.select_nodes("//rect[not(@class)]"))
    keys.emplace_back(found.node().attribute("fill").value());
  ASSERT_EQ(keys.size(), 5U);                                           // 0, 50, 100, 150, 200 bar
  EXPECT_THAT(fills, testing::ElementsAre(keys[0], keys[4], keys[2]));  // the ground lies below
  EXPECT_THAT(svg, HasSubstr("pressure: 0 bar"));
  EXPECT_THAT(svg, HasSubstr("time (ms) 4"));
  // Five shades from end to end, be the lower one no 0.
  DrawingFigure above = drawing;
  above.shades->low = 40;
  const std::string keyed = svg_of({"id", "t", "", above});
  for (const char* words : {"pressure: 40 bar", ">80 bar<", ">120 bar<", ">160 bar<", ">200 bar<"})
    EXPECT_THAT(keyed, HasSubstr(words));
  // Three digits, of small numbers too.
  above.shades = DrawingFigure::Shades{"wear", "um", 0, 1.0 / 3};
  EXPECT_THAT(svg_of({"id", "t", "", above}), HasSubstr(">0.0833 um<"));
  EXPECT_THAT(csv_of(figure),
              testing::StartsWith("time (ms),panel,look,shape,x,y\n,1,port,1,1,1\n"));
}

TEST(Picture, FilesAreNamedAfterTheFiguresOfThePaper) {
  const auto name = [](const char* id, const char* paper) {
    return file_name_of({id, "t", paper, OwnFigure{}});
  };
  EXPECT_EQ(name("rs", "Fig. 12"), "fig12_rs");
  EXPECT_EQ(name("pressure", "Fig. 10, 25"), "fig10_25_pressure");
  EXPECT_EQ(name("rcs", "Fig. 32 top"), "fig32_top_rcs");
  EXPECT_EQ(name("polygon", "Fig. 14b"), "fig14b_polygon");
  EXPECT_EQ(name("film", "(51)"), "film");
  EXPECT_EQ(name("budget", ""), "budget");
  EXPECT_EQ(name("fig34_laws", "Fig. 34"), "fig34_laws");
}

// A class has one colour in legend and cells, darker than the one before: it reads in grey. Lines
// lie over the cells with a pale ground, and break where they have no place.
TEST(Picture, MapOfClasses) {
  MapFigure map{{"n", "rpm"}, {"p", "bar"}, {"class"}, {1, 2}, {3, 4}, {{0, 1}, {3, 2}}, {}, {}};
  map.classes = {"a", "b", "c", "d"};
  map.lines = {{"edge", {1, not_computed(), 1.5, 2}, {3, 3.5, 4, 4}}};
  map.marks = XySeries{"odd", {2}, {4}};
  const Figure figure{"id", "t", "", map};
  EXPECT_EQ(csv_of(figure), "n (rpm),p (bar),class\n1,3,a\n2,3,b\n1,4,d\n2,4,c\n");
  const auto document = read(svg_of(figure));
  std::vector<std::string> fills;
  for (const auto& node : document.select_nodes("//rect[not(@class)]"))
    fills.emplace_back(node.node().attribute("fill").value());
  ASSERT_EQ(fills.size(), 8U);
  EXPECT_THAT((std::vector<std::string>(fills.begin() + 4, fills.end())),
              testing::ElementsAre(fills[0], fills[1], fills[3], fills[2]));
  const auto grey = [](const std::string& colour) {
    const long rgb = std::stol(colour.substr(1), nullptr, 16);
    return 0.3 * static_cast<double>(rgb >> 16) + 0.59 * static_cast<double>(rgb >> 8 & 255) +
           0.11 * static_cast<double>(rgb & 255);
  };
  for (std::size_t k = 0; k + 1 < 4; ++k) EXPECT_GT(grey(fills[k]), grey(fills[k + 1]) + 30);
  EXPECT_EQ(document.select_nodes("//circle").size(), 2U);  // the mark, and its key
  const auto edges = document.select_nodes("//path[@class='boundary']");
  ASSERT_EQ(edges.size(), 2U);
  const std::string path = edges[1].node().attribute("d").value();
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'L'), 2);  // the place alone crosses its row
}

double number(const pugi::xml_node& node, const char* attribute) {
  return node.attribute(attribute).as_double(std::nan(""));
}

TEST(Picture, BarsStandOnZeroInTheirOrder) {
  const Figure figure{
      "id", "t", "",
      BarsFigure{{"change", "%"},
                 {{"tilt", -2, 1, "n"}, {"pitch", 0, 4, "", std::pair{3., 5.}}, {"other", 0, 0}}}};
  const auto document = read(svg_of(figure));
  const auto bars = document.select_nodes("//rect[@class='bar']");
  ASSERT_EQ(bars.size(), 3U);  // an end that is 0 has none
  const auto left = [&](int k) { return number(bars[static_cast<std::size_t>(k)].node(), "x"); };
  const auto width = [&](int k) {
    return number(bars[static_cast<std::size_t>(k)].node(), "width");
  };
  const double zero = number(document.select_node("//line[@class='zero']").node(), "x1");
  EXPECT_NEAR(left(0) + width(0), zero, 0.06);
  EXPECT_NEAR(left(1), zero, 0.06);
  EXPECT_NEAR(left(2), zero, 0.06);
  EXPECT_NEAR(width(0), 2 * width(1), 0.03);
  EXPECT_NEAR(width(2), 4 * width(1), 0.05);
  EXPECT_LT(number(bars[1].node(), "y"), number(bars[2].node(), "y"));
  const auto interval = document.select_node("//line[@class='interval']").node();
  EXPECT_NEAR(number(interval, "x1"), zero + 3 * width(1), 0.11);
  EXPECT_NEAR(number(interval, "x2"), zero + 5 * width(1), 0.11);
  // Each end that is not 0 has its number outside of it, a bar of nothing its 0.
  const auto numbers = document.select_nodes("//text[@font-size='11']");
  std::map<std::string, double> places;
  for (const auto& found : numbers) places[found.node().text().get()] = number(found.node(), "x");
  EXPECT_LT(places.at("-2"), left(0));
  EXPECT_GT(places.at("1"), left(1) + width(1));
  EXPECT_GT(places.at("4"), left(2) + width(2));
  EXPECT_EQ(places.count("0"), 1U);
  EXPECT_EQ(csv_of(figure),
            "change (%),low,high,from,to,note\ntilt,-2,1,,,n\npitch,0,4,3,5,\nother,0,0,,,\n");
}

TEST(Picture, NumbersHaveThreeDigitsAndPowersOfTenFarFromOne) {
  const Figure figure{"id", "t", "",
                      BarsFigure{{"change", "%"},
                                 {{"a", -2.5e-4, 0},
                                  {"b", 0, 1.23456e6},
                                  {"c", 0, 12.3456},
                                  {"d", 0, 1e-3},
                                  {"e", 0, 999999.4},
                                  {"f", 0, 0.5}}}};
  std::vector<std::string> numbers;
  const auto document = read(svg_of(figure));
  for (const auto& found : document.select_nodes("//text[@font-size='11']"))
    numbers.emplace_back(found.node().text().get());
  EXPECT_THAT(numbers,
              testing::IsSupersetOf({"-2.5e-4", "1.23e6", "12.3", "0.001", "999999", "0.5"}));
}

TEST(Picture, BandsLieAboutTheirCurves) {
  const Figure figure{"id", "t", "",
                      BandFigure{{"shaft angle", "deg"},
                                 {"R", "N"},
                                 true,
                                 {0, 90, 180, 270},
                                 {{"R", {-1, 0, -1, 0}, {0, 1, 0, 1}, {3, 4, 3, 4}}},
                                 {{"rig", {45, 300}, {2, 2}}}}};
  const std::string svg = svg_of(figure);
  const auto document = read(svg);
  std::string text = document.select_node("//polygon").node().attribute("points").value();
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  std::vector<std::array<double, 2>> band;
  for (double x = 0, y = 0; in >> x >> y;) band.push_back({x, y});
  ASSERT_EQ(band.size(), 8U);  // low there, high back
  const auto curves = drawn(svg);
  ASSERT_EQ(curves.size(), 2U);
  const double newton = (band[0][1] - band[7][1]) / 4;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(curves[0][i][0], band[i][0], 0.11);
    EXPECT_NEAR(band[i][1] - curves[0][i][1], newton, 0.03);
    EXPECT_NEAR(curves[0][i][1] - band[7 - i][1], 3 * newton, 0.03);
  }
  EXPECT_NEAR(curves[1][0][0], (band[0][0] + band[1][0]) / 2, 0.11);
  EXPECT_NEAR(band[0][1] - curves[1][0][1], 3 * newton, 0.03);
  EXPECT_THAT(svg, HasSubstr(">360<"));  // the turn is drawn whole
  EXPECT_EQ(csv_of(figure),
            "series,shaft angle (deg),R (N),low,high\nR,0,0,-1,3\nR,90,1,0,4\nR,180,0,-1,3\n"
            "R,270,1,0,4\nrig,45,2,,\nrig,300,2,,\n");
}

// A line goes through each axis at its value, by the logarithm where the axis is one, by the word
// where it has words; marked designs are drawn again over all.
TEST(Picture, ParallelAxesAreScaledEachByItself) {
  const Figure figure{"id", "t", "",
                      ParallelFigure{{{"a", "mm", {1, 2, 3}},
                                      {"b", "h", {1, 10, 1000}, true},
                                      {"c", "", {1, 0, 1}, false, {"no", "yes"}},
                                      {"d", "", {5, 7, not_computed()}}},
                                     0,
                                     {1},
                                     "best"}};
  const std::string svg = svg_of(figure);
  const auto lines = drawn(svg);
  ASSERT_EQ(lines.size(), 4U);
  const double bottom = lines[0][0][1], top = lines[2][0][1];
  EXPECT_GT(bottom - top, 200);
  EXPECT_NEAR(lines[1][0][1], (bottom + top) / 2, 0.11);
  EXPECT_NEAR(lines[1][1][1], bottom + (top - bottom) / 3, 0.11);
  EXPECT_NEAR(lines[0][2][1], top, 0.11);
  EXPECT_NEAR(lines[1][2][1], bottom, 0.11);
  EXPECT_NEAR(lines[1][3][0] - lines[1][2][0], lines[1][1][0] - lines[1][0][0], 0.21);
  EXPECT_EQ(lines[2].size(), 3U);  // what was not computed has no place
  EXPECT_EQ(lines[3], lines[1]);
  const auto document = read(svg);
  const auto designs = document.select_nodes("//path[@class='design']");
  EXPECT_NE(designs[0].node().attribute("stroke").as_string(),
            std::string(designs[2].node().attribute("stroke").as_string()));
  EXPECT_STREQ(designs[3].node().child("title").text().get(), "a 2 mm, b 10 h, c no, d 7");
  EXPECT_THAT(svg, HasSubstr(">best<"));
  // Five colours of one axis, equally far apart on it.
  Figure by_hours = figure;
  std::get<ParallelFigure>(by_hours.content).colour_by = 1;
  const std::string keyed = svg_of(by_hours);
  for (const char* words : {">b: 1 h<", ">5.62 h<", ">31.6 h<", ">178 h<", ">1000 h<"})
    EXPECT_THAT(keyed, HasSubstr(words));
  EXPECT_EQ(csv_of(figure), "a (mm),b (h),c,d,marked\n1,1,yes,5,0\n2,10,no,7,1\n3,1000,yes,,0\n");
}

// An infeasible place says why; shades can begin anywhere.
TEST(Picture, MapHatchesWhatHasAReason) {
  const double gap = not_computed();
  MapFigure map{{"n", "rpm"}, {"p"}, {"e", "%"}, {1, 2, 3}, {4}, {{90, gap, gap}}, {}, {}};
  map.linear = true;
  map.z.from = 80;
  map.reasons = {{"", "pistons <touch>", ""}};
  const auto document = read(svg_of({"id", "t", "", map}));
  EXPECT_EQ(document.select_nodes("//path[@class='hatch']").size(), 2U);  // of the cell, of its key
  std::vector<std::string> titles;
  for (const auto& node : document.select_nodes("//rect/title"))
    titles.emplace_back(node.node().text().get());
  EXPECT_THAT(titles, testing::ElementsAre("n 1 rpm, p 4: 90 %", "n 2 rpm, p 4: pistons <touch>",
                                           "n 3 rpm, p 4: not computed"));
  EXPECT_STREQ(document.select_node("//text[starts-with(., 'e:')]").node().text().get(), "e: 80 %");
}

// Over a plane that rises along x a line of equal height stands upright.
TEST(Picture, ContourLiesWhereItsLevelIs) {
  MapFigure map{{"x"}, {"y"}, {"z"}, {1, 2, 3}, {4, 5, 6}, {}, {2.25}, {}};
  for (int row = 0; row < 3; ++row) map.values.push_back({1, 2, 3});
  map.linear = true;
  map.marks = XySeries{"dot", {2, 3}, {4, 4}};
  const auto document = read(svg_of({"id", "t", "", map}));
  std::vector<double> dots;
  for (const auto& found : document.select_nodes("//circle"))
    dots.push_back(found.node().attribute("cx").as_double());
  ASSERT_GE(dots.size(), 2U);
  const auto lines = document.select_nodes("//path[@class='contour']");
  ASSERT_GE(lines.size(), 1U);
  std::string text = lines[0].node().attribute("d").value();
  for (char& c : text)
    if (c == 'M' || c == 'L') c = ' ';
  std::istringstream in(text);
  std::sort(dots.begin(), dots.end());
  const double right = dots.back(), middle = dots[dots.size() - 2];
  double low = 1e9, high = -1e9;
  for (double x = 0, y = 0; in >> x >> y;) {
    EXPECT_NEAR(x, middle + 0.25 * (right - middle), 0.2);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  EXPECT_GT(high - low, 100);
}

TEST(Picture, PngHasThreeTimesTheSize) {
  const std::string png = png_of(
      "<svg xmlns='http://www.w3.org/2000/svg' width='30' height='20'><rect width='9' "
      "height='9'/></svg>");
  ASSERT_GT(png.size(), 24U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png[19], 90);
  EXPECT_EQ(png[23], 60);
  EXPECT_THROW(png_of("no picture"), std::runtime_error);
}

}  // namespace
}  // namespace bentaxis::report
