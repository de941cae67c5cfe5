#include "bentaxis/study/reference_maker.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/reference_set.h"

namespace bentaxis::study {

namespace fs = std::filesystem;
using compare::ReferenceDescription;
using compare::ReferenceKind;

namespace {

// Round-off of the multibody model on the shipped cases is below 2e-13 of peak, and another
// compiler or processor rounds otherwise; a parameter off by 1e-6 of itself shows at 1e-9 or more.
constexpr const char* kGoldenTolerance = "1e-11";
// The hydraulic model steps in time: other round-off chooses other steps, and its error of ln p is
// up to 1e-7 (docs/hydraulics.md); reactions that are small against the pressure forces magnify it.
constexpr const char* kHydraulicGoldenTolerance = "1e-6";

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
  const toml::value<std::string> value(text);
  const auto flags =
      toml::toml_formatter::default_flags & ~toml::format_flags::allow_literal_strings;
  std::ostringstream out;
  out << toml::toml_formatter(value, flags);
  return out.str();
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

// What is worth keeping of a result: reactions and what follows from them, not the checks, which
// are round-off.
ResultTable kept(const ResultTable& table) {
  return select_channels(table, [](const Channel& c) { return c.kind != ChannelKind::check; });
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
    if (!c.compared() || c.largest == 0) continue;
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

}  // namespace

NewReference make_reference(const Case& the_case, bool changed, const fs::path& curve,
                            const fs::path& out) {
  const NumericTable data = read_numeric_csv(curve, true);
  const ChannelLayout layout(the_case.pump.geometry.pistons);
  must_be_new(out);
  const std::string curve_name = curve.filename();
  if (curve_name == "case.toml" || curve_name == "description.toml")
    throw InputError(curve.string() + ": a curve must not be named so");

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
  // A case written anew names its curve where it lies.
  folder.add("case.toml", changed ? case_text(the_case) : read_text(the_case.file));
  for (const auto& file : changed ? std::vector<fs::path>{} : files_of(the_case)) {
    if (fs::absolute(file).lexically_normal().parent_path() !=
        fs::absolute(the_case.file).lexically_normal().parent_path())
      throw InputError(file.string() + ": must lie beside the case to be copied with it");
    folder.add(file.filename(), read_text(file));
  }
  folder.add(curve_name, read_text(curve));
  folder.add("description.toml", description);
  return {folder.commit(), mapped, data.header.size() - 1};
}

std::vector<fs::path> make_golden(Case the_case, bool changed, int samples, const fs::path& out,
                                  const PartProgress& progress_of) {
  ReadyCase ready = prepare(std::move(the_case), progress_of);
  ready.the_case.operation.samples_per_revolution = samples;
  must_be_new(out);
  const fs::path case_path = changed
                                 ? fs::path("case.toml")
                                 : fs::absolute(ready.the_case.file)
                                       .lexically_normal()
                                       .lexically_relative(fs::absolute(out).lexically_normal());
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
      toml_text(case_path.generic_string()), samples,
      ready.the_case.pressure.kind == PressureKind::hydraulic ? kHydraulicGoldenTolerance
                                                              : kGoldenTolerance);
  OutputFolder folder(out);
  if (changed) folder.add("case.toml", case_text(ready.the_case));
  for (const Model model : kModels) {
    const std::string file = to_string(model) + ".csv";
    const auto run = run_for_reference(ready, model, progress_of);
    folder.add(file, to_csv(kept(run.table)));
    description += fmt::format("\n[[curve]]\nfile = {}\npoints = {}\nmodels = [{}]\n",
                               toml_text(file), run.table.rows(), toml_text(to_string(model)));
  }
  folder.add("description.toml", description);
  return folder.commit();
}

GoldenUpdate update_golden(const ReferenceDescription& description,
                           const PartProgress& progress_of) {
  OutputFolder folder(description.folder);
  const ReferenceCases cases(description, progress_of);
  std::string report, within;
  for (const auto& curve : description.curves) {
    if (curve.models.size() != 1 || !curve.columns.empty() ||
        !fs::equivalent(fs::absolute(curve.file).parent_path(), description.folder))
      throw InputError(
          curve.file.string() +
          ": a golden curve belongs to one model, has our columns and lies in its folder");
    const Model model =
        curve.models.front() == to_string(Model::analytic) ? Model::analytic : Model::multibody;
    const Case& the_case = cases.of(model).the_case;
    const ReferenceRun run = run_for_reference(cases.of(model), model, progress_of);
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
  if (!report.empty()) folder.commit();
  return {!report.empty(), fmt::format("{}: {}\n{}{}", description.name,
                                       report.empty() ? "unchanged" : "rewritten", report, within)};
}

GoldenSet find_golden(const fs::path& root) {
  GoldenSet set;
  for (const auto& place : references_below(root)) {
    auto description = compare::read_description(place.folder, place.name);
    if (description.kind == ReferenceKind::golden) {
      set.golden.push_back(std::move(description));
      continue;
    }
    ++set.others;
    const std::string kind = to_string(description.kind);
    if (set.kinds.find(kind) == std::string::npos)
      set.kinds += (set.kinds.empty() ? "" : ", ") + kind;
  }
  if (set.golden.empty())
    throw InputError(root.string() + ": holds no golden curves; " + set.kinds +
                     " data are never written by the program");
  return set;
}

}  // namespace bentaxis::study
