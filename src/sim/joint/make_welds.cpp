#include "src/sim/joint/make_welds.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "src/sim/effects/cross_section.hpp"

namespace fiber {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Whether a rod itself resists bending between two edges: those beside an inner node, or beside
/// the seam of a closed rod.
bool are_consecutive(const Rods& rods, const WeldedEdge& a, const WeldedEdge& b) {
  const auto [first, last] = std::minmax(a.edge, b.edge);
  return a.rod == b.rod &&
         (last == first + 1 ||
          (rods.is_closed(a.rod) && first == rods.first(a.rod) && last + 2 == rods.end(a.rod)));
}

struct HalfEdge {
  double bending;   // stiffness [J]
  double stiff;     // to the stiff side [J]
  double twisting;  // stiffness [J]
};

/// Where rods have sections of their own, the half edges at an inner node have equal shares in it.
HalfEdge half_edge(const Rods& rods, const WeldedEdge& edge) {
  const double length = 0.5 * rods.rest_lengths[edge.edge];
  const RodSection& section = rods.sections[edge.rod];
  const SectionLengths& lengths = rods.section_lengths;
  if (lengths.empty()) {
    return {section.bending_stiffness / length,
            section.bending_ratio * section.bending_stiffness / length,
            section.twisting_stiffness / length};
  }
  const bool is_end = edge.node == rods.first(edge.rod) || edge.node + 1 == rods.end(edge.rod);
  const double share = is_end ? 1.0 : length / rods.rest_length_at(edge.node);
  return {section.bending_stiffness / (share * lengths.bending[edge.node]),
          section.bending_stiffness / (share * lengths.stiff[edge.node]),
          section.twisting_stiffness / (share * lengths.twisting[edge.node])};
}

bool has_stiff_side(const Rods& rods, const WeldedEdge& edge) {
  return !rods.stiff_sides.empty() && rods.stiff_sides[edge.node].stiffness > 0.0;
}

/// The resistance of half an edge to turns to all sides of the first section of a weld, when its
/// cross-section comes there on the shortest way.
/// @param edge gone along as the first edge of the weld, or rather so than against it
Matrix2d half_edge_spring(const Rods& rods, const WeldedEdge& edge, const WeldedEdge& first) {
  const HalfEdge half = half_edge(rods, edge);
  Matrix2d spring = half.bending * Matrix2d::Identity();
  if (has_stiff_side(rods, edge)) {
    const CrossSection own = cross_section(rods, edge.edge);
    const CrossSection there = cross_section(rods, first.edge);
    const Vector2d& side = rods.stiff_sides[edge.node].side;
    const Vector3d tangent = first.sign * there.tangent;
    const Vector3d carried =
        transport(side.x() * own.first + side.y() * own.second, edge.sign * own.tangent, tangent);
    const Vector2d towards(carried.dot(there.first), carried.dot(tangent.cross(there.first)));
    spring += (half.stiff - half.bending) * towards * towards.transpose();
  }
  return spring;
}

/// Gives a weld the stiffnesses to both sides of springs that lead from all edges of its place to a
/// common point, where any of them has a stiff side: K = A (Σ A)⁻¹ B of the springs of its two
/// edges. Of more than two edges with stiff sides across each other it is the symmetric part.
void set_stiff_side(const Rods& rods, const std::vector<WeldedEdge>& edges, Weld& weld) {
  if (std::none_of(edges.begin(), edges.end(),
                   [&](const WeldedEdge& edge) { return has_stiff_side(rods, edge); })) {
    return;
  }
  const WeldedEdge& first = weld.edges[0];
  const Vector3d along = first.sign * edge_direction(rods, first.edge).tangent;
  Matrix2d sum = Matrix2d::Zero();
  std::array<Matrix2d, 2> springs;
  for (WeldedEdge edge : edges) {
    const auto is_edge = [&](const WeldedEdge& other) {
      return edge.edge == other.edge && edge.node == other.node;
    };
    const auto own = std::find_if(weld.edges.begin(), weld.edges.end(), is_edge);
    edge.sign = own != weld.edges.end()                                    ? own->sign
                : edge_direction(rods, edge.edge).tangent.dot(along) < 0.0 ? -1.0
                                                                           : 1.0;
    const Matrix2d spring = half_edge_spring(rods, edge, first);
    sum += spring;
    if (own != weld.edges.end()) {
      springs[static_cast<std::size_t>(own - weld.edges.begin())] = spring;
    }
  }
  const Matrix2d both = springs[0] * sum.inverse() * springs[1];
  Eigen::SelfAdjointEigenSolver<Matrix2d> sides;
  sides.computeDirect(0.5 * (both + both.transpose()));
  weld.bending = std::max(0.0, sides.eigenvalues()[0]);
  weld.stiff_side = {sides.eigenvalues()[1] - weld.bending, sides.eigenvectors().col(1)};
}

}  // namespace

Weld make_weld(const Rods& rods, const std::array<WeldedEdge, 2>& edges, WeldPath path) {
  Weld weld;
  weld.edges = edges;
  const auto tangent = [&](std::size_t i) -> Vector3d {
    return weld.edges[i].sign * edge_direction(rods, weld.edges[i].edge).tangent;
  };
  // Beyond a right angle the edges lie rather beside each other than behind each other.
  if (path == WeldPath::SHORTER && tangent(0).dot(tangent(1)) < 0.0) {
    weld.edges[0].sign *= -1.0;
  }
  const Vector3d before = tangent(0);
  const Vector3d after = tangent(1);
  const Vector3d across = after - before.dot(after) * before;
  const double angle = std::atan2(across.norm(), before.dot(after));
  if (rods.directors.empty()) {
    weld.natural_turn = {angle, 0.0};
    return weld;
  }
  const auto direction = [&](std::size_t i) {
    return cross_section(rods, rods, weld.edges[i].edge).first;
  };
  const Vector3d first = direction(0);
  if (across.norm() > 0.0) {
    const Vector3d side = angle / across.norm() * across;
    weld.natural_turn = {side.dot(first), side.dot(before.cross(first))};
  }
  weld.untwisted = signed_angle(transport(first, before, after), direction(1), after);
  return weld;
}

std::vector<WeldedEdge> edges_at(const Rods& rods, const std::vector<PlacedNode>& place) {
  std::vector<WeldedEdge> edges;
  for (const auto& [rod, node] : place) {
    if (node > rods.first(rod)) {
      edges.push_back({rod, node - 1, node, -1.0});
    }
    if (node + 1 < rods.end(rod)) {
      edges.push_back({rod, node, node, 1.0});
    }
  }
  return edges;
}

void add_welds(const Rods& rods, const std::vector<PlacedNode>& place, std::vector<Weld>& welds) {
  const std::vector<WeldedEdge> edges = edges_at(rods, place);
  HalfEdge sum{0.0, 0.0, 0.0};
  for (const WeldedEdge& edge : edges) {
    const HalfEdge half = half_edge(rods, edge);
    sum.bending += half.bending;
    sum.twisting += half.twisting;
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      if (are_consecutive(rods, edges[i], edges[j])) {
        continue;
      }
      WeldedEdge towards = edges[i];
      towards.sign = -towards.sign;
      Weld weld = make_weld(rods, {towards, edges[j]}, WeldPath::SHORTER);
      const HalfEdge a = half_edge(rods, edges[i]);
      const HalfEdge b = half_edge(rods, edges[j]);
      weld.bending = a.bending * b.bending / sum.bending;
      weld.twisting = sum.twisting > 0.0 ? a.twisting * b.twisting / sum.twisting : 0.0;
      set_stiff_side(rods, edges, weld);
      welds.push_back(weld);
    }
  }
}

Weld make_seam(const Rods& rods, std::uint32_t rod, bool has_bend) {
  const std::uint32_t first = rods.first(rod);
  const std::uint32_t last = rods.end(rod) - 1;
  Weld seam =
      make_weld(rods, {{{rod, last - 1, last, 1.0}, {rod, first, first, 1.0}}}, WeldPath::AS_GIVEN);
  const SectionLengths& lengths = rods.section_lengths;
  const auto length = [&](const std::vector<double>& of_nodes) {
    return lengths.empty() ? rods.rest_length_at_seam(rod) : of_nodes[first] + of_nodes[last];
  };
  const RodSection& section = rods.sections[rod];
  seam.bending = has_bend ? section.bending_stiffness / length(lengths.bending) : 0.0;
  seam.twisting = section.twisting_stiffness / length(lengths.twisting);
  seam.is_seam = true;
  if (has_bend) {
    set_stiff_side(rods, {seam.edges[0], seam.edges[1]}, seam);
  }
  return seam;
}

}  // namespace fiber
