// Reference data: folders of stored curves with a description that is their manifest, read, mapped
// onto the columns of a result and compared with a result table (docs/reference_data.md).
#pragma once

#include <filesystem>
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
  bool is_time = false;  ///< unit s: degrees_per_unit is set by the speed of the case
  double sign = 1;
  double offset_deg = 0;
  std::optional<double> turn_from_deg;  ///< take the turn that starts here from a longer record
};

/// One column of a foreign curve and the channel it stands for: ours = factor x theirs.
struct ColumnMap {
  std::string theirs, ours;
  double unit_in_si = 0;  ///< of theirs; 0 = the channel's own unit
  double factor = 1;      ///< sign and any further factor
};

/// One curve file of a reference.
struct CurveDescription {
  std::filesystem::path file;
  int points = 0;                   ///< rows of the file: tells a truncated one
  std::vector<std::string> models;  ///< that are held to it
  AngleMap angle;
  std::vector<ColumnMap> columns;    ///< empty: the columns have our names
  std::vector<std::string> ignored;  ///< columns of the file that are not compared
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

/// Folders with a description at or below `root`, in the order of their names.
/// @throws InputError where root is no folder, holds no description, or a folder holds files but no
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
};

/// Reads a curve and maps it: columns, units, signs, angle.
/// @param channels         the columns that a result can have
/// @param degrees_per_second  of the shaft, for a curve over time
/// @throws InputError naming file, line or column: unknown or doubled column, wrong number of rows,
///         not a number, angles that do not make one turn.
ReferenceCurve read_reference_curve(const ReferenceDescription& description,
                                    const CurveDescription& curve,
                                    const std::vector<Channel>& channels,
                                    double degrees_per_second);

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
  bool resampled = false;                  ///< the reference had other angles
  double resampling_error = 0;             ///< estimate where it is largest, over peak
  ResultTable reference;                   ///< at the angles of the result

  bool agrees() const;  ///< something was compared and nothing failed
};

/// Compares: |difference| <= absolute + relative x peak at every angle of the result, peak =
/// largest magnitude of the reaction in the reference (or the load scale where that is zero). At
/// angles that the reference lacks it is resampled by a periodic cubic spline, and the error of
/// that, estimated around each angle, is allowed on top. With a tube, the
/// value must lie within the band the reference spans over +- tube_deg, widened by the tolerance.
/// @throws InputError where a curve with gaps would have to be resampled.
/// @param curves  all that hold this model; no channel may be in two of them
Judgement judge(const ReferenceDescription& description, const std::vector<ReferenceCurve>& curves,
                const ResultTable& result, const ZeroScales& zero_scales);

}  // namespace bentaxis::compare
