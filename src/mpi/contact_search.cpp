#include "src/mpi/contact_search.hpp"

#include <algorithm>

#include "fiber_proximity/query/for_engines/narrow_phase.hpp"
#include "src/mpi/fiber_pair_search.hpp"
#include "src/mpi/whole_fiber_pairs.hpp"

namespace fiber {

void ContactSearch::clear() {
  fibers_ = nullptr;
  counts_ = {};
  halo_.assign(FiberRuns());
  inner_.contacts.clear();
  across_.clear();
}

void ContactSearch::update(const OwnedFibers& fibers) {
  clear();
  fibers_ = &fibers;
  engine_->update(fibers.own().fibers());
}

/// Options for the engine that leave out no pair that the query wants. Pairs that are too many are
/// left out later.
QueryOptions ContactSearch::options_here(const QueryOptions& options) const {
  QueryOptions here = options;
  static_cast<PairOptions&>(here) = options_of_stretches(options, fibers_->arc_roundings());
  here.tolerance = 0.0;
  here.relative_tolerance = 0.0;
  return here;
}

void ContactSearch::find_inner(const QueryOptions& options, std::uint64_t count,
                               DistributedResult& result) {
  const Deadline deadline(options.deadline);
  const JoinedPairs joined(fibers_->joined(), options);
  const RankPairs pairs{ranks_, fibers_->own(), halo_, joined};
  QueryOptions here = options_here(options);
  across_.clear();
  constexpr std::uint64_t max_count = std::numeric_limits<std::uint32_t>::max();
  constexpr std::uint64_t more = 16;
  bool is_first = options.type == QueryType::FIRST;
  // Pairs that are none along whole fibres may be among those that the engine finds: it is asked
  // for more until enough are left.
  for (std::uint64_t asked = count; true;
       asked = asked > max_count / more ? no_limit : more * asked) {
    here.type = is_first            ? QueryType::FIRST
                : asked > max_count ? QueryType::ALL
                                    : QueryType::LIMITED;
    here.max_contacts = static_cast<std::uint32_t>(std::min(asked, max_count));
    here.deadline = deadline.left();
    engine_->query(here, inner_);
    counts_ += inner_.counts;
    if (here.type != QueryType::ALL) {
      sort_by_key(inner_.contacts);
    }
    const bool had_all = here.type == QueryType::ALL || !inner_.complete ||
                         inner_.contacts.size() < here.max_contacts;
    pairs.keep_those_of_whole_fibers(options, fibers_->own(), inner_.contacts);
    if (ranks_.all(had_all || inner_.contacts.size() >= count)) {
      break;
    }
    is_first = false;
  }
  result.complete = inner_.complete;
  result.limit_reached = !inner_.complete && inner_.limit_reached;
  result.others_lower = inner_.others_lower;
}

/// [m] More than distances of one pair differ by, the one segment first or the other.
double ContactSearch::rounding_across() const {
  if (halo_.fibers().point_count() == 0) {
    return 0.0;
  }
  Box3d box = fibers_->around();
  for (const Eigen::Vector3d& point : halo_.fibers().points()) {
    box.extend(point);
  }
  return 0x1p-44 * (box.sizes().maxCoeff() + halo_.fibers().largest_radius());
}

void ContactSearch::find_across(const FiberRuns& halo, const QueryOptions& options,
                                DistributedResult& result) {
  ranks_.throw_on_all(error_in([&] { halo_.assign(halo); }));

  // The engine takes what is a shape to it for the first of each pair. Here it is the second one:
  // distances are computed anew, as one process computes them.
  QueryOptions here = options_here(options);
  here.type = QueryType::ALL;
  here.kernel = Kernel::ROBUST;
  here.margin = options.margin * (1.0 + 0x1p-50) + rounding_across();
  here.pair_limit = rest_of(options.pair_limit, inner_.counts.primitive_tests);
  engine_->query_shape(halo_.fibers(), here, candidates_);
  counts_ += candidates_.counts;
  result.complete = result.complete && candidates_.complete;
  result.limit_reached =
      result.limit_reached || (!candidates_.complete && candidates_.limit_reached);
  result.others_lower = std::min(result.others_lower, candidates_.others_lower);
  const LocalFibers& own = fibers_->own();
  const NarrowPhase test(own.fibers(), halo_.fibers(), options);
  across_.clear();
  for (const Contact& contact : candidates_.contacts) {
    if (!(own.global_id(contact.fiber_b, contact.segment_b) <
          halo_.global_id(contact.fiber_a, contact.segment_a))) {
      continue;  // another rank's
    }
    const PointPair pair{own.point_of(contact.fiber_b, contact.segment_b),
                         halo_.point_of(contact.fiber_a, contact.segment_a)};
    const PairDistance distance = test.distance(pair);
    if (test.is_within_margin(pair, distance)) {
      across_.push_back(test.contact(pair, distance));
    } else {
      result.others_lower = std::min(result.others_lower, test.gap_lower(pair, distance));
    }
  }
  sort_by_key(across_);
  const JoinedPairs joined(fibers_->joined(), options);
  RankPairs{ranks_, own, halo_, joined}.keep_those_of_whole_fibers(options, halo_, across_);
}

void ContactSearch::find_closest_of_fibers(const std::function<FiberRuns(double)>& halo_within,
                                           const QueryOptions& options, DistributedResult& result) {
  halo_.assign(FiberRuns());
  const QueryOptions here = options_here(options);
  const JoinedPairs joined(fibers_->joined(), options);
  FiberPairSearch search({ranks_, fibers_->own(), halo_, joined}, *engine_, options, here);
  const double reach = search.find_inner();
  const FiberRuns halo = halo_within(reach);
  ranks_.throw_on_all(error_in([&] { halo_.assign(halo); }));
  search.find_across();
  search.write(inner_.contacts, across_);
  counts_ += search.counts();
  result.complete = search.is_complete();
  result.limit_reached = search.limit_reached();
  result.others_lower = std::min(search.others_lower(), reach);
}

void ContactSearch::write(std::vector<DistributedContact>& contacts) const {
  // Contacts are most of what is moved in memory where there are many: each is written once.
  contacts.clear();
  const std::size_t count = inner_.contacts.size() + across_.size();
  if (count > contacts.capacity()) {
    contacts = {};                        // not both at once
    constexpr std::size_t part_more = 8;  // for a list that is a little longer next time
    contacts.reserve(count + count / part_more);
  }
  const LocalFibers& own = fibers_->own();
  const auto named = [&own](const Contact& contact, const LocalFibers& fibers_b) {
    const GlobalSegment a = own.global_id(contact.fiber_a, contact.segment_a);
    const GlobalSegment b = fibers_b.global_id(contact.fiber_b, contact.segment_b);
    return DistributedContact{a.fiber,       a.segment,       b.fiber,          b.segment,
                              contact.s,     contact.t,       contact.distance, contact.lower,
                              contact.upper, contact.point_a, contact.point_b,  contact.normal};
  };
  auto across = across_.begin();
  for (const Contact& contact : inner_.contacts) {
    const DistributedContact inner = named(contact, own);
    while (across != across_.end() && by_key(named(*across, halo_), inner)) {
      contacts.push_back(named(*across++, halo_));
    }
    contacts.push_back(inner);
  }
  while (across != across_.end()) {
    contacts.push_back(named(*across++, halo_));
  }
}

RankLoad ContactSearch::load() const {
  return fibers_ == nullptr ? RankLoad()
                            : load_of(fibers_->own(), counts_, inner_.contacts, across_);
}

}  // namespace fiber
