#include "src/mpi/rank_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "fiber_proximity/query/narrow_phase.hpp"
#include "src/mpi/whole_fiber_pairs.hpp"

namespace fiber {
void RankSearch::update(const RankFibers& fibers) {
  fibers_ = &fibers;
  counts_ = {};
  halo_.assign(FiberRuns());
  engine_->update(fibers.own().fibers());
}

/// What leaves out no pair that the options want. Those that are too many are left out later.
QueryOptions RankSearch::options_here(const QueryOptions& options) const {
  QueryOptions here = options;
  static_cast<PairOptions&>(here) = options_of_stretches(options, fibers_->arc_roundings());
  here.tolerance = 0.0;
  here.relative_tolerance = 0.0;
  return here;
}

void RankSearch::find_inner(const QueryOptions& options, std::uint64_t count,
                            DistributedResult& result) {
  const Deadline deadline(options.deadline);
  QueryOptions here = options_here(options);
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  constexpr std::uint64_t more = 16;
  bool is_first = options.type == QueryType::FIRST;
  // Pairs that are none along whole fibres may be among those that the engine finds: it is asked
  // for more until enough are left.
  for (std::uint64_t asked = count; true; asked = asked > most / more ? no_limit : more * asked) {
    here.type = is_first ? QueryType::FIRST : asked > most ? QueryType::ALL : QueryType::LIMITED;
    here.max_contacts = static_cast<std::uint32_t>(std::min(asked, most));
    here.deadline = deadline.left();
    engine_->query(here, found_);
    counts_ += found_.counts;
    result.contacts.clear();
    append(options, found_.contacts, fibers_->own(), result.contacts);
    const bool had_all = here.type == QueryType::ALL || !found_.complete ||
                         found_.contacts.size() < here.max_contacts;
    if (ranks_.all(had_all || result.contacts.size() >= count)) {
      break;
    }
    is_first = false;
  }
  result.complete = found_.complete;
  result.limit_reached = !found_.complete && found_.limit_reached;
  result.others_lower = found_.others_lower;
}

/// [m] More than distances of one pair differ by, the one segment first or the other.
double RankSearch::rounding_across() const {
  if (halo_.fibers().point_count() == 0) {
    return 0.0;
  }
  Eigen::AlignedBox3d box;
  for (const NamedFibers* const fibers : {&halo_, &fibers_->own()}) {
    for (const Eigen::Vector3d& point : fibers->fibers().points()) {
      box.extend(point);
    }
  }
  return 0x1p-44 * (box.sizes().maxCoeff() + halo_.fibers().largest_radius());
}

void RankSearch::find_across(const FiberRuns& halo, const QueryOptions& options,
                             DistributedResult& result) {
  ranks_.agree(error_in([&] { halo_.assign(halo); }));

  // The engine takes what is a shape to it for the first of each pair. Here it is the second one:
  // distances are computed anew, as one process computes them.
  QueryOptions here = options_here(options);
  here.type = QueryType::ALL;
  here.kernel = Kernel::ROBUST;
  here.margin = options.margin * (1.0 + 0x1p-50) + rounding_across();
  here.pair_limit = rest_of(options.pair_limit, found_.counts.primitive_tests);
  engine_->query_shape(halo_.fibers(), here, found_);
  counts_ += found_.counts;
  result.complete = result.complete && found_.complete;
  result.limit_reached = result.limit_reached || (!found_.complete && found_.limit_reached);
  result.others_lower = std::min(result.others_lower, found_.others_lower);
  const NamedFibers& own = fibers_->own();
  const NarrowPhase test(own.fibers(), halo_.fibers(), options);
  across_.clear();
  for (const Contact& contact : found_.contacts) {
    if (!(own.name_of(contact.fiber_b, contact.segment_b) <
          halo_.name_of(contact.fiber_a, contact.segment_a))) {
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
  append(options, across_, halo_, result.contacts);
}

/// Appends what is found of this rank's own segments (a) and others, but for what is no pair.
void RankSearch::append(const QueryOptions& options, const std::vector<Contact>& found,
                        const NamedFibers& fibers_b,
                        std::vector<DistributedContact>& contacts) const {
  const RankPairs pairs{ranks_, fibers_->own(), halo_};
  for (const Contact* const contact : pairs.along_whole_fibers(options, found, fibers_b)) {
    const GlobalSegment a = fibers_->own().name_of(contact->fiber_a, contact->segment_a);
    const GlobalSegment b = fibers_b.name_of(contact->fiber_b, contact->segment_b);
    contacts.push_back({a.fiber, a.segment, b.fiber, b.segment, contact->s, contact->t,
                        contact->distance, contact->lower, contact->upper, contact->point_a,
                        contact->point_b, contact->normal});
  }
}

double RankSearch::cost() const {
  // Fitted to the times of fiber_bench_mpi; only how they compare matters.
  constexpr double per_segment = 65e-9;
  constexpr double per_node_test = 5e-9;
  constexpr double per_pair = 250e-9;
  if (fibers_ == nullptr) {
    return 0.0;
  }
  return per_segment * static_cast<double>(fibers_->own().fibers().segment_count()) +
         per_node_test * static_cast<double>(counts_.node_tests) +
         per_pair * static_cast<double>(counts_.primitive_tests);
}

}  // namespace fiber
