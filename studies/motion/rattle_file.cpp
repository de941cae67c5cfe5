#include "bentaxis/study/rattle_file.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <system_error>
#include <type_traits>
#include <utility>

#include "bentaxis/files/csv_rows.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/whole_file.h"
#include "bentaxis/pump/error.h"

namespace bentaxis::study {
namespace {

constexpr const char* kTitle = "# rows of a rattle map that is not complete (docs/rattle.md)";

// What a file keeps of a point.
template <class Point, class Use>
void for_each_number(Point& p, const Use& use) {
  use(p.kind);
  for (auto* n : {&p.apart, &p.plus, &p.minus, &p.largest, &p.mean, &p.least_turn, &p.impacts,
                  &p.largest_impulse})
    use(*n);
  for (auto* n : {&p.observed, &p.passed, &p.period}) use(*n);
  for (auto* n : {&p.lag, &p.lag_rate}) use(*n);
}

std::vector<double> numbers_of(const RattlePoint& p) {
  std::vector<double> numbers;
  for_each_number(p, [&](auto n) { numbers.push_back(static_cast<double>(n)); });
  return numbers;
}
constexpr std::size_t kNumbers = 14;

RattlePoint point_of(const double* numbers) {
  RattlePoint p;
  for_each_number(p, [&](auto& n) { n = static_cast<std::decay_t<decltype(n)>>(*numbers++); });
  return p;
}

void append_numbers(std::string& text, const std::vector<double>& values) {
  for (const double value : values) {
    text += ',';
    append_number(text, value);
  }
}

// A line for the row, one for the criterion, one per sweep.
std::string numbers_text(const RattleRow& row) {
  std::string text = "row," + number_text(row.delivery_bar);
  append_numbers(text, row.boundary_rpm);
  text += "\nrigid";
  append_numbers(text, row.least);
  append_numbers(text, row.greatest);
  for (const auto& [name, points] : {std::pair{"up", &row.up}, {"down", &row.down}}) {
    text += std::string("\n") + name;
    for (const RattlePoint& point : *points) append_numbers(text, numbers_of(point));
  }
  return text + "\n";
}

// And one that tells whether a row is whole and belongs to this map.
std::string sum_of(const std::string& numbers, const std::string& from) {
  return "sum," + sha256_of(from + "\n" + numbers);
}

std::string text_of(const RattleRow& row, const std::string& from) {
  const std::string numbers = numbers_text(row);
  return numbers + sum_of(numbers, from) + "\n";
}

// The numbers behind a line's name; false where it is another or has something else in it.
// @param text  gets the line
bool read_line(std::istream& in, const std::string& name, std::vector<double>& values,
               std::string& text) {
  std::string line;
  if (!std::getline(in, line)) return false;
  text += line + "\n";
  if (line.compare(0, name.size(), name) != 0) return false;
  values.clear();
  const char* at = line.data() + name.size();
  const char* end = line.data() + line.size();
  while (at != end) {
    double value = 0;
    if (*at != ',') return false;
    const auto [stop, error] = std::from_chars(at + 1, end, value);
    if (error != std::errc()) return false;
    values.push_back(value);
    at = stop;
  }
  return true;
}

bool read_row(std::istream& in, const std::string& from, RattleRow& row) {
  std::vector<double> values;
  std::string text;
  if (!read_line(in, "row", values, text) || values.empty()) return false;
  row.delivery_bar = values[0];
  row.boundary_rpm.assign(values.begin() + 1, values.end());
  if (!read_line(in, "rigid", values, text) || values.size() % 2 != 0) return false;
  const std::size_t speeds = values.size() / 2;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(speeds);
  row.least.assign(values.begin(), middle);
  row.greatest.assign(middle, values.end());
  for (const auto& [name, points] : {std::pair{"up", &row.up}, {"down", &row.down}}) {
    if (!read_line(in, name, values, text) || values.size() != speeds * kNumbers) return false;
    for (std::size_t j = 0; j < speeds; ++j) {
      const double* numbers = values.data() + j * kNumbers;
      if (!(numbers[0] >= 0 && numbers[0] < static_cast<double>(rattle_class_names().size())))
        return false;
      points->push_back(point_of(numbers));
    }
  }
  std::string sum;
  return std::getline(in, sum) && sum == sum_of(text, from);
}

}  // namespace

std::string rattle_csv(const RattleMap& map) {
  constexpr std::size_t kColumns = 22;
  CsvRows csv(
      "delivery_bar,speed_rpm,sweep,class,share_apart,share_plus,share_minus,largest_N,mean_N,"
      "largest_over_mean,least_of_turns_N,impacts_per_turn,largest_impulse_Ns,turns_observed,"
      "turns_before,period_turns,lag_rad,lag_rate_rad_per_s,rigid_least_N,rigid_greatest_N,"
      "two_states,reason");
  for (const RattleRow& row : map.rows)
    for (std::size_t j = 0; j < row.up.size(); ++j)
      for (const auto& [name, points] : {std::pair{"up", &row.up}, {"down", &row.down}}) {
        const RattlePoint& p = (*points)[j];
        if (!p.done()) {
          csv.row(row.delivery_bar, map.options.speed_rpm[j], name,
                  std::vector<std::string>(kColumns - 4), p.reason);
          continue;
        }
        csv.row(row.delivery_bar, map.options.speed_rpm[j], name, to_string(p.kind), p.apart,
                p.plus, p.minus, p.largest, p.mean, p.over_mean(), p.least_turn, p.impacts,
                p.largest_impulse, p.observed, p.passed, p.period, p.lag, p.lag_rate, row.least[j],
                row.greatest[j], two_states(row.up[j], row.down[j]) ? 1 : 0, "");
      }
  for (const FailedPoint& failed : map.failed)
    csv.row(failed.value, std::vector<std::string>(kColumns - 2), failed.reason);
  return std::move(csv).text();
}

RattleFile::RattleFile(std::filesystem::path file, std::string from)
    : file_(std::move(file)), from_(std::move(from)) {
  text_ = std::string(kTitle) + "\n# " + from_ + "\n";
}

std::vector<RattleRow> RattleFile::read() {
  const auto content = read_input_file_if_there(file_, {"a rattle map", kLargestReport});
  if (!content) return {};
  std::istringstream in(*content);
  const auto fail = [&](const std::string& why) {
    throw InputError(file_.string() + ": " + why + "; without --resume it is replaced");
  };
  std::string title, from;
  std::getline(in, title);
  std::getline(in, from);
  if (title != kTitle) fail("is not an unfinished rattle map");
  if (from != "# " + from_)
    fail("its rows are of another case, version or set of options (" +
         from.substr(from.size() > 2 ? 2 : 0) + "; now " + from_ + ")");
  std::vector<RattleRow> rows;
  while (in.peek() != std::istream::traits_type::eof()) {
    RattleRow row;
    const std::string which = "row " + std::to_string(rows.size() + 1);
    if (!read_row(in, from_, row)) fail(which + " is damaged");
    if (std::any_of(rows.begin(), rows.end(),
                    [&](const RattleRow& other) { return other.delivery_bar == row.delivery_bar; }))
      fail(which + " is of " + number_text(row.delivery_bar) + " bar, which is a duplicate row");
    rows.push_back(std::move(row));
  }
  for (const RattleRow& row : rows) text_ += text_of(row, from_);
  rows_ = rows.size();
  return rows;
}

void RattleFile::keep(const RattleRow& row) {
  std::string text = text_ + text_of(row, from_);
  write_whole(file_, text);
  text_ = std::move(text);
  ++rows_;
}

void RattleFile::remove() const {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::remove(file_, ignored);
  const std::string name = file_.filename().string();
  for (const fs::directory_entry& entry : fs::directory_iterator(file_.parent_path(), ignored))
    if (entry.path().filename().string().starts_with(name + ".") &&
        entry.path().extension() == kUnfinished)
      fs::remove(entry.path(), ignored);
}

std::string options_text(const RattleOptions& options) {
  std::string text = "speeds_rpm";
  const auto range = [&](const std::vector<double>& values) {
    text += " " + number_text(values.front()) + ":" + number_text(values.back()) + ":" +
            std::to_string(values.size());
  };
  range(options.speed_rpm);
  text += ", delivery_bar";
  range(options.delivery_bar);
  return text + ", discard " + std::to_string(options.discard) + ", turns " +
         std::to_string(options.turns) + ", error " + number_text(options.error);
}

}  // namespace bentaxis::study
