#include "saved_state.h"

#include <bit>
#include <cstring>
#include <string_view>

#include "bentaxis/pump/error.h"

namespace bentaxis::fmu {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes of states are little-endian");

constexpr std::string_view kTag = "bentaxis unit state 3\n";

// FNV-1a, 64 bits: against bytes that were cut or changed, not against forgers.
std::uint64_t checksum(const char* bytes, std::size_t size) {
  std::uint64_t sum = 0xcbf29ce484222325ULL;
  for (std::size_t i = 0; i < size; ++i) {
    sum ^= static_cast<unsigned char>(bytes[i]);
    sum *= 0x100000001b3ULL;
  }
  return sum;
}

// Both ways of going through the parts of a state, so that they cannot come apart.
class Writer {
 public:
  template <class T>
  void part(const T& value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    text.append(bytes, sizeof(T));
  }
  void part(const bool& value) { part(static_cast<std::uint8_t>(value)); }
  void part(const std::vector<double>& values) {
    part(static_cast<std::uint64_t>(values.size()));
    for (const double value : values) part(value);
  }
  std::string text;
};

class Reader {
 public:
  Reader(const char* bytes, std::size_t size) : at_(bytes), left_(size) {}
  template <class T>
  void part(T& value) {
    take(sizeof(T));
    std::memcpy(&value, at_ - sizeof(T), sizeof(T));
  }
  void part(bool& value) {
    std::uint8_t byte = 0;
    part(byte);
    if (byte > 1) refuse();
    value = byte != 0;
  }
  void part(std::vector<double>& values) {
    std::uint64_t size = 0;
    part(size);
    if (size > left_ / sizeof(double)) refuse();
    values.resize(size);
    for (double& value : values) part(value);
  }
  void finish() const {
    if (left_ != 0) refuse();
  }

 private:
  [[noreturn]] static void refuse() {
    throw InputError("the bytes of a state do not have this layout");
  }
  void take(std::size_t size) {
    if (size > left_) refuse();
    at_ += size;
    left_ -= size;
  }
  const char* at_;
  std::size_t left_;
};

template <class Stream, class... Parts>
void go_through(Stream& stream, Parts&... parts) {
  (stream.part(parts), ...);
}

template <class Stream, class TheInputs>
void go_through_inputs(Stream& stream, TheInputs& i) {
  go_through(stream, i.speed, i.acceleration, i.torque, i.suction, i.delivery, i.load_share,
             i.load_share_replaces_curve, i.acceleration_given, i.torque_rate, i.suction_rate,
             i.delivery_rate, i.load_share_rate);
}

template <class Stream, class State>
void go_through_state(Stream& stream, State& state) {
  go_through(stream, state.mode, state.start_time, state.stop_time, state.now, state.tolerance,
             state.stops, state.set_up, state.started, state.parameters);
  go_through_inputs(stream, state.inputs);
  auto& plant = state.plant;
  go_through(stream, plant.time, plant.motion, plant.oil, plant.shaft.angle, plant.shaft.speed,
             plant.shaft.acceleration, plant.load_size, plant.started, plant.speed_changed);
  go_through_inputs(stream, plant.inputs);
}

}  // namespace

std::string bytes_of(const SavedState& state, const std::string& token) {
  Writer writer;
  writer.text = std::string(kTag) + token + "\n";
  go_through_state(writer, state);
  writer.part(checksum(writer.text.data(), writer.text.size()));
  return writer.text;
}

SavedState state_of(const char* bytes, std::size_t size, const std::string& token) {
  const std::string head = std::string(kTag) + token + "\n";
  std::uint64_t sum = 0;
  if (size < head.size() + sizeof(sum) || std::string_view(bytes, kTag.size()) != kTag)
    throw InputError("the bytes are not a state of an FMU of this version");
  if (std::string_view(bytes, head.size()) != head)
    throw InputError("the bytes are a state of another FMU");
  std::memcpy(&sum, bytes + size - sizeof(sum), sizeof(sum));
  if (sum != checksum(bytes, size - sizeof(sum)))
    throw InputError("the bytes of a state have changed: the checksum differs");
  Reader reader(bytes + head.size(), size - head.size() - sizeof(sum));
  SavedState state;
  go_through_state(reader, state);
  reader.finish();
  return state;
}

}  // namespace bentaxis::fmu
