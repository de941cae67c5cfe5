#include <cstdlib>
#include <mutex>
#include <optional>
#include <system_error>

#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "channel.h"
#include "process_slave.h"
#include "supervisor.h"
#include "unpacked.h"

namespace bentaxis::fmu {
namespace {

// Whether this machine can run it.
std::filesystem::path library_of(const std::filesystem::path& file, const Unpacked& unpacked,
                                 const UnitDescription& description) {
  const std::string place = file.string() + ": ";
  if (description.identifier.empty())
    throw InputError(
        place +
        (description.exchange_identifier.empty()
             ? "modelDescription.xml has no <CoSimulation>"
             : "is for model exchange only: export it for co-simulation, which includes a solver"));
  const std::string name =
      "binaries/" + platform_folder(description.version) + "/" + description.identifier + ".so";
  std::filesystem::path library = unpacked.folder() / name;
  if (!std::filesystem::exists(library))
    throw InputError(place + "has no " + name +
                     (unpacked.platforms().empty()
                          ? " and none for another platform"
                          : ": its binaries are for " + joined(unpacked.platforms())));
  return library;
}

// @return the file, where it can be unpacked at all
const std::filesystem::path& with_room(const std::filesystem::path& file) {
  std::error_code failed;
  (void)std::filesystem::temp_directory_path(failed);
  const char* place = std::getenv("TMPDIR");
  if (failed)
    throw InputError(file.string() + ": cannot be unpacked: TMPDIR = \"" +
                     (place != nullptr ? place : "/tmp") +
                     "\" is not a directory for temporary files: " + failed.message());
  return file;
}

}  // namespace

class ImportedUnit::Implementation {
 public:
  Implementation(const std::filesystem::path& archive, Limits wanted)
      : file(with_room(archive)),
        limits(std::move(wanted)),
        unpacked(archive, kMaxUnpacked,
                 [this](const std::filesystem::path& folder) {
                   supervisor.emplace(folder, file.string());
                 }),
        description(
            read_description(unpacked.description(), archive.string() + ": modelDescription.xml")),
        library(library_of(archive, unpacked, description)),
        spare_(new_process()) {}

  ~Implementation() {
    spare_.reset();
    supervisor.reset();  // No process uses the folder any more.
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  // A process that has loaded the library.
  std::unique_ptr<Channel> take_process() {
    {
      const std::lock_guard<std::mutex> lock(busy_);
      if (spare_) return std::move(spare_);
    }
    return new_process();
  }

  const std::filesystem::path file;
  const Limits limits;
  std::optional<Supervisor> supervisor;  // removes the folder, too, in whatever way all this ends
  const Unpacked unpacked;
  const UnitDescription description;
  const std::filesystem::path library;

 private:
  std::unique_ptr<Channel> new_process() {
    auto channel = std::make_unique<Channel>(*supervisor, file.string(), limits);
    const std::string name = library.filename().string();
    const Returned returned = channel->call({process::Task::load,
                                             {"loading " + name},
                                             description.version,
                                             0,
                                             0,
                                             {},
                                             {library.string()}});
    if (returned.outcome == process::Outcome::not_loaded)
      throw InputError(file.string() + ": " + name + " cannot be loaded: " +
                       (returned.text.empty() ? "no reason given" : returned.text));
    return channel;
  }

  std::mutex busy_;
  std::unique_ptr<Channel> spare_;
};

ImportedUnit::ImportedUnit(const std::filesystem::path& file, const Limits& limits)
    : it_(std::make_shared<Implementation>(file, limits)) {}
ImportedUnit::~ImportedUnit() = default;
const UnitDescription& ImportedUnit::description() const { return it_->description; }
const std::filesystem::path& ImportedUnit::file() const { return it_->file; }
const std::filesystem::path& ImportedUnit::folder() const { return it_->unpacked.folder(); }

std::unique_ptr<Slave> ImportedUnit::instantiate(const std::string& name) const {
  return process_slave({it_, it_->description, it_->unpacked.folder() / "resources",
                        it_->file.string(), name, it_->take_process()});
}

}  // namespace bentaxis::fmu
