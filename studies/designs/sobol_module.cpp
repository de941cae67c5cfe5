#include "sobol_module.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <openturns/MartinezSensitivityAlgorithm.hxx>

namespace {

OT::Sample table(const double* values, std::size_t rows, std::size_t columns) {
  OT::Sample sample(rows, columns);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) sample(i, j) = values[i * columns + j];
  return sample;
}

}  // namespace

extern "C" int bentaxis_sobol_indices(unsigned long base, unsigned long numbers,
                                      const double* inputs, const double* outputs, double level,
                                      double* indices, char* message, unsigned long room) try {
  const std::size_t rows = base * (numbers + 2);
  OT::MartinezSensitivityAlgorithm algorithm(table(inputs, rows, numbers), table(outputs, rows, 1),
                                             base);
  algorithm.setConfidenceLevel(level);
  algorithm.setUseAsymptoticDistribution(true);
  const OT::Point first = algorithm.getFirstOrderIndices(),
                  total = algorithm.getTotalOrderIndices();
  const OT::Interval of_first = algorithm.getFirstOrderIndicesInterval();
  const OT::Interval of_total = algorithm.getTotalOrderIndicesInterval();
  for (std::size_t i = 0; i < numbers; ++i) {
    double* const row = indices + 6 * i;
    row[0] = first[i];
    row[1] = of_first.getLowerBound()[i];
    row[2] = of_first.getUpperBound()[i];
    row[3] = total[i];
    row[4] = of_total.getLowerBound()[i];
    row[5] = of_total.getUpperBound()[i];
  }
  return 0;
} catch (const std::exception& error) {
  const std::size_t length = std::min<std::size_t>(std::strlen(error.what()), room - 1);
  std::memcpy(message, error.what(), length);
  message[length] = 0;
  return 1;
}
