#include "bentaxis/report/picture.h"

#include "picture/figures.h"

namespace bentaxis::report {

std::string svg_of(const Figure& figure, const Curves& curves) {
  const auto content = [&](const auto& shown) { return picture::picture_of(shown, curves); };
  return picture::drawn(figure, std::visit(content, figure.content));
}

}  // namespace bentaxis::report
