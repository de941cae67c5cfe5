// Reference data: folders of stored curves with a description that is their manifest, read, mapped
// onto the columns of a result and compared with a result table (docs/reference_data.md).
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::compare {

/// What a reference can show.
enum class ReferenceKind {
  high_precision,  ///< curves computed independently: verification
  published,       ///< printed numbers: validation (published.h)
  golden,          ///< our own earlier results: change detection
  external,        ///< a user's curves from another tool or a rig
};
std::string to_string(ReferenceKind kind);

/// How the angle of a foreign curve becomes the shaft angle:
/// theta_deg = sign x (column in degrees) + offset_deg.
struct AngleMap {
  std::string column = "theta_deg";
  double degrees_per_unit = 1;
  std::string unit = "deg";
  bool is_time = false;  ///< degrees_per_unit are then seconds, and the speed of the case counts
  double sign = 1;       ///< and any further factor
  double offset_deg = 0;
  double rounding_deg = 0;              ///< the angles of the file are good to this
  std::optional<double> turn_from_deg;  ///< take the turn that starts here from a longer record
};

/// Rows are axes: three unit vectors at right angles, right-handed.
using Axes = std::array<std::array<double, 3>, 3>;
inline constexpr Axes kNoTurn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// The axes of a case's frames that do not turn, by name ("S1", "S2"): rows are x, y, z in S1.
using FrameAxes = std::map<std::string, Axes>;

/// The frame that the vectors of a foreign curve are given in: one for the whole file.
struct FrameMap {
  std::string axes_of;  ///< "S1", "S2": all of them in axes turned out of these; "" = each out of
                        ///< the axes of its own reaction
  Axes cosines = kNoTurn;  ///< rows: their x, y, z in those axes
  std::string words;       ///< as the description says it
};
/// Axes that are turned out of others by three angles about axes that turn along.
/// @param sequence  axes, as in "ZXZ" or "313"
/// @throws InputError where it is none
Axes turned_axes(const std::string& sequence, const std::array<double, 3>& angles_deg);
/// Axes that are given in one frame, in the axes of another.
Axes carried(const Axes& axes, const Axes& from, const Axes& to);

/// What a vector is called that a channel is a component of: quantity and piston, "Rs_1", "Rb1".
std::string vector_name(const Channel& channel);

/// Three columns that are the components of one vector in their frame: ours = factor x theirs,
/// turned.
struct VectorMap {
  std::array<std::string, 3> theirs;  ///< "" = the file lacks this component
  std::string ours;                   ///< quantity and piston: "Rs_1", "Rb1"
  std::string unit;                   ///< of theirs; "" = the channels' own
  double unit_in_si = 0;              ///< 0 = the channels' own unit
  double factor = 1;
  std::string file_says = {};  ///< another unit in the file's heading, or ""
};

/// One column of a foreign curve and the channel it stands for: ours = factor x theirs.
struct ColumnMap {
  std::string theirs, ours;
  std::string unit;            ///< of theirs; "" = the channel's own
  double unit_in_si = 0;       ///< of theirs; 0 = the channel's own unit
  double factor = 1;           ///< sign and any further factor
  std::string file_says = {};  ///< another unit in the file's heading, or ""
};

/// One curve file of a reference.
struct CurveDescription {
  std::filesystem::path file;
  int points = 0;                   ///< rows of the file: tells a truncated one
  std::vector<std::string> models;  ///< that are held to it
  std::string sheet;                ///< of a workbook, variable of a MATLAB file
  bool guessed = false;             ///< the mapping was guessed and nobody has confirmed it
  AngleMap angle;
  FrameMap frame;
  std::vector<VectorMap> vectors;
  std::vector<ColumnMap> columns;    ///< empty: the columns have our names
  std::vector<std::string> ignored;  ///< columns of the file that are not compared
  /// Vectors of a guess of which one has a component of the wrong sign, the file does not say
  /// which.
  std::vector<std::string> one_is_wrong = {};
};

/// The description.toml of a reference folder.
struct ReferenceDescription {
  std::filesystem::path folder;
  std::string name;  ///< path of the folder below the root of the set
  ReferenceKind kind = ReferenceKind::external;
  std::filesystem::path case_file;
  std::filesystem::path multibody_case_file;  ///< the case itself unless another one is named
  std::optional<int> samples_per_revolution;  ///< instead of the case's
  std::string source, how_made, who_may_change;
  int digits = 16;
  double relative = 0;                     ///< of peak
  std::map<std::string, double> absolute;  ///< per unit
  double tube_deg = 0;
  std::vector<CurveDescription> curves;
  std::vector<std::filesystem::path> documents;
  std::filesystem::path numbers;  ///< of a published reference

  /// Golden and high-precision curves hold every reaction; an external one what it has.
  bool must_be_complete() const {
    return kind == ReferenceKind::golden || kind == ReferenceKind::high_precision;
  }
};

/// What a guessed mapping assumes, in words, one line each; empty where it was not guessed.
std::vector<std::string> assumptions_of(const CurveDescription& curve);

/// A unit that foreign columns may have: the channels' unit it is a multiple of ("N", "Nm", "mm",
/// "bar") and its value in SI; nullptr where there is none of this name (known_unit()).
struct ForeignUnit {
  std::string family;
  double si = 0;
};
const ForeignUnit* find_unit(const std::string& name);
/// Degrees that one unit of an angle is; 0 where it is none.
double degrees_per(const std::string& angle_unit);
/// Seconds that one unit of time is; 0 where it is none.
double seconds_per(const std::string& time_unit);

/// Folders with a description at or below `root`, in the order of their names.
/// @throws InputError where root is not a directory, has no description, or a folder holds files
/// but no
///         description (README.md, folders named "generator", for people, and folders with a
///         catalogue.toml, of other commands, are left alone).
std::vector<std::filesystem::path> find_references(const std::filesystem::path& root);

/// Reads folder/description.toml. @throws InputError naming file, line and key.
ReferenceDescription read_description(const std::filesystem::path& folder, const std::string& name);

/// The folder is the manifest. `used` are files named by something else (the case's pressure
/// curve).
/// @throws InputError naming the first file that nothing uses, or that is missing.
void check_files(const ReferenceDescription& description,
                 const std::vector<std::filesystem::path>& used);

/// A stored curve in our columns, over one turn.
struct ReferenceCurve {
  std::filesystem::path file;
  ResultTable table;     ///< angles rising in [0, 360)
  std::size_t rows = 0;  ///< of the file
  double angle_rounding_deg = 0;
  std::vector<std::string> notes;  ///< what of the file is not compared and why
};

/// Reads a curve and maps it: columns, units, signs, angle.
/// @param channels         the columns that a result can have
/// @param degrees_per_second  of the shaft, for a curve over time
/// @param frames              of the case, for vectors in other axes than their own
/// @throws InputError naming file, line or column: unknown or doubled column, wrong number of rows,
///         not a number, angles that do not make one turn.
ReferenceCurve read_reference_curve(const ReferenceDescription& description,
                                    const CurveDescription& curve,
                                    const std::vector<Channel>& channels, double degrees_per_second,
                                    const FrameAxes& frames = {});

/// Rows of a record in the order of the shaft angle, each with its angle in [0, 360); one turn.
struct Turn {
  std::vector<double> theta_deg;
  std::vector<std::size_t> rows;
  /// First row, and the same again a turn later.
  std::optional<std::pair<std::size_t, std::size_t>> repeated;
};
/// @param values  of the column of the angle
/// @param place   of a row, for messages
/// @throws InputError where the record makes no turn
Turn one_turn(const std::string& file, const AngleMap& map, const std::vector<double>& values,
              const std::function<std::string(std::size_t)>& place, double degrees_per_second);

/// What became of one channel.
enum class Finding {
  agrees,
  differs,
  missing,     ///< the reference has no such curve: neither agreement nor disagreement
  incomplete,  ///< one of both has values that the other lacks, or a reaction that must be there
  absent,      ///< computed by neither
};
const char* to_string(Finding finding);

struct ReferenceChannel {
  ChannelComparison comparison;
  Finding finding = Finding::missing;
  std::string hint;  ///< of a differing channel: what it looks like ("opposite sign")
  bool failed() const { return finding == Finding::differs || finding == Finding::incomplete; }
};

/// A result held against a reference.
struct Judgement {
  std::vector<ReferenceChannel> channels;  ///< reactions and what follows from them
  bool resampled = false;       ///< the reference had other angles, and the result could not follow
  double resampling_error = 0;  ///< estimate where it is largest, over peak
  ResultTable reference;        ///< at the angles of the result
  ResultTable low, high;        ///< with a tube: what it spans there; else empty
  ResultTable resampling;       ///< how far it may be off there: by resampling, estimated, or by
                                ///< the rounding of its angles
  ResultTable result;           ///< of a model that followed: at the angles of all curves
  bool at_own_angles = false;   ///< these are not among the samples of the case
  struct Gap {
    double from_deg = 0, to_deg = 0;
  };
  /// Where the curves have no points for long, so that nothing is compared.
  std::vector<Gap> gaps;

  bool agrees() const;  ///< something was compared and nothing failed
};

/// A model at any angles of a turn, deg.
using ResultAt = std::function<ResultTable(const std::vector<double>& theta_deg)>;

/// Rows of a table at these angles of a turn; nothing where it lacks one.
std::optional<ResultTable> rows_at(const ResultTable& table, const std::vector<double>& theta_deg);

/// Compares at the angles of the curves: |difference| <= absolute + relative x peak, peak = largest
/// magnitude of the reaction in the reference (or the load scale where that is zero). Where the
/// angles of a curve are rounded, what the model changes within that is allowed on top. With a
/// tube, the value must lie within the band the reference spans over +- tube_deg, widened by the
/// tolerance.
/// @throws InputError where a curve has no points over more than 30 deg, and these are not the
///         angles of `case_theta_deg`
/// @param curves  all that hold this model; no channel may be in two of them
/// @param case_theta_deg  angles of the case's own samples
Judgement judge(const ReferenceDescription& description, const std::vector<ReferenceCurve>& curves,
                const ResultAt& result_at, const std::vector<double>& case_theta_deg,
                const ZeroScales& zero_scales);

/// The same at the angles of a result that cannot follow: |difference| <= absolute + relative x
/// peak at every angle of the result, peak = largest magnitude of the reaction in the reference (or
/// the load scale where that is zero). At angles that the reference lacks it is resampled by a
/// periodic cubic spline, and the error of that, estimated around each angle, is allowed on top.
/// With a tube, the value must lie within the band the reference spans over +- tube_deg, widened by
/// the tolerance.
/// @throws InputError where a curve with gaps would have to be resampled.
/// @param curves  all that hold this model; no channel may be in two of them
Judgement judge(const ReferenceDescription& description, const std::vector<ReferenceCurve>& curves,
                const ResultTable& result, const ZeroScales& zero_scales);

}  // namespace bentaxis::compare
