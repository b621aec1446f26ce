#pragma once

#include <algorithm>

namespace fiber {

/// A part of an edge, or a point of it, by parameters from 0 to 1; nothing where the first is
/// greater than the last.
struct EdgePart {
  double first = 0.0;
  double last = 1.0;

  static constexpr EdgePart whole() { return {0.0, 1.0}; }
  static constexpr EdgePart first_node() { return {0.0, 0.0}; }
  static constexpr EdgePart last_node() { return {1.0, 1.0}; }

  bool is_point() const { return first == last; }

  /// The parameter on the edge of that on the part.
  double on_edge(double parameter) const { return first + parameter * (last - first); }

  /// Keeps that in which something linear along the edge is not below 0.
  void keep_positive(double at_first_node, double at_last_node) {
    if (at_first_node < 0.0 && at_last_node < 0.0) {
      last = -1.0;
    } else if (at_first_node < 0.0) {
      first = std::max(first, at_first_node / (at_first_node - at_last_node));
    } else if (at_last_node < 0.0) {
      last = std::min(last, at_first_node / (at_first_node - at_last_node));
    }
  }
};

}  // namespace fiber
