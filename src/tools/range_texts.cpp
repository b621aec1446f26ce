#include "src/tools/range_texts.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "src/tools/packed.hpp"

namespace fiber {

std::vector<RangeText> sort_over_ranks(const Communicator& ranks, const WorkRange& all,
                                       std::vector<RangeText> texts) {
  const auto rank_count = static_cast<std::size_t>(ranks.size());
  PerRank<char> packed(rank_count);
  for (RangeText& range : texts) {
    const std::size_t to = (range.begin - all.begin) * rank_count / (all.end - all.begin);
    pack(packed[to], std::vector{range.begin});
    pack(packed[to], range.text);
    range.text = {};
  }
  packed = ranks.exchange(std::move(packed));
  texts.clear();
  for (const std::vector<char>& from : packed) {
    for (const char* next = from.data(); next != from.data() + from.size();) {
      const auto begin = unpack<std::vector<std::uint64_t>>(next);
      texts.push_back({begin.front(), unpack<std::string>(next)});
    }
  }
  std::sort(texts.begin(), texts.end(),
            [](const RangeText& x, const RangeText& y) { return x.begin < y.begin; });
  return texts;
}

}  // namespace fiber
