#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/query/options.hpp"
#include "test/support/joined_fibers.hpp"

namespace fiber::test {

/// What is a contact along a graph, from the definitions: all points are looked at, of the fibres
/// as they are given, and nothing is shared with the library but the distance of two segments.
class GraphOracle {
 public:
  explicit GraphOracle(const JoinedFibers& fibers) : fibers_(fibers) {
    for (std::uint32_t f = 0; f + 1 < fibers.offsets.size(); ++f) {
      const std::uint32_t begin = fibers.offsets[f];
      const std::uint32_t end = fibers.offsets[f + 1];
      for (std::uint32_t p = begin; p < end; ++p) {
        if (p + 1 < end || fibers.topology.closed[f] != 0) {
          const std::uint32_t next = p + 1 < end ? p + 1 : begin;
          segments_.push_back(
              {f, p - begin, {p, next}, std::max(fibers.radii[p], fibers.radii[next])});
        }
      }
    }
    std::map<std::int32_t, std::vector<std::uint32_t>> joints;
    places_.resize(fibers.points.size());
    for (std::uint32_t p = 0; p < places_.size(); ++p) {
      places_[p] = p;
      if (fibers.topology.joints[p] >= 0) {
        std::vector<std::uint32_t>& same = joints[fibers.topology.joints[p]];
        same.push_back(p);
        places_[p] = same.front();
      }
    }
  }

  struct Segment {
    std::uint32_t fiber;
    std::uint32_t index;
    std::array<std::uint32_t, 2> points;
    double radius;
  };
  const std::vector<Segment>& segments() const { return segments_; }

  const Eigen::Vector3d& at(std::uint32_t point) const { return fibers_.points[point]; }

  SegmentDistance nearest(const Segment& a, const Segment& b) const {
    return segment_distance(at(a.points[0]), at(a.points[1]), at(b.points[0]), at(b.points[1]));
  }

  /// What is along the shortest way from one segment to another: segments between them, or length.
  double between(const Segment& a, const Segment& b, bool by_length) const {
    std::vector<double> costs(places_.size(), infinite);
    costs[places_[a.points[0]]] = costs[places_[a.points[1]]] = 0.0;
    for (bool changes = true; changes;) {
      changes = false;
      for (const Segment& segment : segments_) {
        const double cost =
            by_length ? (at(segment.points[1]) - at(segment.points[0])).norm() : 1.0;
        double& x = costs[places_[segment.points[0]]];
        double& y = costs[places_[segment.points[1]]];
        if (x + cost < y || y + cost < x) {
          x = std::min(x, y + cost);
          y = std::min(y, x + cost);
          changes = true;
        }
      }
    }
    return std::min(costs[places_[b.points[0]]], costs[places_[b.points[1]]]);
  }

  /// Whether a loop is between two segments, with limits that are larger by a factor.
  bool makes_loop(const Segment& a, const Segment& b, double factor) const {
    const SegmentDistance d = nearest(a, b);
    for (const int inner_a : {0, 1}) {
      for (const int inner_b : {0, 1}) {
        if (some_way_stays(a, b, inner_a, inner_b, d, factor)) {
          return false;
        }
      }
    }
    return true;
  }

  bool is_left_out(const Segment& a, const Segment& b, const PairOptions& options,
                   double factor) const {
    if ((options.pairing == Pairing::SAME_FIBER && a.fiber != b.fiber) ||
        (options.pairing == Pairing::DIFFERENT_FIBERS && a.fiber == b.fiber)) {
      return true;
    }
    const double skip = options.neighbour_skip.value_or(1);
    const double length = options.neighbour_skip_length.value_or(0.0);
    if (between(a, b, false) < skip || between(a, b, true) < factor * length) {
      return true;
    }
    return options.needs_loops() && !makes_loop(a, b, factor);
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  using Long = Eigen::Matrix<long double, 3, 1>;

  Long on(const Segment& segment, double s) const {
    return (1.0L - s) * at(segment.points[0]).cast<long double>() +
           s * at(segment.points[1]).cast<long double>();
  }

  bool some_way_stays(const Segment& a, const Segment& b, int inner_a, int inner_b,
                      const SegmentDistance& d, double factor) const {
    const long double radius = std::max(a.radius, b.radius);
    std::vector<bool> stays(fibers_.points.size(), true);
    const auto ask = [&](const Long& x, const Long& y) {
      const long double limit = factor * (1.25L * (x - y).norm() + 2.5L * radius);
      for (std::uint32_t p = 0; p < stays.size(); ++p) {
        const Long point = at(p).cast<long double>();
        stays[p] = stays[p] && (point - x).norm() <= limit && (point - y).norm() <= limit;
      }
    };
    ask(on(a, d.s), on(b, d.t));
    const Eigen::Vector3d& end_a = at(a.points[1 - inner_a]);
    const Eigen::Vector3d& end_b = at(b.points[1 - inner_b]);
    const SegmentDistance of_a = segment_distance(end_a, end_a, at(b.points[0]), at(b.points[1]));
    const SegmentDistance of_b = segment_distance(at(a.points[0]), at(a.points[1]), end_b, end_b);
    const long double most = (d.distance + radius) / factor;
    if (of_a.distance <= most) {
      ask(end_a.cast<long double>(), on(b, of_a.t));
    }
    if (of_b.distance <= most) {
      ask(on(a, of_b.s), end_b.cast<long double>());
    }
    // From point to point, by segments and within joints.
    std::vector<bool> reached(stays.size(), false);
    reached[a.points[inner_a]] = stays[a.points[inner_a]];
    for (bool changes = true; changes;) {
      changes = false;
      const auto go = [&](std::uint32_t p, std::uint32_t q) {
        if (reached[p] && !reached[q] && stays[q]) {
          reached[q] = changes = true;
        }
      };
      for (const Segment& segment : segments_) {
        if (&segment != &a && &segment != &b) {
          go(segment.points[0], segment.points[1]);
          go(segment.points[1], segment.points[0]);
        }
      }
      for (std::uint32_t p = 0; p < places_.size(); ++p) {
        if (places_[p] != p || fibers_.topology.joints[p] >= 0) {
          for (std::uint32_t q = 0; q < places_.size(); ++q) {
            if (places_[p] == places_[q]) {
              go(p, q);
            }
          }
        }
      }
    }
    return reached[b.points[inner_b]];
  }

  const JoinedFibers& fibers_;
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> places_;  // by point, the first point that is the same place
};

}  // namespace fiber::test
