#include "src/mpi/rank_search.hpp"

#include <algorithm>
#include <exception>
#include <string>

#include "src/mpi/halo.hpp"

namespace fiber {

void RankSearch::reach(const Communicator& ranks, const FiberRuns& own, double margin) {
  if (reach_ >= margin) {
    return;
  }
  reach_ = -1.0;
  const FiberRuns halo = find_halo(ranks, own, margin);
  halo_segments_ = halo.segment_count();
  std::string error;
  try {
    local_.assign(own, halo);
    engine_->update(local_.fibers());
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  ranks.agree(error);
  reach_ = margin;
}

/// What leaves out no pair that the options want. Those that are too many are left out later.
QueryOptions RankSearch::options_here(const QueryOptions& options, double arc_roundings) const {
  QueryOptions here = options;
  here.tolerance = 0.0;
  here.relative_tolerance = 0.0;
  here.contact_limit = 0;
  if (options.pairing == Pairing::SAME_FIBER) {
    here.pairing = Pairing::ALL;  // stretches of one fibre may be several here
  }
  if (!options.needs_loops()) {
    here.neighbour_skip = options.neighbour_skip.value_or(1);
    // Sums along a stretch are rounded in another way than those along the whole fibre.
    const double surely =
        (1.0 - 0x1p-50) * options.neighbour_skip_length.value_or(0.0) - 0x1p-48 * arc_roundings;
    here.neighbour_skip_length = std::max(0.0, surely);
  }
  return here;
}

void RankSearch::find(const Communicator& ranks, const FiberRuns& own, double arc_roundings,
                      const QueryOptions& options, std::uint64_t count, DistributedResult& result) {
  const Deadline deadline(options.deadline);
  QueryOptions here = options_here(options, arc_roundings);
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  bool is_first = options.type == QueryType::FIRST;
  // Pairs that are none along whole fibres, or other ranks', may be among those that the engine
  // finds: it is asked for more until enough are left.
  for (std::uint64_t asked = count; true; asked = asked > most / 2 ? no_limit : 2 * asked) {
    here.type = is_first ? QueryType::FIRST : asked > most ? QueryType::ALL : QueryType::LIMITED;
    here.max_contacts = static_cast<std::uint32_t>(std::min(asked, most));
    here.deadline = deadline.left();
    engine_->query(here, found_);
    take(ranks, own, options, result.contacts);
    const bool had_all = here.type == QueryType::ALL || !found_.complete ||
                         found_.contacts.size() < here.max_contacts;
    if (ranks.all(had_all || result.contacts.size() >= count)) {
      break;
    }
    is_first = false;
  }
  result.complete = found_.complete;
  result.limit_reached = !found_.complete && found_.limit_reached;
  result.others_lower = found_.others_lower;
}

/// Whether segments that are a pair here are none along whole fibres.
bool RankSearch::is_left_out(const QueryOptions& options, const Contact& contact) const {
  const GlobalSegment a = local_.name_of(contact.fiber_a, contact.segment_a);
  const GlobalSegment b = local_.name_of(contact.fiber_b, contact.segment_b);
  if (a.fiber != b.fiber) {
    return options.pairing == Pairing::SAME_FIBER;
  }
  const std::uint32_t point_a = local_.point_of(contact.fiber_a, contact.segment_a);
  const std::uint32_t point_b = local_.point_of(contact.fiber_b, contact.segment_b);
  return options.pairing == Pairing::DIFFERENT_FIBERS ||
         b.segment - a.segment <= options.neighbour_skip.value_or(1) ||
         (options.neighbour_skip_length.value_or(0.0) > 0.0 &&
          local_.arc(point_b) - local_.arc(point_a + 1) < *options.neighbour_skip_length);
}

/// Of the contacts found here those that this rank reports.
void RankSearch::take(const Communicator& ranks, const FiberRuns& own, const QueryOptions& options,
                      std::vector<DistributedContact>& contacts) const {
  std::vector<const Contact*> kept;
  std::vector<LoopQuestion> questions;
  std::vector<std::size_t> asked;  // places of theirs among those kept
  for (const Contact& contact : found_.contacts) {
    const std::uint32_t point_a = local_.point_of(contact.fiber_a, contact.segment_a);
    if (!local_.is_own(point_a) || is_left_out(options, contact)) {
      continue;
    }
    const GlobalSegment a = local_.name_of(contact.fiber_a, contact.segment_a);
    const GlobalSegment b = local_.name_of(contact.fiber_b, contact.segment_b);
    // Where a stretch of the fibre holds both, the engine has seen the loop.
    if (options.needs_loops() && a.fiber == b.fiber && contact.fiber_a != contact.fiber_b) {
      const std::uint32_t point_b = local_.point_of(contact.fiber_b, contact.segment_b);
      asked.push_back(kept.size());
      questions.push_back({a.fiber, a.segment, b.segment, local_.fibers().capsule(point_a),
                           local_.fibers().capsule(point_b)});
    }
    kept.push_back(&contact);
  }
  const std::vector<bool> loops = find_loops(ranks, own, questions);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (!loops[i]) {
      kept[asked[i]] = nullptr;
    }
  }
  contacts.clear();
  for (const Contact* const contact : kept) {
    if (contact != nullptr) {
      const GlobalSegment a = local_.name_of(contact->fiber_a, contact->segment_a);
      const GlobalSegment b = local_.name_of(contact->fiber_b, contact->segment_b);
      contacts.push_back({a.fiber, a.segment, b.fiber, b.segment, contact->s, contact->t,
                          contact->distance, contact->lower, contact->upper, contact->point_a,
                          contact->point_b, contact->normal});
    }
  }
}

}  // namespace fiber
