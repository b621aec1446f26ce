// Which edges of a rod are too near along it to be contacts.

#include <gtest/gtest.h>

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

TEST(ContactNeighbours, AreTwoEdgesOrFourRadiiOfRod) {
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
  EXPECT_TRUE(are_contact_neighbours(rods, arcs, 1, first + 3, first + 5));
  EXPECT_FALSE(are_contact_neighbours(rods, arcs, 1, first + 3, first + 6));
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
