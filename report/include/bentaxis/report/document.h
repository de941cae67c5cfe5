// What a command has to report, as typed data. json_text makes the report's JSON of it
// (docs/report_json.md, docs/report.schema.json), the page draws that. Whoever fills a document has
// computed everything in it: nothing here computes.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/compare/published.h"
#include "bentaxis/compare/split.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/report/curves.h"
#include "bentaxis/report/scene.h"
#include "bentaxis/results/remarks.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::report {

using bentaxis::AssumptionRow;
using bentaxis::Lines;
using bentaxis::TimingRow;
using bentaxis::Warning;
using compare::PublishedTable;

// ---- Tables of the section "runs"

/// A cell: nothing, yes or no, a text, a count or a number (null where not computed).
using Cell = std::variant<std::monostate, bool, std::string, long, double>;

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

/// A titled block: text, facts, table.
struct Section {
  std::string title, text;
  Lines facts;
  Table table;
};

// ---- Figures

/// A curve that a figure brings itself.
struct Series {
  std::string label;
  Values values;
};

/// Ends of an axis that stand, whatever is drawn. A curve that leaves them is cut, and marked
/// there.
struct Ends {
  double low, high;
};

/// Curves of the page by their names, one colour each; both models and their difference.
struct ChannelFigure {
  std::string unit;
  std::vector<std::string> channels;
  std::vector<Series> extra = {};               ///< over the same angles
  std::optional<Curves> curves = std::nullopt;  ///< instead of the page's, at angles of their own
  std::optional<Ends> ends = std::nullopt;      ///< of the values
};

/// Each piston's share at one angle that can be chosen; buttons lead to `angles` (deg).
struct PistonBars {
  std::string unit;
  std::vector<std::string> channels;
  std::vector<double> angles;
};

/// Curves over an axis of their own.
struct OwnFigure {
  std::string unit, axis;
  bool angle = false;  ///< the axis is one of shaft angles, deg
  Values x;
  std::vector<Series> series = {};
  /// Areas upon each other, what is positive upwards from 0, what is negative downwards; `series`
  /// are lines over them.
  std::vector<Series> stack = {};
  /// Curves with an axis of their own on the right.
  struct Right {
    std::string value, unit;  ///< what is drawn against it
    std::vector<Series> series;
  };
  std::optional<Right> right = std::nullopt;
  std::string value = "value";              ///< what is drawn against the axis on the left
  std::optional<Ends> ends = std::nullopt;  ///< of the axis on the left
};

/// An axis of a plane figure. `from` fixes its lower end, `to` its upper one: a curve that leaves
/// it is cut, and marked there.
struct Axis {
  std::string label, unit = {};
  bool log = false;
  std::optional<double> from = std::nullopt;
  std::optional<double> to = std::nullopt;
};

struct XySeries {
  std::string label;
  Values x, y;
  bool dashed = false;
  void add(double at_x, double at_y) {
    x.push_back(at_x);
    y.push_back(at_y);
  }
  void close() { add(x.front(), y.front()); }  ///< ends where it begins
};

/// A place in a plane, by name.
struct NamedPoint {
  std::string label;
  double x, y;
};

/// Any quantity over any other.
struct XyFigure {
  Axis x, y;
  std::vector<XySeries> series;
  bool equal = false;  ///< a unit is as long across as up: either axis shows more where it has room
  std::vector<NamedPoint> points = {};  ///< drawn over the series
};

/// A quantity, or one of a few classes, over two others: values[i][j] at y_values[i], x_values[j].
struct MapFigure {
  Axis x, y, z;
  Values x_values, y_values;
  std::vector<Values> values;
  std::vector<double> contours;
  std::vector<NamedPoint> points;
  /// What the values 0, 1, .. stand for, drawn light to dark. None: shades go by the quantity's
  /// logarithm, or from 0 (from z.from, where that is set) by itself where `linear`.
  std::vector<std::string> classes = {};
  bool linear = false;
  std::vector<XySeries> lines = {};              ///< drawn over it; a place alone, across its row
  std::optional<XySeries> marks = std::nullopt;  ///< places of the map, each a dot
  /// Why values are not there, as `values`: such a place is hatched, where there is a reason.
  std::vector<std::vector<std::string>> reasons = {};
};

struct ScatterPoint {
  double x, y;
  std::string note;  ///< shown when pointed at
};

struct ScatterSeries {
  std::string name;
  std::optional<int> style;  ///< symbol and colour; the same for the same thing in every figure
  bool line = false;
  bool emphasis = false;  ///< broad and pale under the others
  std::vector<ScatterPoint> points;
};

/// Points in a plane.
struct ScatterFigure {
  Axis x, y;
  std::vector<ScatterSeries> series;
};

/// Drawings to scale, one per angle, of which one can be chosen. They stand below each other.
struct DrawingFigure {
  /// What is drawn alike: a colour of its own, named in the legend.
  struct Look {
    std::string label;
    int colour = 0;
    bool filled = false;  ///< the inside of its lines, pale
  };
  struct Line {
    int panel = 0, look = 0;
    double width = 1;  ///< of the line, px
    Values x, y;
    std::optional<double> value = std::nullopt;  ///< shades its inside, as `shades` says
    void add(double at_x, double at_y) {
      x.push_back(at_x);
      y.push_back(at_y);
    }
  };
  struct Arrow {
    int panel = 0, look = 0;
    double x = 0, y = 0, dx = 0, dy = 0;  ///< from, along
  };
  struct Panel {
    Axis x, y;  ///< of one scale
    double x_low = 0, x_high = 1, y_low = 0, y_high = 1;
  };
  struct Frame {
    double theta_deg = 0;  ///< or what `axis` names
    std::string text;      ///< what there is to say of it
    std::vector<Line> lines;
    std::vector<Arrow> arrows;
  };
  /// What the values of lines mean: light at `low`, dark at `high`.
  struct Shades {
    std::string label, unit;
    double low = 0, high = 1;
  };
  std::vector<Look> looks;
  std::vector<Panel> panels;
  std::vector<Frame> frames;
  std::size_t shown = 0;  ///< the frame that a still picture shows, and a page at first
  std::optional<Shades> shades = std::nullopt;
  std::vector<Line> ground = {};  ///< below the lines of every frame
  std::string axis = {};          ///< of the frames, where it is no shaft angle: "time (ms)"
};

/// Bars lying one below the other, in the order given: each from 0 to `low` and from 0 to `high`.
struct BarsFigure {
  struct Bar {
    std::string label;
    double low = 0, high = 0;
    std::string note = {};  ///< shown when pointed at
    std::optional<std::pair<double, double>> interval =
        std::nullopt;  ///< within which the end lies
  };
  Axis x;  ///< linear
  std::vector<Bar> bars;
};

/// Curves with bands about them over one axis, and others over values of their own.
struct BandFigure {
  struct Band {
    std::string label;
    Values low, middle, high;  ///< at `x_values`
  };
  Axis x, y;
  bool angle = false;  ///< x is a shaft angle, deg
  Values x_values;
  std::vector<Band> bands;
  std::vector<XySeries> lines = {};
};

/// Many designs, each a line over parallel axes, one for each number of a design.
struct ParallelFigure {
  struct Column {
    std::string label, unit;
    Values values;  ///< one per design
    bool log = false;
    std::vector<std::string> words = {};  ///< what the values 0, 1, .. stand for
  };
  std::vector<Column> columns;
  std::size_t colour_by = 0;             ///< the column that gives lines their colours
  std::vector<std::size_t> marked = {};  ///< designs drawn over the others
  std::string marked_label = {};         ///< what these are: "Pareto front"
};

struct FigureContent
    : std::variant<ChannelFigure, PistonBars, OwnFigure, XyFigure, MapFigure, ScatterFigure,
                   DrawingFigure, BarsFigure, BandFigure, ParallelFigure> {
  using variant::variant;
  BENTAXIS_COMPILED_ONCE(FigureContent);
};

struct Figure {
  std::string id, title;
  std::string paper;  ///< figures of the paper that it answers, or ""
  FigureContent content;
  std::string note = {};
};

// ---- Sections

/// Where a report comes from.
struct Provenance {
  struct Input {
    std::string file;    ///< name, with that of its folder
    std::string sha256;  ///< of what was read
  };
  std::string command;  ///< line, as a shell takes it
  std::string date;     ///< ISO 8601, UTC
  std::string version;  ///< of bentaxis
  std::vector<Input> inputs;
  Lines machine;  ///< processor, system, compiler
};

struct CaseSection {
  std::string file;
  std::vector<InputEntry> entries;
};

struct DerivedQuantity {
  std::string name, symbol;
  double value;
  std::string unit, source;
};

/// The channel with the largest difference over its peak.
struct WorstChannel {
  std::string channel;
  double over_peak, theta_deg;
};

/// What is absent does not apply to this report.
struct Verdict {
  /// The worst of all verdicts of the report, as the exit status; nothing where nothing
  /// was compared: a finding, not a verdict.
  std::optional<bool> agrees;
  std::string headline;
  std::string word = {};  ///< instead of "Agrees" or "Differs", or ""
  std::optional<double> tolerance = std::nullopt;
  std::optional<int> compared = std::nullopt;  ///< number of channels
  std::string not_valid = {};  ///< where no pump behaves so: "over 7.5 % of the turn", or ""
  std::optional<bool> checks_hold = std::nullopt;
  std::optional<double> digits = std::nullopt;  ///< of the worst channel
  std::optional<WorstChannel> worst = std::nullopt;
  std::optional<double> rest_over_peak = std::nullopt;  ///< under unequal assumptions
  std::optional<double> rest_tolerance = std::nullopt;
  struct Further {
    std::string name, headline;
    bool agrees;
  };
  std::optional<Further> reference =
      std::nullopt;  ///< of both models against curves from elsewhere
  /// Chi-square test of a fit.
  struct Fit {
    double chi_square = 0;
    long degrees_of_freedom = 0;
    std::optional<double> p_value = std::nullopt;  ///< nothing without degrees of freedom
    double refuted_below = 0;                      ///< the p-value that refutes a fit
    bool refuted = false;
  };
  std::optional<Fit> fit = std::nullopt;
  std::optional<bool> models_agree = std::nullopt;  ///< beside a reference: the models alone
  /// Why models differ that should not, as far as it is known.
  struct Cause {
    std::string text;
    double round_off_over_peak, over_peak;  ///< estimated, and found
  };
  std::optional<Cause> cause = std::nullopt;
  /// What the command was asked, answered in sentences, the most important first.
  std::vector<std::string> answers = {};
};

/// Plausibility warnings of the case.
struct PlausibilityRow {
  std::string code, text;
  std::string reason;  ///< why they are meant, or ""
};
using DoubtRow [[deprecated("use PlausibilityRow")]] = PlausibilityRow;

struct PlausibilitySection {
  std::string summary;  ///< the pump in one line
  std::vector<PlausibilityRow> warnings, meant;
};

/// An input that both models share.
struct CommonInput {
  std::string input, value, caught_by;
};

/// A limit of the models' validity over the turn, or in the rows of a motion. Where it does not
/// apply, the numbers are absent.
struct ValidityRow {
  std::string limit, unit, consequence;
  bool applicable = true;
  double violated_share = 0, worst = 0, theta_deg = 0;
  std::optional<double> time_s = std::nullopt;  ///< of the worst value, of a motion
};

/// How a table was obtained.
struct ModelSection {
  std::string name;
  Lines assumptions, facts;
  double seconds = 0;
  std::size_t angles = 0;
};
ModelSection model_of(const ResultTable& table, const Lines& assumptions);

/// Contribution of each differing assumption to each channel.
struct AssumptionSplit {
  std::string text;
  std::vector<AssumptionRow> rows;
  compare::Split split;
};

/// Torque and power by cause, efficiencies and the block's balance. Values are one per model.
struct Budget {
  struct Torque {
    std::string cause, column;  ///< column of the budgets' CSV files
    Values mean, least, greatest;
    Values carrying;  ///< mean of its part in the torque that carries the block round
    double largest_difference = 0;
    std::string verdict;
  };
  struct Quantity {
    std::string name, kind, unit;
    Values values;
    std::string note;
  };
  std::string text;
  std::vector<std::string> models;
  std::vector<Torque> torque;  ///< Nm; the last is the whole
  std::vector<Quantity> power, efficiency, block;
};

/// The numbers that are asked for first.
struct KeyFigures {
  struct Row {
    std::string quantity, symbol, unit;
    Values values;                                    ///< one per model
    std::optional<double> difference = std::nullopt;  ///< of the models, second minus first
    std::optional<double> over_value = std::nullopt;  ///< its size over that of the first
    std::optional<double> at = std::nullopt;          ///< angle or time of the first
    std::string note = {};
  };
  std::vector<std::string> models;
  std::string at_unit = "deg";
  std::vector<Row> rows;
};

/// What is to be said in words.
struct Summary {
  struct Group {
    std::string title;
    std::vector<std::string> lines;
  };
  std::string text;
  std::vector<Group> groups;
};

// ---- Records of single commands

/// One row of `tradeoff`: key and value.
using Record = std::vector<std::pair<std::string, Cell>>;

/// One case of `hardcases`.
struct HardCaseRow {
  struct Group {
    std::string group;
    double loss_over_peak, predicted;
  };
  struct Model {
    std::string model, expected, verdict, message;
    std::optional<double> digits;
    std::vector<Group> groups;
    std::string weak_point;
    std::optional<double> measured_over_predicted;
    double microseconds_per_angle;
  };
  std::string name, group, hard;
  std::vector<std::string> changes;
  std::vector<Model> models;
};

struct LongRunSection {
  Section section;
  bool bounded = true;
};

/// A report. A part that is absent is left out of the JSON and of the page; a list that is there
/// may be empty.
struct Document {
  BENTAXIS_COMPILED_ONCE(Document);

  std::string title;
  Lines program;  ///< versions
  std::optional<Provenance> provenance;
  std::vector<std::string> files;  ///< written together with it, it too; none: it stands alone
  std::optional<CaseSection> the_case;
  std::optional<PlausibilitySection> plausibility;
  std::string picture;         ///< SVG at the head of the page, or ""; not in the JSON
  std::optional<Scene> scene;  ///< the pump in space; not in the JSON
  std::optional<std::vector<DerivedQuantity>> derived;
  std::optional<Verdict> verdict;
  std::string meaning;  ///< what the verdict says and what not, or ""
  std::optional<KeyFigures> key_figures;
  std::optional<Summary> summary;
  std::optional<std::vector<Warning>> warnings;
  std::optional<std::vector<CommonInput>> common;
  std::optional<std::vector<ValidityRow>> validity;
  std::optional<std::vector<TimingRow>> timing;
  std::optional<std::vector<ModelSection>> models;
  std::optional<compare::Comparison> comparison;  ///< "channels"
  std::optional<std::vector<compare::Check>> checks;
  std::optional<Budget> budget;
  std::optional<AssumptionSplit> assumptions;
  std::optional<PublishedTable> published;
  std::optional<std::vector<Section>> runs;
  std::optional<std::vector<Figure>> figures;
  std::optional<std::vector<Record>> records;          ///< "rows"
  std::optional<std::vector<HardCaseRow>> hard_cases;  ///< "cases"
  std::optional<LongRunSection> long_run;
};

/// The report as docs/report.schema.json describes it, as the text of a file: JSON. Text that is no
/// UTF-8 is replaced, never refused.
std::string json_text(const Document& document);

/// Its list "files"; empty where the text is no report.
std::vector<std::string> files_of(const std::string& json_text);

// Without a blank between the values, for the page. Curves to 9 digits: enough for a plot;
// differences to 4.
std::string compact_json(const Document& document);
std::string compact_json(const Curves& curves);

/// For the page: as compact_json(), but columns and differences as base64 of the upper five bytes
/// of each number (9 digits), little-endian, NaN where not computed; a column of the second table
/// that is the first one's with the difference, to these digits, is `true`.
std::string packed_json(const Curves& curves);

/// A column by its name; nullptr where there is none.
const Values* find(const std::vector<std::pair<std::string, Values>>& columns,
                   const std::string& name);

/// Curves of both tables, but for their checks, and the difference of what was computed.
/// Differences are taken before rounding.
Curves curves_of(const ResultTable& first, const ResultTable& second);

/// Of one table.
Curves curves_of(const ResultTable& only);

/// Results of the first and of the second model.
using TablePair = std::pair<const ResultTable&, const ResultTable&>;
/// Which of the tables' rows curves have: of very many those that a page shows (Curves::rows),
/// which take a fraction of the tables' memory.
enum class Rows { all, shown };
/// Of pairs of tables of the same rows; a column that an earlier pair has is not added again.
Curves curves_of(const std::vector<TablePair>& pairs, Rows which);

/// One channel's values.
Values values_of(const ResultTable& table, const std::string& channel_name);

}  // namespace bentaxis::report
