// What the documents of all studies are put together with.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/files/csv_rows.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/study/case_sections.h"
#include "bentaxis/study/plausibility_section.h"

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

/// A curve by each of two models under one name, and their difference.
inline void add_both(Curves& curves, const std::string& name, const Values& first,
                     const Values& second) {
  Values difference;
  for (std::size_t i = 0; i < first.size(); ++i) difference.push_back(second[i] - first[i]);
  curves.tables.at(0).columns.emplace_back(name, first);
  curves.tables.at(1).columns.emplace_back(name, second);
  curves.difference.emplace_back(name, std::move(difference));
}

using bentaxis::joined;

}  // namespace bentaxis::report
