// CSV files as documents write them.
#include "bentaxis/files/csv_rows.h"

#include <gtest/gtest.h>

namespace bentaxis {
namespace {

TEST(CsvRows, HasAFieldForEveryKind) {
  CsvRows csv("name,count,number,missing,quoted");
  csv.row("a", 3, 0.1, not_computed(), Quoted{"b"});
  csv.row(std::string("x, \"y\""), -1L, 2.0, std::monostate(), Quoted{"c \"d\""});
  EXPECT_EQ(std::move(csv).text(),
            "name,count,number,missing,quoted\n"
            "a,3,0.1,,\"b\"\n"
            "\"x, \"\"y\"\"\",-1,2,,\"c \"\"d\"\"\"\n");
}

TEST(CsvRows, TakesAListAsSoManyFields) {
  CsvRows csv;
  csv.row(std::vector<std::string>{"a", "b"}, "c");
  csv.row(std::vector<double>{1, 0.25}, not_computed());
  EXPECT_EQ(std::move(csv).text(), "a,b,c\n1,0.25,\n");
}

TEST(CsvRows, TakesACellByWhatItHolds) {
  using Cell = std::variant<std::monostate, std::string, long, double>;
  CsvRows csv;
  csv.row(std::vector<Cell>{{}, std::string("a"), 7L, 1e300});
  EXPECT_EQ(std::move(csv).text(), ",a,7,1e+300\n");
}

TEST(CsvRows, WritesAllDigits) {
  const double third = 1.0 / 3;
  CsvRows csv;
  csv.row(third);
  EXPECT_EQ(std::stod(std::move(csv).text()), third);
}

}  // namespace
}  // namespace bentaxis
