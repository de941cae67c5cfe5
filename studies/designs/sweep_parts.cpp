#include "bentaxis/designs/sweep_parts.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>
#include <variant>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/files/toml_reader.h"
#include "bentaxis/files/whole_file.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/full_key.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/study/reporting.h"

namespace bentaxis::designs {
namespace fs = std::filesystem;
namespace {

static_assert(sizeof(std::size_t) == 8 && std::endian::native == std::endian::little,
              "blocks are kept in little-endian order, counts in 64 bits");

constexpr const char* kTitle = "bentaxis sweep block 1\n";
constexpr const char* kCaseFile = "case.toml";
constexpr const char* kPlanFile = "plan.toml";
constexpr const char* kLockFile = "lock";
constexpr std::size_t kHash = 64;  // hexadecimal digits of a SHA-256

std::optional<std::string> content_of(const fs::path& file) {
  return read_input_file_if_there(file, {"a file of a sweep", kLargestReport});
}

constexpr const char* kBlock = "block-";

fs::path file_of(const fs::path& folder, std::size_t block) {
  std::string number = std::to_string(block);
  number.insert(0, number.size() < 6 ? 6 - number.size() : 0, '0');
  return folder / (kBlock + number + ".bin");
}

// Numbers and texts one behind the other.
class Writer {
 public:
  explicit Writer(std::string content) : content_(std::move(content)) {}
  void number(std::size_t value) { bytes(&value, sizeof value); }
  void numbers(const std::vector<double>& values, std::size_t /*count*/) {
    bytes(values.data(), values.size() * sizeof(double));
  }
  void text(const std::string& text) {
    number(text.size());
    content_ += text;
  }
  template <class List>
  void resize(List& /*list*/, std::size_t /*count*/) {}
  const std::string& content() const { return content_; }

 private:
  void bytes(const void* from, std::size_t count) {
    content_.append(static_cast<const char*>(from), count);
  }
  std::string content_;
};

// The reverse: after the first thing that is not there, everything is empty and `whole` false.
class Reader {
 public:
  explicit Reader(std::string_view content) : rest_(content) {}
  void number(std::size_t& value) {
    value = 0;
    bytes(&value, sizeof value);
  }
  void numbers(std::vector<double>& values, std::size_t count) {
    if (count > rest_.size() / sizeof(double)) bad_ = true;
    values.resize(bad_ ? 0 : count);
    bytes(values.data(), values.size() * sizeof(double));
  }
  void text(std::string& text) {
    std::size_t size = 0;
    number(size);
    if (size > rest_.size()) bad_ = true;
    text.assign(bad_ ? 0 : size, '\0');
    bytes(text.data(), text.size());
  }
  // Of entries of at least a number each: no more than the rest can hold.
  template <class List>
  void resize(List& list, std::size_t count) {
    if (count > rest_.size() / sizeof(std::uint64_t)) bad_ = true;
    list.resize(bad_ ? 0 : count);
  }
  bool whole() const { return !bad_ && rest_.empty(); }

 private:
  void bytes(void* to, std::size_t count) {
    if (count > rest_.size()) bad_ = true;
    if (bad_ || count == 0) return;
    std::memcpy(to, rest_.data(), count);
    rest_.remove_prefix(count);
  }
  std::string_view rest_;
  bool bad_ = false;
};

// A block as it stands in its file, for either direction.
template <class Way>
void pass(Way& way, SweepBlock& block) {
  std::size_t values = block.values.size(), results = block.results.size();
  std::size_t checks = block.checks.size();
  for (std::size_t* const count : {&block.first, &block.designs, &values, &results})
    way.number(*count);
  way.numbers(block.values, values);
  way.numbers(block.results, results);
  way.resize(block.reasons, block.designs);
  for (std::string& reason : block.reasons) way.text(reason);
  way.number(checks);
  way.resize(block.checks, checks);
  for (SweepCheck& check : block.checks) {
    std::size_t outputs = check.own.size();
    way.number(check.design);
    way.number(outputs);
    for (auto* const list : {&check.own, &check.values, &check.scales}) way.numbers(*list, outputs);
    way.text(check.own_reason);
    way.text(check.reason);
  }
}

std::string bytes_of(SweepBlock block, const std::string& identity) {
  Writer out(kTitle + identity);
  pass(out, block);
  return out.content() + sha256_of(out.content());
}

std::optional<SweepBlock> block_of(const std::string& bytes, const std::string& identity) {
  const std::string head = kTitle + identity;
  if (bytes.size() < head.size() + kHash || bytes.compare(0, head.size(), head) != 0)
    return std::nullopt;
  const std::string content = bytes.substr(0, bytes.size() - kHash);
  if (sha256_of(content) != bytes.substr(content.size())) return std::nullopt;
  Reader in(std::string_view(content).substr(head.size()));
  SweepBlock block;
  pass(in, block);
  if (!in.whole()) return std::nullopt;
  return block;
}

// A case as a file that leaves out what follows from other parameters: read back, it still does.
std::string text_of(const Family& family) {
  std::istringstream lines(case_text(family.base()));
  std::string text, table;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) table = line.substr(1, line.size() - 2);
    const auto& followers = family.followers();
    if (std::none_of(followers.begin(), followers.end(), [&](const Family::Follower& f) {
          return f.table->name == table && line.starts_with(f.parameter->key + " = ");
        }))
      text += line + "\n";
  }
  return text;
}

// What a folder says it is of.
struct Found {
  std::string identity, program;
};
std::optional<Found> found_in(const fs::path& folder) {
  if (!fs::exists(folder / kPlanFile)) return std::nullopt;
  TableReader top = TomlFile::read(folder / kPlanFile, "plan of a sweep").root();
  TableReader record = top.table("record");
  return Found{record.text("identity"), record.text("program")};
}

std::string program_in(const SweepRecord& record) {
  TableReader top = TomlFile(record.plan, kPlanFile).root();
  return top.table("record").text("program");
}

}  // namespace

bool BlockLayout::fits(std::size_t number, const SweepBlock& block) const {
  const bool single = number >= blocks();
  if (single && !singles) return false;
  const std::size_t first = single ? designs + (number - blocks()) : number * block_size;
  if (block.first != first ||
      block.designs != (single ? 1 : std::min(block_size, designs - first)) ||
      block.values.size() != block.designs * variables ||
      block.results.size() != block.designs * outputs || block.reasons.size() != block.designs)
    return false;
  std::size_t next = first;  // checks come in the order of the designs, each at most once
  return std::all_of(block.checks.begin(), block.checks.end(), [&](const SweepCheck& check) {
    const bool fits =
        check.design >= next && check.design < first + block.designs && check.own.size() == outputs;
    next = check.design + 1;
    return fits;
  });
}

SweepRecord record_of(const Sweep& sweep, const std::string& program) {
  SweepRecord record;
  record.layout = {sweep.designs(), sweep.block_size(), sweep.plan().varied.size(),
                   sweep.plan().outputs.size()};
  const Case& base = sweep.family().base();
  record.case_text = text_of(sweep.family());
  for (const Table& table : standard_registry().tables)
    for (const Parameter& p : table.parameters) {
      if (!std::holds_alternative<CurveField>(p.field)) continue;
      const auto value = value_of(p, base);
      const std::string path = value ? std::get<std::string>(*value) : "";
      if (path.empty()) continue;
      const auto content = content_of(path);
      if (!content) throw InputError(path + ": cannot be read");
      const std::string name = full_key(table, p) + ".csv";
      record.curves.emplace_back(name, *content);
      record.case_text = replace_all(std::move(record.case_text), toml_text(path), toml_text(name));
    }
  // What is better changes no block.
  SweepPlan blocks = sweep.plan();
  blocks.direction.assign(blocks.outputs.size(), 0);
  std::string all = program + "\n" + std::to_string(sweep.block_size()) + "\n" + record.case_text +
                    "\n" + plan_text(blocks);
  for (const auto& [name, content] : record.curves) all += name + "\n" + sha256_of(content) + "\n";
  record.identity = sha256_of(all);
  record.plan = plan_text(sweep.plan()) + "\n[record]\nidentity = " + toml_text(record.identity) +
                "\nprogram = " + toml_text(program) + "\n";
  return record;
}

SweepParts::SweepParts(fs::path folder, SweepRecord record)
    : folders_{folder}, folder_(std::move(folder)), record_(std::move(record)) {}

// Refuses a folder of another sweep.
void SweepParts::must_be_own() const {
  if (const auto found = found_in(folder_); found && found->identity != record_.identity)
    throw InputError(
        folder_.string() + ": holds blocks of another " +
        (found->program == program_in(record_) ? "case or plan" : "version, " + found->program) +
        "; remove it or name another --out");
}

RunLock SweepParts::begin(RunLock::Kind kind) const {
  // Looked at twice: what is refused is not touched, and nobody can change it once it is locked.
  {
    const RunLock held = reading();
    must_be_own();
  }
  RunLock lock(folder_ / kLockFile, kind, "sweep");
  must_be_own();
  for (const auto& [name, content] : record_.curves) write_whole(folder_ / name, content);
  write_whole(folder_ / kCaseFile, record_.case_text);
  write_whole(folder_ / kPlanFile, record_.plan);
  return lock;
}

RunLock SweepParts::reading() const {
  return {folder_ / kLockFile, RunLock::Kind::reader, "sweep"};
}

void SweepParts::add(const fs::path& folder) {
  const auto found = found_in(folder);
  if (!found) throw InputError(folder.string() + ": holds no blocks of a sweep");
  if (found->identity != record_.identity)
    throw InputError(folder.string() + ": holds blocks of another case, plan or version than " +
                     folder_.string());
  folders_.push_back(folder);
}

void SweepParts::keep(std::size_t block, const SweepBlock& content) const {
  write_whole(file_of(folder_, block), bytes_of(content, record_.identity));
}

std::optional<SweepBlock> SweepParts::read(std::size_t block) const {
  for (const fs::path& folder : folders_)
    if (const auto bytes = content_of(file_of(folder, block)))
      if (auto found = block_of(*bytes, record_.identity);
          found && record_.layout.fits(block, *found))
        return found;
  return std::nullopt;
}

std::vector<std::size_t> SweepParts::misplaced(const std::vector<std::size_t>& among) const {
  std::vector<std::size_t> found;
  std::copy_if(among.begin(), among.end(), std::back_inserter(found), [&](std::size_t block) {
    return std::any_of(folders_.begin(), folders_.end(), [&](const fs::path& folder) {
      const auto bytes = content_of(file_of(folder, block));
      const auto content = bytes ? block_of(*bytes, record_.identity) : std::nullopt;
      return content && !record_.layout.fits(block, *content);
    });
  });
  return found;
}

std::vector<std::size_t> SweepParts::numbers() const {
  std::vector<std::size_t> all;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, ignored)) {
    const std::string name = entry.path().stem();
    if (entry.path().extension() != ".bin" || !name.starts_with(kBlock)) continue;
    if (const auto number = number_in(name.substr(std::string(kBlock).size())))
      all.push_back(static_cast<std::size_t>(*number));
  }
  return all;
}

std::size_t SweepParts::count() const { return numbers().size() - count_singles(); }

std::size_t SweepParts::count_singles() const {
  if (!record_.layout.singles) return 0;
  const auto all = numbers();
  return static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [&](std::size_t n) { return n >= record_.layout.blocks(); }));
}

void SweepParts::remove(std::size_t blocks) const {
  std::error_code ignored;
  for (std::size_t i = 0; i < blocks; ++i) fs::remove(file_of(folder_, i), ignored);
  if (record_.layout.singles)
    for (const std::size_t number : numbers())
      if (number >= record_.layout.blocks()) fs::remove(file_of(folder_, number), ignored);
  for (const auto& [name, content] : record_.curves) fs::remove(folder_ / name, ignored);
  fs::remove(folder_ / kCaseFile, ignored);
  fs::remove(folder_ / kPlanFile, ignored);
  fs::remove(folder_ / kLockFile, ignored);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, ignored))
    if (entry.path().extension() == kUnfinished) fs::remove(entry.path(), ignored);
  fs::remove(folder_, ignored);
}

std::pair<Sweep, SweepRecord> sweep_in(const fs::path& folder) {
  const auto found = found_in(folder);
  if (!found) throw InputError(folder.string() + ": holds no blocks of a sweep");
  const Case base = read_case(folder / kCaseFile);
  Sweep sweep(base, sweep_plan(read_sweep_request(folder / kPlanFile), base));
  SweepRecord record = record_of(sweep, found->program);
  if (record.identity != found->identity)
    throw InputError(folder.string() + ": " + kCaseFile + " or " + kPlanFile +
                     " differs from the case that its blocks were computed from");
  return {std::move(sweep), std::move(record)};
}

ResumedBlocks compute_blocks(const Sweep& sweep, const SweepParts& parts, const SweepShare& share,
                             const Progress& progress) {
  std::vector<std::size_t> missing;
  ResumedBlocks resumed;
  std::size_t mine = 0;
  for (std::size_t block = share.part; block < sweep.blocks(); block += share.parts) {
    if (mine++ % share.ranks != share.rank) continue;
    if (share.resume && parts.read(block))
      ++resumed.kept;
    else
      missing.push_back(block);
  }
  if (share.resume) resumed.misplaced = parts.misplaced(missing);
  study::Reporting reporting(missing.size(), progress);
  numerics::parallel_for(share.threads, missing.size(), [&](std::size_t i) {
    parts.keep(missing[i], sweep.compute(missing[i], [&] { reporting.tick(); }));
    reporting.done();
  });
  return resumed;
}

std::string list_of(const std::vector<std::size_t>& numbers) {
  constexpr std::size_t kMaxRuns = 20;
  std::string text;
  std::size_t runs = 0;
  for (std::size_t i = 0; i < numbers.size(); ++runs) {
    if (runs == kMaxRuns) return text + ", ..";
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += (text.empty() ? "" : ", ") + std::to_string(numbers[i]);
    if (last > i) text += "-" + std::to_string(numbers[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace bentaxis::designs
