// Numbers that bench/external/expected.json has a number from outside for. What is
// expected stands there alone: no source here knows it.
#pragma once

#include <string>
#include <vector>

namespace bentaxis::external {

struct Number {
  std::string id;  ///< of its row in expected.json
  double value = 0;
};
using Numbers = std::vector<Number>;

Numbers iso_6336();              ///< ISO/TR 6336-30, example 1, and the spur case of its formulas
Numbers pair_of_62();            ///< m 2 mm, 62/62 after Ma et al. 2014
Numbers finite_element_tooth();  ///< as finite_element_tooth.py computed it once
Numbers oscillator();            ///< with backlash, by matching pieces, against coupled/
Numbers oil();                   ///< its viscosity
Numbers regression();            ///< NIST's nonlinear regressions
Numbers sobol();                 ///< functions whose variance is known part by part
Numbers propagation();           ///< of distributions: JCGM 101, JCGM 102, NPL
Numbers posterior();             ///< the sampler of identification
Numbers judgements();            ///< of what compares and screens
Numbers modelica();              ///< examples of the Modelica library
Numbers bearings();              ///< ISO 281, ISO/TS 16281
Numbers stiff();                 ///< Test Set for IVP Solvers

}  // namespace bentaxis::external
