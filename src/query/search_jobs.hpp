#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

#include "fiber_proximity/query/contact.hpp"

namespace fiber {

/// State that the jobs of a round share.
class SearchRound {
 public:
  /// @param pairs_left that may be examined in the round
  /// @param wants_any  whether one contact is enough
  SearchRound(std::uint64_t pairs_left, bool wants_any)
      : pairs_left_(pairs_left), wants_any_(wants_any) {}

  /// Whether what this job finds is not needed any more.
  bool is_over(std::uint32_t job) const {
    return lacks_pairs() || job > enough_.load(std::memory_order_relaxed);
  }

  void take_pairs(std::uint64_t count) { taken_.fetch_add(count, std::memory_order_relaxed); }
  /// Whether more pairs have come up than are left. Without a contact that is enough this does not
  /// depend on the threads.
  bool lacks_pairs() const { return taken_.load(std::memory_order_relaxed) > pairs_left_; }

  /// Notes that the job has found one, if that is enough.
  void end(std::uint32_t job, bool is_done) {
    if (wants_any_ && is_done) {
      std::uint32_t first = enough_.load(std::memory_order_relaxed);
      while (job < first && !enough_.compare_exchange_weak(first, job)) {
      }
    }
  }

 private:
  const std::uint64_t pairs_left_;
  const bool wants_any_;
  std::atomic<std::uint64_t> taken_{0};
  std::atomic<std::uint32_t> enough_{std::numeric_limits<std::uint32_t>::max()};
};

/// A job of a round, which finds what a part of the search is about.
template <class Part>
class SearchJob {
 public:
  SearchJob(Part& part, QueryCounts& counts, SearchRound& round, std::uint32_t index)
      : part_(part), counts_(counts), round_(round), index_(index) {}

  Part& part() { return part_; }
  QueryCounts& counts() { return counts_; }  ///< of the part

  /// Tells the round what pairs the part has taken. @returns whether to go on
  bool look() {
    const std::uint64_t taken = part_.pairs_taken() + (part_.lacks_pairs() ? 1 : 0);
    round_.take_pairs(taken - told_);
    told_ = taken;
    return !round_.is_over(index_);
  }

  /// look() in each of so many calls: threads wait for each other to count.
  bool goes_on(std::uint32_t calls) { return ++calls_ % calls != 0 || look(); }

  /// Whether nothing is to be found any more.
  bool is_over() { return round_.is_over(index_) || part_.done_by_now(); }

 private:
  Part& part_;
  QueryCounts& counts_;
  SearchRound& round_;
  const std::uint32_t index_;
  std::uint32_t calls_ = 0;
  std::uint64_t told_ = 0;
};

/// Searches on several threads for a whole whose bound shrinks with what it finds.
///
/// Jobs of some pieces of the search come in rounds, each as large as all before. The jobs of a
/// round begin with the bound of the rounds before, and the whole absorbs what they find in their
/// order. So the answer, its counts among that, is the same for any number of threads. Keeps its
/// memory from search to search.
/// @tparam Part of the search, and all of it: made of the whole and a result, it tells
/// pairs_left(),
///              pairs_taken(), lacks_pairs(), wants_any(), done() and done_by_now(); absorb(part)
template <class Part>
class SearchJobs {
 public:
  /// @param count   of the pieces
  /// @param least   pieces of a job
  /// @param first   pieces of the first round
  /// @param execute calls what it is given, on the threads that are to work
  /// @param find    calls (job, begin, end) search pieces for a job
  /// @param alone   calls (begin, end) search pieces for the whole
  template <class Execute, class Find, class Alone>
  void search(Part& whole, std::uint32_t count, std::uint32_t least, std::uint32_t first,
              const Execute& execute, const Find& find, const Alone& alone) {
    std::uint32_t size = first;
    for (std::uint32_t begin = 0; begin < count && !whole.done_by_now();) {
      const std::uint32_t end = begin + std::min(count - begin, size);
      if (!search_together(whole, begin, end, least, execute, find)) {
        alone(begin, end);
      }
      begin = end;
      size = begin;
    }
  }

 private:
  /// Searches the pieces of a round as jobs of their own.
  /// @return false, with nothing found, if they are few, or where more pairs come up than are left
  template <class Execute, class Find>
  bool search_together(Part& whole, std::uint32_t begin, std::uint32_t end, std::uint32_t least,
                       const Execute& execute, const Find& find) {
    const std::uint32_t pieces = std::max(least, (end - begin + max_jobs - 1) / max_jobs);
    const std::uint32_t jobs = (end - begin + pieces - 1) / pieces;
    if (jobs < min_jobs) {
      return false;
    }
    for (std::uint32_t index = 0; index < jobs; ++index) {
      jobs_[index].part.emplace(whole, jobs_[index].result);
    }
    SearchRound round(whole.pairs_left(), whole.wants_any());
    const auto run = [&](std::uint32_t index) {
      Part& part = *jobs_[index].part;
      SearchJob<Part> job(part, jobs_[index].result.counts, round, index);
      const std::uint32_t first = begin + index * pieces;
      find(job, first, std::min(end, first + pieces));
      job.look();
      round.end(index, part.done());
    };
    execute([&] { tbb::parallel_for(std::uint32_t{0}, jobs, run); });
    if (round.lacks_pairs()) {
      return false;
    }
    for (std::uint32_t index = 0; index < jobs && !whole.done_by_now(); ++index) {
      whole.absorb(*jobs_[index].part);
    }
    return true;
  }

  struct Job {
    QueryResult result;
    std::optional<Part> part;
  };
  static constexpr std::uint32_t min_jobs = 4;  // fewer are not worth waking threads
  // Each finds what it needs anew: more would take more time and memory for that.
  static constexpr std::uint32_t max_jobs = 64;

  std::array<Job, max_jobs> jobs_;  // of a round
};

}  // namespace fiber
