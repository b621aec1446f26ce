#include "fiber_proximity/mpi/distributed_engine.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "src/mpi/closest_contacts.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/distributed_options.hpp"
#include "src/mpi/rank_fibers.hpp"
#include "src/mpi/rank_search.hpp"

namespace fiber {

struct DistributedEngine::State {
  State(MPI_Comm comm, const EngineOptions& options) : ranks(comm), search(options) {}

  Communicator ranks;
  RankFibers fibers;
  RankSearch search;
  double near = 0.0;  // [m] how near the last closest pairs were that were asked for

  void reach(double margin) { search.reach(ranks, fibers.own(), margin); }
  void find(const QueryOptions& options, std::uint64_t count, DistributedResult& result) {
    search.find(ranks, fibers.own(), fibers.arc_roundings(), options, count, result);
    result.complete = ranks.all(result.complete);
  }
  void find_all(const QueryOptions& options, std::uint64_t most, DistributedResult& result);
  void find_closest(const QueryOptions& options, std::uint64_t most, DistributedResult& result);
};

/// @param most contacts to be reported
void DistributedEngine::State::find_all(const QueryOptions& options, std::uint64_t most,
                                        DistributedResult& result) {
  reach(options.margin);
  if (options.type == QueryType::FIBER_PAIRS) {
    find(options, RankSearch::no_limit, result);
    keep_closest_of_fibers(ranks, result);
  } else {
    // One more, to see whether there are more.
    find(options, most == RankSearch::no_limit ? most : most + 1, result);
  }
  result.limit_reached =
      (most != RankSearch::no_limit && keep_closest(ranks, most, result)) || result.limit_reached;
}

/// Pairs of what is here make a bound: what is needed of other ranks is no further than that.
void DistributedEngine::State::find_closest(const QueryOptions& options, std::uint64_t most,
                                            DistributedResult& result) {
  const Deadline deadline(options.deadline);
  reach(std::min(options.margin, near));
  find(options, most, result);
  const double enough = margin_of_closest(ranks, most, result.contacts);
  const bool is_over = options.type == QueryType::FIRST && std::isfinite(enough);
  QueryOptions rest = options;
  rest.margin = std::min(options.margin, enough);
  if (rest.margin > search.reach() && !is_over && result.complete) {
    reach(rest.margin);
    rest.deadline = deadline.left();
    find(rest, most, result);
  }
  near = std::isfinite(enough) ? std::max(0.0, enough) : 0.0;
  keep_closest(ranks, most, result);
  result.limit_reached = result.limit_reached || (options.type == QueryType::LIMITED &&
                                                  ranks.sum(result.contacts.size()) == most);
}

DistributedEngine::DistributedEngine(MPI_Comm ranks, const EngineOptions& options)
    : state_(std::make_unique<State>(ranks, options)) {}

DistributedEngine::~DistributedEngine() = default;

void DistributedEngine::update(const FiberAssembly& parts, const std::vector<FiberPart>& names) {
  state_->search.clear();
  state_->fibers.update(state_->ranks, parts, names);
}

void DistributedEngine::query(const QueryOptions& options, DistributedResult& result) {
  State& state = *state_;
  if (state.fibers.empty()) {
    throw std::logic_error("the engine has no fibres yet: call update() first");
  }
  require_distributed_options(state.ranks, options);
  QueryOptions here = options;
  if (options.pair_limit > 0) {
    here.pair_limit = std::max<std::uint64_t>(1, options.pair_limit / state.ranks.size());
  }
  const bool is_limited = options.contact_limit > 0;
  const std::uint64_t most = is_limited ? options.contact_limit : RankSearch::no_limit;
  result.contacts.clear();
  switch (options.type) {
    case QueryType::FIRST:
    case QueryType::CLOSEST:
      state.find_closest(here, 1, result);
      break;
    case QueryType::LIMITED:
      state.find_closest(here, std::min<std::uint64_t>(options.max_contacts, most), result);
      break;
    case QueryType::ALL:
    case QueryType::FIBER_PAIRS:
      state.find_all(here, most, result);
      break;
  }
  std::sort(
      result.contacts.begin(), result.contacts.end(),
      [](const DistributedContact& x, const DistributedContact& y) { return x.key() < y.key(); });
  result.limit_reached = !state.ranks.all(!result.limit_reached);
  result.others_lower = state.ranks.smallest(result.others_lower);
}

DistributedFacts DistributedEngine::facts() const {
  return {state_->fibers.own().segment_count(), state_->search.halo_segments()};
}

}  // namespace fiber
