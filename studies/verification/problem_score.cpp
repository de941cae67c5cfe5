#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "bentaxis/compare/difference.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/study/problem.h"

namespace bentaxis::study {
namespace {

constexpr double kSameAngle = 1e-9;      // of the grid's unit: the same row
constexpr std::size_t kManyPoints = 12;  // of an interpolation
constexpr std::size_t kFewPoints = 8;    // of the one that tells its error
constexpr double kWidestGapSteps = 30;   // between rows, in steps of the grid
constexpr double kMostDigits = 16;       // a double has no more
constexpr double kKnownWithin = 1e-4;    // of the peak: an interpolated curve that names a mistake
constexpr double kExact = 1e-12;         // two mistakes this near are not told apart

// "Rb1_x1" and "N" of "Rb1_x1_N"; the unit is empty where the end of the name is none.
struct NameParts {
  std::string stem, unit;
};

NameParts parts_of(const std::string& name) {
  std::size_t cut = name.rfind('_');
  if (const std::size_t per = name.rfind("_per_"); per != std::string::npos && per > 0)
    cut = name.rfind('_', per - 1);
  if (cut == std::string::npos) return {name, ""};
  std::string unit = name.substr(cut + 1);
  if (const std::size_t per = unit.find("_per_"); per != std::string::npos)
    unit.replace(per, 5, "/");
  if (find_written_unit(unit) == nullptr && unit != "Ns") return {name, ""};
  return {name.substr(0, cut), unit};
}

// A column of theirs that stands for one of ours.
struct Source {
  std::size_t column = 0;
  double factor = 1;  // ours = factor x theirs
  std::string note;
};

class Matcher {
 public:
  explicit Matcher(const ForeignTable& table) : table_(table) {
    for (std::size_t c = 0; c < table.header.size(); ++c) {
      std::string name = table.header[c];
      NameParts parts = parts_of(name);
      if (const std::size_t bracket = name.find_first_of("[("); bracket != std::string::npos) {
        parts.stem = name.substr(0, name.find_last_not_of(" _", bracket - 1) + 1);
        parts.unit = c < table.units.size() ? table.units[c] : "";
      } else if (parts.unit.empty() && c < table.units.size()) {
        parts.unit = table.units[c];
      }
      parts_.push_back(parts);
    }
  }

  // Where several columns fit, the one whose name is exact.
  std::optional<Source> find(const std::string& ours) {
    const NameParts wanted = parts_of(ours);
    std::optional<Source> found;
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      if (table_.header[c] == ours) {
        used_.insert(c);
        return Source{c, 1, ""};
      }
      if (found || used_.count(c) > 0) continue;
      if (lower_case(parts_[c].stem) != lower_case(wanted.stem)) continue;
      if (parts_[c].unit.empty()) {
        found = {c, 1, fmt::format("{} has no unit: taken as {}", table_.header[c], wanted.unit)};
        continue;
      }
      const UnitOfMeasure* theirs = find_written_unit(parts_[c].unit);
      const UnitOfMeasure* unit = find_written_unit(wanted.unit);
      if (theirs == nullptr || unit == nullptr || !(theirs->dimension == unit->dimension)) continue;
      const double factor = theirs->factor / unit->factor;
      found = {
          c, factor,
          factor == 1 ? "" : fmt::format("{} is converted to {}", table_.header[c], unit->name)};
    }
    if (found) used_.insert(found->column);
    return found;
  }

  // Columns of the table that stand for nothing.
  std::vector<std::string> unused() const {
    std::vector<std::string> names;
    for (std::size_t c = 0; c < table_.header.size(); ++c)
      if (used_.count(c) == 0) names.push_back(table_.header[c]);
    return names;
  }

 private:
  const ForeignTable& table_;
  std::vector<NameParts> parts_;
  std::set<std::size_t> used_;
};

// Place of a value on a grid: a row of it, or between rows.
struct Place {
  double x = 0;
  std::optional<std::size_t> row;
};

// A value of a curve, and how far it may be off.
struct Value {
  double value = 0, error = 0;
};

class Grid {
 public:
  /// @param period  0: none
  Grid(std::vector<double> values, double period)
      : xs_(std::move(values)), period_(period), step_(xs_[1] - xs_[0]) {}

  // Nothing where the value is outside the grid.
  std::optional<Place> place(double x) const {
    const double first = xs_.front();
    if (period_ > 0) {
      x -= period_ * std::floor((x - first) / period_);
      if (first + period_ - x <= kSameAngle) x = first;
    }
    const double nearest = std::round((x - first) / step_);
    if (nearest >= 0 && nearest < static_cast<double>(xs_.size()) &&
        std::abs(x - xs_[static_cast<std::size_t>(nearest)]) <= kSameAngle)
      return Place{x, static_cast<std::size_t>(nearest)};
    const double last = period_ > 0 ? first + period_ : xs_.back();
    if (x < first || x > last) return std::nullopt;
    return Place{x, std::nullopt};
  }

  // Value of a curve at a place, and its error where that is between rows: polynomials through the
  // nearest ones.
  Value at(const std::vector<double>& curve, const Place& place) const {
    if (place.row) return {curve[*place.row], 0};
    const double many = polynomial(curve, place.x, kManyPoints);
    return {many, std::abs(many - polynomial(curve, place.x, kFewPoints))};
  }

  double step() const { return step_; }

 private:
  double polynomial(const std::vector<double>& curve, double x, std::size_t points) const {
    const auto count = static_cast<long>(curve.size()), n = static_cast<long>(points);
    long start = static_cast<long>(std::floor((x - xs_.front()) / step_)) - n / 2 + 1;
    if (period_ == 0) start = std::clamp(start, 0L, count - n);
    double above = 0, below = 0, weight = 1;  // of equally spaced rows: binomial coefficients
    for (long i = 0; i < n; ++i) {
      const double at = xs_.front() + step_ * static_cast<double>(start + i);
      const double share = weight / (x - at);
      above += share * curve[static_cast<std::size_t>(((start + i) % count + count) % count)];
      below += share;
      weight *= -static_cast<double>(n - 1 - i) / static_cast<double>(i + 1);
    }
    return above / below;
  }

  std::vector<double> xs_;
  double period_ = 0, step_ = 1;
};

std::vector<double> mistake_grid(const Problem& problem) {
  std::vector<double> xs;
  for (const std::size_t row : problem.mistake_rows) xs.push_back(problem.grid[row]);
  return xs;
}

// One row of theirs that is compared.
struct Row {
  Place place;
  std::size_t row = 0;  // of the table
};

// A curve that a wrong column may be, at the grid's rows where it is known.
struct Candidate {
  std::string says;
  const KnownMistake* stored = nullptr;
  std::map<std::size_t, double> distance;  // share of the peak, of wrong columns that it explains
};

class Scorer {
 public:
  Scorer(const Problem& problem, const ForeignTable& table, double tolerance)
      : problem_(problem),
        table_(table),
        grid_(problem.grid, problem.period),
        mistakes_(mistake_grid(problem), problem.period),
        matcher_(table) {
    result_.tolerance = tolerance;
  }

  Score score() {
    find_rows();
    for (std::size_t c = 0; c < problem_.columns.size(); ++c) compare(c);
    if (std::none_of(result_.columns.begin(), result_.columns.end(),
                     [](const ColumnScore& one) { return one.rows > 0; }))
      throw InputError(fmt::format("{}: has none of the columns that {} asks for: {}",
                                   table_.file.string(), problem_.name, asked()));
    say_gaps();
    name_mistakes();
    result_.verdict = verdict();
    return std::move(result_);
  }

 private:
  std::string asked() const {
    return joined(problem_.columns, ", ", [](const ProblemColumn& column) { return column.name; });
  }

  void find_rows() {
    const auto angle = matcher_.find(problem_.over);
    if (!angle)
      throw InputError(fmt::format("{}: has no column {} (or the same in another unit)",
                                   table_.file.string(), problem_.over));
    if (!angle->note.empty()) result_.gaps.push_back(angle->note);
    std::set<std::size_t> covered;
    std::size_t outside = 0, repeated = 0;
    for (std::size_t r = 0; r < table_.rows.size(); ++r) {
      const double x = table_.rows[r][angle->column] * angle->factor;
      const auto place = is_computed(x) ? grid_.place(x) : std::nullopt;
      if (!place) {
        ++outside;
        continue;
      }
      if (place->row && !covered.insert(*place->row).second) ++repeated;
      if (place->row || problem_.smooth)
        rows_.push_back({*place, r});
      else
        ++between_;
      if (!place->row && problem_.smooth) ++resampled_;
    }
    result_.covered = covered.size();
    if (rows_.empty())
      throw InputError(fmt::format(
          "{}: no row is at a value of {} that {} asks for ({} to {}, step {})",
          table_.file.string(), problem_.over, problem_.name, number_text(problem_.grid.front()),
          number_text(problem_.grid.back()), number_text(grid_.step())));
    if (repeated > 0)
      result_.gaps.push_back(fmt::format(
          "{} rows are at angles of rows before them; all of them are compared", repeated));
    if (outside > 0)
      result_.gaps.push_back(fmt::format(
          "{} rows are left out: their {} is not within the problem's", outside, problem_.over));
    if (between_ > 0)
      result_.gaps.push_back(
          fmt::format("{} rows are left out: they lie between the problem's angles, and its curves "
                      "have corners",
                      between_));
    if (resampled_ > 0)
      result_.gaps.push_back(fmt::format(
          "{} rows are at other angles: compared with interpolated curves", resampled_));
    say_holes();
  }

  // Intervals without rows.
  void say_holes() {
    std::vector<double> xs;
    for (const Row& row : rows_) xs.push_back(row.place.x);
    std::sort(xs.begin(), xs.end());
    const double wide = resampled_ > 0 ? kWidestGapSteps * grid_.step() : 1.5 * grid_.step();
    const double end =
        problem_.period > 0 ? xs.front() + problem_.period : problem_.grid.back() + grid_.step();
    std::vector<std::pair<double, double>> holes;
    if (problem_.period == 0 && xs.front() - problem_.grid.front() > 0.5 * grid_.step())
      holes.emplace_back(problem_.grid.front(), xs.front());
    for (std::size_t i = 0; i < xs.size(); ++i) {
      const double next = i + 1 < xs.size() ? xs[i + 1] : end;
      // The one across the end of a turn is told where it begins within the turn.
      const bool is_next_turn =
          problem_.period > 0 && xs[i] + grid_.step() >= problem_.grid.front() + problem_.period;
      const double back = is_next_turn ? problem_.period : 0;
      if (next - xs[i] > wide) holes.emplace_back(xs[i] - back, next - back);
    }
    complete_ = holes.empty();
    if (complete_) return;
    constexpr std::size_t kListed = 3;
    std::string text;
    for (std::size_t i = 0; i < std::min(kListed, holes.size()); ++i)
      text += fmt::format("{}{} and {}", i > 0 ? ", " : "", rounded_text(holes[i].first, 6),
                          rounded_text(holes[i].second, 6));
    if (holes.size() > kListed) text += fmt::format(", and {} more", holes.size() - kListed);
    result_.gaps.push_back(fmt::format("rows at {} of {} angles; none between {} ({})",
                                       result_.covered, problem_.grid.size(), text, problem_.over));
  }

  double value(const Row& row, std::size_t c) const {
    return table_.rows[row.row][sources_[c]->column] * sources_[c]->factor;
  }

  Value right(const Place& place, std::size_t c) const {
    return grid_.at(problem_.columns[c].values, place);
  }

  void compare(std::size_t c) {
    const ProblemColumn& column = problem_.columns[c];
    ColumnScore one;
    one.column = c;
    sources_.push_back(matcher_.find(column.name));
    if (sources_[c] && !sources_[c]->note.empty()) result_.gaps.push_back(sources_[c]->note);
    compare::Difference worst;
    std::size_t empty = 0;
    for (const Row& row : rows_) {
      if (!sources_[c]) break;
      const double theirs = value(row, c);
      if (!is_computed(theirs)) {
        ++empty;
        continue;
      }
      const auto [known, error] = right(row.place, c);
      const auto d =
          compare::difference(std::max(0.0, std::abs(theirs - known) - error), 0, column.peak);
      one.interpolation = std::max(one.interpolation, error / column.peak);
      ++one.rows;
      if (!worst.keep_larger(d)) continue;
      one.largest = d.value;
      one.at = row.place.x;
      one.theirs = theirs;
      one.right = known;
    }
    if (empty > 0 && one.rows > 0) {
      result_.gaps.push_back(fmt::format("{} has no value in {} rows", column.name, empty));
      complete_ = false;
    }
    if (one.rows > 0) {
      const double share = std::max({one.largest / column.peak, one.interpolation, 1e-300});
      one.digits = std::clamp(-std::log10(share), 0.0, kMostDigits);
      one.state = one.largest <= result_.tolerance * column.peak ? ColumnScore::State::agrees
                                                                 : ColumnScore::State::differs;
    }
    result_.columns.push_back(one);
  }

  // The one column that a heading is like, or begins as without its underscores.
  static std::optional<std::string> column_meant(const std::string& heading,
                                                 const std::set<std::string>& wanted) {
    const auto plain = [](const std::string& text) {
      std::string kept;
      for (const char c : text)
        if (c != '_') kept += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return kept;
    };
    const std::string begin = plain(heading);
    std::optional<std::string> found;
    int count = 0;
    for (const std::string& name : wanted)
      if (begin.size() >= 3 && plain(name).starts_with(begin)) {
        found = name;
        ++count;
      }
    return count == 1 ? found : meant(heading, wanted, 0.7);
  }

  void say_gaps() {
    std::vector<std::string> missing;
    std::set<std::string> wanted;
    for (const ColumnScore& one : result_.columns)
      if (one.state == ColumnScore::State::missing) {
        missing.push_back(problem_.columns[one.column].name);
        wanted.insert(missing.back());
      }
    if (!missing.empty()) result_.gaps.push_back("no column " + joined(missing));
    constexpr std::size_t kListed = 4;
    std::string others;
    const std::vector<std::string> unused = matcher_.unused();
    for (std::size_t i = 0; i < unused.size(); ++i) {
      const auto near = column_meant(unused[i], wanted);
      if (near)
        result_.gaps.push_back(
            fmt::format("column {} is not asked for; is it {}?", unused[i], *near));
      else if (i < kListed)
        others += (others.empty() ? "" : ", ") + unused[i];
    }
    if (unused.size() > kListed) others += fmt::format(" .. ({} columns)", unused.size());
    if (!others.empty()) result_.gaps.push_back("not asked for: " + others);
  }

  // Largest distance of a wrong column from another curve, at rows where that is known well enough;
  // nothing where these are too few.
  using Curve = std::function<std::optional<Value>(const Place& place)>;
  struct Distance {
    double from_curve = 0, from_right = 0;
  };
  std::optional<Distance> distance(std::size_t c, const Curve& curve) const {
    Distance d;
    std::size_t count = 0;
    const double peak = problem_.columns[c].peak;
    for (const Row& row : rows_) {
      const double theirs = value(row, c);
      const auto other = is_computed(theirs) ? curve(row.place) : std::nullopt;
      if (!other || other->error > kKnownWithin * peak) continue;
      const auto from = [&](const Value& one) {
        return std::max(0.0, std::abs(theirs - one.value) - one.error) / peak;
      };
      d.from_curve = std::max(d.from_curve, from(*other));
      d.from_right = std::max(d.from_right, from(right(row.place, c)));
      ++count;
    }
    if (count < kNamedRows) return std::nullopt;
    return d;
  }

  void consider(Candidate& candidate, std::size_t c, const Curve& curve) const {
    const auto d = distance(c, curve);
    if (d && d->from_curve <= kNamedWithin && d->from_curve * kNamedNearer <= d->from_right)
      candidate.distance[c] = d->from_curve;
  }

  std::vector<std::size_t> wrong_columns() const {
    std::vector<std::size_t> wrong;
    for (const ColumnScore& one : result_.columns)
      if (one.state == ColumnScore::State::differs) wrong.push_back(one.column);
    return wrong;
  }

  std::vector<Candidate> candidates() const {
    const std::vector<std::size_t> wrong = wrong_columns();
    std::vector<Candidate> all;
    const auto add = [&](const std::string& says, const auto& curve_of) {
      Candidate candidate{says, nullptr, {}};
      for (const std::size_t c : wrong) consider(candidate, c, curve_of(c));
      if (!candidate.distance.empty()) all.push_back(std::move(candidate));
    };
    for (const KnownMistake& mistake : problem_.mistakes) {
      Candidate candidate{mistake.says, &mistake, {}};
      for (const auto& [c, values] : mistake.curves) {
        if (std::count(wrong.begin(), wrong.end(), c) == 0) continue;
        consider(candidate, c, [this, &curve = values](const Place& place) -> std::optional<Value> {
          const auto there = mistakes_.place(place.x);
          if (!there || (!there->row && !problem_.smooth)) return std::nullopt;
          return mistakes_.at(curve, *there);
        });
      }
      if (!candidate.distance.empty()) all.push_back(std::move(candidate));
    }
    // What can happen to any column.
    const auto scaled = [&](double factor) {
      return [this, factor](std::size_t c) -> Curve {
        return [this, factor, c](const Place& place) {
          const Value one = right(place, c);
          return Value{factor * one.value, std::abs(factor) * one.error};
        };
      };
    };
    add("opposite sign: the reaction on the other body", scaled(-1));
    add("1000 times too large: a unit", scaled(1e3));
    add("1000 times too small: a unit", scaled(1e-3));
    add("degrees for radians", scaled(180 / std::numbers::pi));
    add("radians for degrees", scaled(std::numbers::pi / 180));
    if (problem_.period > 0) {
      const auto moved = [&](double sign, double offset) {
        return [this, sign, offset](std::size_t c) -> Curve {
          return [this, sign, offset, c](const Place& place) -> std::optional<Value> {
            const auto moved_to = grid_.place(sign * place.x + offset);
            if (!moved_to || (!moved_to->row && !problem_.smooth)) return std::nullopt;
            return right(*moved_to, c);
          };
        };
      };
      add("the angle counts in the other direction", moved(-1, 0));
      for (const double offset : {90.0, 180.0, 270.0})
        add(fmt::format("the angle is off by {} deg", offset > 180 ? -90.0 : offset),
            moved(1, offset * problem_.period / 360));
    }
    for (std::size_t other = 0; other < problem_.columns.size(); ++other)
      for (const double sign : {1.0, -1.0})
        add(fmt::format("{}this is {}", sign < 0 ? "with opposite sign, " : "",
                        problem_.columns[other].name),
            [&](std::size_t c) -> Curve {
              return [this, other, sign, c](const Place& place) -> std::optional<Value> {
                if (other == c) return std::nullopt;
                const Value one = right(place, other);
                return Value{sign * one.value, one.error};
              };
            });
    return all;
  }

  // The candidate that explains most columns comes first; of those that explain the same ones the
  // nearest, with the others that are as near beside it.
  void name_mistakes() {
    std::vector<Candidate> all = candidates();
    std::vector<std::size_t> wrong = wrong_columns();
    const auto farthest = [](const Candidate& one) {
      double largest = 0;
      for (const auto& [c, d] : one.distance) largest = std::max(largest, d);
      return largest;
    };
    while (!wrong.empty() && !all.empty()) {
      for (Candidate& one : all)
        std::erase_if(one.distance, [&](const auto& entry) {
          return std::count(wrong.begin(), wrong.end(), entry.first) == 0;
        });
      std::stable_sort(all.begin(), all.end(), [&](const Candidate& a, const Candidate& b) {
        if (a.distance.size() != b.distance.size()) return a.distance.size() > b.distance.size();
        const bool whole_a = untouched(a).empty(), whole_b = untouched(b).empty();
        if (whole_a != whole_b) return whole_a;
        return farthest(a) < farthest(b);
      });
      const Candidate& best = all.front();
      if (best.distance.empty()) break;
      NamedMistake named{best.says, {}, farthest(best), {}, untouched(best)};
      for (const auto& [c, d] : best.distance) named.columns.push_back(c);
      for (std::size_t i = 1; i < all.size(); ++i) {
        const bool same =
            all[i].distance.size() == best.distance.size() &&
            std::equal(all[i].distance.begin(), all[i].distance.end(), best.distance.begin(),
                       [](const auto& a, const auto& b) { return a.first == b.first; });
        if (same && untouched(all[i]).empty() == named.untouched.empty() &&
            farthest(all[i]) <= kNamedNearer * std::max(named.distance, kExact))
          named.or_else.push_back(all[i].says);
      }
      std::erase_if(wrong, [&](std::size_t c) {
        return std::count(named.columns.begin(), named.columns.end(), c) > 0;
      });
      result_.mistakes.push_back(std::move(named));
    }
    result_.unexplained = wrong;
  }

  // Columns that a stored mistake changes, and that are right.
  std::vector<std::size_t> untouched(const Candidate& candidate) const {
    std::vector<std::size_t> columns;
    if (candidate.stored != nullptr)
      for (const auto& [c, values] : candidate.stored->curves)
        if (result_.columns[c].state == ColumnScore::State::agrees) columns.push_back(c);
    return columns;
  }

  Score::Verdict verdict() const {
    bool all = complete_;
    for (const ColumnScore& one : result_.columns) {
      if (one.state == ColumnScore::State::differs) return Score::Verdict::wrong;
      all = all && one.state == ColumnScore::State::agrees;
    }
    return all ? Score::Verdict::solved : Score::Verdict::incomplete;
  }

  const Problem& problem_;
  const ForeignTable& table_;
  Grid grid_, mistakes_;
  Matcher matcher_;
  std::vector<Row> rows_;
  std::vector<std::optional<Source>> sources_;
  std::size_t between_ = 0, resampled_ = 0;
  bool complete_ = true;
  Score result_;
};

}  // namespace

double Score::digits() const {
  double fewest = kMostDigits;
  for (const ColumnScore& one : columns)
    if (one.state != ColumnScore::State::missing) fewest = std::min(fewest, one.digits);
  return fewest;
}

Score score(const Problem& problem, const ForeignTable& table, std::optional<double> tolerance) {
  return Scorer(problem, table, tolerance.value_or(problem.tolerance)).score();
}

}  // namespace bentaxis::study
