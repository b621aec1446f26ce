#include "fiber_proximity/mpi/distributed_engine.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "src/mpi/communicator.hpp"
#include "src/mpi/contact_search.hpp"
#include "src/mpi/distributed_options.hpp"
#include "src/mpi/halo_exchange.hpp"
#include "src/mpi/motion_search.hpp"
#include "src/mpi/owned_fibers.hpp"
#include "src/mpi/select_contacts.hpp"

namespace fiber {

struct DistributedEngine::State {
  State(MPI_Comm comm, const EngineOptions& options)
      : ranks(comm), engine_options(options), search(ranks, options) {}

  Communicator ranks;
  EngineOptions engine_options;
  OwnedFibers fibers;
  SendLists lists;
  ContactSearch search;
  std::optional<MotionSearch> motions;  // none until there is a motion

  bool has_motion = false;

  void require_fibers() const {
    if (fibers.empty() || fibers.do_move()) {
      throw std::logic_error("the engine has no fibres yet: call update() first");
    }
  }

  /// The part of a limit of pairs that each rank gets.
  std::uint64_t share_of(std::uint64_t limit) const {
    return limit == 0 ? 0 : std::max<std::uint64_t>(1, limit / ranks.size());
  }
  void find_all(const QueryOptions& options, std::uint64_t max_contacts, DistributedResult& result);
  void find_closest_of_fibers(const QueryOptions& options, std::uint64_t max_contacts,
                              DistributedResult& result);
  void find_closest(const QueryOptions& options, std::uint64_t max_contacts,
                    DistributedResult& result);
};

/// @param max_contacts to be reported, over all ranks
void DistributedEngine::State::find_all(const QueryOptions& options, std::uint64_t max_contacts,
                                        DistributedResult& result) {
  const bool is_limited = max_contacts != ContactSearch::no_limit;
  const Deadline deadline(options.deadline);
  HaloExchange halo(ranks, fibers.states(), lists.find(ranks, fibers, options.margin));
  // One more than the limit shows whether there are more.
  search.find_inner(options, is_limited ? max_contacts + 1 : ContactSearch::no_limit, result);
  QueryOptions rest = options;
  rest.deadline = deadline.left();
  search.find_across(halo.take(), rest, result);
  search.write(result.contacts);
  const bool are_more = is_limited && keep_closest(ranks, max_contacts, result);
  result.limit_reached = are_more || result.limit_reached;
}

void DistributedEngine::State::find_closest_of_fibers(const QueryOptions& options,
                                                      std::uint64_t max_contacts,
                                                      DistributedResult& result) {
  // The lists of a margin serve several queries, and its halo comes while this rank looks at what
  // it has. Without a margin all others would come: then what it finds says first how near they
  // matter.
  std::optional<HaloExchange> halo;
  const auto send = [&](double margin) {
    halo.emplace(ranks, fibers.states(), lists.find(ranks, fibers, margin));
  };
  if (std::isfinite(options.margin)) {
    send(options.margin);
  }
  search.find_closest_of_fibers(
      [&](double margin) {
        if (!halo) {
          send(margin);
        }
        return halo->take();
      },
      options, result);
  search.write(result.contacts);
  const bool are_more = keep_closest(ranks, max_contacts, result);
  result.limit_reached = are_more || result.limit_reached;
}

/// Pairs of what each rank has make a bound: nothing of others matters that is further than that.
void DistributedEngine::State::find_closest(const QueryOptions& options, std::uint64_t max_contacts,
                                            DistributedResult& result) {
  const Deadline deadline(options.deadline);
  search.find_inner(options, max_contacts, result);
  search.write(result.contacts);
  const double enough = margin_of_closest(ranks, max_contacts, result.contacts);
  const bool is_over = options.type == QueryType::FIRST && std::isfinite(enough);
  if (ranks.all(result.complete) && !is_over) {
    QueryOptions rest = options;
    rest.margin = std::max(0.0, std::min(options.margin, enough));
    rest.deadline = deadline.left();
    search.find_across(
        HaloExchange(ranks, fibers.states(), lists.find(ranks, fibers, rest.margin)).take(), rest,
        result);
    search.write(result.contacts);
  }
  keep_closest(ranks, max_contacts, result);
  const bool are_enough = ranks.sum(result.contacts.size()) == max_contacts;
  result.limit_reached = (options.type == QueryType::LIMITED && are_enough) || result.limit_reached;
}

DistributedEngine::DistributedEngine(MPI_Comm ranks, const EngineOptions& options)
    : state_(std::make_unique<State>(ranks, options)) {}

DistributedEngine::~DistributedEngine() = default;

void DistributedEngine::update(const FiberAssembly& parts, const std::vector<FiberPart>& names,
                               const FiberTopology& topology) {
  state_->has_motion = false;
  state_->fibers.update(state_->ranks, parts, names, topology, state_->search.load());
  state_->search.update(state_->fibers);
}

void DistributedEngine::update_motion(const FiberAssembly& before, const FiberAssembly& after,
                                      const std::vector<FiberPart>& names,
                                      const FiberTopology& topology) {
  State& state = *state_;
  state.search.clear();
  state.fibers.update_motion(state.ranks, before, after, names, topology);
  if (!state.motions) {
    state.motions.emplace(state.ranks, state.engine_options);
  }
  state.has_motion = false;
  state.motions->update(state.fibers);
  state.has_motion = true;
}

void DistributedEngine::query_motion(const MotionOptions& options,
                                     DistributedMotionResult& result) {
  State& state = *state_;
  if (state.fibers.empty() || !state.has_motion) {
    throw std::logic_error("the engine has no motion: call update_motion() first");
  }
  require_distributed_options(state.ranks, options);
  MotionOptions here = options;
  here.pair_limit = state.share_of(options.pair_limit);
  result.contacts.clear();
  result.touching.clear();
  state.motions->find(here, state.lists.find(state.ranks, state.fibers, reach_of(options)), result);
  keep_earliest(state.ranks, options, result);
}

DistributedFibers DistributedEngine::adopt() {
  state_->require_fibers();
  DistributedFibers parts = state_->fibers.adopt(state_->ranks);
  state_->search.follow(state_->fibers);
  return parts;
}

void DistributedEngine::query(const QueryOptions& options, DistributedResult& result) {
  State& state = *state_;
  state.require_fibers();
  require_distributed_options(state.ranks, options);
  QueryOptions here = options;
  here.pair_limit = state.share_of(options.pair_limit);
  const bool is_limited = options.contact_limit > 0;
  const std::uint64_t max_contacts = is_limited ? options.contact_limit : ContactSearch::no_limit;
  result.contacts.clear();
  switch (options.type) {
    case QueryType::FIRST:
    case QueryType::CLOSEST:
      state.find_closest(here, 1, result);
      break;
    case QueryType::LIMITED:
      state.find_closest(here, std::min<std::uint64_t>(options.max_contacts, max_contacts), result);
      break;
    case QueryType::ALL:
      state.find_all(here, max_contacts, result);
      break;
    case QueryType::FIBER_PAIRS:
      state.find_closest_of_fibers(here, max_contacts, result);
      break;
  }
  if (options.type != QueryType::ALL || is_limited) {  // all are sorted as they are written
    std::sort(result.contacts.begin(), result.contacts.end(), by_key);
  }
  result.limit_reached = !state.ranks.all(!result.limit_reached);
  result.complete = state.ranks.all(result.complete);
  result.others_lower = state.ranks.min(result.others_lower);
}

DistributedFacts DistributedEngine::facts() const {
  return {state_->fibers.own().fibers().segment_count(),
          state_->search.halo_segments(),
          state_->fibers.split_count(),
          state_->fibers.sent_points(),
          state_->lists.search_count(),
          state_->search.counts(),
          state_->fibers.joined().fibers().segment_count()};
}

}  // namespace fiber
