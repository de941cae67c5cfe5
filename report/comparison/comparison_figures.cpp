#include "comparison_figures.h"

#include "bentaxis/results/budget.h"
#include "document_parts.h"

namespace bentaxis::study {

std::vector<report::Figure> channel_figures(const std::vector<const ResultTable*>& tables,
                                            const std::vector<ResultTable>& without_viscous) {
  std::vector<report::Figure> figures;
  const auto add = [&](const std::string& id, const std::string& title, const std::string& paper,
                       const std::string& unit, std::vector<std::string> channels,
                       std::vector<report::Series> extra = {}) {
    figures.push_back(
        {id, title, paper, report::ChannelFigure{unit, std::move(channels), std::move(extra)}});
  };
  add("pressure",
      tables.size() > 1 ? "Chamber pressure of piston 1 (given to both models)"
                        : "Chamber pressure of piston 1",
      "Fig. 10, 25", "bar", {"p_1_bar"});
  add("rs", "Joint force Rs on piston 1, by the shaft, at A, in S2", "Fig. 12", "N",
      {"Rs_1_x2_N", "Rs_1_y2_N", "Rs_1_z2_N"});
  add("rs_xy", "Joint force Rs on piston 1: components across the block axis", "Fig. 26", "N",
      {"Rs_1_x2_N", "Rs_1_y2_N"});
  add("rs3", "Joint force Rs on piston 1 in S3: along the piston (z3) and across it", "4.1.2", "N",
      {"Rs_1_x3_N", "Rs_1_y3_N", "Rs_1_z3_N"});
  add("rc", "Bore force Rc on piston 1, by the block, at B, in S2", "Fig. 14, 27", "N",
      {"Rc_1_x2_N", "Rc_1_y2_N"});
  add("bearings", "Bearing forces Rb1 (tapered, C1) and Rb2 (cylindrical, C2) on the shaft, in S1",
      "Fig. 15", "N", {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N", "Rb2_x1_N", "Rb2_y1_N"});
  add("rb1", "Tapered bearing force Rb1 on the shaft at C1, in S1", "Fig. 28", "N",
      {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N"});
  add("rb2", "Cylindrical bearing force Rb2 on the shaft at C2, in S1", "Fig. 29", "N",
      {"Rb2_x1_N", "Rb2_y1_N"});
  add("td", "Drive torque Td", "Fig. 17, 30", "Nm", {"Td_z1_Nm"});
  std::vector<std::string> means;
  for (const ResultTable* table : tables) {
    double mean = 0;
    for (std::size_t row = 0; row < table->rows(); ++row)
      mean += table->at(row, table->find("Td_z1_Nm")) / static_cast<double>(table->rows());
    if (is_computed(mean)) means.push_back(fmt::format("{} {:.5g} Nm", table->name, mean));
  }
  figures.back().note = "Mean torque: " + joined(means) + ".";

  const auto has = [](const ResultTable& table, const char* name) {
    const report::Values values = report::values_of(table, name);
    return std::any_of(values.begin(), values.end(), is_computed);
  };
  const auto extras = [&](const char* channel) {
    std::vector<report::Series> list;
    for (const ResultTable& table : without_viscous)
      if (has(table, channel))
        list.push_back({table.name + ", Cc = 0", report::values_of(table, channel)});
    return list;
  };
  if (std::any_of(tables.begin(), tables.end(),
                  [&](const ResultTable* table) { return has(*table, "Rcs_z4_N"); }))
    add("rcs", "Gear tooth force Rcs on the block, by the shaft, at O4, along z4", "Fig. 32 top",
        "N", {"Rcs_z4_N"}, extras("Rcs_z4_N"));
  add("tcs", "Torque that drives the block, about z2", "Fig. 32 bottom", "Nm", {"Tcs_z2_Nm"},
      extras("Tcs_z2_Nm"));
  std::vector<std::string> shares;
  for (const Channel& channel : tables.front()->channels)
    if (channel.quantity == "Tc") shares.push_back(channel.name);
  figures.push_back({"shares", "Each piston's share of the pistons' torque on the block, about z2",
                     "Fig. 31, 33", report::PistonBars{"Nm", shares, {0, 38}}});
  add("film", "Film force Fh of the port plate on the block, at (xh, yh)", "(51)", "N",
      {"Fh_z2_N"});
  add("film_point", "Point where Fh acts, from z2", "(53)", "mm", {"xh_x2_mm", "yh_y2_mm"});
  add("pin", "Pin force Rcn on the block", "(54)", "N", {"Rcn_x2_N", "Rcn_y2_N"});
  return figures;
}

namespace {

// What the drive torque is needed for over the turn: the causes that there are.
report::Figure budget_figure(const BudgetComparison& budgets) {
  report::ChannelFigure content{"Nm", {"Td_z1_Nm"}};
  for (std::size_t c = 0; c < kCauses; ++c) {
    const std::string column = drive_column(static_cast<Cause>(c));
    if (budgets.analytic.peak(column) > 0 || budgets.multibody.peak(column) > 0)
      content.channels.push_back(column);
  }
  return {"torque_budget", "Drive torque by cause", "", std::move(content),
          "The parts add up to Td at every angle; budget_analytic.csv and budget_multibody.csv "
          "contain them."};
}

// Whether a figure of channels shows one of these.
bool shows(const report::Figure& figure, const std::vector<Channel>& channels) {
  const auto* curves = std::get_if<report::ChannelFigure>(&figure.content);
  const auto* bars = std::get_if<report::PistonBars>(&figure.content);
  const auto& names = curves != nullptr ? curves->channels : bars->channels;
  return std::any_of(channels.begin(), channels.end(),
                     [&](const Channel& channel) { return contains(names, channel.name); });
}

}  // namespace

std::vector<report::Figure> comparison_figures(const ComparisonResult& r) {
  const ChannelLayout layout(r.first.the_case.pump);
  const auto wanted = r.options.channels.of(layout);
  auto figures = channel_figures({&r.analytic, &r.multibody}, r.without_viscous);
  std::erase_if(figures, [&](const auto& figure) { return !shows(figure, wanted); });
  if (r.budget) figures.push_back(budget_figure(*r.budget));
  return figures;
}

}  // namespace bentaxis::study
