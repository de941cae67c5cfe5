#include "sweep_hdf5.h"

#include "bentaxis/designs/sweep_tables.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"

#ifdef BENTAXIS_HAS_HDF5

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "bentaxis/files/module.h"
#include "hdf5_module.h"

namespace bentaxis::designs {

std::string hdf5_version() {
  return std::to_string(H5_VERS_MAJOR) + "." + std::to_string(H5_VERS_MINOR) + "." +
         std::to_string(H5_VERS_RELEASE);
}

namespace {

// The library brings curl, OpenSSL and LDAP: forty others, loaded where HDF5 is written.
const Module& module() {
  static const Module loaded(BENTAXIS_HDF5_MODULE);
  return loaded;
}

const Hdf5Functions& hdf5() {
  static const Hdf5Functions& functions =
      module().table<Hdf5Functions>("kBentaxisHdf5", "sweep.h5");
  return functions;
}

// Starts the library. At the end of the program it would write once more what it could not write
// before, and fail so that the program crashes. Files that are closed have all of theirs. Counts
// only before anything else is called.
const Hdf5Ids& hdf5_ids() {
  static const Hdf5Ids ids = [] {
    hdf5().dont_atexit();
    Hdf5Ids found{};
    hdf5().ids(&found);
    return found;
  }();
  return ids;
}

constexpr hsize_t kChunk = 16384;  // rows

enum class Packing {
  none,  // of results: compression saves a third at most, and takes longer than all else here
  light  // of levels and texts, which come again and again
};

// What the system has refused to the library, which says no more than that it failed.
[[noreturn]] void fail() {
  const int error = errno;
  throw InputError(std::string("sweep.h5: cannot be written by the library HDF5: ") +
                   (error != 0 ? std::strerror(error) : "is the disk full?"));
}

// An identifier of the library, given back at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id_ < 0) fail();
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t operator*() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void must(herr_t status) {
  if (status < 0) fail();
}

Handle text_type() {
  Handle type(hdf5().Tcopy(hdf5_ids().text), hdf5().Tclose);
  must(hdf5().Tset_size(*type, H5T_VARIABLE));
  must(hdf5().Tset_cset(*type, H5T_CSET_UTF8));
  return type;
}

void attribute(hid_t object, const char* name, const std::string& value) {
  const Handle type = text_type(), space(hdf5().Screate(H5S_SCALAR), hdf5().Sclose);
  const Handle made(hdf5().Acreate2(object, name, *type, *space, H5P_DEFAULT, H5P_DEFAULT),
                    hdf5().Aclose);
  const char* const text = value.c_str();
  must(hdf5().Awrite(*made, *type, &text));
}

void attribute(hid_t object, const char* name, double value) {
  const Handle space(hdf5().Screate(H5S_SCALAR), hdf5().Sclose);
  const Handle made(
      hdf5().Acreate2(object, name, hdf5_ids().stored_double, *space, H5P_DEFAULT, H5P_DEFAULT),
      hdf5().Aclose);
  must(hdf5().Awrite(*made, hdf5_ids().native_double, &value));
}

// Without times, so that equal results are equal files; members in the order they were made in.
Handle group(hid_t parent, const char* name) {
  const Handle how(hdf5().Pcreate(hdf5_ids().group_creation), hdf5().Pclose);
  must(hdf5().Pset_obj_track_times(*how, false));
  must(hdf5().Pset_link_creation_order(*how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  return {hdf5().Gcreate2(parent, name, H5P_DEFAULT, *how, H5P_DEFAULT), hdf5().Gclose};
}

Handle data_set(hid_t parent, const std::string& name, hid_t type,
                const std::vector<hsize_t>& extent, Packing packing) {
  const auto rank = static_cast<int>(extent.size());
  const Handle space(hdf5().Screate_simple(rank, extent.data(), nullptr), hdf5().Sclose);
  const Handle how(hdf5().Pcreate(hdf5_ids().data_set_creation), hdf5().Pclose);
  must(hdf5().Pset_obj_track_times(*how, false));
  if (extent[0] > 0) {
    std::vector<hsize_t> chunk = extent;
    chunk[0] = std::min(chunk[0], kChunk);
    must(hdf5().Pset_chunk(*how, rank, chunk.data()));
    if (packing == Packing::light) {
      if (hdf5().Tis_variable_str(type) <= 0) must(hdf5().Pset_shuffle(*how));
      must(hdf5().Pset_deflate(*how, 1));
    }
  }
  return {hdf5().Dcreate2(parent, name.c_str(), type, *space, H5P_DEFAULT, *how, H5P_DEFAULT),
          hdf5().Dclose};
}

// Rows [first, first + count) of a data set with one column.
void write_rows(const Handle& set, hid_t type, hsize_t first, hsize_t count, const void* rows) {
  const Handle file(hdf5().Dget_space(*set), hdf5().Sclose);
  const Handle memory(hdf5().Screate_simple(1, &count, nullptr), hdf5().Sclose);
  must(hdf5().Sselect_hyperslab(*file, H5S_SELECT_SET, &first, nullptr, &count, nullptr));
  must(hdf5().Dwrite(*set, type, *memory, *file, H5P_DEFAULT, rows));
}

}  // namespace

std::string why_no_hdf5() { return module().loaded() ? "" : module().what_is_wrong(); }

struct Hdf5File::Implementation {
  std::size_t variables, outputs;
  Handle file, reason_type;
  std::vector<Handle> columns;  // variables, then outputs
  std::vector<Handle> reasons;  // one

  Implementation(const std::filesystem::path& path, const Sweep& sweep, const SweepRecord& record)
      : variables(sweep.plan().varied.size()),
        outputs(sweep.plan().outputs.size()),
        file(open(path)),
        reason_type(text_type()) {
    const Handle root(hdf5().Gopen2(*file, "/", H5P_DEFAULT), hdf5().Gclose);
    attribute(*root, "title", "designs of a pump and their computed outputs");
    attribute(*root, "case", record.case_text);
    attribute(*root, "plan", record.plan);
    for (const auto& [name, content] : record.curves) attribute(*root, name.c_str(), content);
    const std::vector<hsize_t> extent = {sweep.designs()};
    const Handle designs = group(*file, "designs"), results = group(*file, "outputs");
    for (const Varied& v : sweep.plan().varied) {
      columns.push_back(
          data_set(*designs, v.variable.name(), hdf5_ids().stored_double, extent, Packing::light));
      attribute(*columns.back(), "unit", v.variable.unit());
      attribute(*columns.back(), "meaning", v.variable.meaning());
      attribute(*columns.back(), "symbol", v.variable.symbol());
      const std::string words = joined(v.variable.words(), ",");
      if (!words.empty()) attribute(*columns.back(), "words", words);
    }
    for (const Output& o : sweep.plan().outputs) {
      columns.push_back(
          data_set(*results, o.name, hdf5_ids().stored_double, extent, Packing::none));
      attribute(*columns.back(), "unit", o.unit);
      attribute(*columns.back(), "meaning", o.meaning);
    }
    reasons.push_back(data_set(*file, "reason", *reason_type, extent, Packing::light));
    attribute(*reasons.back(), "meaning", "why a design is infeasible; empty where it is not");
  }

  static Handle open(const std::filesystem::path& path) {
    hdf5_ids();
    hdf5().Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are said by this program
    const Handle how(hdf5().Pcreate(hdf5_ids().file_creation), hdf5().Pclose);
    must(hdf5().Pset_obj_track_times(*how, false));
    return {hdf5().Fcreate(path.c_str(), hdf5_ids().overwrite, *how, H5P_DEFAULT), hdf5().Fclose};
  }

  void check_columns(const char* name, const std::vector<SweepCheck>& checks, std::size_t outputs_,
                     std::vector<double> SweepCheck::*which, const Handle& parent) const {
    std::vector<double> all;
    for (const SweepCheck& c : checks) all.insert(all.end(), (c.*which).begin(), (c.*which).end());
    const Handle set =
        data_set(*parent, name, hdf5_ids().stored_double, {checks.size(), outputs_}, Packing::none);
    must(hdf5().Dwrite(*set, hdf5_ids().native_double, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()));
    attribute(*set, "columns", "as /outputs, in the order of the plan");
  }
};

Hdf5File::Hdf5File(const std::filesystem::path& file, const Sweep& sweep, const SweepRecord& record)
    : implementation_(std::make_unique<Implementation>(file, sweep, record)) {}
Hdf5File::~Hdf5File() = default;

void Hdf5File::add(const SweepBlock& block) {
  Implementation& it = *implementation_;
  std::vector<double> column(block.designs);
  const auto write = [&](const Handle& set, const std::vector<double>& rows, std::size_t which,
                         std::size_t width) {
    for (std::size_t i = 0; i < block.designs; ++i) column[i] = rows[i * width + which];
    write_rows(set, hdf5_ids().native_double, block.first, block.designs, column.data());
  };
  for (std::size_t i = 0; i < it.variables; ++i)
    write(it.columns[i], block.values, i, it.variables);
  for (std::size_t i = 0; i < it.outputs; ++i)
    write(it.columns[it.variables + i], block.results, i, it.outputs);
  std::vector<const char*> texts;
  // A text that is not there reads as an empty one, and takes no place.
  for (const std::string& reason : block.reasons)
    texts.push_back(reason.empty() ? nullptr : reason.c_str());
  write_rows(it.reasons.front(), *it.reason_type, block.first, block.designs, texts.data());
}

void Hdf5File::finish(const std::vector<SweepCheck>& checks) {
  Implementation& it = *implementation_;
  if (!checks.empty()) {
    const Handle parent = group(*it.file, "checks");
    attribute(*parent, "meaning", "designs that were also computed by the other model");
    attribute(*parent, "tolerance", kCheckTolerance);
    std::vector<double> designs;
    for (const SweepCheck& c : checks) designs.push_back(static_cast<double>(c.design));
    const Handle set =
        data_set(*parent, "design", hdf5_ids().stored_integer, {checks.size()}, Packing::none);
    must(hdf5().Dwrite(*set, hdf5_ids().native_double, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                       designs.data()));
    it.check_columns("own", checks, it.outputs, &SweepCheck::own, parent);
    it.check_columns("other", checks, it.outputs, &SweepCheck::values, parent);
    it.check_columns("scale", checks, it.outputs, &SweepCheck::scales, parent);
  }
  must(hdf5().Fflush(*it.file, H5F_SCOPE_GLOBAL));
  implementation_.reset();
}

}  // namespace bentaxis::designs

#else

namespace bentaxis::designs {

std::string hdf5_version() { return "none"; }
std::string why_no_hdf5() {
  return "this program was built without HDF5; install libhdf5-dev (scripts/setup full) and build "
         "again";
}

struct Hdf5File::Implementation {};

Hdf5File::Hdf5File(const std::filesystem::path& file, const Sweep&, const SweepRecord&) {
  throw InputError(file.string() + ": " + why_no_hdf5() + ", or take --format csv");
}
Hdf5File::~Hdf5File() = default;
void Hdf5File::add(const SweepBlock&) {}
void Hdf5File::finish(const std::vector<SweepCheck>&) {}

}  // namespace bentaxis::designs

#endif
