#include "fiber_proximity/query/contact_batch.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

#include "fiber_proximity/bounds/bounding_volume.hpp"
#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t groups_per_job = 32;
constexpr std::size_t pairs_per_slice = 1024;

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

/// Keeps all candidates but those that are no pairs.
class CandidateSink final : public PairSink {
 public:
  CandidateSink(const PairTest& test, float bound, std::vector<PointPair>& pairs)
      : test_(test), bound_(bound), pairs_(pairs) {}

  bool offer(PointPair candidate) override {
    const PointPair pair = test_.ordered(candidate);
    if (!test_.is_neighbour_pair(pair)) {
      pairs_.push_back(pair);
    }
    return true;
  }

  float bound() const override { return bound_; }

 private:
  const PairTest& test_;
  const float bound_;
  std::vector<PointPair>& pairs_;
};

bool before(const PointPair& x, const PointPair& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }

}  // namespace

void ContactBatch::find(const RunTreeView& a, const RunTreeView& b, const PairTest& test,
                        double bound, std::size_t point_count, QueryResult& result) {
  collect(a, b, test, round_up(bound), result.counts);
  sort_pairs(point_count);
  result.counts.primitive_tests += pairs_.size();
  judge(test, bound, result.contacts);
}

void ContactBatch::collect(const RunTreeView& a, const RunTreeView& b, const PairTest& test,
                           float bound, QueryCounts& counts) {
  const std::uint32_t groups = a.group_count();
  job_count_ = b.group_count() == 0 ? 0 : (groups + groups_per_job - 1) / groups_per_job;
  jobs_.resize(std::max(jobs_.size(), job_count_));
  for_each_of(job_count_, [&](std::size_t index) {
    Job& job = jobs_[index];
    job.pairs.clear();
    job.counts = {};
    const auto begin = static_cast<std::uint32_t>(index) * groups_per_job;
    CandidateSink sink(test, bound, job.pairs);
    find_near_segments(a, begin, std::min(groups, begin + groups_per_job), b, sink, job.counts);
  });
  for (std::size_t job = 0; job < job_count_; ++job) {
    counts.node_tests += jobs_[job].counts.node_tests;
    counts.node_overlaps += jobs_[job].counts.node_overlaps;
  }
}

/// A counting sort by the first segment where pairs are many, as in dense hair; then each first
/// segment's few pairs by the second.
void ContactBatch::sort_pairs(std::size_t point_count) {
  std::size_t count = 0;
  for (std::size_t job = 0; job < job_count_; ++job) {
    count += jobs_[job].pairs.size();
  }
  pairs_.resize(count);
  if (count < point_count / run_width || count > 0xFFFF'FFFFU) {
    auto out = pairs_.begin();
    for (std::size_t job = 0; job < job_count_; ++job) {
      out = std::copy(jobs_[job].pairs.begin(), jobs_[job].pairs.end(), out);
    }
    tbb::parallel_sort(pairs_.begin(), pairs_.end(), before);
    return;
  }
  begins_.assign(point_count + 1, 0);
  for (std::size_t job = 0; job < job_count_; ++job) {
    for (const PointPair& pair : jobs_[job].pairs) {
      ++begins_[pair.a + 1];
    }
  }
  for (std::size_t point = 0; point < point_count; ++point) {
    begins_[point + 1] += begins_[point];
  }
  for (std::size_t job = 0; job < job_count_; ++job) {
    for (const PointPair& pair : jobs_[job].pairs) {
      pairs_[begins_[pair.a]++] = pair;
    }
  }
  // Placing has moved each beginning to its end, the next one's beginning.
  const std::size_t slices = (point_count + pairs_per_slice - 1) / pairs_per_slice;
  for_each_of(slices, [&](std::size_t slice) {
    const std::size_t end = std::min(point_count, (slice + 1) * pairs_per_slice);
    for (std::size_t point = slice * pairs_per_slice; point < end; ++point) {
      std::sort(pairs_.begin() + (point == 0 ? 0 : begins_[point - 1]),
                pairs_.begin() + begins_[point], before);
    }
  });
}

void ContactBatch::judge(const PairTest& test, double bound, std::vector<Contact>& contacts) {
  const std::size_t slices = (pairs_.size() + pairs_per_slice - 1) / pairs_per_slice;
  const auto slice_end = [&](std::size_t slice) {
    return std::min(pairs_.size(), (slice + 1) * pairs_per_slice);
  };
  is_contact_.resize(pairs_.size());
  slice_begins_.assign(slices + 1, 0);
  for_each_of(slices, [&](std::size_t slice) {
    for (std::size_t i = slice * pairs_per_slice; i < slice_end(slice); ++i) {
      is_contact_[i] = test.distance(pairs_[i]).gap <= bound ? 1 : 0;
      slice_begins_[slice + 1] += is_contact_[i];
    }
  });
  for (std::size_t slice = 0; slice < slices; ++slice) {
    slice_begins_[slice + 1] += slice_begins_[slice];
  }
  contacts.resize(slice_begins_[slices]);
  for_each_of(slices, [&](std::size_t slice) {
    std::size_t place = slice_begins_[slice];
    for (std::size_t i = slice * pairs_per_slice; i < slice_end(slice); ++i) {
      if (is_contact_[i] != 0) {
        contacts[place++] = test.contact(pairs_[i], test.distance(pairs_[i]));
      }
    }
  });
}

}  // namespace fiber
