#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <tuple>

#include "fiber_proximity/environment/check_motions.hpp"
#include "fiber_proximity/query/motion.hpp"

namespace fiber {

/// Puts together what the steps of a path find: of each pair the first contact, of these the
/// earliest ones.
class PathCollector {
 public:
  /// What is reported of a contact in a step.
  using Report = std::function<Contact(const MotionContact&)>;

  /// @param contacts is cleared
  PathCollector(const MotionOptions& options, PathContacts& contacts);

  /// Whether the next step is to be asked: not if there are as many contacts as may be, of earlier
  /// ones.
  bool takes_step() {
    has_left_out_ = has_left_out_ || (most_ > 0 && contacts_.contacts.size() >= most_);
    return !has_left_out_;
  }

  /// What the next step is to be asked for.
  MotionOptions options() const;

  /// Takes what a step, the one from this state on, has found.
  void take(const MotionResult& found, std::size_t step, const Report& report);

  void finish();

 private:
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

  const MotionOptions options_;
  std::size_t most_;  // to be reported, 0 for no limit
  PathContacts& contacts_;
  std::set<Key> seen_;
  bool has_left_out_ = false;
};

}  // namespace fiber
