// What the documents of all studies are put together with: texts, lists, numbers and units, CSV,
// sections. Of the web page too, whose library has no std::ranges.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "answers_text.h"
#include "bentaxis/files/csv_rows.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/plausibility_section.h"
#include "new_section.h"

namespace bentaxis::study {

/// A report on a case: its head (put_description) and what follows from its dimensions.
inline report::Document case_document(const CaseDescription& description, std::string title,
                                      const report::Lines& program,
                                      std::optional<report::Scene> scene = std::nullopt) {
  report::Document document;
  document.title = std::move(title);
  document.program = program;
  put_description(document, description, std::move(scene));
  document.derived = derived_section(description.the_case);
  return document;
}

}  // namespace bentaxis::study

namespace bentaxis::report {

// ---- Parts of a document

/// Puts items behind those of a part of a document, which is there from then on.
using bentaxis::append;
template <class Item>
void append(std::optional<std::vector<Item>>& list, std::vector<Item> more) {
  if (!list) list.emplace();
  append(*list, std::move(more));
}
template <class Item>
void append(std::optional<std::vector<Item>>& list, Item one) {
  if (!list) list.emplace();
  list->push_back(std::move(one));
}

// ---- Lists

/// What `of` makes of each item of a list.
template <class List, class Of>
auto each_of(const List& list, Of of) {
  std::vector<std::decay_t<decltype(of(*std::begin(list)))>> made;
  for (const auto& item : list) made.push_back(of(item));
  return made;
}
/// What `of` finds at each of so many rows.
template <class Of>
Values values_at(std::size_t rows, Of of) {
  Values values;
  for (std::size_t row = 0; row < rows; ++row) values.push_back(of(row));
  return values;
}
/// How many items of a list are so.
template <class List, class Is>
std::size_t count_of(const List& list, Is is) {
  return static_cast<std::size_t>(std::count_if(std::begin(list), std::end(list), is));
}
/// The first of the items for which `size` is largest; nullptr where it is computed for none.
template <class List, class Size>
auto largest_of(const List& list, Size size) {
  decltype(&*std::begin(list)) largest = nullptr;
  for (const auto& item : list)
    if (is_computed(size(item)) && (largest == nullptr || size(item) > size(*largest)))
      largest = &item;
  return largest;
}
/// Numbers below `count`, by size: the largest first, what is not computed last.
template <class Size>
std::vector<std::size_t> by_size(std::size_t count, Size size) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto known = [&](std::size_t i) { return is_computed(size(i)) ? size(i) : -HUGE_VAL; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return known(a) > known(b); });
  return order;
}

// ---- Curves

/// A curve by each of two models under one name, and their difference.
inline void add_both(Curves& curves, const std::string& name, const Values& first,
                     const Values& second) {
  curves.tables.at(0).columns.emplace_back(name, first);
  curves.tables.at(1).columns.emplace_back(name, second);
  curves.difference.emplace_back(
      name, values_at(first.size(), [&](std::size_t row) { return second[row] - first[row]; }));
}

// ---- Texts

using bentaxis::joined;

/// A summary as a command prints it: titles, and their lines below them.
inline std::string summary_text(const Summary& summary) {
  std::string text;
  for (const Summary::Group& group : summary.groups) {
    text += group.title + "\n";
    for (const std::string& line : group.lines) text += "  " + line + "\n";
  }
  return text;
}

/// Warnings as a command prints them, a line each.
inline std::string warnings_text(const std::vector<Warning>& warnings) {
  std::string text;
  for (const Warning& warning : warnings)
    text += fmt::format("warning: {}: {}\n", warning.name, warning.text);
  return text;
}

}  // namespace bentaxis::report
