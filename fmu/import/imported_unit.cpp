#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/error.h"
#include "shared_library.h"
#include "slave_kinds.h"
#include "unpacked.h"

namespace bentaxis::fmu {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// Whether this machine can run it.
std::filesystem::path library_of(const std::filesystem::path& file, const Unpacked& unpacked,
                                 const UnitDescription& description) {
  const std::string place = file.string() + ": ";
  if (description.identifier.empty())
    throw InputError(place +
                     (description.exchange_identifier.empty()
                          ? "modelDescription.xml has no <CoSimulation>"
                          : "is for model exchange alone: export it for co-simulation, which "
                            "brings its own solver"));
  const std::string name =
      "binaries/" + platform_folder(description.version) + "/" + description.identifier + ".so";
  std::filesystem::path library = unpacked.folder() / name;
  if (!std::filesystem::exists(library))
    throw InputError(place + "has no " + name +
                     (unpacked.platforms().empty()
                          ? ", nor binaries for another machine"
                          : ": its binaries are for " + joined(unpacked.platforms())));
  return library;
}

}  // namespace

class ImportedUnit::Implementation {
 public:
  explicit Implementation(const std::filesystem::path& archive)
      : file(archive),
        unpacked(archive),
        description(
            read_description(unpacked.description(), archive.string() + ": modelDescription.xml")),
        library(library_of(archive, unpacked, description), archive.string()) {}

  const std::filesystem::path file;
  const Unpacked unpacked;
  const UnitDescription description;
  const SharedLibrary library;
};

namespace {

// An instance holds what it is made of.
class Kept : public Slave {
 public:
  Kept(std::shared_ptr<const void> origin, std::unique_ptr<Slave> slave)
      : origin_(std::move(origin)), slave_(std::move(slave)) {}
  void set(const UnitVariable& variable, double value) override { slave_->set(variable, value); }
  double get(const UnitVariable& variable) override { return slave_->get(variable); }
  void enter_initialisation(double start, double end) override {
    slave_->enter_initialisation(start, end);
  }
  void exit_initialisation() override { slave_->exit_initialisation(); }
  void step(double time, double step) override { slave_->step(time, step); }
  const std::vector<std::string>& log() const override { return slave_->log(); }

 private:
  std::shared_ptr<const void> origin_;
  std::unique_ptr<Slave> slave_;  // goes first
};

}  // namespace

ImportedUnit::ImportedUnit(const std::filesystem::path& file)
    : it_(std::make_shared<Implementation>(file)) {}
ImportedUnit::~ImportedUnit() = default;
const UnitDescription& ImportedUnit::description() const { return it_->description; }
const std::filesystem::path& ImportedUnit::file() const { return it_->file; }
const std::filesystem::path& ImportedUnit::folder() const { return it_->unpacked.folder(); }

std::unique_ptr<Slave> ImportedUnit::instantiate(const std::string& name) const {
  const SlaveOrigin origin{it_->description, it_->library, it_->unpacked.folder() / "resources",
                           it_->file.string(), name};
  return std::make_unique<Kept>(
      it_, it_->description.version == 2 ? fmi2_slave(origin) : fmi3_slave(origin));
}

}  // namespace bentaxis::fmu
