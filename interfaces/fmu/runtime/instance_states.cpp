// Saved states of an instance.
#include <algorithm>

#include "bentaxis/pump/error.h"
#include "instance.h"

namespace bentaxis::fmu {

SavedState Instance::present() const {
  return {run_, wanted_, inputs_, run_.started ? plant_->state() : PlantState()};
}

const SavedState& Instance::known_state(void* state) const {
  const auto found = saved_.find(state);
  if (state == nullptr || found == saved_.end())
    throw Refused("the state was not returned by this instance, or it has been freed");
  return *found->second;
}

void Instance::put_state(void** place, SavedState state) {
  if (place == nullptr) throw Refused("there is no place for a state");
  if (*place != nullptr) {  // of the same instance: to be used again
    const auto found = saved_.find(*place);
    if (found == saved_.end())
      throw Refused(
          "the state to be written was not returned by this instance; a null pointer asks for a "
          "new one");
    *found->second = std::move(state);
    return;
  }
  auto kept = std::make_unique<SavedState>(std::move(state));
  SavedState* const pointer = kept.get();
  saved_[pointer] = std::move(kept);
  *place = pointer;
}

void Instance::save(void** state) {
  // What was set but has not taken effect is set in the saved state too; a plant whose parameters
  // are others than those that are saved would be no state.
  if ((run_.mode & kRunning) != 0) settle();
  put_state(state, present());
}

void Instance::restore(void* state_given) {
  const SavedState state = known_state(state_given);
  // In initialization mode the start is looked for anew: it may be that of other values.
  const bool goes_on = state.started && (state.mode & (kInstantiated | kInitialization)) == 0;
  const bool as_built =
      plant_ && state.parameters == parameters_ && state.tolerance == run_.tolerance;
  if (goes_on && as_built) {
    try {
      plant_->set_state(state.plant);
    } catch (...) {  // it stands nowhere then
      plant_.reset();
      run_.started = false;
      run_.mode = kFailed;
      throw;
    }
  } else if (goes_on) {
    UnitChoice choice = resources_.choice;
    choice.tolerance = state.tolerance;
    auto plant = std::make_unique<Plant>(case_as_set(state.parameters), choice, kind_);
    plant->set_state(state.plant);
    plant_ = std::move(plant);
  } else {
    plant_.reset();
  }
  run_ = state;
  run_.started = goes_on;
  parameters_ = wanted_ = state.parameters;
  inputs_ = state.inputs;
  inputs_changed_ = false;
  open_.reset();
}

void Instance::free_state(void** state) {
  if (state == nullptr || *state == nullptr) return;
  known_state(*state);
  saved_.erase(*state);
  *state = nullptr;
}

std::size_t Instance::serialized_size(void* state) const {
  return bytes_of(known_state(state), resources_.token).size();
}

void Instance::serialize(void* state, char* bytes, std::size_t size) const {
  const std::string text = bytes_of(known_state(state), resources_.token);
  if (size < text.size())
    throw Refused("the state takes " + std::to_string(text.size()) + " bytes, not " +
                  std::to_string(size));
  std::copy(text.begin(), text.end(), bytes);
}

void Instance::deserialize(const char* bytes, std::size_t size, void** state) {
  SavedState read = state_of(bytes, size, resources_.token);
  const bool one_mode =
      read.mode != 0 && (read.mode & (read.mode - 1)) == 0 && read.mode <= kFailed;
  unsigned foreign = kStep;
  if (kind_ == Kind::co_simulation)
    foreign = unsigned{kContinuous} | (stepping_.event_mode ? 0U : unsigned{kEvent});
  if (one_mode && (read.mode & foreign) != 0)
    throw InputError("the bytes are a state of the other interface type");
  const bool runs = (read.mode & kRunning) != 0;
  if (!one_mode || read.parameters.size() != variables_.size() || (runs && !read.started))
    throw InputError("the bytes are not a state of this FMU");
  put_state(state, std::move(read));
}

}  // namespace bentaxis::fmu
