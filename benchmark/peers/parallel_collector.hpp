#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <utility>
#include <vector>

#include "fiber_proximity/query/pair_collector.hpp"

namespace fiber {

/// A PairCollector per thread, for broad phases that report pairs from several threads at once.
/// For QueryType::ALL only: the other types must see the pairs of all threads.
class ParallelCollector {
 public:
  /// What each thread has found; kept from query to query, so that its memory is.
  using Parts = tbb::enumerable_thread_specific<QueryResult>;

  ParallelCollector(const FiberAssembly& fibers, const QueryOptions& options, Parts& parts,
                    QueryResult& result)
      : whole_(fibers, options, result),
        result_(result),
        parts_(parts),
        collectors_([&] { return PairCollector(fibers, options, parts_.local()); }) {
    for (QueryResult& part : parts_) {
      part.contacts.clear();
      part.counts = {};
    }
  }

  /// The calling thread's own.
  PairCollector& local() { return collectors_.local(); }

  /// Puts together what the threads found and sorts it; call once, after the last offer.
  void finish() {
    std::vector<Contact>& contacts = result_.contacts;
    for (QueryResult& part : parts_) {
      result_.counts.primitive_tests += part.counts.primitive_tests;
      if (contacts.empty()) {
        std::swap(contacts, part.contacts);  // a single thread's are not copied
      } else {
        contacts.insert(contacts.end(), part.contacts.begin(), part.contacts.end());
      }
    }
    whole_.finish();
  }

 private:
  PairCollector whole_;
  QueryResult& result_;
  Parts& parts_;
  tbb::enumerable_thread_specific<PairCollector> collectors_;
};

}  // namespace fiber
