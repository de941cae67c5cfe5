#include "bentaxis/study/fmu_coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_set>

#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/results/trajectory.h"
#include "fmu_connections.h"

namespace bentaxis::study {

namespace {

constexpr double kMaxPoints = 1e6;
constexpr std::size_t kMaxSaid = 1000;  // lines

}  // namespace

// What instances have said, without repetition.
class UnitCoupling::Said {
 public:
  /// @param from  of the lines: those before have been added
  void add(const std::vector<std::string>& lines, std::size_t from = 0) {
    for (std::size_t i = from; i < lines.size() && lines_.size() < kMaxSaid; ++i)
      if (seen_.insert(lines[i]).second) lines_.push_back(lines[i]);
  }
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
  std::unordered_set<std::string> seen_;
};

// An instance of the unit, always a communication step ahead of the pump.
class UnitCoupling::Partner {
 public:
  Partner(std::unique_ptr<fmu::Slave> slave, std::vector<Connection> connections, double step,
          double end, std::string place, std::shared_ptr<UnitRecord> record,
          std::shared_ptr<Said> said)
      : slave_(std::move(slave)),
        connections_(std::move(connections)),
        step_(step),
        end_(end),
        place_(std::move(place)),
        record_(std::move(record)),
        said_(std::move(said)) {
    if (record_) record_->columns.emplace_back("time_s");
    for (const Connection& c : connections_) {
      all_.push_back(&c.unit);
      (c.to_pump ? outputs_ : inputs_).push_back(&c.unit);
      if (record_)
        record_->columns.push_back(c.unit.unit.empty() ? c.unit.name
                                                       : c.unit.name + " (" + c.unit.unit + ")");
      speed_given_ = speed_given_ || (c.to_pump && c.pump == "drive_speed");
      acceleration_given_ = acceleration_given_ || (c.to_pump && c.pump == "drive_acceleration");
    }
  }

  // What acts from a communication point on.
  Surroundings at(const coupled::PumpOutputs& pump) {
    if (points_ == 0) slave_->enter_initialisation(0, end_);
    tell(pump);
    if (points_ == 0) slave_->exit_initialisation();
    Surroundings outside;
    // What is recorded is read at once with what acts.
    const std::vector<double> values = slave_->get(record_ ? all_ : outputs_);
    std::size_t at = 0;
    for (const Connection& c : connections_) {
      if (c.to_pump) take(c, values[at], pump.time, outside);
      if (c.to_pump || record_) ++at;
    }
    if (record_) {
      record_->values.push_back(pump.time);
      append(record_->values, values);
    }
    slave_->step(step_ * static_cast<double>(points_), step_);
    ++points_;
    // Without an acceleration the speed goes straight to where the unit gets.
    if (speed_given_ && !acceleration_given_) {
      Surroundings later;
      for (const Connection& c : connections_)
        if (c.to_pump && c.pump == "drive_speed")
          take(c, slave_->get(c.unit), pump.time + step_, later);
      outside.shaft->acceleration = (later.shaft->speed - outside.shaft->speed) / step_;
    }
    note_log();
    return outside;
  }

  /// No more is asked of it.
  void end() {
    slave_->end();
    note_log();
  }

 private:
  void note_log() {
    said_->add(slave_->log(), noted_);
    noted_ = slave_->log().size();
  }

  void tell(const coupled::PumpOutputs& pump) {
    std::vector<double> values;
    for (const Connection& c : connections_)
      if (!c.to_pump) values.push_back(told(c, pump));
    if (!inputs_.empty()) slave_->set(inputs_, values);
  }

  double told(const Connection& c, const coupled::PumpOutputs& pump) const {
    double value = pump[c.pump];
    if (!is_computed(value))
      throw ComputationError(fmt::format("{}: input \"{}\" at {} s: {} is not computed", place_,
                                         c.unit.name, rounded_text(pump.time), c.pump));
    value = fmu::converted(value, c.from, c.to);
    // What counts takes the nearest number.
    const bool counts = c.unit.type != "Real" && c.unit.type.rfind("Float", 0) != 0;
    return counts ? std::round(value) : value;
  }

  void take(const Connection& c, double read, double time, Surroundings& outside) const {
    const double value = fmu::converted(read, c.from, c.to);
    if (c.pump == "load_share") {
      if (value < 0)
        throw ComputationError(
            fmt::format("{}: output \"{}\" at {} s: load_share = {}: must be "
                        ">= 0",
                        place_, c.unit.name, rounded_text(time), number_text(value)));
      outside.load_share = value;
    }
    if (c.pump == "suction_pressure") outside.suction = value;
    if (c.pump == "delivery_pressure") outside.delivery = value;
    if (c.pump == "drive_torque") outside.torque = value;
    if (c.pump != "drive_speed" && c.pump != "drive_acceleration") return;
    if (!outside.shaft) outside.shaft.emplace();
    (c.pump == "drive_speed" ? outside.shaft->speed : outside.shaft->acceleration) = value;
  }

  std::unique_ptr<fmu::Slave> slave_;
  std::vector<Connection> connections_;
  std::vector<const fmu::UnitVariable*> inputs_, outputs_, all_;  // of the unit, of connections_
  double step_, end_;
  std::string place_;
  std::shared_ptr<UnitRecord> record_;
  std::shared_ptr<Said> said_;
  std::size_t noted_ = 0;  // lines of its log
  bool speed_given_ = false, acceleration_given_ = false;
  long points_ = 0;
};

struct UnitCoupling::Instances {
  std::shared_ptr<Said> said = std::make_shared<Said>();
  std::vector<std::shared_ptr<Partner>> running;
};

UnitCoupling::UnitCoupling(const UnitChoice& choice, const Case& the_case, bool oil_follows)
    : driven_(the_case), instances_(std::make_shared<Instances>()) {
  drive_of(the_case);
  unit_ = std::make_shared<fmu::ImportedUnit>(choice.file, choice.limits);
  connections_ = connect(unit_->description(), pump_side(the_case, oil_follows), choice.connect,
                         choice.file.string());
  find_parameters(choice.parameters);
  find_step(choice);
  find_drive();
}

UnitCoupling::~UnitCoupling() = default;

bool UnitCoupling::drives(const char* input) const {
  return std::any_of(connections_.begin(), connections_.end(),
                     [&](const Connection& c) { return c.to_pump && c.pump == input; });
}

void UnitCoupling::find_parameters(const std::vector<std::string>& wanted) {
  for (const std::string& text : wanted) {
    const std::string option = "--fmu-set " + text;
    const auto sign = text.find('=');
    const auto value = sign == std::string::npos ? std::nullopt : number_in(text.substr(sign + 1));
    if (!value) throw InputError(option + ": must be NAME=VALUE, a number");
    const fmu::UnitVariable* v = unit_->description().find(text.substr(0, sign));
    if (v == nullptr || v->causality != "parameter") {
      std::set<std::string> names;
      for (const auto& other : unit_->description().variables)
        if (other.causality == "parameter") names.insert(other.name);
      throw InputError(option + ": the FMU has no such parameter" +
                       (names.empty()
                            ? ": it has none"
                            : suggestion(text.substr(0, sign), names, "in modelDescription.xml")));
    }
    parameters_.emplace_back(*v, *value);
  }
}

std::unique_ptr<fmu::Slave> UnitCoupling::instance(const std::string& name) const {
  auto slave = unit_->instantiate(name);
  for (const auto& [variable, value] : parameters_) {
    try {
      slave->set(variable, value);
    } catch (const ComputationError& error) {
      throw InputError(fmt::format("--fmu-set {}={}: the FMU refuses it: {}", variable.name,
                                   number_text(value), error.what()));
    }
  }
  return slave;
}

void UnitCoupling::find_step(const UnitChoice& choice) {
  const DriveSpec& drive = *driven_.drive;
  double step =
      choice.step.value_or(unit_->description().step_size.value_or(drive.duration / drive.samples));
  if (!(step > 0)) step = drive.duration / drive.samples;
  if (choice.step && step > drive.duration)
    throw InputError(fmt::format("--communication-step {}: must be <= {}, [drive] duration_s",
                                 number_text(step), number_text(drive.duration)));
  // As rounding has it, not one more.
  constexpr double kWhole = 1e-9;
  const double points = std::max(1.0, std::ceil(drive.duration / step - kWhole));
  if (points > kMaxPoints)
    throw InputError(
        fmt::format("{} {}: {:.3g} steps would be made in [drive] duration_s = {}: at most {:g}",
                    choice.step ? "--communication-step" : choice.file.string() + ": stepSize",
                    number_text(step), points, number_text(drive.duration), kMaxPoints));
  step_ = drive.duration / points;
}

// [drive] as the unit wants it, begun as the unit begins.
void UnitCoupling::find_drive() {
  DriveSpec& drive = *driven_.drive;
  const bool torque = drives("drive_torque"), speed = drives("drive_speed");
  if (!torque && !speed) return;
  const double usual = rad_per_second(driven_.operation.speed_rpm);
  const double start = start_speed(drive, usual);
  drive.kind = torque ? DriveKind::torque : DriveKind::speed;
  drive.motor.reset();
  drive.curve = {};
  drive.start_speed.reset();

  const auto slave = instance("start");
  slave->enter_initialisation(0, drive.duration);
  slave->exit_initialisation();
  for (const Connection& c : connections_) {
    if (!c.to_pump || (c.pump != "drive_torque" && c.pump != "drive_speed")) continue;
    const double value = fmu::converted(slave->get(c.unit), c.from, c.to);
    if (torque) {
      drive.torque = value;
    } else if (value != usual) {
      // A speed that stands: what is at the start counts.
      drive.curve = {unit_->file(), {0, 1, 2, 3}, {value, value, value, value}};
    }
  }
  if (torque) drive.start_speed = start;
  slave->end();
  instances_->said->add(slave->log());
}

namespace {

std::vector<std::string> loose(const fmu::UnitDescription& unit,
                               const std::vector<Connection>& connections, bool to_pump) {
  std::vector<std::string> names;
  for (const auto& v : unit.variables)
    if (v.causality == (to_pump ? "output" : "input") &&
        std::none_of(connections.begin(), connections.end(), [&](const Connection& c) {
          return c.to_pump == to_pump && c.unit.name == v.name;
        }))
      names.push_back(v.name);
  return names;
}

}  // namespace

std::vector<std::string> UnitCoupling::loose_inputs() const {
  return loose(unit_->description(), connections_, false);
}
std::vector<std::string> UnitCoupling::loose_outputs() const {
  return loose(unit_->description(), connections_, true);
}

coupled::Exchange UnitCoupling::exchange(int parts, std::shared_ptr<UnitRecord> record) const {
  const double step = step_ / parts;
  const auto partner =
      std::make_shared<Partner>(instance("drive"), connections_, step, driven_.drive->duration,
                                unit_->file().string(), std::move(record), instances_->said);
  instances_->running.push_back(partner);
  return {step, [partner](const coupled::PumpOutputs& pump) { return partner->at(pump); }};
}

void UnitCoupling::end_instances() const {
  while (!instances_->running.empty()) {
    const std::shared_ptr<Partner> partner = instances_->running.back();
    instances_->running.pop_back();
    partner->end();
  }
}

std::string UnitRecord::csv() const {
  std::string text = joined(columns, ",", csv_text) + "\n";
  for (std::size_t i = 0; i < values.size(); ++i) {
    append_number(text, values[i]);
    text += (i + 1) % columns.size() == 0 ? '\n' : ',';
  }
  return text;
}

std::vector<std::string> UnitCoupling::log() const { return instances_->said->lines(); }

}  // namespace bentaxis::study
