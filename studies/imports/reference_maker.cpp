#include "bentaxis/study/reference_maker.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/kept_case.h"
#include "bentaxis/files/new_folder.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/study/reference_set.h"
#include "bentaxis/study/regression.h"

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

void must_be_new(const fs::path& folder) {
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    throw InputError(folder.string() + ": exists and is not empty; --out must be a new directory");
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

namespace {

// A model's curve has this many angles for a guess: finer than what tells one curve from another.
constexpr int kGuessSamples = 360;
// Nothing agrees better than this with what another program has written.
constexpr double kBestTolerance = 1e-5;
// A component in our axes is the sum of up to three rounded ones.
constexpr double kOfRounding = 4;

std::string list_text(const std::vector<std::string>& texts) {
  return "[" + joined(texts, ", ", toml_text) + "]";
}

std::string factor_lines(const std::string& unit, double factor, const std::string& file_says) {
  std::string text;
  if (!unit.empty()) text += "unit = " + toml_text(unit) + "\n";
  if (!file_says.empty())
    text += "file_says = " + toml_text(file_says) +
            "  # the heading of the file, which its values contradict: check which is right\n";
  if (factor < 0) text += "sign = -1\n";
  return text;
}

std::string curve_text(const MappingGuess& guess) {
  const compare::CurveDescription& curve = guess.curve;
  const std::vector<std::string>& open = guess.unrecognised;
  const std::string undecided =
      open.empty() ? ""
                   : "# Not recognised, although a name or size suggests a channel: map each, or "
                     "put it into ignore.\nundecided = " +
                         list_text(open) + "\n";
  const std::string wrong =
      curve.one_is_wrong.empty()
          ? ""
          : "# A component of one of these vectors has the wrong sign; the others do not show in "
            "which.\none_is_wrong = " +
                list_text(curve.one_is_wrong) + "\n";
  std::vector<std::string> ignored = curve.ignored;
  std::erase_if(ignored, [&](const std::string& name) { return contains(open, name); });
  std::string text = fmt::format(
      "[[curve]]\nfile = {}\n{}points = {}\nguessed = true  # every report lists the assumptions; "
      "remove this line once you have checked them\n{}ignore = {}  # columns that stand for no "
      "result\n\n# theta_deg = sign x column (in degrees) + offset_deg; theta = 0 where piston 1 "
      "is deepest in.\n[curve.angle]\ncolumn = {}\nunit = {}  # deg, rad, mrad, turn, gon; s, ms, "
      "us, min with the speed of the case\nsign = {}\noffset_deg = {}\n",
      toml_text(curve.file.filename()),
      curve.sheet.empty() ? "" : "sheet = " + toml_text(curve.sheet) + "\n", curve.points,
      undecided + wrong, list_text(ignored), toml_text(curve.angle.column),
      toml_text(curve.angle.unit), curve.angle.sign < 0 ? -1 : 1,
      number_text(curve.angle.offset_deg));
  if (curve.angle.rounding_deg > 0)
    text += fmt::format("rounding_deg = {:.2g}  # half a unit of its last digit\n",
                        curve.angle.rounding_deg);
  if (curve.angle.turn_from_deg)
    text += "turn_from_deg = " + number_text(*curve.angle.turn_from_deg) +
            "  # of a record longer than a turn: the last one\n";
  if (!curve.vectors.empty()) {
    text += fmt::format(
        "\n# The axes that vectors are given in: \"own\" (those of each reaction), \"S1\" or "
        "\"S2\", turned.\n[curve.frame]\naxes_of = \"{}\"\n",
        curve.frame.axes_of.empty() ? "own" : curve.frame.axes_of);
    if (!guess.euler.empty())
      text += fmt::format("euler = \"{}\"\neuler_deg = [{}, {}, {}]\n", guess.euler,
                          number_text(guess.euler_deg[0]), number_text(guess.euler_deg[1]),
                          number_text(guess.euler_deg[2]));
    else
      for (std::size_t i = 0; i < 3; ++i)
        text += fmt::format("{} = [{:g}, {:g}, {:g}]{}\n", "xyz"[i], curve.frame.cosines[i][0],
                            curve.frame.cosines[i][1], curve.frame.cosines[i][2],
                            i == 0 ? "  # direction cosines of their x" : "");
  }
  for (const auto& vector : curve.vectors)
    text +=
        fmt::format("\n[[curve.vector]]\ntheirs = {}\nours = {}\n{}",
                    list_text({vector.theirs.begin(), vector.theirs.end()}), toml_text(vector.ours),
                    factor_lines(vector.unit, vector.factor, vector.file_says));
  for (const auto& column : curve.columns)
    text += fmt::format("\n[[curve.column]]\ntheirs = {}\nours = {}\n{}", toml_text(column.theirs),
                        toml_text(column.ours),
                        factor_lines(column.unit, column.factor, column.file_says));
  return text;
}

}  // namespace

MappingGuess guess_reference(const Case& the_case, const fs::path& file, const std::string& sheet) {
  const ForeignTable table = read_table(file, sheet);
  Case sampled = the_case;
  sampled.operation.samples_per_revolution = kGuessSamples;
  const PreparedCase ready = prepare(std::move(sampled));
  return guess_mapping(table, run_turn(ready, Model::analytic), frames_of(the_case),
                       6 * the_case.operation.speed_rpm, [&](const std::vector<double>& theta_deg) {
                         return run_at_angles(ready, theta_deg, {.model = Model::analytic});
                       });
}

std::string proposal_text(const MappingGuess& guess) {
  std::size_t width = 6, ours = 4;
  for (const auto& p : guess.proposals) {
    width = std::max(width, p.theirs.size());
    ours = std::max(ours, p.ours.size());
  }
  for (const auto& [column, why] : guess.ignored) width = std::max(width, column.size());
  std::string text = fmt::format("{:<{}}  {:<{}}  {:>4}  {:<6}  {:>11}  {:>10}\n", "column", width,
                                 "ours", ours, "sign", "unit", "correlation", "difference");
  for (const auto& p : guess.proposals)
    text += fmt::format("{:<{}}  {:<{}}  {:>4}  {:<6}  {:>11.7f}  {:>10.1e}{}\n", p.theirs, width,
                        p.ours, ours, p.sign < 0 ? "-1" : "+1", p.unit, p.correlation, p.difference,
                        p.remark.empty() ? "" : "  " + p.remark);
  for (const auto& [column, why] : guess.ignored)
    text += fmt::format("{:<{}}  {:<{}}  {}\n", column, width, "-", ours, why);
  for (const auto& line : compare::assumptions_of(guess.curve))
    if (line.find("times") == std::string::npos && line.find("stand for no") == std::string::npos)
      text += line + "\n";
  if (guess.shift_not_taken_deg != 0)
    text += fmt::format(
        "no phase shift: {0:.3g} deg would fit better, but not well, and a wrong port timing looks "
        "the same; if the angle of the record begins elsewhere, set offset_deg = {0:.3g} in the "
        "mapping\n",
        guess.shift_not_taken_deg);
  return text;
}

std::string description_of(const MappingGuess& guess, const std::string& source,
                           std::optional<double> tolerance) {
  const double relative =
      tolerance ? *tolerance : std::max(kBestTolerance, kOfRounding * guess.rounding);
  return fmt::format(
      "# Made by bentaxis reference new.\n"
      "schema = 1\n"
      "kind = \"external\"\n"
      "case = \"case.toml\"\n"
      "{}"
      "source = {}\n"
      "how_made = \"not stated\"\n"
      "who_may_change = \"not stated\"\n"
      "digits = {}  # that are good in the curve\n"
      "\n"
      "# Allowed: absolute + relative x the reaction's peak{}. A value near a steep edge may lie "
      "anywhere\n"
      "# between what the curve spans over +-tube_deg.\n"
      "[tolerance]\n"
      "relative = {:.2g}\n"
      "absolute_N = 0.0\n"
      "absolute_Nm = 0.0\n"
      "tube_deg = 0.0\n"
      "\n{}",
      guess.samples == 0
          ? ""
          : fmt::format("samples_per_revolution = {}  # the record's own angles\n", guess.samples),
      toml_text(source.empty() ? guess.curve.file.filename().string() + ", not stated by whom"
                               : source),
      std::clamp(guess.digits, 1, 16), tolerance ? "" : "; proposed: what the file's digits allow",
      relative, curve_text(guess));
}

std::vector<fs::path> make_reference(const Case& the_case, bool changed, const fs::path& curve,
                                     const std::string& description, const fs::path& out,
                                     const fs::path& mapping, const PartProgress& progress_of) {
  must_be_new(out);
  const std::string curve_name = curve.filename();
  if (curve_name == "case.toml" || curve_name == "description.toml")
    throw InputError(curve.string() + ": is a reserved name; rename the curve file");
  NewFolder folder(out);
  std::vector<fs::path> names;
  const auto add = [&](const fs::path& name, const std::string& content) {
    folder.add(name, content);
    names.push_back(out / name);
  };
  // A case written anew names its curve where it lies.
  add("case.toml", changed ? case_text(the_case) : bytes_of(the_case.file));
  for (const auto& file : changed ? std::vector<fs::path>{} : files_of(the_case)) {
    if (fs::absolute(file).lexically_normal().parent_path() !=
        fs::absolute(the_case.file).lexically_normal().parent_path())
      throw InputError(file.string() +
                       ": must be in the directory of the case to be copied with it");
    add(file.filename(), bytes_of(file));
  }
  add(curve_name, bytes_of(curve));
  add("description.toml", description);
  // What regress would refuse is not written.
  const Outcome outcome = hold({folder.here(), out.filename().string()}, progress_of);
  const bool nothing = outcome.state == Outcome::State::differs && !outcome.error.empty();
  if (outcome.state == Outcome::State::unusable || nothing) {
    std::string why = outcome.error;
    if (!mapping.empty())
      why = replace_all(why, (folder.here() / "description.toml").string(), mapping.string());
    why = replace_all(why, (folder.here() / curve_name).string(), curve.string());
    why = replace_all(why, folder.here().string(), out.string());
    const std::string name = (mapping.empty() ? curve : mapping).string();
    throw InputError((why.find(name) == std::string::npos ? name + ": " : "") + why);
  }
  folder.commit();
  return names;
}

std::vector<fs::path> make_golden(Case the_case, bool changed, int samples, const fs::path& out,
                                  const PartProgress& progress_of) {
  PreparedCase ready = prepare(std::move(the_case), progress_of);
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
                       std::to_string(table.rows()) + " rows: change the case first");
    const std::string text = to_csv(table);
    if (text == bytes_of(curve.file)) continue;
    std::string what;
    bool agrees = false;
    try {
      const auto stored =
          compare::read_reference_curve(description, curve, table.channels,
                                        6 * the_case.operation.speed_rpm, frames_of(the_case));
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
