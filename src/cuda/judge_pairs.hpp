#pragma once

#include <cmath>
#include <cstdint>

#include "src/cuda/segment_tree.hpp"
#include "src/geometry/segment_distance-inl.hpp"

namespace fiber {

/// segment_distance(), bit for bit, of one pair.
struct NearestPoints {
  double s;
  double t;
  double distance;  ///< of the axes [m]

  using Lane = one_lane::LaneDistance<one_lane::Tag<double>>;
  using Vector = Lane::Vector;

  /// @param p, q six coordinates each: two points that follow each other [m]
  FIBER_ON_DEVICE NearestPoints(const double* p, const double* q) {
    const Vector p0{p[0], p[1], p[2]};
    const Vector p1{p[3], p[4], p[5]};
    const Vector q0{q[0], q[1], q[2]};
    const Vector q1{q[3], q[4], q[5]};
    const double extent = Lane::extent(p0, p1, q0, q1);
    constexpr double least = 0x1p-100;   // min_distance_scale
    constexpr double largest = 0x1p200;  // largest_distance_scale
    if (extent > 0.0 && !(extent > least && extent < largest)) {
      const int exponent = ilogb(extent);
      take(scaled(p0, -exponent), scaled(p1, -exponent), scaled(q0, -exponent),
           scaled(q1, -exponent));
      distance = ldexp(distance, exponent);
    } else {
      take(p0, p1, q0, q1);
    }
  }

 private:
  FIBER_ON_DEVICE void take(const Vector& p0, const Vector& p1, const Vector& q0,
                            const Vector& q1) {
    const Lane nearest({Lane::subtract(p1, p0), Lane::subtract(q1, q0), Lane::subtract(p0, q0),
                        Lane::subtract(p1, q0), Lane::subtract(p0, q1)});
    s = nearest.s;
    t = nearest.t;
    distance = sqrt(nearest.squared);
  }
  FIBER_ON_DEVICE static Vector scaled(const Vector& v, int exponent) {
    return {ldexp(v.x, exponent), ldexp(v.y, exponent), ldexp(v.z, exponent)};
  }
};

/// A pair that may be a contact, with its bounds.
struct JudgedPair {
  double s;
  double t;
  double gap;  ///< [m]
};

/// @param a, b first points of the two segments
FIBER_ON_DEVICE inline JudgedPair judged_pair(const TreePoints& points, std::uint32_t a,
                                              std::uint32_t b) {
  const NearestPoints nearest(points.coordinates + 3 * std::size_t{a},
                              points.coordinates + 3 * std::size_t{b});
  return {nearest.s, nearest.t, nearest.distance - (points.radius_of(a) + points.radius_of(b))};
}

/// Decides which pairs are contacts, as Kernel::ROBUST does.
struct JudgePairs {
  TreePoints points;
  double margin;  ///< [m]
  const std::uint64_t* pairs;
  JudgedPair* judged;
  std::uint32_t* are_contacts;  ///< 1 or 0
  std::uint32_t first;          ///< which pair index 0 is

  FIBER_ON_DEVICE void operator()(std::uint32_t number) const {
    const std::uint32_t index = first + number;
    const auto a = static_cast<std::uint32_t>(pairs[index] >> 32U);
    const auto b = static_cast<std::uint32_t>(pairs[index]);
    judged[index] = judged_pair(points, a, b);
    are_contacts[index] = judged[index].gap <= margin ? 1U : 0U;
  }
};

/// Contacts on a device, sorted by a, then b.
struct ContactArrays {
  std::uint32_t* a;  ///< first points of the segments
  std::uint32_t* b;
  double* s;
  double* t;
  double* distance;  ///< signed gap of the surfaces [m]
};

/// Brings the contacts of some pairs together, in their order, as far as there is room.
struct WriteContacts {
  const std::uint64_t* pairs;
  const JudgedPair* judged;
  const std::uint32_t* places;  ///< how many contacts come up to and with each pair
  std::uint32_t first;          ///< of these pairs
  std::uint32_t end;
  ContactArrays contacts;
  std::uint64_t capacity;
  std::uint32_t* total;  ///< how many contacts come up to and with the last of them

  FIBER_ON_DEVICE void operator()(std::uint32_t number) const {
    const std::uint32_t index = first + number;
    const std::uint32_t before = index == 0 ? 0U : places[index - 1];
    const std::uint32_t up_to_here = places[index];
    if (index + 1 == end) {
      *total = up_to_here;
    }
    if (up_to_here == before || before >= capacity) {
      return;
    }
    contacts.a[before] = static_cast<std::uint32_t>(pairs[index] >> 32U);
    contacts.b[before] = static_cast<std::uint32_t>(pairs[index]);
    contacts.s[before] = judged[index].s;
    contacts.t[before] = judged[index].t;
    contacts.distance[before] = judged[index].gap;
  }
};

/// Points of either precision as doubles.
template <class Number>
struct TakePoints {
  const Number* from;
  double* to;

  FIBER_ON_DEVICE void operator()(std::uint32_t index) const {
    to[index] = static_cast<double>(from[index]);
  }
};

}  // namespace fiber
