#include "bentaxis/hydraulics/accuracy_log.h"

#include <mutex>
#include <optional>

#include "bentaxis/hydraulics/steady_state.h"

namespace bentaxis::hydraulics {
namespace {

struct Log {
  std::mutex mutex;
  std::optional<AccuracyLog::Record> record;  // while it is kept
};

Log& the_log() {
  static Log log;
  return log;
}

}  // namespace

InaccurateState inaccurate_state(const Case& the_case, const SteadyState& state) {
  return {the_case.file, the_case.operation.speed_rpm, the_case.pressure.ports.delivery,
          pressure_error(state), the_case.hydraulics->curve_error};
}

AccuracyLog::AccuracyLog() {
  const std::lock_guard lock(the_log().mutex);
  the_log().record.emplace();
}

AccuracyLog::~AccuracyLog() {
  const std::lock_guard lock(the_log().mutex);
  the_log().record.reset();
}

AccuracyLog::Record AccuracyLog::record() {
  const std::lock_guard lock(the_log().mutex);
  return the_log().record.value_or(Record());
}

void AccuracyLog::note(const Case& the_case, const SteadyState& state) {
  const InaccurateState here = inaccurate_state(the_case, state);
  const std::lock_guard lock(the_log().mutex);
  auto& record = the_log().record;
  if (!record) return;
  if (record->count++ == 0 || here.error * record->worst.limit > record->worst.error * here.limit)
    record->worst = here;
}

}  // namespace bentaxis::hydraulics
