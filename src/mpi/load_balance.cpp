#include "src/mpi/load_balance.hpp"

#include <algorithm>
#include <numeric>

namespace fiber {
namespace {

// [s] Fitted to the times of fiber_bench_mpi; only their ratios matter.
constexpr double per_segment = 60e-9;
constexpr double per_node_test = 3e-9;
constexpr double per_pair = 250e-9;

/// Pairs cost time where contacts are; all else costs the same for each segment.
/// @param of_segments, of_pairs [s] of all
std::vector<double> costs_of_runs(const LocalFibers& own, double of_segments, double of_pairs,
                                  const std::vector<Contact>& inner,
                                  const std::vector<Contact>& across) {
  std::vector<double> contacts(own.runs().size());
  double all = 0.0;
  const auto add = [&](std::uint32_t fiber, std::uint32_t segment) {
    contacts[own.run_of(own.point_of(fiber, segment))] += 1.0;
    all += 1.0;
  };
  for (const Contact& contact : inner) {
    add(contact.fiber_a, contact.segment_a);
    add(contact.fiber_b, contact.segment_b);
  }
  for (const Contact& contact : across) {
    add(contact.fiber_a, contact.segment_a);
  }
  if (all == 0.0) {
    of_segments += of_pairs;
  }
  std::vector<double> costs;
  costs.reserve(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    costs.push_back(of_segments * static_cast<double>(own.runs()[i].count) /
                        static_cast<double>(own.fibers().segment_count()) +
                    of_pairs * contacts[i] / std::max(1.0, all));
  }
  return costs;
}

}  // namespace

RankLoad load_of(const LocalFibers& own, const QueryCounts& counts,
                 const std::vector<Contact>& inner, const std::vector<Contact>& across) {
  const double of_segments = per_segment * static_cast<double>(own.fibers().segment_count()) +
                             per_node_test * static_cast<double>(counts.node_tests);
  const double of_pairs = per_pair * static_cast<double>(counts.primitive_tests);
  return {of_segments + of_pairs, [=, &own, &inner, &across] {
            return costs_of_runs(own, of_segments, of_pairs, inner, across);
          }};
}

bool LoadBalance::is_too_uneven(const std::vector<double>& costs) {
  constexpr double max_imbalance = 1.1;  // beside what the last split reached
  const double mean =
      std::accumulate(costs.begin(), costs.end(), 0.0) / static_cast<double>(costs.size());
  const double max_cost = *std::max_element(costs.begin(), costs.end());
  if (mean <= 0.0) {
    return false;
  }
  if (!is_reached_known_) {
    is_reached_known_ = true;
    best_imbalance_ = max_cost / mean;
  }
  return max_cost > max_imbalance * best_imbalance_ * mean;
}

}  // namespace fiber
