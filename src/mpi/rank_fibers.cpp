#include "src/mpi/rank_fibers.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "src/mpi/partition.hpp"

namespace fiber {
namespace {

// What moves to a rank as a whole. Shorter pieces fit space better, and take more memory each.
constexpr std::uint32_t segments_per_piece = 16;

bool are_same(const std::vector<FiberPart>& x, const std::vector<FiberPart>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const FiberPart& a, const FiberPart& b) {
                      return a.fiber == b.fiber && a.first_segment == b.first_segment;
                    });
}

/// Cuts the parts of a rank into pieces.
FiberRuns pieces_of(const FiberAssembly& parts, const std::vector<FiberPart>& names,
                    const std::vector<double>& arcs) {
  FiberRuns pieces;
  const std::size_t most = parts.segment_count() / segments_per_piece + names.size();
  pieces.runs.reserve(most);
  pieces.nodes.reserve(parts.segment_count() + most);
  std::vector<FiberNode> nodes;
  for (std::size_t part = 0; part < names.size(); ++part) {
    const std::uint32_t begin = parts.offsets()[part];
    const std::uint32_t last = parts.offsets()[part + 1] - 1;
    for (std::uint32_t first = begin; first < last; first += segments_per_piece) {
      const std::uint32_t count = std::min(segments_per_piece, last - first);
      nodes.clear();
      for (std::uint32_t p = first; p <= first + count; ++p) {
        nodes.push_back(
            {plain(parts.points()[p]), arcs[p], p < first + count ? parts.segment_radius(p) : 0.0});
      }
      pieces.add({names[part].fiber, names[part].first_segment + (first - begin)}, nodes.data(),
                 count);
    }
  }
  return pieces;
}

std::vector<PartitionObject> objects_of(const FiberRuns& pieces) {
  std::vector<PartitionObject> objects;
  objects.reserve(pieces.runs.size());
  for (const FiberRun& run : pieces.runs) {
    objects.push_back(
        {pieces.nodes[run.begin + run.count / 2].point, static_cast<float>(run.count)});
  }
  return objects;
}

/// Most that sums along a fibre are rounded by, in units of ε [m].
double roundings_of(const FiberAssembly& parts, const std::vector<FiberPart>& names,
                    const std::vector<double>& arcs) {
  double most = 0.0;
  for (std::size_t part = 0; part < names.size(); ++part) {
    const std::uint32_t last = parts.offsets()[part + 1] - 1;
    const double count =
        static_cast<double>(names[part].first_segment + (last - parts.offsets()[part]));
    most = std::max(most, count * arcs[last]);
  }
  return most;
}

}  // namespace

bool RankFibers::is_as_before(const FiberAssembly& parts,
                              const std::vector<FiberPart>& names) const {
  return has_fibers_ && offsets_ == parts.offsets() && are_same(names_, names);
}

/// Sends the pieces of all ranks to whom they belong; of the same pieces, only the nodes.
void RankFibers::migrate(const Communicator& ranks, FiberRuns pieces, bool is_same) {
  if (!is_same) {
    destinations_ = partition(ranks, objects_of(pieces), ranks.size());
  }
  std::vector<FiberRuns> to(static_cast<std::size_t>(ranks.size()));
  for (std::size_t i = 0; i < pieces.runs.size(); ++i) {
    const FiberRun& run = pieces.runs[i];
    to[static_cast<std::size_t>(destinations_[i])].add(run.first, pieces.nodes.data() + run.begin,
                                                       run.count);
  }
  pieces = {};
  if (!is_same) {
    own_ = exchange_runs(ranks, std::move(to));
    return;
  }
  PerRank<FiberNode> nodes;
  for (FiberRuns& some : to) {
    nodes.push_back(std::move(some.nodes));
  }
  own_.nodes = joined_nodes(ranks.exchange(nodes));
}

void RankFibers::update(const Communicator& ranks, const FiberAssembly& parts,
                        const std::vector<FiberPart>& names) {
  const bool is_same = ranks.all(is_as_before(parts, names));
  has_fibers_ = false;
  ranks.agree(names.size() == parts.fiber_count()
                  ? ""
                  : std::to_string(names.size()) + " names for " +
                        std::to_string(parts.fiber_count()) + " parts, there must be one per part");
  if (!is_same) {
    chains_.emplace(ranks, parts, names);
    names_ = names;
    offsets_ = parts.offsets();
  }
  const std::vector<double> arcs = chains_->arc_lengths(ranks, parts, names);
  arc_roundings_ = ranks.largest(roundings_of(parts, names, arcs));
  migrate(ranks, pieces_of(parts, names, arcs), is_same);
  has_fibers_ = true;
}

}  // namespace fiber
