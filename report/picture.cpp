#include "bentaxis/report/picture.h"

#include "picture/figures.h"

namespace bentaxis::report {

std::string file_name_of(const Figure& figure) {
  const std::string mark = "Fig. ";
  if (!figure.paper.starts_with(mark) || figure.id.starts_with("fig")) return figure.id;
  std::string name = "fig";
  for (const char c : figure.paper.substr(mark.size())) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (plain)
      name += c;
    else if (name.back() != '_')
      name += '_';
  }
  return name + "_" + figure.id;
}

std::string svg_of(const Figure& figure, const Curves& curves) {
  const auto content = [&](const auto& shown) { return picture::picture_of(shown, curves); };
  return picture::drawn(figure, std::visit(content, figure.content));
}

}  // namespace bentaxis::report
