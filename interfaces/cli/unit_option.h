// A unit of others that acts on the pump: options of commands that simulate.
#pragma once

#include <memory>
#include <string>

#include "bentaxis/pump/case.h"
#include "bentaxis/study/fmu_coupling.h"
#include "command_parser.h"

namespace bentaxis::cli {

/// --fmu, --fmu-set, --connect, --communication-step, --fmu-timeout.
class UnitOption {
 public:
  void add_to(CommandParser command);
  bool given() const { return !file_.empty(); }
  /// Nothing where no unit was given.
  /// @throws InputError where the others were given without it, and as study::UnitCoupling
  std::shared_ptr<const study::UnitCoupling> coupling(const CommandParser& command,
                                                      const Case& the_case, bool oil_follows) const;

 private:
  std::string file_;
  study::UnitChoice choice_;
};

}  // namespace bentaxis::cli
