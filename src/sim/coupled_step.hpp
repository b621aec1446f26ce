#pragma once

#include <array>
#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "rod_batch.hpp"

namespace fiber {

/// To which of something each rod of a batch belongs.
using LaneIndices = std::array<std::uint32_t, lane_count>;

/// Newton's step of rods that contacts join, by conjugate gradients with the factors of the rods as
/// preconditioner; for each island its own ones.
class CoupledStep {
 public:
  /// What is solved for.
  struct Problem {
    const std::vector<RodBatch>& batches;     ///< factorised
    const std::vector<std::size_t>& offsets;  ///< of the batches in the step
    const std::vector<LaneIndices>& islands;  ///< by batch: of its rods
    const std::vector<double>& decreases;     ///< by island: what the step without contacts
                                              ///< between rods promises [J]
    const Contacts& contacts;                 ///< with derivatives
    const std::vector<std::size_t>& places;   ///< of nodes in the step
  };

  /// Makes the step that of rods without contacts between them the one with these.
  /// @param step of all batches
  void correct(const Problem& problem, std::vector<Lanes>& step);

 private:
  /// Of conjugate gradients, for an island.
  struct Numbers {
    double norm = 0.0;       // squared: of the residual, as the preconditioner sees it
    double curvature = 0.0;  // along the direction
    double forward = 0.0;    // share of the direction that is gone
    double back = 0.0;       // the same, negative
    double growth = 0.0;     // of the norm
    bool is_solving = true;
  };

  void begin(const Problem& problem, const std::vector<Lanes>& step);
  bool is_any_solving(const std::vector<double>& decreases);
  void choose_shares();
  static void precondition(const Problem& problem, const std::vector<Lanes>& values,
                           std::vector<Lanes>& preconditioned);
  void sum_products(const Problem& problem, const std::vector<Lanes>& a,
                    const std::vector<Lanes>& b, double Numbers::*sum);
  void add_shares(const Problem& problem, const std::vector<Lanes>& a, const std::vector<Lanes>& b,
                  double Numbers::*share, std::vector<Lanes>& sum) const;

  std::vector<Numbers> numbers_;  // by island
  std::vector<Lanes> residual_;
  std::vector<Lanes> preconditioned_;
  std::vector<Lanes> direction_;
  std::vector<Lanes> product_;  // of the preconditioner and the direction
  std::vector<Lanes> image_;    // of the direction
};

}  // namespace fiber
