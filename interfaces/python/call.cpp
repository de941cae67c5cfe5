#include "call.h"

#include <string>

namespace bentaxis::python {

study::PartProgress Watch::progress_of() {
  return [this](const std::string&) { return Progress([this](double) { look(); }); };
}

void Watch::look() {
  if (std::this_thread::get_id() != caller_) return;
  constexpr std::chrono::milliseconds kBetweenLooks(50);
  const auto now = std::chrono::steady_clock::now();
  if (now - looked_ < kBetweenLooks) return;
  looked_ = now;
  {
    const pybind11::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() == 0) return;
    PyErr_Fetch(&type_, &value_, &trace_);
  }
  throw Interrupted();
}

void Watch::raise() {
  if (type_ == nullptr) throw std::runtime_error("interrupted");
  PyErr_Restore(type_, value_, trace_);
  type_ = value_ = trace_ = nullptr;
  throw pybind11::error_already_set();
}

}  // namespace bentaxis::python
