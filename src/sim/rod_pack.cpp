// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/rod_pack.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/rod_pack.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/frames-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void measure(RodPack& rods) {
  const Real least = real(std::numeric_limits<double>::min());
  const Real one = real(1.0);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Vector point = position_at(rods, 0, lane);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Vector next = position_at(rods, i + 1, lane);
      const Vector edge = next - point;
      const Real length = larger(square_root(dot(edge, edge)), least);
      const Real inverse = one / length;
      store(length, rods.lengths[i], lane);
      store(inverse, rods.inverse_lengths[i], lane);
      store(inverse * edge, &rods.tangents[3 * i], lane);
      point = next;
    }
  }
}

HWY_INLINE Vector director_at(const RodPack& rods, std::size_t edge, std::size_t lane) {
  return load_vector(&rods.directors[3 * edge], lane);
}

/// From the director of the edge before a node to that of the edge after it.
HWY_INLINE Real twist_at(const RodPack& rods, std::size_t node, std::size_t lane) {
  const Vector tangent = tangent_at(rods, node, lane);
  const Vector carried =
      transport(director_at(rods, node - 1, lane), tangent_at(rods, node - 1, lane), tangent);
  return signed_angle(carried, director_at(rods, node, lane), tangent);
}

void measure_directors(RodPack& rods) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Vector start = load_vector(&rods.start_tangents[3 * i], lane);
      const Vector director = load_vector(&rods.start_directors[3 * i], lane);
      store(transport(director, start, tangent_at(rods, i, lane)), &rods.directors[3 * i], lane);
      if (i > 0) {
        store(twist_at(rods, i, lane), rods.director_twists[i], lane);
      }
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(measure);
HWY_EXPORT(measure_directors);

void measure_edges(RodPack& rods) {
  HWY_DYNAMIC_DISPATCH(measure)(rods);
  if (rods.unknowns == 4) {
    HWY_DYNAMIC_DISPATCH(measure_directors)(rods);
  }
}

}  // namespace fiber
#endif
