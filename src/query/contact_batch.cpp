#include "fiber_proximity/query/contact_batch.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "fiber_proximity/bounds/bounding_volume.hpp"
#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
#include "fiber_proximity/hierarchy/sort_keys.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t groups_per_job = 32;
constexpr std::size_t pairs_per_slice = 512;
// Pairs are judged in rounds, so that their distances stay in the cache until they are reported.
constexpr std::size_t slices_per_round = 32;

/// Calls for 0 … count − 1, on several threads if that is more than one thread is woken for.
template <class Call>
void for_each_of(std::size_t count, const Call& call) {
  constexpr std::size_t worth_a_thread = 3;
  if (count < worth_a_thread) {
    for (std::size_t i = 0; i < count; ++i) {
      call(i);
    }
    return;
  }
  tbb::parallel_for(std::size_t{0}, count, call);
}

/// Pairs as keys, in the order of the contacts.
std::uint64_t key_of(PointPair pair) { return std::uint64_t{pair.a} << 32U | pair.b; }
PointPair pair_of(std::uint64_t key) {
  return {static_cast<std::uint32_t>(key >> 32U), static_cast<std::uint32_t>(key)};
}

/// Keeps all candidates but those that are no pairs.
class CandidateSink final : public PairSink {
 public:
  CandidateSink(const PairTest& test, float bound, std::vector<std::uint64_t>& keys)
      : test_(test), bound_(bound), keys_(keys) {}

  bool offer(PointPair candidate) override {
    const PointPair pair = test_.ordered(candidate);
    if (!test_.is_neighbour_pair(pair)) {
      keys_.push_back(key_of(pair));
    }
    return true;
  }

  float bound() const override { return bound_; }

 private:
  const PairTest& test_;
  const float bound_;
  std::vector<std::uint64_t>& keys_;
};

}  // namespace

void ContactBatch::find(const RunTreeView& a, const RunTreeView& b, const PairTest& test,
                        double bound, QueryResult& result) {
  collect(a, b, test, round_up(bound), result.counts);
  sort();
  result.counts.primitive_tests += keys_.size();
  judge(test, bound, result.contacts);
}

void ContactBatch::collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test,
                           float bound, QueryCounts& counts) {
  const std::uint32_t groups = a.group_count();
  job_count_ = b.group_count() == 0 ? 0 : (groups + groups_per_job - 1) / groups_per_job;
  jobs_.resize(std::max(jobs_.size(), job_count_));
  for_each_of(job_count_, [&](std::size_t index) {
    Job& job = jobs_[index];
    job.keys.clear();
    job.counts = {};
    const auto begin = static_cast<std::uint32_t>(index) * groups_per_job;
    CandidateSink sink(test, bound, job.keys);
    find_near_segments(a, begin, std::min(groups, begin + groups_per_job), b, sink, job.counts);
  });
  for (std::size_t job = 0; job < job_count_; ++job) {
    counts.node_tests += jobs_[job].counts.node_tests;
    counts.node_overlaps += jobs_[job].counts.node_overlaps;
  }
}

void ContactBatch::sort() {
  keys_.clear();
  for (std::size_t job = 0; job < job_count_; ++job) {
    keys_.insert(keys_.end(), jobs_[job].keys.begin(), jobs_[job].keys.end());
  }
  sort_keys(keys_, scratch_);
}

void ContactBatch::judge(const PairTest& test, double bound, std::vector<Contact>& contacts) {
  constexpr std::size_t pairs_per_round = slices_per_round * pairs_per_slice;
  distances_.resize(std::max(distances_.size(), std::min(pairs_per_round, keys_.size())));
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < keys_.size(); begin += pairs_per_round) {
    count = judge_round(begin, test, bound, contacts, count);
  }
  contacts.resize(count);
}

/// Judges the pairs from `begin` on; returns how many contacts there are now.
std::size_t ContactBatch::judge_round(std::size_t begin, const PairTest& test, double bound,
                                      std::vector<Contact>& contacts, std::size_t contact_count) {
  const std::size_t end = std::min(keys_.size(), begin + slices_per_round * pairs_per_slice);
  const std::size_t slices = (end - begin + pairs_per_slice - 1) / pairs_per_slice;
  const auto slice_begin = [&](std::size_t slice) {
    return std::min(end, begin + slice * pairs_per_slice);
  };
  places_.assign(slices + 1, 0);
  for_each_of(slices, [&](std::size_t slice) {
    const std::size_t first = slice_begin(slice);
    const std::size_t size = slice_begin(slice + 1) - first;
    PairDistance* const distances = distances_.data() + (first - begin);
    PointPair pairs[pairs_per_slice];
    std::transform(keys_.begin() + first, keys_.begin() + first + size, pairs, pair_of);
    test.distances(pairs, size, distances);
    places_[slice + 1] = std::count_if(distances, distances + size,
                                       [&](const PairDistance& each) { return each.gap <= bound; });
  });
  places_[0] = contact_count;
  for (std::size_t slice = 0; slice < slices; ++slice) {
    places_[slice + 1] += places_[slice];
  }
  // What a query before has left there is written over: making it anew would take as long.
  contacts.resize(std::max(contacts.size(), places_[slices]));
  for_each_of(slices, [&](std::size_t slice) {
    std::size_t place = places_[slice];
    for (std::size_t i = slice_begin(slice); i < slice_begin(slice + 1); ++i) {
      const PairDistance& distance = distances_[i - begin];
      if (distance.gap <= bound) {
        contacts[place++] = test.contact(pair_of(keys_[i]), distance);
      }
    }
  });
  return places_[slices];
}

}  // namespace fiber
