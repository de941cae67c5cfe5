// What designs differ in: any parameter of the registry, by the name that --set takes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/registry.h"

namespace bentaxis::designs {

/// A parameter of the registry as a number: a number or an integer in the file's unit, an end of a
/// pair ("port_plate.delivery_arc_deg.1" and ".2"), a flag as 0 or 1, a choice as the place of its
/// word, from 0.
class Variable {
 public:
  /// @param name  "pump.tilt_deg"
  /// @throws InputError where the registry has no such parameter, where it is a text or a file, or
  ///         where it has nothing to do in this case
  Variable(const std::string& name, const Case& base);

  const std::string& name() const { return name_; }
  const Parameter& parameter() const { return *parameter_; }
  /// Symbol in the paper or in docs/, of a pair that of its end, or "". Unique within its table.
  std::string symbol() const;
  /// Of the file: "mm"; "" where there is none.
  std::string unit() const { return parameter_->unit.name; }
  const std::string& meaning() const { return parameter_->meaning; }
  /// Words of a choice, "false" and "true" of a flag; empty of a number.
  const std::vector<std::string>& words() const { return words_; }
  /// Whether only whole numbers are values.
  bool discrete() const { return !words_.empty() || integer_; }
  /// What the registry allows, in the file's unit, in this case.
  NumberRange range(const Case& the_case) const;

  double value(const Case& the_case) const;
  /// Puts a value in its place; checks nothing but that it is whole where it must be.
  /// @throws InputError
  void put(Case& the_case, double value) const;
  /// A value for people and for `--set`: 40, lumped, true.
  std::string text(double value) const;
  /// The reverse. @throws InputError naming the variable
  double value_of(const std::string& text) const;

 private:
  std::string name_;
  const Table* table_ = nullptr;
  const Parameter* parameter_ = nullptr;
  int end_ = -1;  // of a pair: 0 or 1
  bool integer_ = false;
  std::vector<std::string> words_;
};

/// Cases that differ from one in some variables. Immutable.
class Family {
 public:
  /// @throws InputError where two variables are one
  Family(Case base, std::vector<Variable> variables);

  const Case& base() const { return base_; }
  const std::vector<Variable>& variables() const { return variables_; }
  /// A parameter that the case does not give: its default follows from others.
  struct Follower {
    const Table* table;
    const Parameter* parameter;
  };
  const std::vector<Follower>& followers() const { return followers_; }

  /// Makes `scratch`, a copy of base() or what an earlier call made of one, the case of these
  /// values, one per variable, as `--set` would: what takes its default from another parameter
  /// follows. Copies nothing, so that it is fast.
  /// @throws InputError where a case file with these values would be refused; `scratch` may be used
  ///         again all the same
  void make(std::span<const double> values, Case& scratch) const;

 private:
  Case base_;
  std::vector<Variable> variables_;
  std::vector<Follower> followers_;
};

}  // namespace bentaxis::designs
