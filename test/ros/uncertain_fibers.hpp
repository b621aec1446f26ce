#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/random.hpp"

/// Fibres that are told, and what the true ones may be.
namespace uncertain_fibers {

using fiber::Contact;
using fiber::FiberAssembly;
using fiber::test::Random;

/// Of two inputs, the second of which is exact, or of several.
inline std::vector<double> random_uncertainties(Random& random, std::size_t count) {
  std::vector<double> of_fibers(count);
  for (double& each : of_fibers) {
    each = random.chance(0.3) ? 0.0 : random.uniform(0.0, 0.1);
  }
  return of_fibers;
}

/// How true points may be off from the told ones.
enum class Truth { ANYWHERE, NEARER, FURTHER };
constexpr std::array truths{Truth::ANYWHERE, Truth::NEARER, Truth::FURTHER};

/// @param aimed_at of NEARER and FURTHER: the pair whose points move straight at each other or
///                 apart; its body b moves only where it is a fibre
inline FiberAssembly true_fibers(Random& random, const FiberAssembly& told,
                                 const std::vector<double>& uncertainties, Truth truth,
                                 const Contact& aimed_at, bool is_b_fiber) {
  constexpr double within = 1.0 - 1e-12;  // rounding of the sums included
  const double sign = truth == Truth::NEARER ? 1.0 : -1.0;
  std::vector<Eigen::Vector3d> points = told.points();
  for (std::uint32_t fiber = 0; fiber < told.fiber_count(); ++fiber) {
    const std::uint32_t begin = told.offsets()[fiber];
    for (std::uint32_t point = begin; point < told.offsets()[fiber + 1]; ++point) {
      const double most = within * uncertainties[fiber];
      const std::uint32_t index = point - begin;
      if (truth == Truth::ANYWHERE) {
        points[point] += random.uniform(0.0, most) * random.direction();
      } else if (fiber == aimed_at.fiber_a &&
                 (index == aimed_at.segment_a || index == aimed_at.segment_a + 1)) {
        points[point] += sign * most * aimed_at.normal;
      } else if (is_b_fiber && fiber == aimed_at.fiber_b) {
        points[point] -= sign * most * aimed_at.normal;
      }
    }
  }
  return fiber::test::with_points(told, points);
}

}  // namespace uncertain_fibers
