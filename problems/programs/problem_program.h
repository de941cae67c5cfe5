// What the programs in C++ that solve problems of the set share: data in SI, table of results.
#pragma once

#include <toml++/toml.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace problems {

constexpr double kPi = 3.14159265358979323846;

/// Numbers of [data] in SI, by their keys without unit.
class Data {
 public:
  explicit Data(const toml::table& table) {
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      const auto [stem, factor] = unit_of(name);
      if (const auto* list = value.as_array()) {
        for (const auto& one : *list) values_[stem].push_back(factor * number(one));
      } else if (value.is_number()) {
        values_[stem] = {factor * number(value)};
      }
    }
  }
  double operator()(const std::string& name, std::size_t i = 0) const {
    return values_.at(name).at(i);
  }

 private:
  static double number(const toml::node& node) { return node.value<double>().value(); }
  static std::pair<std::string, double> unit_of(const std::string& name) {
    const std::vector<std::pair<std::string, double>> units = {
        {"_kg_mm2", 1e-6},   {"_m_per_s2", 1},   {"_N_s_per_m", 1}, {"_Nm_s_per_rad", 1},
        {"_deg", kPi / 180}, {"_rpm", kPi / 30}, {"_mm", 1e-3},     {"_bar", 1e5},
        {"_kg", 1},          {"_Nm", 1},         {"_N", 1}};
    for (const auto& [ending, factor] : units)
      if (name.size() > ending.size() &&
          name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
        return {name.substr(0, name.size() - ending.size()), factor};
    return {name, 1};
  }
  std::map<std::string, std::vector<double>> values_;
};

/// The asked columns of a problem, one row for each angle.
using Rows = std::vector<std::vector<double>>;
using Solver = std::function<Rows(const Data&, const std::vector<double>& theta)>;

/// Reads FOLDER/problem.toml, solves it, writes the table. @return exit status
inline int solve(const std::map<std::string, Solver>& solvers, const std::string& name,
                 const std::string& folder, const std::string& out) {
  if (solvers.count(name) == 0) throw std::runtime_error(name + ": is not solved by this program");
  const toml::table file = toml::parse_file(folder + "/problem.toml");
  const Data data(*file["data"].as_table());
  std::vector<double> degrees, grid;
  for (int i = 0; i < file["grid"]["count"].value<int>().value(); ++i) {
    degrees.push_back(file["grid"]["from"].value<double>().value() +
                      i * file["grid"]["step"].value<double>().value());
    grid.push_back(degrees.back() * kPi / 180);
  }
  const Rows rows = solvers.at(name)(data, grid);
  std::ofstream stream(out);
  stream.precision(17);
  stream << file["grid"]["column"].value<std::string>().value();
  for (const auto& column : *file["column"].as_array())
    stream << ',' << (*column.as_table())["name"].value<std::string>().value();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    stream << '\n' << degrees[i];
    for (const double value : rows[i]) stream << ',' << value;
  }
  stream << '\n';
  return stream.good() ? 0 : 3;
}

}  // namespace problems
