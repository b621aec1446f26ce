#pragma once

#include <memory>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/sim/contacts.hpp"

namespace fiber {

struct EdgePair;

/// Contacts of rods with themselves, with each other, or both, by the potential of
/// src/sim/contact/edge_contact.hpp: from 1.05 of the sum of radii between axes on, and never
/// nearer than 0.95 of it.
///
/// Candidates come from run_tree, with a reach that serves for some steps.
class FiberContact : public ContactSource {
 public:
  /// How stiff contacts are, and of which rods.
  struct Options {
    Pairing pairing = Pairing::ALL;

    /// Force by distance where surfaces meet [N/m] >= 0; 0 derives it from how the rods resist
    /// stretch.
    double stiffness = 0.0;
  };

  /// @throws std::invalid_argument for a stiffness that is negative or not finite
  explicit FiberContact(const Options& options);
  ~FiberContact() override;

  void find(const Rods& rods, const Room& room, ContactSet& found) override;

 private:
  void find_candidates(const Rods& rods, double reach);
  void add_near(const Rods& rods, const Room& room, double approach, ContactSet& found);
  EdgePair candidate(const Rods& rods, const Contact& contact) const;

  Options options_;
  std::unique_ptr<ProximityEngine> engine_;
  FiberAssembly fibers_;      // where the rods were when candidates were looked for
  double reach_ = -1.0;       // [m] surfaces further apart then are no candidates
  std::vector<double> arcs_;  // along each rod at rest, by node [m]
  std::vector<EdgePair> candidates_;
  std::vector<double> candidate_distances_;  // of axes, where they were looked for [m]
  QueryResult result_;
};

}  // namespace fiber
