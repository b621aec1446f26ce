// Which edges of a rod are too near along it to be contacts.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/sim/contact/edge_contact.hpp"
#include "test/sim/contact_system.hpp"
#include "test/sim/polyline.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double thin_radius = 0.01;
constexpr double thin_touching = 2.0 * thin_radius;

/// Of the sum of radii: contacts with little weight give way as far as that.
constexpr double min_nearest = 0.91;

/// A rod of short edges, whose neighbours along it are nearer than they could touch.
TEST(ContactNeighbours, AreNoPairs) {
  for (const double edge : {0.2 * thin_radius, thin_radius, 5.0 * thin_radius}) {
    Rods rods;
    Random random(5);
    rods.add(polyline(random, Vector3d::UnitX(), 40, edge, 0.1), thin_radius, rubber(thin_radius));
    const auto contacts = contacts_with(nullptr);
    const ContactSet found = contacts_of(*contacts, rods);
    const std::vector<double> arcs = contact_arcs(rods);
    for (const EdgePair& pair : found.pairs) {
      EXPECT_FALSE(are_contact_neighbours(rods, arcs, 0, pair.edge_a, pair.edge_b));
    }
    ContactSet measured = found;
    EXPECT_EQ(energy_in(measured, rods), 0.0) << "edges of " << edge / thin_radius << " radii";
  }
}

TEST(ContactNeighbours, HaveANodeInCommonOrLessThanFourRadiiOfRodBetweenThem) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {0.3, 0, 0}, 30), thin_radius, rubber(thin_radius));
  rods.add(straight({0, 1, 0}, {3.0, 1, 0}, 30), thin_radius, rubber(thin_radius));
  const std::vector<double> arcs = contact_arcs(rods);
  // Edges of a radius: between the first and that there are less than four.
  EXPECT_TRUE(are_contact_neighbours(rods, arcs, 0, 3, 6));
  EXPECT_TRUE(are_contact_neighbours(rods, arcs, 0, 7, 3));
  EXPECT_FALSE(are_contact_neighbours(rods, arcs, 0, 3, 9));
  // Long ones.
  const std::uint32_t first = rods.first(1);
  EXPECT_TRUE(are_contact_neighbours(rods, arcs, 1, first + 3, first + 4));
  EXPECT_FALSE(are_contact_neighbours(rods, arcs, 1, first + 3, first + 5));
}

/// Straight rods, circles, and the tightest bend that leaves room: a half-circle as wide as four
/// radii.
TEST(ContactNeighbours, DoNotPressInRodsThatMakeNoLoop) {
  for (const double edge : {0.5 * thin_radius, 2.0 * thin_radius, 4.0 * thin_radius,
                            10.0 * thin_radius, 40.0 * thin_radius}) {
    for (const double bend : {0.0, 0.1, edge / (2.0 * thin_radius)}) {
      const double turn = std::min(bend, 0.5 * M_PI);  // at each node
      std::vector<Vector3d> points{Vector3d::Zero()};
      const double whole_turn = turn > 0.0 ? M_PI / turn : 30.0;
      for (int i = 0; i < std::min(30, static_cast<int>(whole_turn) + 1); ++i) {
        points.push_back(points.back() +
                         edge * Vector3d(std::cos(i * turn), std::sin(i * turn), 0.0));
      }
      Rods rods;
      rods.add(points, thin_radius, rubber(thin_radius));
      const auto contacts = contacts_with(nullptr);
      ContactSet found = contacts_of(*contacts, rods);
      EXPECT_EQ(energy_in(found, rods), 0.0)
          << "edges of " << edge / thin_radius << " radii that turn by " << turn;
    }
  }
}

/// The smallest distance of axes of edges of a rod that share no node, over the diameter.
double nearest_axes(const Rods& rods) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t a = 0; a + 1 < rods.positions.size(); ++a) {
    for (std::uint32_t b = a + 2; b + 1 < rods.positions.size(); ++b) {
      nearest = std::min(nearest, segment_distance(rods.positions[a], rods.positions[a + 1],
                                                   rods.positions[b], rods.positions[b + 1])
                                      .distance);
    }
  }
  return nearest / (2.0 * rods.radii.front());
}

/// A zig-zag of three long edges, whose last end is drawn through its first edge.
TEST(ContactNeighbours, EdgesOfAZigZagDoNotPassThroughEachOther) {
  constexpr double radius = 0.005;
  Rods rods;
  rods.add({{-0.1, 0, 0}, {0.1, 0, 0}, {0.1, 0.001, 0.06}, {-0.05, 0.001, 0.06}}, radius,
           rubber(radius));
  Effects all = elastic(0.0);
  Attachment::Hold drawn = pin(3, rods.positions[3]);
  drawn.placement = [start = rods.positions[3]](double time) {
    return Placement{start - Vector3d(0.0, 0.0, 0.12 * std::min(1.0, time)), Vector3d::Zero(),
                     Vector3d::Zero()};
  };
  all.push_back(hold(rods, {pin(0, rods.positions[0]), pin(1, rods.positions[1]), drawn}));
  Stepper stepper(rods, std::move(all), {}, contacts_with(nullptr));
  double nearest = nearest_axes(rods);
  while (stepper.time() < 1.0) {
    stepper.step(1.0 / 240.0);
    nearest = std::min(nearest, nearest_axes(stepper.rods()));
  }
  EXPECT_LT(nearest, 1.1) << "they meet";
  EXPECT_GT(nearest, min_nearest);
}

/// A hairpin whose arms touch: they are held apart as those of two rods are.
TEST(ContactNeighbours, ArmsOfAHairpinAreHeldApart) {
  constexpr double edge = 2.0 * thin_radius;
  std::vector<Vector3d> points = straight({20 * edge, 0, 0}, {0, 0, 0}, 20);
  points.emplace_back(-edge, 0.5 * thin_touching, 0.0);
  const std::vector<Vector3d> back =
      straight({0, 0.99 * thin_touching, 0}, {20 * edge, 0.99 * thin_touching, 0}, 20);
  points.insert(points.end(), back.begin(), back.end());
  Rods hairpin;
  hairpin.add(points, thin_radius, rubber(thin_radius));
  Rods both;
  both.add(std::vector<Vector3d>(points.begin(), points.begin() + 21), thin_radius,
           rubber(thin_radius));
  both.add(back, thin_radius, rubber(thin_radius));
  const auto gradient_of = [](const Rods& rods) {
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, rods);
    return full_system(found, rods).gradient;
  };
  const VectorXd of_hairpin = gradient_of(hairpin);
  const VectorXd of_both = gradient_of(both);
  EXPECT_GT(of_both.head(30).norm(), 0.0);
  EXPECT_EQ(of_hairpin.head(30), of_both.head(30)) << "ten nodes, far from the bend";
}

}  // namespace
}  // namespace fiber::test
