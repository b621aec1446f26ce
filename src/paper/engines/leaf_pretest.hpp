#pragma once

#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// Engines that can leave out the test of two leaves' volumes before the segments themselves. It
/// changes only the cost; the paper finds that it always pays (Sect. 5).
class LeafPretest {
 public:
  /// Whether queries from now on make the test; they do from the start.
  void set_leaf_pretest(bool is_wanted) { is_wanted_ = is_wanted; }

 protected:
  ~LeafPretest() = default;
  bool has_leaf_pretest() const { return is_wanted_; }

 private:
  bool is_wanted_ = true;
};

/// Sets it of an engine that has the choice; every other one keeps what it does.
inline void set_leaf_pretest(ProximityEngine& engine, bool is_wanted) {
  if (auto* const choice = dynamic_cast<LeafPretest*>(&engine)) {
    choice->set_leaf_pretest(is_wanted);
  }
}

}  // namespace fiber
