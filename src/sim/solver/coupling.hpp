#pragma once

#include <array>
#include <vector>

#include "src/sim/contact/contact_set.hpp"
#include "src/sim/solver/for_each_pack.hpp"
#include "src/sim/solver/pack_step.hpp"

namespace fiber {

/// To which island each rod of a pack belongs.
using LaneIslands = std::array<std::uint32_t, lane_count>;

/// Newton's step of rods whose contacts reach beyond the bands of their Hessians, by conjugate
/// gradients with the bands' factors as preconditioner (Nocedal and Wright 2006, Alg. 5.3); for
/// each island its own ones.
///
/// The Hessian's product with a direction p needs no Hessian: with the preconditioner M, M p
/// follows from the residuals p is made of.
class Coupling {
 public:
  /// What is solved for.
  struct Problem {
    const std::vector<PackStep>& packs;       ///< factorised
    const std::vector<std::size_t>& offsets;  ///< of the packs in the step
    const std::vector<LaneIslands>& islands;  ///< by pack
    const std::vector<double>& decreases;     ///< by island: what the step by the bands alone
                                              ///< promises [J]; 0 where there is none to find
    const ContactSet& contacts;               ///< with derivatives
    const std::vector<std::size_t>& places;   ///< of nodes in the step
  };

  /// Makes the step by the bands alone the one by the whole Hessian.
  /// @param step of all packs
  void correct(const Problem& problem, std::vector<SimdBatch>& step);

 private:
  /// Of conjugate gradients, for an island.
  struct Numbers {
    double norm = 0.0;     // squared: of the residual, as the preconditioner sees it
    double forward = 0.0;  // share of the direction that is gone
    double growth = 0.0;   // of the norm
    bool is_solving = true;
  };

  template <class Function>
  void for_each_part(const Problem& problem, Work work, const Function& function);
  std::vector<double> sums(const Problem& problem) const;
  void begin(const Problem& problem, const std::vector<SimdBatch>& step);
  bool is_any_solving(const std::vector<double>& decreases);
  void find_image(const Problem& problem);
  void advance(const Problem& problem, std::vector<SimdBatch>& step);
  void turn(const Problem& problem);

  std::vector<Numbers> numbers_;         // by island
  std::vector<SimdBatch> partial_sums_;  // by pack
  std::vector<SimdBatch> residual_;
  std::vector<SimdBatch> preconditioned_;
  std::vector<SimdBatch> direction_;
  std::vector<SimdBatch> product_;  // of the preconditioner and the direction
  std::vector<SimdBatch> image_;    // of the direction
};

}  // namespace fiber
