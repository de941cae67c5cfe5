// One instant of a pump of zero size but its pistons' pressure: the module links alone.
#include <cstdio>

#include "bentaxis/analytic/model.h"

int main() {
  const bentaxis::ChannelLayout layout(7);
  bentaxis::Instant now;
  now.turn(0.5, 157.0);
  std::printf("%zu columns, %s\n", layout.size(), now.locked() ? "locked" : "free");
  try {
    const bentaxis::analytic::Model model(bentaxis::PumpParameters{}, bentaxis::Assumptions{});
  } catch (const std::exception& refused) {
    std::puts(refused.what());
    return 0;
  }
  return 1;  // a pump of nothing must be refused
}
