#include <algorithm>
#include <utility>

#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/study/reporting.h"
#include "optimise_pieces.h"

namespace bentaxis::designs {
namespace {

constexpr std::size_t kPieces = 8;  // that a batch is cut in, at least

}  // namespace

SweepBlock DesignBatches::make(std::vector<double> values, std::size_t designs, std::size_t numbers,
                               const std::function<void()>& tick) {
  SweepBlock block;
  block.first = next_ * designs;
  block.designs = designs;
  block.values = std::move(values);
  const std::size_t number = next_++;
  if (auto found = found_in(number, block.values); all_have(found.has_value())) {
    ++kept_;
    return std::move(*found);
  }
  fill(block, numbers, tick);
  keep(number, block);
  return block;
}

SweepBlock DesignBatches::make_singles(std::vector<double> values, std::size_t designs,
                                       std::size_t numbers, bool keeps,
                                       const std::function<void()>& tick) {
  SweepBlock block;
  block.designs = designs;
  block.values = std::move(values);
  if (!keeps || work_.parts == nullptr) {
    fill(block, numbers, tick);
    return block;
  }
  const BlockLayout& layout = work_.parts->record().layout;
  const std::size_t width = block.values.size() / designs;
  block.results.resize(designs * numbers);
  block.reasons.resize(designs);
  const auto take = [&](std::size_t i, const SweepBlock& from, std::size_t place) {
    std::copy_n(from.results.begin() + static_cast<std::ptrdiff_t>(place * numbers), numbers,
                block.results.begin() + static_cast<std::ptrdiff_t>(i * numbers));
    block.reasons[i] = from.reasons[place];
  };
  SweepBlock missing;
  std::vector<std::size_t> places;
  const std::size_t first = next_single_;
  next_single_ += designs;
  for (std::size_t i = 0; i < designs; ++i) {
    const auto from = block.values.begin() + static_cast<std::ptrdiff_t>(i * width);
    const std::vector<double> here(from, from + static_cast<std::ptrdiff_t>(width));
    const auto found = found_in(layout.blocks() + first + i, here);
    if (all_have(found.has_value())) {
      ++kept_singles_;
      take(i, *found, 0);
    } else {
      places.push_back(i);
      missing.values.insert(missing.values.end(), here.begin(), here.end());
    }
  }
  missing.designs = places.size();
  if (places.empty()) return block;
  fill(missing, numbers, tick);
  for (std::size_t k = 0; k < places.size(); ++k) {
    take(places[k], missing, k);
    SweepBlock single;
    single.first = layout.designs + first + places[k];
    single.designs = 1;
    const auto from = missing.values.begin() + static_cast<std::ptrdiff_t>(k * width);
    single.values.assign(from, from + static_cast<std::ptrdiff_t>(width));
    const auto result = missing.results.begin() + static_cast<std::ptrdiff_t>(k * numbers);
    single.results.assign(result, result + static_cast<std::ptrdiff_t>(numbers));
    single.reasons = {missing.reasons[k]};
    keep(layout.blocks() + first + places[k], single);
  }
  return block;
}

std::optional<SweepBlock> DesignBatches::found_in(std::size_t number,
                                                  const std::vector<double>& values) const {
  if (work_.parts == nullptr || !work_.resume) return std::nullopt;
  auto found = work_.parts->read(number);
  if (found && found->values != values) found.reset();
  return found;
}

void DesignBatches::keep(std::size_t number, const SweepBlock& block) const {
  if (work_.parts != nullptr && work_.rank == 0) work_.parts->keep(number, block);
}

bool DesignBatches::all_have(bool one) const {
  double count = one ? 1 : 0;
  if (work_.ranks > 1 && work_.sum) work_.sum({&count, 1});
  return count == static_cast<double>(work_.ranks);
}

void DesignBatches::fill(SweepBlock& block, std::size_t numbers,
                         const std::function<void()>& tick) {
  const std::size_t width = block.values.size() / block.designs;
  block.results.assign(block.designs * numbers, 0);
  block.reasons.assign(block.designs, "");
  const std::size_t size = std::clamp<std::size_t>(block.designs / kPieces, 1, piece_);
  const std::size_t pieces = (block.designs + size - 1) / size;
  // One by one where it is all there is: threads cost more than a design.
  study::Reporting reporting(1, [&](double) { tick(); });
  const auto piece = [&](std::size_t p) {
    if (p % work_.ranks != work_.rank) return;
    reporting.tick();
    const std::size_t first = p * size, count = std::min(size, block.designs - first);
    compute_(std::span<const double>(block.values).subspan(first * width, count * width),
             std::span(block.results).subspan(first * numbers, count * numbers),
             std::span(block.reasons).subspan(first, count));
  };
  if (pieces == 1)
    piece(0);
  else
    numerics::parallel_for(work_.threads, pieces, piece);
  if (work_.ranks > 1 && work_.sum) work_.sum(block.results);
}

}  // namespace bentaxis::designs
