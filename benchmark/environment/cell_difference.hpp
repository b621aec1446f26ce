#pragma once

#include <cstdint>

#include "benchmark/environment/cell_checker.hpp"

namespace fiber {

/// By what one way to check a cell differs from another, over all frames.
class CellDifference {
 public:
  void add(const CellAnswer& wanted, const CellAnswer& given);

  std::uint64_t missed() const { return missed_; }           ///< pairs that were not given
  std::uint64_t unwanted() const { return unwanted_; }       ///< pairs given that were not wanted
  double distance_error() const { return distance_error_; }  ///< [m] the largest
  double nearest_error() const { return nearest_error_; }    ///< [m] the largest

 private:
  void compare(const std::vector<FoundPair>& wanted, const std::vector<FoundPair>& given);

  std::uint64_t missed_ = 0;
  std::uint64_t unwanted_ = 0;
  double distance_error_ = 0.0;
  double nearest_error_ = 0.0;
};

}  // namespace fiber
