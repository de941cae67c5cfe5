#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "bentaxis/compare/reference.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "commands.h"
#include "hydraulic_case.h"
#include "reference_set.h"

namespace bentaxis::cli {
namespace {

namespace fs = std::filesystem;
using compare::ReferenceDescription;
using compare::ReferenceKind;

// A golden curve says that something changed, not what: few angles are enough.
constexpr int kGoldenSamples = 36;
// Round-off of the multibody model on the shipped cases is below 2e-13 of peak, and another
// compiler or processor rounds otherwise; a parameter off by 1e-6 of itself shows at 1e-9 or more.
constexpr const char* kGoldenTolerance = "1e-11";
// The hydraulic model steps in time: other round-off chooses other steps, and its error of ln p is
// up to 1e-7 (docs/hydraulics.md); reactions that are small against the pressure forces magnify it.
constexpr const char* kHydraulicGoldenTolerance = "1e-6";

struct Options {
  std::string case_file, from, out, folder;
  int samples = kGoldenSamples;
};

std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": cannot be read: no such file, or no permission");
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void must_be_new(const fs::path& folder) {
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    throw InputError(folder.string() + ": exists and is not empty; --out must name a new folder");
}

// A TOML text in quotes.
std::string toml_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

// ---- reference new: what do the columns of a foreign curve stand for? ---------------------------

// Lower-case words of a column name: "Joint 1.FX [kN]" -> joint 1 fx kn.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char letter : name) {
    const auto c = static_cast<unsigned char>(letter);
    if (std::isalnum(c) == 0) {
      if (!words.back().empty()) words.emplace_back();
    } else {
      words.back() += static_cast<char>(std::tolower(c));
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

// The unit a column's name ends with: "Joint 1.FX [kN]", "torque_Nmm".
std::string unit_in(const std::string& name) {
  std::string last;
  for (const char c : name)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0)
      last += c;
    else if (c == '_' || c == ' ' || c == '[' || c == '(' || c == '/')
      last.clear();
  for (const char* unit : {"N", "kN", "MN", "lbf", "Nm", "kNm", "Nmm", "m", "mm", "um", "in", "Pa",
                           "kPa", "MPa", "bar", "psi"})
    if (last == unit) return unit;
  return "";
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

struct Guess {
  std::string ours, unit;
};

// The channel whose name's words (quantity, piston, axis) all occur in the column's name.
Guess guess_channel(const std::string& column, const std::vector<Channel>& channels) {
  const auto words = words_of(column);
  Guess best;
  std::size_t most = 0;
  for (const Channel& channel : channels) {
    if (channel.kind == ChannelKind::check) continue;
    auto needed = words_of(channel.name);
    needed.pop_back();  // the unit may differ
    // The axis may be given without the number of the frame.
    bool all = true;
    for (const auto& word : needed)
      all = all && (contains(words, word) ||
                    (word == words_of(channel.axis.empty() ? "-" : channel.axis).front() &&
                     contains(words, word.substr(0, 1))));
    if (channel.quantity == "Td" && contains(words, "torque") && channel.axis == "z1") all = true;
    if (all && needed.size() > most) {
      most = needed.size();
      best.ours = channel.name;
    }
  }
  best.unit = best.ours.empty() ? "" : unit_in(column);
  return best;
}

// Column of the angle and its unit; empty where none looks like one.
Guess guess_angle(const std::vector<std::string>& header) {
  for (const auto& column : header)
    for (const char* word : {"theta", "angle", "phi", "rotation", "deg", "degrees"})
      if (contains(words_of(column), word))
        return {column, contains(words_of(column), "rad") ? "rad" : "deg"};
  for (const auto& column : header)
    for (const char* word : {"time", "t", "s"})
      if (contains(words_of(column), word)) return {column, "s"};
  return {};
}

int make_new(const Options& options) {
  const Case the_case = read_case(options.case_file);
  const NumericTable data = read_numeric_csv(options.from, true);
  const ChannelLayout layout(the_case.pump.geometry.pistons);
  const fs::path out = options.out.empty()
                           ? "reference_" + fs::path(options.case_file).stem().string()
                           : options.out;
  must_be_new(out);
  const std::string curve_name = fs::path(options.from).filename();
  if (curve_name == "case.toml" || curve_name == "description.toml")
    throw InputError(options.from + ": a curve must not be named so");

  Guess angle = guess_angle(data.header);
  std::string columns, ignored;
  std::set<std::string> taken;
  int mapped = 0;
  for (const auto& column : data.header) {
    if (column == angle.ours) continue;
    const Guess guess = guess_channel(column, layout.channels());
    if (guess.ours.empty() || !taken.insert(guess.ours).second) {
      ignored += (ignored.empty() ? "" : ", ") + toml_text(column);
      continue;
    }
    ++mapped;
    columns += fmt::format("\n[[curve.column]]\ntheirs = {}\nours = {}\n", toml_text(column),
                           toml_text(guess.ours));
    const std::string own = guess.ours.substr(guess.ours.rfind('_') + 1);
    columns += fmt::format("unit = {}  # of their column\nsign = 1\n",
                           toml_text(guess.unit.empty() ? own : guess.unit));
  }
  if (angle.ours.empty()) {
    angle = {data.header.front(), "deg"};
    ignored.clear();
    for (std::size_t i = 1; i < data.header.size(); ++i)
      if (columns.find("theirs = " + toml_text(data.header[i]) + "\n") == std::string::npos)
        ignored += (ignored.empty() ? "" : ", ") + toml_text(data.header[i]);
  }
  const std::string description = fmt::format(
      "# A guess, made by bentaxis reference new: check every line, then run bentaxis regress on "
      "this "
      "folder.\n"
      "schema = 1\n"
      "kind = \"external\"\n"
      "case = \"case.toml\"\n"
      "source = \"TODO: which tool or rig, which version, who, when\"\n"
      "how_made = \"TODO: model, settings, filtering\"\n"
      "who_may_change = \"TODO\"\n"
      "digits = 6  # that are good in the curve\n"
      "\n"
      "# Allowed: absolute + relative x the reaction's peak. A value near a steep edge may lie "
      "anywhere\n"
      "# between what the curve spans over +-tube_deg.\n"
      "[tolerance]\n"
      "relative = 0.01\n"
      "absolute_N = 0.0\n"
      "absolute_Nm = 0.0\n"
      "tube_deg = 0.0\n"
      "\n"
      "[[curve]]\n"
      "file = {}\n"
      "points = {}\n"
      "ignore = [{}]  # columns that stand for no result\n"
      "\n"
      "# theta_deg = sign x column (in degrees) + offset_deg; theta = 0 where piston 1 is deepest "
      "in.\n"
      "[curve.angle]\n"
      "column = {}\n"
      "unit = {}  # deg, rad, turn, or s with the speed of the case\n"
      "sign = 1\n"
      "offset_deg = 0.0\n"
      "# turn_from_deg = 360.0  # of a record longer than a turn\n"
      "{}",
      toml_text(curve_name), data.rows.size(), ignored, toml_text(angle.ours),
      toml_text(angle.unit), columns);

  OutputFolder folder(out);
  folder.add("case.toml", read_text(options.case_file));
  for (const auto& file : files_of(the_case)) {
    if (fs::absolute(file).lexically_normal().parent_path() !=
        fs::absolute(options.case_file).lexically_normal().parent_path())
      throw InputError(file.string() + ": must lie beside the case to be copied with it");
    folder.add(file.filename(), read_text(file));
  }
  folder.add(curve_name, read_text(options.from));
  folder.add("description.toml", description);
  for (const auto& path : folder.commit()) std::printf("%s\n", path.c_str());
  std::printf(
      "%d of %zu columns recognised; complete description.toml, then: bentaxis regress %s\n",
      mapped, data.header.size() - 1, out.c_str());
  return kDone;
}

// ---- Golden curves
// -------------------------------------------------------------------------------

// What is worth keeping of a result: reactions and what follows from them, not the checks, which
// are round-off.
ResultTable kept(const ResultTable& table) {
  return select_channels(table, [](const Channel& c) { return c.kind != ChannelKind::check; });
}

int make_golden(const Options& options) {
  Case the_case = with_pressure(read_case(options.case_file)).the_case;
  the_case.operation.samples_per_revolution = options.samples;
  must_be_new(options.out);
  const fs::path case_path = fs::absolute(options.case_file)
                                 .lexically_normal()
                                 .lexically_relative(fs::absolute(options.out).lexically_normal());
  std::string description = fmt::format(
      "schema = 1\n"
      "kind = \"golden\"\n"
      "case = {}\n"
      "samples_per_revolution = {}\n"
      "source = \"this program\"\n"
      "how_made = \"bentaxis reference golden; both models, driven\"\n"
      "who_may_change = \"the program, when asked by bentaxis reference update; the change is "
      "reviewed "
      "and its reason stated in the commit\"\n"
      "digits = 16\n"
      "\n[tolerance]\nrelative = {}\n",
      toml_text(case_path.generic_string()), options.samples,
      the_case.pressure.kind == PressureKind::hydraulic ? kHydraulicGoldenTolerance
                                                        : kGoldenTolerance);
  OutputFolder folder(options.out);
  for (const std::string model : {"analytic", "multibody"}) {
    const std::string file = model + ".csv";
    const auto run = run_for_reference(model, the_case);
    folder.add(file, to_csv(kept(run.table)));
    description += fmt::format("\n[[curve]]\nfile = {}\npoints = {}\nmodels = [{}]\n",
                               toml_text(file), run.table.rows(), toml_text(model));
  }
  folder.add("description.toml", description);
  for (const auto& path : folder.commit()) std::printf("%s\n", path.c_str());
  return kDone;
}

// Largest change of each group, as text; "" where nothing changed at all.
std::string changes(const compare::Judgement& judgement) {
  std::map<std::string, const compare::ChannelComparison*> worst;
  std::string text;
  for (const auto& channel : judgement.channels) {
    const auto& c = channel.comparison;
    if (channel.finding == compare::Finding::missing ||
        channel.finding == compare::Finding::incomplete)
      text += fmt::format("    {}: {}\n", c.channel.name,
                          channel.hint.empty() ? "was not stored" : channel.hint);
    if (c.verdict == compare::Verdict::not_computed || c.largest == 0) continue;
    auto& entry = worst[c.channel.group];
    if (entry == nullptr || c.largest_over_peak() > entry->largest_over_peak()) entry = &c;
  }
  for (const auto& [group, c] : worst)
    text += fmt::format("    {:<6} {} at {:g} deg by {:.3g} {}: {:.2e} of peak{}\n", group,
                        c->channel.name, c->theta_of_largest_deg, c->largest, c->channel.unit,
                        c->largest_over_peak(),
                        c->verdict == compare::Verdict::agrees ? " (within tolerance)" : "");
  return text;
}

// Rewrites the curves of one golden reference. @returns whether anything changed
bool update_golden(const ReferenceDescription& description) {
  OutputFolder folder(description.folder);
  const ReferenceCases cases = cases_of(description);
  std::string report, within;
  for (const auto& curve : description.curves) {
    if (curve.models.size() != 1 || !curve.columns.empty() ||
        !fs::equivalent(fs::absolute(curve.file).parent_path(), description.folder))
      throw InputError(
          curve.file.string() +
          ": a golden curve belongs to one model, has our columns and lies in its folder");
    const std::string& model = curve.models.front();
    const Case& the_case = model == "analytic" ? cases.analytic : cases.multibody;
    const ReferenceRun run = run_for_reference(model, the_case);
    const ResultTable table = kept(run.table);
    if (table.rows() != static_cast<std::size_t>(curve.points))
      throw InputError((description.folder / "description.toml").string() +
                       ": points = " + std::to_string(curve.points) + ", but the case now gives " +
                       std::to_string(table.rows()) + " rows: change it there first");
    const std::string text = to_csv(table);
    if (text == read_text(curve.file)) continue;
    std::string what;
    bool agrees = false;
    try {
      const auto stored = compare::read_reference_curve(description, curve, table.channels,
                                                        6 * the_case.operation.speed_rpm);
      const auto judgement = compare::judge(description, {stored}, table, run.zero_scales);
      what = changes(judgement);
      // A new column is worth a new file, round-off is not.
      agrees = judgement.agrees() &&
               std::none_of(judgement.channels.begin(), judgement.channels.end(),
                            [](const auto& c) { return c.finding == compare::Finding::missing; });
    } catch (const InputError& error) {
      what = fmt::format("    the stored curve cannot be read: {}\n", error.what());
    }
    if (agrees) {
      within += fmt::format("  {}: within tolerance, left as it is\n{}",
                            curve.file.filename().string(), what);
      continue;
    }
    report += fmt::format("  {}\n{}", curve.file.filename().string(), what);
    folder.add(curve.file.filename(), text);
  }
  std::printf("%s: %s\n%s%s", description.name.c_str(), report.empty() ? "unchanged" : "rewritten",
              report.c_str(), within.c_str());
  if (report.empty()) return false;
  folder.commit();
  return true;
}

int update(const Options& options) {
  const fs::path root = options.folder;
  std::vector<ReferenceDescription> golden;
  int others = 0;
  std::string kinds;
  for (const auto& place : references_below(root)) {
    auto description = compare::read_description(place.folder, place.name);
    if (description.kind == ReferenceKind::golden) {
      golden.push_back(std::move(description));
      continue;
    }
    ++others;
    const std::string kind = to_string(description.kind);
    if (kinds.find(kind) == std::string::npos) kinds += (kinds.empty() ? "" : ", ") + kind;
  }
  if (golden.empty())
    throw InputError(root.string() + ": holds no golden curves; " + kinds +
                     " data are never written by the program");
  int changed = 0;
  for (const auto& description : golden) changed += update_golden(description);
  std::printf("%d of %zu golden folders rewritten", changed, golden.size());
  if (others > 0)
    std::printf("; %d others (%s) are never written by the program", others, kinds.c_str());
  std::printf(".\n");
  return kDone;
}

}  // namespace

Command add_reference_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("reference", "Make reference data for regress, and update golden curves");
  command->require_subcommand(1);
  const auto add_case = [&](CLI::App& sub) {
    sub.add_option("case", options->case_file, "case file (TOML)")->required()->option_text("CASE");
  };
  CLI::App* make = command->add_subcommand(
      "new", "Folder for a curve of another tool or a rig, with a guess at what its columns are");
  add_case(*make);
  make->add_option("--from", options->from, "the curve (CSV, one header line)")
      ->required()
      ->option_text("CURVE.csv");
  make->add_option("--out", options->out, "new folder")->option_text("DIR [reference_CASE]");
  CLI::App* golden = command->add_subcommand(
      "golden", "Folder with the curves that both models give today, to detect changes");
  add_case(*golden);
  golden->add_option("--samples", options->samples, "angles in the turn")
      ->check(CLI::Range(3, 100000))
      ->option_text("NUMBER [36]");
  golden->add_option("--out", options->out, "new folder")->required()->option_text("DIR");
  CLI::App* renew = command->add_subcommand(
      "update", "Rewrite golden curves and say what changed; never touches other data");
  renew->add_option("dir", options->folder, "folder with references")
      ->required()
      ->option_text("DIR");
  return {command, [=] {
            if (make->parsed()) return make_new(*options);
            if (golden->parsed()) return make_golden(*options);
            return update(*options);
          }};
}

}  // namespace bentaxis::cli
