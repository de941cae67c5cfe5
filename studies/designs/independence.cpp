#include "bentaxis/designs/independence.h"

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::designs {

std::string why_not_independent(const Output& output, const Case& base) {
  switch (output.source) {
    case Source::curve:
      return ChannelLayout(base.pump).channels()[output.columns.front()].kind == ChannelKind::input
                 ? "an input, given to both models"
                 : "";
    case Source::validity:
      if (output.share) return "counts samples";
      // By the analytic model, whichever results are looked at.
      return output.item == "friction" || output.item == "ring" || output.item == "reach"
                 ? "computed by one function for both models"
                 : "";
    case Source::efficiency:
      if (!output.item.starts_with("volumetric")) return "";
      [[fallthrough]];
    case Source::hydraulics:
    case Source::timing:
      return "of the oil, which is computed once for both models";
    case Source::derived:
    case Source::plausibility:
      return "follows from the case alone";
    case Source::motion:
      return "integrated to an error of its own: simulate compares both models";
    case Source::budget:
    case Source::life:
      break;
  }
  return "";
}

std::vector<std::string> not_independent(const std::vector<Output>& outputs, const Case& base) {
  std::vector<std::string> list;
  for (const Output& output : outputs)
    if (const std::string why = why_not_independent(output, base); !why.empty())
      list.push_back(output.name + " (" + why + ")");
  return list;
}

void require_independent(const std::vector<Output>& outputs, const Case& base,
                         const std::string& option) {
  const std::vector<std::string> shared = not_independent(outputs, base);
  if (!outputs.empty() && shared.size() == outputs.size())
    throw InputError(option + ": none of the outputs is computed independently by both models: " +
                     joined(shared));
}

}  // namespace bentaxis::designs
