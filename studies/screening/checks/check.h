// One check of plausibility, the words of all, and the checks of each part of a case.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "bentaxis/pump/plausible_range.h"
#include "checks/facts.h"

namespace bentaxis::study::checks {

using Slips = std::vector<Slip>;
using namespace slips;
inline const Slips kOfInertia = {kTenth, kTenfold, kKgM2, kGMm2};

/// The first slip that explains a value outside of [low, high]; a slip that would move it by far
/// more than it is outside explains nothing.
std::string guess(double value, double low, double high, const Slips& slips);

/// "" where value is in [low, high].
std::string outside(const std::string& key, double value, double low, double high,
                    const std::string& unit, const std::string& why, const Slips& slips = {});

/// The same of a number of the case, as its file has it. Also "" where it is not there or unused.
/// @param shown  the key, behind the table where a reader would not know which is meant
std::string outside(const Facts& f, const char* table_name, const std::string& shown, double low,
                    double high, const std::string& why, const Slips& slips = {});

/// "" where a number of the case is in the range that its entry holds for plausible.
std::string implausible(const Facts& f, const char* table, const char* key);

std::string first_of(std::initializer_list<std::string> texts);

inline bool always(const Facts& /*facts*/) { return true; }

struct Check {
  using Applies = bool (*)(const Facts&);
  using Text = std::string (*)(const Facts&);

  Check(const char* a_code, const char* words, Text what) : Check(a_code, words, always, what) {}
  Check(const char* a_code, const char* words, Applies where, Text what)
      : code(a_code), doubtful(words), applies(where), text(what) {}
  // Of the parameter whose plausible range is asked for: {0} and {1} in the words are its bounds.
  Check(const char* a_code, const char* words, const char* of_table, const char* of_key,
        Applies where = always, Text what = nullptr)
      : code(a_code), doubtful(words), applies(where), text(what), table(of_table), key(of_key) {}

  const char* code;
  const char* doubtful;  // what is, in words: docs/plausibility.md
  Applies applies;
  Text text = nullptr;  // "" where nothing is; null: implausible()
  const char* table = nullptr;
  const char* key = nullptr;

  std::string found(const Facts& facts) const;
  std::string words() const;
};

/// The checks of each part, in the order of the case file.
std::vector<Check> dimensions();
std::vector<Check> gear();
std::vector<Check> transfer();
std::vector<Check> bearings();
std::vector<Check> piston();
std::vector<Check> shaft_and_block();
std::vector<Check> friction();
std::vector<Check> operation();
std::vector<Check> pressure();
std::vector<Check> port_plate();
std::vector<Check> film_and_flank();
std::vector<Check> hydraulics();

}  // namespace bentaxis::study::checks
