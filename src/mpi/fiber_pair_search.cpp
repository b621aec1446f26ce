#include "src/mpi/fiber_pair_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/bounds/bounding_volume.hpp"
#include "src/mpi/ordered_pairs.hpp"

namespace fiber {

/// Hands what the trees find to the search.
class FiberPairSearch::Sink final : public PairSink {
 public:
  Sink(FiberPairSearch& search, bool is_across) : search_(search), is_across_(is_across) {}

  bool offer(PointPair points) override {
    if (is_across_) {
      search_.offer_across(points);
    } else {
      search_.offer_inner(points);
    }
    return !search_.is_over();
  }
  PairBound bound() const override { return {round_up(std::max(0.0, search_.closest_.bound()))}; }
  bool bound_shrinks() const override { return true; }
  bool wants_adjacent() const override {
    return is_across_ || search_.inner_test_.wants_adjacent();
  }
  PointRange ruled_out_with(std::uint32_t point) const override {
    return is_across_ ? PointRange() : search_.inner_test_.ruled_out_with(point);
  }

 private:
  FiberPairSearch& search_;
  const bool is_across_;
};

FiberPairSearch::FiberPairSearch(const RankPairs& pairs, const RunTreeEngine& engine,
                                 const QueryOptions& options, const QueryOptions& here)
    : pairs_(pairs),
      ranks_(pairs.ranks),
      own_(pairs.own),
      engine_(engine),
      halo_(pairs.halo),
      options_(options),
      deadline_(options.deadline),
      inner_test_(own_.fibers(), here),
      own_ids_(own_),
      closest_(count_fiber_pairs(ranks_, own_, options.pairing), options.margin),
      own_runs_(own_),
      tries_left_(own_.fibers().segment_count()),
      pairs_left_(QueryLimits(options).pairs) {}

double FiberPairSearch::find_inner() {
  look();
  return closest_.exchange(ranks_, others_lower_);
}

void FiberPairSearch::find_across() {
  join_halo();
  across_test_.emplace(own_.fibers(), halo_.fibers(), options_);
  halo_ids_ = GlobalSegments(halo_);
  Sink sink(*this, true);
  const auto is_over_now = [this] { return is_over(); };
  if (halo_.fibers().point_count() == 0) {
    // Nothing of others is near.
  } else if (std::isfinite(closest_.bound())) {
    engine_.offer_pairs_with(halo_.fibers(), sink, is_over_now, counts_);
  } else {
    offer_ordered_pairs(halo_, own_, sink, is_over_now, counts_);
  }
  if (has_split_fibers_ && !is_over()) {
    look();
  }
  ask_about_loops();
  leave_out(is_over_ ? std::min(inner_test_.min_gap(), across_test_->min_gap()) : closest_.bound());
}

/// At pairs of own segments: before there is a halo, and then at those that waited for it.
void FiberPairSearch::look() {
  Sink sink(*this, false);
  engine_.offer_pairs(
      sink, [this] { return is_over(); }, counts_);
}

void FiberPairSearch::offer_inner(PointPair points) {
  if (points.b < points.a) {
    std::swap(points.a, points.b);  // points here are in the order of names
  }
  const Pair pair{points, own_ids_.global_id(points.a), own_ids_.global_id(points.b), false};
  const bool waits =
      needs_loop(pair) && own_ids_.stretch_of(points.a) != own_ids_.stretch_of(points.b);
  has_split_fibers_ = has_split_fibers_ || waits;
  if (across_test_ ? waits : !waits || tries_left_ > 0) {
    consider(pair);
  }
}

/// @param points of a segment of the halo, and of one of this rank
void FiberPairSearch::offer_across(PointPair points) {
  const Pair pair{
      {points.b, points.a}, own_ids_.global_id(points.b), halo_ids_.global_id(points.a), true};
  if (pair.a < pair.b) {  // otherwise another rank's
    consider(pair);
  }
}

/// Whether the pairing and the skip of neighbours allow it.
bool FiberPairSearch::may_be_pair(const Pair& pair) const {
  if (pair.a.fiber != pair.b.fiber) {
    return options_.pairing != Pairing::SAME_FIBER;
  }
  return options_.pairing != Pairing::DIFFERENT_FIBERS &&
         pair.b.segment - pair.a.segment > options_.neighbour_skip.value_or(1);
}

void FiberPairSearch::consider(const Pair& pair) {
  if (!may_be_pair(pair) || !takes_pair()) {
    return;
  }
  const NarrowPhase& test = test_of(pair);
  const double bound = closest_.bound_of(pair.a.fiber, pair.b.fiber);
  if (test.gap_lower_bound(pair.points) > bound) {
    leave_out(bound);
    return;
  }
  const std::optional<PointPair> along = needs_loop(pair) ? on_one_stretch(pair) : std::nullopt;
  if (along && is_ruled_out(*along)) {
    return;
  }
  ++counts_.primitive_tests;
  const PairDistance distance = test.distance(pair.points);
  const double lower = test.gap_lower(pair.points, distance);
  if (lower > bound || !test.is_within_margin(pair.points, distance)) {
    leave_out(lower);
    return;
  }
  if (along && !makes_loop(*along, distance)) {
    return;
  }
  const Contact contact = test.contact(pair.points, distance);
  if (is_left_out(pair, contact)) {
    return;
  }
  const PairKey key{contact.distance, pair.a, pair.b};
  const FiberPairMinimum* minimum = closest_.find(pair.a.fiber, pair.b.fiber);
  if (minimum != nullptr && !(key < minimum->key)) {
    if (minimum->key < key) {  // not the same pair, looked at again
      leave_out(contact.lower);
    }
  } else if (!needs_loop(pair) || along) {
    keep(pair, contact);
  } else if (across_test_) {
    open_.push_back({pair, contact.distance, contact.lower});
  } else {
    --tries_left_;
    if (is_known_loop(own_runs_, question_about(pair))) {
      keep(pair, contact);
    }
  }
}

bool FiberPairSearch::takes_pair() {
  if (pairs_left_ == 0) {
    is_over_ = true;
    limit_reached_ = true;
    return false;
  }
  --pairs_left_;
  return true;
}

/// To be asked often.
bool FiberPairSearch::is_over() {
  constexpr std::uint32_t steps_between_looks = 32;  // looking takes as long as a few steps
  if (deadline_.is_set() && ++steps_ % steps_between_looks == 0 && deadline_.has_passed()) {
    is_over_ = true;
  }
  return is_over_;
}

bool FiberPairSearch::is_closer(const PairKey& key) {
  const FiberPairMinimum* minimum = closest_.find(key.a.fiber, key.b.fiber);
  return minimum == nullptr || key < minimum->key;
}

void FiberPairSearch::keep(const Pair& pair, const Contact& contact) {
  leave_out(closest_.keep({{contact.distance, pair.a, pair.b}, contact, true, pair.is_across}));
}

/// Whether the length between the two along the whole fibre is too short, or joints leave them out.
bool FiberPairSearch::is_left_out(const Pair& pair, const Contact& contact) {
  if (const std::optional<PointPair> points = pairs_.joined.points_of(pair.a, pair.b)) {
    std::uint64_t loop_steps = 0;
    const bool is_none = pairs_.joined.are_left_out(*points, loop_steps);
    take_loop_steps(loop_steps);
    return is_none;
  }
  return pair.a.fiber == pair.b.fiber && options_.neighbour_skip_length.value_or(0.0) > 0.0 &&
         pairs_.are_left_out(options_, contact, pair.is_across ? halo_ : own_);
}

/// Own segments and the halo's, those that follow each other as one stretch: it tells of a loop
/// between two of its segments what the whole fibre tells.
void FiberPairSearch::join_halo() {
  if (!options_.needs_loops() || options_.pairing == Pairing::DIFFERENT_FIBERS) {
    return;
  }
  ranks_.throw_on_all(error_in([this] {
    if (halo_.runs().empty()) {
      return;
    }
    FiberRuns all;
    for (const LocalFibers* some : {&own_, &halo_}) {
      for (const FiberRun& run : some->runs()) {
        some->add_to(all, run, 0, run.count);
      }
    }
    joined_.assign(all);
    loops_.emplace(joined_.fibers());
  }));
}

/// The points of both segments on one stretch of fibre, if they are on one: a joined stretch once
/// there are any, otherwise an own one.
std::optional<PointPair> FiberPairSearch::on_one_stretch(const Pair& pair) {
  if (!loops_) {
    const bool is_one = own_ids_.stretch_of(pair.points.a) == own_ids_.stretch_of(pair.points.b);
    return is_one ? std::optional(pair.points) : std::nullopt;
  }
  const std::vector<GlobalSegment>& names = joined_.first_ids();
  const auto has_first = [&](std::uint32_t stretch) {
    return !(pair.a < names[stretch]) &&
           (stretch + 1 == names.size() || pair.a < names[stretch + 1]);
  };
  if (!has_first(joined_stretch_)) {
    const auto after = std::upper_bound(names.begin(), names.end(), pair.a);
    joined_stretch_ = static_cast<std::uint32_t>(after - names.begin()) - 1;
  }
  const std::vector<std::uint32_t>& offsets = joined_.fibers().offsets();
  const std::uint32_t begin = offsets[joined_stretch_];
  const std::uint64_t first = names[joined_stretch_].segment;
  if (pair.b.segment - first >= offsets[joined_stretch_ + 1] - begin - 1) {
    return std::nullopt;
  }
  return PointPair{begin + static_cast<std::uint32_t>(pair.a.segment - first),
                   begin + static_cast<std::uint32_t>(pair.b.segment - first)};
}

bool FiberPairSearch::is_ruled_out(PointPair along) const {
  return loops_ ? loops_->rules_out(along.a, along.b) : inner_test_.rules_out(along.a, along.b);
}

bool FiberPairSearch::makes_loop(PointPair along, const PairDistance& distance) {
  std::uint64_t loop_steps = 0;
  const bool makes = loops_ ? loops_->makes_loop(along, distance.nearest, loop_steps)
                            : !inner_test_.lacks_loop(along, distance, loop_steps);
  take_loop_steps(loop_steps);
  return makes;
}

void FiberPairSearch::take_loop_steps(std::uint64_t loop_steps) {
  pairs_left_ -= std::min(pairs_left_, loop_steps / QueryLimits::loop_steps_per_pair);
}

/// The closest ones first, then four times as many: of most fibres the first one decides.
void FiberPairSearch::ask_about_loops() {
  constexpr std::size_t more = 4;
  std::sort(open_.begin(), open_.end(), [](const OpenPair& x, const OpenPair& y) {
    return x.a.fiber < y.a.fiber || (x.a.fiber == y.a.fiber && x.key() < y.key());
  });
  for (std::size_t max_per_fiber = 1; true; max_per_fiber *= more) {
    closest_.exchange(ranks_, others_lower_);
    drop_those_beaten();
    if (ranks_.sum(open_.size()) == 0) {
      return;
    }
    const std::vector<OpenPair> asked = take_closest(max_per_fiber);
    std::vector<LoopQuestion> questions;
    questions.reserve(asked.size());
    for (const OpenPair& pair : asked) {
      questions.push_back(question_about(pair));
    }
    const std::vector<bool> loops = find_loops(ranks_, own_, halo_, questions);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (!loops[i]) {
        continue;
      }
      if (is_closer(asked[i].key())) {
        const NarrowPhase& test = test_of(asked[i]);
        keep(asked[i], test.contact(asked[i].points, test.distance(asked[i].points)));
      } else {
        leave_out(asked[i].lower);
      }
    }
  }
}

LoopQuestion FiberPairSearch::question_about(const Pair& pair) const {
  return {pair.a.fiber, pair.a.segment, pair.b.segment, own_.fibers().capsule(pair.points.a),
          (pair.is_across ? halo_ : own_).fibers().capsule(pair.points.b)};
}

void FiberPairSearch::drop_those_beaten() {
  std::size_t kept = 0;
  for (const OpenPair& pair : open_) {
    if (is_closer(pair.key())) {
      open_[kept++] = pair;
    } else {
      leave_out(pair.lower);
    }
  }
  open_.resize(kept);
}

/// Takes so many open pairs of each fibre, the closest first; the others stay open.
std::vector<FiberPairSearch::OpenPair> FiberPairSearch::take_closest(std::size_t max_per_fiber) {
  std::vector<OpenPair> taken;
  std::vector<OpenPair> left;
  std::size_t of_fiber = 0;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    of_fiber = i > 0 && open_[i].a.fiber == open_[i - 1].a.fiber ? of_fiber + 1 : 0;
    (of_fiber < max_per_fiber ? taken : left).push_back(open_[i]);
  }
  open_ = std::move(left);
  return taken;
}

void FiberPairSearch::write(std::vector<Contact>& inner, std::vector<Contact>& across) const {
  inner.clear();
  across.clear();
  for (const FiberPairMinimum& minimum : closest_.minima()) {
    if (minimum.is_here) {
      (minimum.is_across ? across : inner).push_back(minimum.contact);
    }
  }
  sort_by_key(inner);
  sort_by_key(across);
}

}  // namespace fiber
