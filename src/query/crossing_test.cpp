#include "src/query/crossing_test.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "src/geometry/disjoint_sets.hpp"
#include "src/geometry/fiber_graph.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// A number in doubles, and how far it may be from the exact one.
struct Approximate {
  double value;
  double error;

  bool is_certain() const { return std::abs(value) > error; }  // not for NaN
  bool is_positive() const { return is_certain() && value > 0.0; }
  bool is_negative() const { return is_certain() && value < 0.0; }
  int sign() const { return value > 0.0 ? 1 : -1; }
};

// Up to here no product of three overflows, and one that underflows is off by less than the other:
// 2⁻¹⁰⁷⁴ times 2¹⁵⁰, a few times.
constexpr double largest_entry = 0x1p150;
constexpr double underflow = 0x1p-900;

constexpr double unbounded = std::numeric_limits<double>::infinity();

bool is_large(const Vector3d& v) { return !(v.cwiseAbs().maxCoeff() <= largest_entry); }

/// The error of three vectors that are each rounded once: at most eight roundings in a product of
/// three, so 8.1 · 2⁻⁵³ of the sum of their magnitudes (as in Shewchuk 1997, orient3d); twice that
/// here.
Approximate determinant(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  if (is_large(a) || is_large(b) || is_large(c)) {
    return {0.0, unbounded};
  }
  const Vector3d p = a.cwiseAbs();
  const Vector3d q = b.cwiseAbs();
  const Vector3d r = c.cwiseAbs();
  const double sum = p.x() * (q.y() * r.z() + q.z() * r.y()) +
                     p.y() * (q.z() * r.x() + q.x() * r.z()) +
                     p.z() * (q.x() * r.y() + q.y() * r.x());
  return {a.dot(b.cross(c)), 0x1p-49 * sum + underflow};
}

/// How far a point is in front of the eye, in units of the direction's length.
Approximate depth(const Vector3d& point, const View& view) {
  if (!view.is_perspective) {
    return {1.0, 0.0};
  }
  const Vector3d offset = point - view.eye;
  if (is_large(offset) || is_large(view.direction)) {
    return {0.0, unbounded};
  }
  return {offset.dot(view.direction),
          0x1p-50 * offset.cwiseAbs().dot(view.direction.cwiseAbs()) + underflow};
}

/// On which side of a plane through the viewer the two ends of a segment are.
struct Sides {
  Approximate first;
  Approximate last;

  bool are_equal() const {
    return (first.is_positive() && last.is_positive()) ||
           (first.is_negative() && last.is_negative());
  }
  bool differ() const {
    return (first.is_positive() && last.is_negative()) ||
           (first.is_negative() && last.is_positive());
  }
  /// Good enough to divide the segment by.
  bool are_accurate() const {
    return first.error + last.error <= 0x1p-40 * std::abs(first.value - last.value);
  }
  double parameter() const {
    return std::clamp(first.value / (first.value - last.value), 0.0, 1.0);
  }
};

Sides sides_of(const Vector3d& first, const Vector3d& last, const Vector3d& p0, const Vector3d& p1,
               const View& view) {
  const Vector3d viewer = view.is_perspective ? Vector3d(view.eye - p0) : Vector3d(-view.direction);
  const Vector3d axis = p1 - p0;
  return {determinant(axis, first - p0, viewer), determinant(axis, last - p0, viewer)};
}

/// Two segments and the viewer in units of one power of two; the direction in units of another.
struct IntegerScene {
  std::array<PerturbedPoint, 4> ends;
  PerturbedPoint viewer;
  IntegerVector direction;

  LeadingTerm side(std::size_t of, std::size_t p0, std::size_t p1) const {
    return perturbed_orientation({ends[p0], ends[p1], ends[of], viewer});
  }

  /// How far an end is in front of the eye.
  Integer depth(std::size_t end) const {
    const auto& p = ends[end].coordinates;
    const auto& e = viewer.coordinates;
    return e[3] == 0 ? Integer(1) : dot({p[0] - e[0], p[1] - e[1], p[2] - e[2]}, direction);
  }
};

std::array<Integer, 4> homogeneous(const IntegerVector& v, int weight) {
  return {v[0], v[1], v[2], weight};
}

/// Where a segment is divided: weight_last / (weight_first + weight_last).
struct Division {
  Integer weight_first;
  Integer weight_last;

  /// By the sides of its ends, which differ: where one is infinitely smaller, at that end.
  Division(const LeadingTerm& first, const LeadingTerm& last)
      : weight_first(first.dominates(last) ? Integer(0) : Integer(abs(last.coefficient))),
        weight_last(last.dominates(first) ? Integer(0) : Integer(abs(first.coefficient))) {}

  double parameter() const {
    return rounded_quotient(weight_last, weight_first + weight_last, 0).value;
  }
  bool is_in_front(const Integer& depth_first, const Integer& depth_last) const {
    return weight_first * depth_first + weight_last * depth_last > 0;
  }
};

/// Points that move together: equal ones in a row, the ends of a fibre and points of a joint if
/// they are equal. By point: the first that moves with it.
std::vector<std::uint32_t> find_joints(const FiberAssembly& fibers) {
  const std::vector<Vector3d>& points = fibers.points();
  DisjointSets together(static_cast<std::uint32_t>(points.size()));
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t begin = fibers.offsets()[fiber];
    const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
    for (std::uint32_t i = begin + 1; i <= last; ++i) {
      if (points[i] == points[i - 1]) {
        together.join(i, i - 1);
      }
    }
    if (points[last] == points[begin]) {
      together.join(last, begin);
    }
  }
  if (const std::shared_ptr<const FiberGraph> graph = fibers.graph()) {
    for (std::uint32_t joint = 0; joint < graph->joint_count(); ++joint) {
      const std::uint32_t first = graph->joint_points()[*graph->members(joint).begin()].point;
      for (const std::uint32_t member : graph->members(joint)) {
        const std::uint32_t point = graph->joint_points()[member].point;
        if (points[point] == points[first]) {
          together.join(point, first);
        }
      }
    }
  }
  std::vector<std::uint32_t> joints;
  together.find_roots(joints);
  return joints;
}

}  // namespace

CrossingTest::CrossingTest(const FiberAssembly& fibers, const View& view)
    : fibers_(fibers), view_(view), joints_(find_joints(fibers)) {}

std::optional<Crossing> CrossingTest::operator()(std::uint32_t point_a,
                                                 std::uint32_t point_b) const {
  assert(point_a < point_b);
  const Ends ends{point_a, point_a + 1, point_b, point_b + 1};
  if (!is_pair(ends)) {
    return std::nullopt;
  }
  Place place{};
  switch (judge_in_doubles(ends, place)) {
    case Verdict::APART:
      return std::nullopt;
    case Verdict::CROSSING:
      return crossing_at(ends, place);
    case Verdict::OPEN:
      break;
  }
  if (const std::optional<Place> exact = judge_in_integers(ends)) {
    return crossing_at(ends, *exact);
  }
  return std::nullopt;
}

bool CrossingTest::is_pair(const Ends& ends) const {
  std::array<std::uint32_t, 4> joints{};
  std::transform(ends.begin(), ends.end(), joints.begin(),
                 [this](std::uint32_t point) { return joints_[point]; });
  std::sort(joints.begin(), joints.end());
  return std::adjacent_find(joints.begin(), joints.end()) == joints.end() &&
         !(fibers_.graph() != nullptr && fibers_.graph()->share_joint(ends[0], ends[2]));
}

CrossingTest::Verdict CrossingTest::judge_in_doubles(const Ends& ends, Place& place) const {
  const Vector3d& p0 = fibers_.points()[ends[0]];
  const Vector3d& p1 = fibers_.points()[ends[1]];
  const Vector3d& q0 = fibers_.points()[ends[2]];
  const Vector3d& q1 = fibers_.points()[ends[3]];
  const Sides sides_a = sides_of(p0, p1, q0, q1, view_);
  const Sides sides_b = sides_of(q0, q1, p0, p1, view_);
  if (sides_a.are_equal() || sides_b.are_equal()) {
    return Verdict::APART;
  }
  const Approximate depths[] = {depth(p0, view_), depth(p1, view_), depth(q0, view_),
                                depth(q1, view_)};
  if ((depths[0].is_negative() && depths[1].is_negative()) ||
      (depths[2].is_negative() && depths[3].is_negative())) {
    return Verdict::APART;
  }
  const Approximate twist = determinant(p1 - p0, q0 - p0, q1 - p0);
  const bool in_front = std::all_of(std::begin(depths), std::end(depths),
                                    [](const Approximate& each) { return each.is_positive(); });
  if (!sides_a.differ() || !sides_b.differ() || !in_front || !twist.is_certain() ||
      !sides_a.are_accurate() || !sides_b.are_accurate()) {
    return Verdict::OPEN;
  }
  place = {sides_a.parameter(), sides_b.parameter(), twist.sign(),
           twist.sign() == sides_b.last.sign()};
  return Verdict::CROSSING;
}

std::optional<CrossingTest::Place> CrossingTest::judge_in_integers(const Ends& ends) const {
  int exponent = view_.is_perspective ? last_bit({view_.eye}) : std::numeric_limits<int>::max();
  for (const std::uint32_t end : ends) {
    exponent = std::min(exponent, last_bit({fibers_.points()[end]}));
  }
  IntegerScene scene;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    scene.ends[i] = {homogeneous(scaled_integers(fibers_.points()[ends[i]], exponent), 1),
                     joints_[ends[i]]};
  }
  scene.direction = scaled_integers(view_.direction, last_bit({view_.direction}));
  scene.viewer.coordinates = view_.is_perspective
                                 ? homogeneous(scaled_integers(view_.eye, exponent), 1)
                                 : homogeneous(Integer(-1) * scene.direction, 0);
  const LeadingTerm a_first = scene.side(0, 2, 3);
  const LeadingTerm a_last = scene.side(1, 2, 3);
  const LeadingTerm b_first = scene.side(2, 0, 1);
  const LeadingTerm b_last = scene.side(3, 0, 1);
  if (a_first.sign() == a_last.sign() || b_first.sign() == b_last.sign()) {
    return std::nullopt;
  }
  const Division a(a_first, a_last);
  const Division b(b_first, b_last);
  if (!a.is_in_front(scene.depth(0), scene.depth(1)) ||
      !b.is_in_front(scene.depth(2), scene.depth(3))) {
    return std::nullopt;
  }
  const int sign = perturbed_orientation(scene.ends).sign();
  return Place{a.parameter(), b.parameter(), sign, sign == b_last.sign()};
}

Crossing CrossingTest::crossing_at(const Ends& ends, const Place& place) const {
  const Capsule a = fibers_.capsule(ends[0]);
  const Capsule b = fibers_.capsule(ends[2]);
  const SegmentId id_a = fibers_.segment_id(ends[0]);
  const SegmentId id_b = fibers_.segment_id(ends[2]);
  const Vector3d along_a = place.s * (a.p1 - a.p0);
  const Vector3d along_b = place.t * (b.p1 - b.p0);
  Crossing crossing;
  static_cast<SegmentIdPair&>(crossing) = {id_a.fiber, id_a.segment, id_b.fiber, id_b.segment};
  crossing.s = place.s;
  crossing.t = place.t;
  crossing.a_is_over = place.a_is_over;
  crossing.sign = place.sign;
  crossing.separation = ((b.p0 - a.p0) + (along_b - along_a)).stableNorm();
  crossing.gap = crossing.separation - (a.radius + b.radius);
  crossing.point_a = a.p0 + along_a;
  crossing.point_b = b.p0 + along_b;
  return crossing;
}

}  // namespace fiber
