// What is asked of lists everywhere: whether something is in one, and the text of one.
#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

namespace bentaxis {

/// Whether a list has a value.
template <class List, class Value>
bool contains(const List& list, const Value& value) {
  return std::find(std::begin(list), std::end(list), value) != std::end(list);
}

/// Appends a value to a list that does not have it yet.
template <class List, class Value>
void add_once(List& list, const Value& value) {
  if (!contains(list, value)) list.push_back(value);
}

/// Appends all of one list to another.
template <class List, class More>
void append(List& list, More&& more) {
  if constexpr (std::is_lvalue_reference_v<More>)
    list.insert(list.end(), std::begin(more), std::end(more));
  else
    list.insert(list.end(), std::make_move_iterator(std::begin(more)),
                std::make_move_iterator(std::end(more)));
}

/// Sorts a list and leaves one of what is the same.
template <class List>
void sort_once(List& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}
/// Of numbers, one of those that are nearer to the one before than `gap`.
inline void sort_once(std::vector<double>& list, double gap) {
  std::sort(list.begin(), list.end());
  const auto near = [gap](double a, double b) { return b - a < gap; };
  list.erase(std::unique(list.begin(), list.end(), near), list.end());
}

/// The texts of a list in one, with a separator between them.
/// @param text_of  of an element of the list
template <class List, class TextOf>
std::string joined(const List& list, const std::string& separator, TextOf text_of) {
  std::string all;
  bool first = true;
  for (const auto& element : list) {
    if (!first) all += separator;
    all += text_of(element);
    first = false;
  }
  return all;
}
template <class List>
std::string joined(const List& list, const std::string& separator = ", ") {
  return joined(list, separator,
                [](const std::string& text) -> const std::string& { return text; });
}

}  // namespace bentaxis
