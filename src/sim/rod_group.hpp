#pragma once

#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/stepper.hpp"
#include "moving_rod.hpp"

namespace fiber {

/// Rods whose equations are solved together: all of them where there are contacts, one where there
/// are none.
class RodGroup {
 public:
  /// @param begin    the first rod
  /// @param end      the rod after the last
  /// @param contacts null for none; must outlive this
  RodGroup(const Rods& rods, std::uint32_t begin, std::uint32_t end, Contacts* contacts);

  /// Moves the rods by one step of implicit Euler.
  /// @param step [s]
  void solve(Rods& rods, const Effects& effects, const StepperOptions& options, double step);

 private:
  template <typename Function>
  void for_each_rod(const Function& function);
  void limit_start(Rods& rods, const Effects& effects);
  void stop_torn(Rods& rods, const Effects& effects, std::size_t rod,
                 const std::vector<Eigen::Vector3d>& wanted);
  bool find_lost(Rods& rods, const Effects& effects);
  void iterate(Rods& rods, const Effects& effects, const StepperOptions& options);
  Merit measure(const Rods& rods, const Effects& effects);
  Merit accepted_merit(const Rods& rods) const;
  void accept();
  void find_step(const Rods& rods, const Effects& effects);
  void correct_step();
  void precondition(Eigen::VectorXd& values);
  void limit_step(const Rods& rods);
  bool search(Rods& rods, const Effects& effects);
  double* part(Eigen::VectorXd& values, std::size_t rod) const;

  std::vector<MovingRod> rods_;
  Contacts* contacts_;
  std::vector<RodSystem*> systems_;
  std::uint32_t first_node_;
  std::uint32_t unknowns_;
  std::vector<std::size_t> offsets_;  // of the rods in all unknowns
  Eigen::VectorXd gradient_;
  Eigen::VectorXd step_;
  std::vector<Merit> merits_;                   // by rod, where they were tried last
  std::vector<Merit> accepted_merits_;          // and where they were accepted
  std::vector<std::uint8_t> is_lost_;           // by rod
  std::vector<Eigen::Vector3d> displacements_;  // of nodes, to be limited
};

}  // namespace fiber
