#include "src/tools/range_texts.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace fiber {
namespace {

/// What goes before a text on its way to another rank.
struct TextHead {
  std::uint64_t begin = 0;
  std::uint64_t size = 0;  // [byte]
};

}  // namespace

std::vector<RangeText> sort_over_ranks(const Communicator& ranks, const WorkRange& all,
                                       std::vector<RangeText> texts) {
  const auto rank_count = static_cast<std::size_t>(ranks.size());
  PerRank<TextHead> heads(rank_count);
  PerRank<char> characters(rank_count);
  for (RangeText& range : texts) {
    const std::size_t to = (range.begin - all.begin) * rank_count / (all.end - all.begin);
    heads[to].push_back({range.begin, range.text.size()});
    characters[to].insert(characters[to].end(), range.text.begin(), range.text.end());
    range.text = {};
  }
  heads = ranks.exchange(std::move(heads));
  characters = ranks.exchange(std::move(characters));
  texts.clear();
  for (std::size_t from = 0; from < rank_count; ++from) {
    auto next = characters[from].begin();
    for (const TextHead& head : heads[from]) {
      const auto end = next + static_cast<std::ptrdiff_t>(head.size);
      texts.push_back({head.begin, {next, end}});
      next = end;
    }
  }
  std::sort(texts.begin(), texts.end(),
            [](const RangeText& x, const RangeText& y) { return x.begin < y.begin; });
  return texts;
}

}  // namespace fiber
