// What EngineOptions::simplification promises, held against the fibres as they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "fiber_proximity/geometry/exact_distance.hpp"
#include "fiber_proximity/geometry/norm.hpp"
#include "fiber_proximity/query/brute_force.hpp"
#include "fiber_proximity/query/simplified_engine.hpp"
#include "support/contacts.hpp"
#include "support/exact_gap.hpp"
#include "support/neighbour_skips.hpp"
#include "support/rounds.hpp"
#include "support/simplifiable.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr QueryType all_types[] = {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED,
                                   QueryType::ALL, QueryType::FIBER_PAIRS};
constexpr Kernel all_kernels[] = {Kernel::FAST, Kernel::ROBUST, Kernel::EXACT};

/// By first point of each segment: its piece. As many entries as points.
std::vector<std::uint32_t> pieces_of_segments(const FiberAssembly& fibers,
                                              const SimplifiedFibers& simplified) {
  std::vector<std::uint32_t> pieces(fibers.point_count());
  for (std::uint32_t piece = 0; piece + 1 < simplified.assembly().point_count(); ++piece) {
    for (std::uint32_t i = simplified.run_begin(piece); i < simplified.run_end(piece); ++i) {
      pieces[i] = piece;
    }
  }
  return pieces;
}

/// A pair of segments that the query is about.
struct Pair {
  std::uint32_t a;
  std::uint32_t b;
  Gap gap;
};

/// Fibres, or a shape (a) and fibres (b), and all their pairs that no neighbour rule leaves out.
class Truth {
 public:
  Truth(const FiberAssembly& fibers, double deviation, const QueryOptions& options)
      : Truth(fibers, fibers, deviation, true) {
    for_each_pair([&](std::uint32_t a, std::uint32_t b) {
      const bool same = fibers.segment_id(a).fiber == fibers.segment_id(b).fiber;
      if (a < b && !(same && are_neighbours(a, b, options))) {
        pairs_.push_back({a, b, Gap(fibers.capsule(a), fibers.capsule(b))});
      }
      if (a <= b && same && (a == b || are_neighbours(a, b, options))) {
        // Pieces this near to each other are not asked for, nor others as near.
        skip_ = std::max(skip_, pieces_b_[b] - pieces_a_[a]);
      }
    });
  }
  Truth(const FiberAssembly& shape, const FiberAssembly& fibers, double deviation)
      : Truth(shape, fibers, deviation, false) {
    for_each_pair([&](std::uint32_t a, std::uint32_t b) {
      pairs_.push_back({a, b, Gap(shape.capsule(a), fibers.capsule(b))});
    });
  }

  const std::vector<Pair>& pairs() const { return pairs_; }

  std::uint32_t point_a(const Contact& contact) const {
    return a_.offsets()[contact.fiber_a] + contact.segment_a;
  }
  std::uint32_t point_b(const Contact& contact) const {
    return b_.offsets()[contact.fiber_b] + contact.segment_b;
  }

  /// Whether segments are told apart, although they are in runs.
  bool is_exact(std::uint32_t a, std::uint32_t b) const {
    return self_ && b_.segment_id(a).fiber == b_.segment_id(b).fiber &&
           pieces_b_[b] - pieces_a_[a] <= skip_;
  }

  /// Whether the contact stands for this pair.
  bool covers(const Contact& contact, std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t i = point_a(contact);
    const std::uint32_t j = point_b(contact);
    return (i == a && j == b) ||
           (!is_exact(a, b) && same_run(pieces_a_, i, a) && same_run(pieces_b_, j, b));
  }

  /// The contact that stands for a pair of these segments, or null.
  const Contact* find(const std::vector<Contact>& contacts, std::uint32_t a,
                      std::uint32_t b) const {
    const auto found = std::find_if(contacts.begin(), contacts.end(),
                                    [&](const Contact& each) { return covers(each, a, b); });
    return found == contacts.end() ? nullptr : &*found;
  }

  /// [m] Deviations of the two runs, and their largest radii.
  double deviations(const Contact& contact) const {
    return (self_ ? simplified_.deviation(pieces_a_[point_a(contact)]) : 0.0) +
           simplified_.deviation(pieces_b_[point_b(contact)]);
  }
  double radii(const Contact& contact) const {
    const double a = self_ ? largest_radius(point_a(contact)) : a_.segment_radius(point_a(contact));
    return a + largest_radius(point_b(contact));
  }

  /// [m] of the axes where the contact has them nearest
  double axis_distance(const Contact& contact) const {
    const Capsule a = a_.capsule(point_a(contact));
    const Capsule b = b_.capsule(point_b(contact));
    return ((1.0 - contact.t) * b.p0 + contact.t * b.p1 - (1.0 - contact.s) * a.p0 -
            contact.s * a.p1)
        .stableNorm();
  }

  /// [m] about what sums and differences here are rounded by
  double rounding() const {
    double largest = a_.largest_radius() + b_.largest_radius();
    for (const FiberAssembly* fibers : {&a_, &b_}) {
      for (const Vector3d& point : fibers->points()) {
        largest = std::max(largest, point.cwiseAbs().maxCoeff());
      }
    }
    return 1e-13 * largest + 1e-320;  // subnormal vectors have few digits
  }

 private:
  Truth(const FiberAssembly& a, const FiberAssembly& b, double deviation, bool self)
      : a_(a), b_(b), self_(self) {
    simplified_.update(b, deviation);
    pieces_b_ = pieces_of_segments(b, simplified_);
    pieces_a_ = self ? pieces_b_ : std::vector<std::uint32_t>();
    for (std::uint32_t i = 0; !self && i < a.point_count(); ++i) {
      pieces_a_.push_back(i);
    }
    arc_.assign(b.point_count(), 0.0);
    for (std::size_t i = 1; i < arc_.size(); ++i) {
      arc_[i] = arc_[i - 1] + norm_of(b.points()[i] - b.points()[i - 1]);
    }
  }

  template <class Call>
  void for_each_pair(const Call& call) const {
    for (const std::uint32_t a : segments(a_)) {
      for (const std::uint32_t b : segments(b_)) {
        call(a, b);
      }
    }
  }
  static std::vector<std::uint32_t> segments(const FiberAssembly& fibers) {
    std::vector<std::uint32_t> all;
    for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
        all.push_back(i);
      }
    }
    return all;
  }

  bool are_neighbours(std::uint32_t a, std::uint32_t b, const QueryOptions& options) const {
    return b - a <= options.neighbour_skip.value_or(1) ||
           arc_[b] - arc_[a + 1] < options.neighbour_skip_length.value_or(0.0);
  }
  static bool same_run(const std::vector<std::uint32_t>& pieces, std::uint32_t i, std::uint32_t j) {
    return pieces[i] == pieces[j];
  }
  double largest_radius(std::uint32_t point) const {
    double largest = 0.0;
    const std::uint32_t piece = pieces_b_[point];
    for (std::uint32_t i = simplified_.run_begin(piece); i < simplified_.run_end(piece); ++i) {
      largest = std::max(largest, b_.segment_radius(i));
    }
    return largest;
  }

  const FiberAssembly& a_;
  const FiberAssembly& b_;
  const bool self_;
  SimplifiedFibers simplified_;
  std::vector<std::uint32_t> pieces_a_;
  std::vector<std::uint32_t> pieces_b_;
  std::vector<double> arc_;
  std::vector<Pair> pairs_;
  std::uint32_t skip_ = 0;
};

/// [m] How far the kernel's bounds may be apart.
double kernel_error(const QueryOptions& options, const Truth& truth) {
  return (options.kernel == Kernel::FAST && options.type == QueryType::ALL ? 1e9 : 1.0) *
         truth.rounding();
}

/// That a contact's bounds, distance, points and place agree with the runs it stands for.
void expect_true(const Contact& contact, const Truth& truth, double deviation,
                 const QueryOptions& options) {
  bool reaches_upper = false;
  for (const Pair& pair : truth.pairs()) {
    if (truth.covers(contact, pair.a, pair.b)) {
      ASSERT_TRUE(pair.gap.is_at_least(contact.lower));
      reaches_upper = reaches_upper || pair.gap.is_at_most(contact.upper);
    }
  }
  ASSERT_TRUE(reaches_upper) << "no pair within upper, " << contact.upper;
  const double error = kernel_error(options, truth);
  ASSERT_LE(contact.upper - contact.lower, 4.0 * deviation * (1.0 + 1e-12) + error);
  ASSERT_LE(contact.lower, options.margin + error);
  ASSERT_LE(contact.lower, contact.distance);
  ASSERT_LE(contact.distance, contact.upper);
  ASSERT_NEAR((contact.point_b - contact.point_a).dot(contact.normal), contact.distance, error);
  const bool exact = truth.is_exact(truth.point_a(contact), truth.point_b(contact));
  if (!exact) {
    ASSERT_NEAR(truth.axis_distance(contact), contact.distance + truth.radii(contact),
                truth.deviations(contact) + error);
  }
}

/// That every pair is reported, stood for, or ruled out.
void expect_complete(const QueryResult& result, const Truth& truth, const QueryOptions& options) {
  const double minimum_lower = result.minimum_lower();
  for (const Pair& pair : truth.pairs()) {
    const bool is_covered = truth.find(result.contacts, pair.a, pair.b) != nullptr;
    ASSERT_TRUE(is_covered || pair.gap.is_at_least(result.others_lower));
    ASSERT_TRUE(pair.gap.is_at_least(minimum_lower));
    if (options.type == QueryType::ALL && pair.gap.is_at_most(options.margin)) {
      ASSERT_TRUE(is_covered) << "segments " << pair.a << " and " << pair.b << " are missing";
    }
  }
}

class SimplifiedTest : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<ProximityEngine> make(double simplification, double skin = 0.0) {
    EngineOptions options;
    options.simplification = simplification;
    options.skin = skin;
    return make_engine(GetParam(), options);
  }

  /// Calls with fibres of all families, an engine that simplifies them, and by how much.
  template <class Call>
  void for_each_assembly(const Call& call) const {
    SCOPED_TRACE(seed_message());
    Random random;
    for (const AssemblyFamily& family : sampled(simplifiable_families(), random)) {
      const FiberAssembly fibers = family.make(random);
      const double deviation =
          std::max(1e-300, size_of(fibers) * std::pow(10.0, random.uniform(-4.0, -0.5)));
      SCOPED_TRACE(family.name + ", deviation " + std::to_string(deviation));
      const std::unique_ptr<ProximityEngine> engine = make(deviation);
      engine->update(fibers);
      call(fibers, *engine, deviation, random);
      if (testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
};

QueryOptions random_options(Random& random, double size) {
  QueryOptions options;
  options.type = all_types[random.integer(0, 4)];
  options.kernel = all_kernels[random.integer(0, 2)];
  options.margin = random.chance(0.3) ? 0.0 : size * random.uniform(0.0, 0.1);
  options.margin = random.chance(0.2) ? infinity : options.margin;
  options.max_contacts = static_cast<std::uint32_t>(random.integer(1, 8));
  options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 5));
  options.neighbour_skip_length = random.chance(0.5) ? 0.0 : size * random.uniform(0.0, 0.2);
  if (random.chance(0.1)) {
    options.neighbour_skip_length = infinity;
  }
  return options;
}

std::string described(const QueryOptions& options) {
  return "type " + std::to_string(static_cast<int>(options.type)) + ", kernel " +
         name_of(options.kernel) + ", margin " + std::to_string(options.margin) + ", " +
         skips_of(options);
}

TEST_P(SimplifiedTest, ContactsHoldTheTruthAndNoneIsMissing) {
  for_each_assembly([](const FiberAssembly& fibers, const ProximityEngine& engine, double deviation,
                       Random& random) {
    for (int round = 0; round < rounds(3); ++round) {
      QueryOptions options = random_options(random, size_of(fibers));
      options.type = round == 0 ? QueryType::ALL : options.type;
      options.margin = round == 0 && options.margin == infinity ? 0.0 : options.margin;
      SCOPED_TRACE(described(options));
      const Truth truth(fibers, deviation, options);
      QueryResult result;
      engine.query(options, result);
      ASSERT_TRUE(result.complete);
      ASSERT_TRUE(
          std::is_sorted(result.contacts.begin(), result.contacts.end(),
                         [](const Contact& x, const Contact& y) { return x.key() < y.key(); }));
      expect_complete(result, truth, options);
      for (std::size_t i = 0; i < result.contacts.size(); i += 1 + result.contacts.size() / 16) {
        ASSERT_NO_FATAL_FAILURE(expect_true(result.contacts[i], truth, deviation, options));
      }
    }
  });
}

TEST_P(SimplifiedTest, TheClosestPairIsWithinItsBounds) {
  for_each_assembly([](const FiberAssembly& fibers, const ProximityEngine& engine, double deviation,
                       Random& random) {
    QueryOptions options = random_options(random, size_of(fibers));
    options.type = QueryType::CLOSEST;
    options.margin = infinity;
    SCOPED_TRACE(described(options));
    const Truth truth(fibers, deviation, options);
    QueryResult result;
    engine.query(options, result);
    ASSERT_EQ(result.contacts.empty(), truth.pairs().empty());
    if (result.contacts.empty()) {
      return;
    }
    const double upper = result.closest()->upper;
    ASSERT_TRUE(std::any_of(truth.pairs().begin(), truth.pairs().end(),
                            [&](const Pair& pair) { return pair.gap.is_at_most(upper); }));
    for (const Pair& pair : truth.pairs()) {
      ASSERT_TRUE(pair.gap.is_at_least(result.minimum_lower()));
    }
    ASSERT_LE(upper - result.minimum_lower(),
              4.0 * deviation * (1.0 + 1e-12) + kernel_error(options, truth));
  });
}

/// [m] The smallest gap of two fibres, but for its last digits; infinite if they have no pair.
double least_gap(const Truth& truth, const FiberAssembly& fibers, std::uint32_t fiber_a,
                 std::uint32_t fiber_b) {
  double least = infinity;
  for (const Pair& pair : truth.pairs()) {
    if (fibers.segment_id(pair.a).fiber == fiber_a && fibers.segment_id(pair.b).fiber == fiber_b) {
      least = std::min(least, pair.gap.value());
    }
  }
  return least;
}

TEST_P(SimplifiedTest, EachPairOfFibersIsThereOnceAndWithinItsBounds) {
  for_each_assembly([](const FiberAssembly& fibers, const ProximityEngine& engine, double deviation,
                       Random& random) {
    QueryOptions options = random_options(random, size_of(fibers));
    options.type = QueryType::FIBER_PAIRS;
    options.margin = infinity;
    SCOPED_TRACE(described(options));
    const Truth truth(fibers, deviation, options);
    const double error = kernel_error(options, truth);
    QueryResult result;
    engine.query(options, result);
    std::size_t count = 0;
    for (std::uint32_t a = 0; a < fibers.fiber_count(); ++a) {
      for (std::uint32_t b = a; b < fibers.fiber_count(); ++b) {
        const double gap = least_gap(truth, fibers, a, b);
        const auto contact = std::find_if(
            result.contacts.begin(), result.contacts.end(),
            [&](const Contact& each) { return each.fiber_a == a && each.fiber_b == b; });
        ASSERT_EQ(contact == result.contacts.end(), gap == infinity);
        if (gap < infinity) {
          ++count;
          ASSERT_LE(gap, contact->upper + error);
          ASSERT_GE(gap, contact->upper - 4.0 * deviation * (1.0 + 1e-12) - error);
        }
      }
    }
    ASSERT_EQ(result.contacts.size(), count);
  });
}

TEST_P(SimplifiedTest, LimitedAndFirstAreAmongAllContacts) {
  for_each_assembly([](const FiberAssembly& fibers, const ProximityEngine& engine,
                       double /*deviation*/, Random& random) {
    QueryOptions options = random_options(random, size_of(fibers));
    options.kernel = Kernel::ROBUST;
    options.type = QueryType::ALL;
    QueryResult all;
    engine.query(options, all);
    QueryResult some;
    for (const QueryType type : {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED}) {
      options.type = type;
      SCOPED_TRACE(described(options));
      engine.query(options, some);
      const std::size_t most = type == QueryType::LIMITED ? options.max_contacts : 1;
      ASSERT_EQ(some.contacts.size(), std::min(most, all.contacts.size()));
      ASSERT_EQ(some.limit_reached, type == QueryType::LIMITED && some.contacts.size() == most);
      for (const Contact& contact : some.contacts) {
        ASSERT_TRUE(contains(all.contacts, contact));
      }
    }
  });
}

TEST_P(SimplifiedTest, ContactsOfAShapeHoldTheTruthAndNoneIsMissing) {
  for_each_assembly([](const FiberAssembly& fibers, const ProximityEngine& engine, double deviation,
                       Random& random) {
    AssemblyBuilder builder;
    const double size = size_of(fibers);
    for (int f = 0; f < 3 && fibers.point_count() > 0; ++f) {
      const int place = random.integer(0, static_cast<int>(fibers.point_count()) - 1);
      const Vector3d start =
          fibers.points()[static_cast<std::size_t>(place)] + 0.1 * size * random.in_cube();
      builder.add_fiber({start, start + 0.2 * size * random.direction(),
                         start + 0.3 * size * random.direction()});
    }
    const FiberAssembly shape = builder.build({0.02 * size});
    QueryOptions options = random_options(random, size);
    SCOPED_TRACE(described(options));
    const Truth truth(shape, fibers, deviation);
    QueryResult result;
    engine.query_shape(shape, options, result);
    expect_complete(result, truth, options);
    for (const Contact& contact : result.contacts) {
      ASSERT_NO_FATAL_FAILURE(expect_true(contact, truth, deviation, options));
    }
    ASSERT_TRUE(
        std::is_sorted(result.contacts.begin(), result.contacts.end(),
                       [](const Contact& x, const Contact& y) { return x.key() < y.key(); }));
  });
}

TEST_P(SimplifiedTest, WithinNothingAllIsAsBruteForceHasIt) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : dense_families()) {
    const FiberAssembly fibers = family.make(random);
    const std::unique_ptr<ProximityEngine> engine = make(1e-300);
    engine->update(fibers);
    for (const QueryType type :
         {QueryType::CLOSEST, QueryType::LIMITED, QueryType::ALL, QueryType::FIBER_PAIRS}) {
      QueryOptions options = random_options(random, size_of(fibers));
      options.type = type;
      options.margin = std::min(options.margin, 1.0);
      SCOPED_TRACE(family.name + ", " + described(options));
      QueryResult expected;
      brute_force(fibers, options, expected);
      QueryResult found;
      engine->query(options, found);
      EXPECT_TRUE(same_contacts(found.contacts, expected.contacts));
      EXPECT_EQ(found.limit_reached, expected.limit_reached);
    }
  }
}

TEST_P(SimplifiedTest, APairAtTheMarginIsNotLostToRounding) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(100); ++round) {
    // Small, so that deviations and what they are rounded up by are far below digits of the gap.
    AssemblyBuilder builder;
    for (int f = 0; f < 2; ++f) {
      const Vector3d start = random.in_cube();
      const Vector3d u = 1e-6 * random.direction();
      builder.add_fiber(sampled(8, [&](double x) { return Vector3d(start + x * u); }));
    }
    const FiberAssembly fibers = builder.build({0.0});
    QueryOptions options;
    options.neighbour_skip = 8;
    options.margin = infinity;
    QueryResult result;
    brute_force(fibers, options, result);
    options.margin = result.closest()->distance;
    const std::unique_ptr<ProximityEngine> engine = make(1e-12);
    engine->update(fibers);
    engine->query(options, result);
    ASSERT_FALSE(result.contacts.empty());
  }
}

TEST_P(SimplifiedTest, ArcLengthIsThatOfTheFibreNotOfItsPieces) {
  // A ring of zigzags: its pieces are shorter than itself, and than the skip.
  AssemblyBuilder builder;
  bool outside = false;
  builder.add_fiber(sampled(200, [&outside](double x) {
    const double angle = 6.25 * x;
    outside = !outside;
    return Vector3d((outside ? 1.01 : 0.99) * Vector3d(std::cos(angle), std::sin(angle), 0.0));
  }));
  const FiberAssembly fibers = builder.build({0.01});
  const double deviation = 0.02;
  QueryOptions options;
  options.margin = 0.1;
  options.neighbour_skip_length = 6.5;
  const Truth truth(fibers, deviation, options);
  const std::unique_ptr<ProximityEngine> engine = make(deviation);
  engine->update(fibers);
  QueryResult result;
  engine->query(options, result);
  EXPECT_FALSE(result.contacts.empty());
  expect_complete(result, truth, options);
}

TEST_P(SimplifiedTest, NothingIsMissingNearCorners) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::vector<AssemblyFamily> families = dense_families();
  const auto hairpins =
      std::find_if(families.begin(), families.end(),
                   [](const AssemblyFamily& family) { return family.name == "hairpins"; });
  for (int round = 0; round < rounds(60); ++round) {
    const FiberAssembly fibers = hairpins->make(random);
    const double deviation = random.uniform(0.001, 0.02);
    QueryOptions options;
    options.margin = random.uniform(0.0, 0.02);
    options.neighbour_skip = static_cast<std::uint32_t>(round % 3);
    SCOPED_TRACE(described(options));
    const Truth truth(fibers, deviation, options);
    const std::unique_ptr<ProximityEngine> engine = make(deviation);
    engine->update(fibers);
    QueryResult result;
    engine->query(options, result);
    ASSERT_NO_FATAL_FAILURE(expect_complete(result, truth, options));
  }
}

TEST_P(SimplifiedTest, RunsThatBendTowardsEachOtherBesideACornerAreSeen) {
  AssemblyBuilder builder;
  builder.add_fiber({{-1.0, 0.0, 0.0},
                     {-0.1, 0.09, 0.0},
                     {0.0, 0.0, 0.0},  // the corner
                     {-0.09, 0.1, 0.0},
                     {0.05, 1.0, 0.0}});
  const FiberAssembly fibers = builder.build({0.0});
  const std::unique_ptr<ProximityEngine> engine = make(0.1);
  engine->update(fibers);
  QueryOptions options;
  options.margin = 0.02;
  QueryResult expected;
  brute_force(fibers, options, expected);
  QueryResult found;
  engine->query(options, found);
  EXPECT_FALSE(expected.contacts.empty());
  EXPECT_TRUE(same_contacts(found.contacts, expected.contacts));
  const auto* simplified = dynamic_cast<const SimplifiedEngine*>(engine.get());
  ASSERT_NE(simplified, nullptr);
  EXPECT_EQ(simplified->simplified().assembly().segment_count(), 2U);
}

TEST_P(SimplifiedTest, MovingFibersAreSimplifiedAnew) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : dense_families()) {
    FiberAssembly fibers = family.make(random);
    const double deviation = 0.01;
    const std::unique_ptr<ProximityEngine> engine = make(deviation, 0.05);
    for (int frame = 0; frame < 5; ++frame) {
      SCOPED_TRACE(family.name + ", frame " + std::to_string(frame));
      engine->update(fibers);
      QueryOptions options;
      options.neighbour_skip = 1;  // as the oracle has it, which knows no loops
      options.margin = 0.02;
      const Truth truth(fibers, deviation, options);
      QueryResult result;
      engine->query(options, result);
      ASSERT_NO_FATAL_FAILURE(expect_complete(result, truth, options));
      std::vector<Vector3d> points = fibers.points();
      for (Vector3d& point : points) {
        point += random.in_cube(0.003);
      }
      fibers.update_points(points);
    }
  }
}

TEST_P(SimplifiedTest, ADeadlineLeavesAnAnswerThatIsTrue) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = dense_families().front().make(random);
  const double deviation = 0.002;
  const std::unique_ptr<ProximityEngine> engine = make(deviation);
  engine->update(fibers);
  for (const QueryType type : all_types) {
    QueryOptions options;
    options.neighbour_skip = 1;  // as the oracle has it, which knows no loops
    options.type = type;
    options.margin = 0.1;
    const Truth truth(fibers, deviation, options);
    QueryResult whole;
    engine->query(options, whole);
    for (const double deadline : {1e-9, 1e-5, 1e3}) {
      options.deadline = deadline;
      QueryResult result;
      engine->query(options, result);
      for (const Pair& pair : truth.pairs()) {
        ASSERT_TRUE(pair.gap.is_at_least(result.minimum_lower()));
      }
      if (result.complete) {
        ASSERT_TRUE(same_contacts(result.contacts, whole.contacts));
      }
      ASSERT_TRUE(result.complete || deadline < 1e3);
      ASSERT_TRUE(!result.complete || deadline > 1e-9 || type == QueryType::FIRST);
    }
  }
}

// One of each kind: what is simplified does not depend on the engine.
INSTANTIATE_TEST_SUITE_P(Engines, SimplifiedTest,
                         testing::Values("run_tree", "AL", "SW", "OS", "brute_force"),
                         [](const auto& engine) { return test_name(engine.param); });

std::string refusal(const std::string& engine, double simplification) {
  EngineOptions options;
  options.simplification = simplification;
  try {
    make_engine(engine, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SimplifiedEngine, RefusesWhatIsNoDeviation) {
  EXPECT_EQ(refusal("run_tree", -1.0),
            "simplification is -1.000000 m, it must be finite and not negative");
  EXPECT_EQ(refusal("AL", infinity), "simplification is inf m, it must be finite and not negative");
  EXPECT_EQ(refusal("AL", std::nan("")),
            "simplification is nan m, it must be finite and not negative");
  EXPECT_EQ(refusal("AL-threaded", 0.1).rfind("AL-threaded needs fibres of equal", 0), 0U);
  EXPECT_EQ(refusal("DL-6-classic", 0.1), "");
}

TEST(SimplifiedEngine, IsNotThereUnlessAskedFor) {
  EXPECT_EQ(EngineOptions().simplification, 0.0);
  const auto simplifies = [](double simplification) {
    EngineOptions options;
    options.simplification = simplification;
    const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree", options);
    return dynamic_cast<const SimplifiedEngine*>(engine.get()) != nullptr;
  };
  EXPECT_FALSE(simplifies(0.0));
  EXPECT_TRUE(simplifies(1e-3));
}

}  // namespace
}  // namespace fiber::test
