#pragma once

#include <cstdint>

#include "benchmark/kernels/pair_kernel.hpp"

namespace fiber {

/// The truth about a pair, computed with integers of any length.
struct PairTruth {
  explicit PairTruth(const HardPair& pair);

  double distance;  ///< [m] of the axes, rounded to nearest
  double unit;      ///< [m] ε times the largest difference of coordinates along one axis, at least
                    ///< the least double
  bool contact;     ///< whether the distance is at most the sum of the radii
};

/// How right a kernel is about pairs.
class PairScore {
 public:
  void add(const HardPair& pair, const PairTruth& truth, const Guarded<PairAnswer>& answer);

  double error() const { return error_; }                    ///< [m] largest |d − d*|
  double error_units() const { return error_units_; }        ///< largest, in units of PairTruth
  double relative_error() const { return relative_error_; }  ///< largest where d* > 0
  std::uint64_t answered() const { return answered_; }
  std::uint64_t false_contacts() const { return false_contacts_; }    ///< of the kernel's decisions
  std::uint64_t missed_contacts() const { return missed_contacts_; }  ///< of the kernel's decisions
  /// Those if the distance is compared with the sum of the radii in double.
  std::uint64_t plain_false_contacts() const { return plain_false_contacts_; }
  std::uint64_t plain_missed_contacts() const { return plain_missed_contacts_; }
  std::uint64_t outside_bounds() const { return outside_bounds_; }  ///< the truth lies beyond them
  std::uint64_t not_finite() const { return not_finite_; }
  std::uint64_t no_answer() const { return no_answer_; }
  std::uint64_t ended() const { return ended_; }

 private:
  double error_ = 0.0;
  double error_units_ = 0.0;
  double relative_error_ = 0.0;
  std::uint64_t answered_ = 0;
  std::uint64_t false_contacts_ = 0;
  std::uint64_t missed_contacts_ = 0;
  std::uint64_t plain_false_contacts_ = 0;
  std::uint64_t plain_missed_contacts_ = 0;
  std::uint64_t outside_bounds_ = 0;
  std::uint64_t not_finite_ = 0;
  std::uint64_t no_answer_ = 0;
  std::uint64_t ended_ = 0;
};

}  // namespace fiber
