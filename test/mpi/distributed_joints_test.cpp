// Closed and joined fibres over ranks: what one process finds, to the bit, and what the definitions
// say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "test/mpi/gathered_motions.hpp"
#include "test/mpi/scattered_fibers.hpp"
#include "test/support/joined_fibers.hpp"
#include "test/support/neighbour_skips.hpp"
#include "test/support/rounds.hpp"
#include "test/support/true_contacts.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Every rank computes what one process finds: more ranks get fewer scenes, which are others.
int scenes_of_joined_fibers() { return rounds(std::max(20, 120 / rank_count())); }
std::uint64_t stream_of_joined_fibers() { return static_cast<std::uint64_t>(rank_count()); }

/// Points of a joint a little apart, as a tracker has them.
JoinedFibers with_noise(JoinedFibers fibers, Random& random) {
  fibers.topology.joint_tolerance = 0.2;
  for (Vector3d& point : fibers.points) {
    point += random.in_cube(0.03);
  }
  return fibers;
}

QueryOptions draw_joined_options(Random& random) {
  QueryOptions options = within(random.chance(0.4) ? 0.0 : random.uniform(0.0, 1.0));
  set_neighbour_skips(options, random, 4, random.chance(0.5) ? random.uniform(0.0, 2.0) : 0.0);
  options.pairing = static_cast<Pairing>(std::max(0, random.integer(-2, 2)));
  options.kernel = random.chance(0.2) ? Kernel::EXACT : Kernel::ROBUST;
  return options;
}

TEST(DistributedJoints, AnswerAsOneProcessAndAsTheDefinitionsSay) {
  SCOPED_TRACE(seed_message());
  Random random(stream_of_joined_fibers());
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  std::size_t contacts = 0;
  for (int scene = 0; scene < scenes_of_joined_fibers(); ++scene) {
    const bool has_noise = random.chance(0.2);
    JoinedFibers fibers = random_joined_fibers(random);
    fibers = has_noise ? with_noise(fibers, random) : fibers;
    FiberAssembly assembly = fibers.assembly();
    DistributedFibers mine = scattered_to(own_rank(), assembly, scatter(assembly, 3, random));
    const int adopted = random.integer(0, 4);
    const int scattered_anew = random.integer(1, 6);
    for (int frame = 0; frame < 3; ++frame) {
      const std::string trace = fibers.name + (has_noise ? ", noisy, scene " : ", scene ") +
                                std::to_string(scene) + ", frame " + std::to_string(frame);
      SCOPED_TRACE(trace);
      if (frame > 0) {
        fibers = bent(fibers, random);
        assembly.update_points(fibers.points);
      }
      if (frame == scattered_anew) {
        mine = scattered_to(own_rank(), assembly, scatter(assembly, 3, random));
      }
      follow(assembly, mine);
      engine.update(mine.parts, mine.names, mine.topology);
      if (frame == adopted) {
        mine = engine.adopt();
      }
      for (const QueryType type : {QueryType::ALL, QueryType::CLOSEST, QueryType::LIMITED,
                                   QueryType::FIBER_PAIRS, QueryType::FIRST}) {
        QueryOptions options = draw_joined_options(random);
        options.type = type;
        options.max_contacts = static_cast<std::uint32_t>(random.integer(1, 20));
        if (type != QueryType::ALL && random.chance(0.3)) {
          options.margin = std::numeric_limits<double>::infinity();
        }
        SCOPED_TRACE(skips_of(options) + ", margin " + std::to_string(options.margin) +
                     ", pairing " + std::to_string(static_cast<int>(options.pairing)) + ", type " +
                     std::to_string(static_cast<int>(type)));
        const DistributedResult found = answer(engine, options);
        ASSERT_TRUE(found.complete);
        const QueryResult expected = answer("run_tree", assembly, options);
        if (type == QueryType::FIRST) {
          ASSERT_EQ(over_ranks(found.contacts.size(), MPI_SUM), expected.contacts.size());
          continue;
        }
        ASSERT_TRUE(same_as_one_process(found, expected.contacts));
        ASSERT_EQ(found.limit_reached, expected.limit_reached);
        if (type == QueryType::ALL && !has_noise) {
          ASSERT_TRUE(are_those(expected.contacts, true_contacts(fibers, options)));
        }
        contacts += expected.contacts.size();
      }
    }
  }
  expect_enough(contacts, std::size_t{1000});
}

TEST(DistributedJoints, InMotionsAreThoseOfOneProcess) {
  SCOPED_TRACE(seed_message());
  Random random(stream_of_joined_fibers());
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  std::size_t contacts = 0;
  for (int scene = 0; scene < scenes_of_joined_fibers(); ++scene) {
    const JoinedFibers fibers = random_joined_fibers(random);
    SCOPED_TRACE(fibers.name + ", scene " + std::to_string(scene));
    FiberAssembly before = fibers.assembly();
    const std::vector<ScatteredPart> scattered = scatter(before, 3, random);
    for (int frame = 0; frame < 2; ++frame) {
      FiberAssembly after = before;
      after.update_points(shaken(fibers, random).points);
      const DistributedFibers from = scattered_to(own_rank(), before, scattered);
      const DistributedFibers to = scattered_to(own_rank(), after, scattered);
      engine.update_motion(from.parts, to.parts, from.names, from.topology);
      MotionOptions options;
      options.margin = random.uniform(0.0, 0.3);
      if (random.chance(0.5)) {
        options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 3));
      }
      options.pairing = static_cast<Pairing>(std::max(0, random.integer(-2, 2)));
      DistributedMotionResult found;
      engine.query_motion(options, found);
      const auto one = make_engine("run_tree", one_thread());
      one->update_motion(before, after);
      MotionResult expected;
      one->query_motion(options, expected);
      ASSERT_TRUE(same_as_one_process(found.contacts, expected.contacts)) << "frame " << frame;
      ASSERT_TRUE(same_as_one_process(found.touching, expected.touching)) << "frame " << frame;
      contacts += expected.contacts.size() + expected.touching.size();
      before = after;
    }
  }
  expect_enough(contacts, std::size_t{100});
}

/// One rank brings all, as an assembly that is closed and joined itself.
TEST(DistributedJoints, MayBeThoseOfTheParts) {
  SCOPED_TRACE(seed_message());
  Random random(stream_of_joined_fibers());
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  for (int scene = 0; scene < rounds(10); ++scene) {
    const FiberAssembly fibers = random_joined_fibers(random).assembly();
    std::vector<FiberPart> names;
    for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      names.push_back({name_of_fiber(fiber), 0});
    }
    const bool brings_all = own_rank() == rank_count() - 1;
    engine.update(brings_all ? fibers : FiberAssembly(),
                  brings_all ? names : std::vector<FiberPart>());
    const QueryOptions options = within(0.3);
    ASSERT_TRUE(
        same_as_one_process(answer(engine, options), answer("run_tree", fibers, options).contacts));
  }
}

/// Rings that are far from each other.
TEST(DistributedJoints, AreKnownWholeWhereTheyAreOwned) {
  JoinedFibers rings;
  for (int i = 0; i < 70; ++i) {
    rings.add(moved(circle(50), {4.0 * i, 0.0, 0.0}), 0.01, true);
  }
  const FiberAssembly fibers = rings.assembly();
  Random random;
  const DistributedFibers mine = scattered_to(own_rank(), fibers, scatter(fibers, 3, random));
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  engine.update(mine.parts, mine.names, mine.topology);
  const DistributedFacts facts = engine.facts();
  EXPECT_GE(facts.joined_segments, facts.own_segments);
  // The split cuts through few rings.
  EXPECT_LE(over_ranks(facts.joined_segments, MPI_SUM),
            fibers.segment_count() + 50 * 4 * static_cast<std::size_t>(rank_count() - 1));
  // Chains cost nothing, nor do numbers that one point alone has.
  const auto rank = static_cast<std::uint64_t>(own_rank());
  engine.update(FiberAssembly({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 3}, {0.1}), {{rank, 0}},
                {{}, {-1, own_rank(), -1}, {}});
  EXPECT_EQ(engine.facts().joined_segments, 0U);
}

/// What is thrown on this rank; all ranks must throw the same.
std::string error_on_all(const std::function<void()>& work) {
  const std::string error = error_in(work);
  const Communicator ranks(MPI_COMM_WORLD);
  std::vector<char> text(error.begin(), error.end());
  text = ranks.broadcast(std::move(text));
  EXPECT_EQ(error, std::string(text.begin(), text.end())) << "rank " << own_rank();
  return error;
}

/// A ring of four points and a chain that is joined with its third one; each rank has a part.
struct RingAndChain {
  std::vector<Vector3d> ring{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}};
  std::vector<std::int32_t> ring_joints{-1, -1, 8, -1, -1};
  std::vector<std::uint8_t> closed{1, 1};
  std::int32_t middle_joint = 8;  // of the point where the two halves meet, in the second one
  Vector3d start{1, 1, 0};        // of the chain

  /// The first half of the ring is rank 0's, the second one the last rank's, the chain rank 1's.
  DistributedFibers of_rank() const {
    std::vector<Vector3d> points;
    std::vector<std::uint32_t> offsets{0};
    DistributedFibers mine;
    const auto add = [&](std::uint64_t fiber, std::uint64_t first,
                         const std::vector<Vector3d>& more, const std::vector<std::int32_t>& joints,
                         std::uint8_t is_closed) {
      points.insert(points.end(), more.begin(), more.end());
      offsets.push_back(static_cast<std::uint32_t>(points.size()));
      mine.names.push_back({fiber, first});
      mine.topology.closed.push_back(is_closed);
      mine.topology.joints.insert(mine.topology.joints.end(), joints.begin(), joints.end());
    };
    if (own_rank() == 0) {
      add(5, 0, {ring.begin(), ring.begin() + 3}, {ring_joints.begin(), ring_joints.begin() + 3},
          closed[0]);
    }
    if (own_rank() == rank_count() - 1) {
      add(5, 2, {ring.begin() + 2, ring.end()}, {middle_joint, -1, ring_joints.back()}, closed[1]);
    }
    if (own_rank() == std::min(1, rank_count() - 1)) {
      add(9, 0, {start, {2, 2, 0}, {3, 2, 0}}, {8, -1, -1}, 0);
    }
    if (!points.empty()) {
      mine.parts = FiberAssembly(std::move(points), std::move(offsets), {0.01});
    }
    return mine;
  }

  std::string error() const {
    const DistributedFibers mine = of_rank();
    DistributedEngine engine(MPI_COMM_WORLD, one_thread());
    const std::string found =
        error_on_all([&] { engine.update(mine.parts, mine.names, mine.topology); });
    DistributedResult result;
    if (!found.empty()) {
      EXPECT_THROW(engine.query({}, result), std::logic_error) << "no fibres after an error";
    }
    return found;
  }
};

testing::AssertionResult ends_with(const std::string& text, const std::string& end) {
  if (text.size() >= end.size() && text.substr(text.size() - end.size()) == end) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "the error is: " << text;
}

TEST(DistributedJoints, ThatAreWrongEndOnAllRanksWithOneError) {
  EXPECT_EQ(RingAndChain().error(), "");
  RingAndChain fibers;
  fibers.start = {1, 1, 0.25};
  EXPECT_TRUE(ends_with(fibers.error(),
                        "joint 8: fibre 5, point 2 and fibre 9, point 0 are 0.25 m apart; points "
                        "that are joined must lie within 0.01 m, the largest radius that meets "
                        "there or 1e-6 of the largest coordinate"));
  fibers = {};
  fibers.ring.back() = {0, 0, 0.001};
  EXPECT_TRUE(ends_with(fibers.error(),
                        "fibre 5: is closed, and its first point is repeated 0.001 m away; repeat "
                        "it where it is, or leave it out"));
  fibers = {};
  fibers.ring_joints.back() = 3;
  EXPECT_TRUE(ends_with(fibers.error(),
                        "fibre 5: is closed, and its first point is in no joint, but where it is "
                        "repeated as the last one in joint 3"));
  fibers = {};
  fibers.middle_joint = -1;
  EXPECT_TRUE(ends_with(fibers.error(), "fibre 5, point 2: rank 0 has it in joint 8, rank " +
                                            std::to_string(rank_count() - 1) + " in no joint"));
  fibers = {};
  fibers.closed[1] = 0;
  EXPECT_TRUE(ends_with(fibers.error(), " has a part of it as closed, rank " +
                                            std::to_string(rank_count() - 1) + " as open"));
}

/// The parts are called as before, and joined in another way.
TEST(DistributedJoints, MayChangeFromUpdateToUpdate) {
  const DistributedFibers mine = RingAndChain().of_rank();
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  const auto contacts_with = [&](const FiberTopology& topology) {
    engine.update(mine.parts, mine.names, topology);
    return over_ranks(answer(engine, within(0.01)).contacts.size(), MPI_SUM);
  };
  EXPECT_EQ(contacts_with(mine.topology), 0U);
  EXPECT_EQ(contacts_with({mine.topology.closed, {}, {}}), 2U) << "the chain touches the ring";
  EXPECT_EQ(contacts_with({{}, mine.topology.joints, {}}), 1U) << "the ring touches itself";
  EXPECT_EQ(contacts_with({}), 3U);
  EXPECT_EQ(contacts_with(mine.topology), 0U);
}

TEST(DistributedJoints, OfAFiberOfTwoPointsAreRefused) {
  DistributedFibers mine;
  if (own_rank() == rank_count() - 1) {
    mine.parts = FiberAssembly({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {0, 3}, {0.01});
    mine.names = {{7, 0}};
    mine.topology.closed = {1};
  }
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  EXPECT_TRUE(ends_with(error_on_all([&] { engine.update(mine.parts, mine.names, mine.topology); }),
                        "fibre 7: is closed and has 2 points, a closed fibre needs at least 3"));
}

TEST(DistributedJoints, OfOtherPartsThanOneRankSaysAreRefused) {
  const bool is_wrong = own_rank() == rank_count() - 1;
  DistributedFibers mine = RingAndChain().of_rank();
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  const auto error_with = [&](const FiberTopology& topology) {
    return error_on_all([&] { engine.update(mine.parts, mine.names, topology); });
  };
  FiberTopology topology = mine.topology;
  if (is_wrong) {
    topology.joints.push_back(1);
  }
  EXPECT_NE(error_with(topology).find("the topology's joints has "), std::string::npos);
  topology = mine.topology;
  if (is_wrong) {
    topology.closed.push_back(1);
  }
  EXPECT_NE(error_with(topology).find("the topology's closed has "), std::string::npos);
  topology = mine.topology;
  topology.joint_tolerance = is_wrong ? -1.0 : 0.1;
  EXPECT_TRUE(ends_with(error_with(topology), "joint_tolerance is -1 m, it must be at least 0"));
  if (rank_count() > 1) {
    topology.joint_tolerance = is_wrong ? 0.2 : 0.1;
    EXPECT_EQ(error_with(topology), "joint_tolerance is not the same on all ranks, it must be");
  }
}

TEST(DistributedJoints, ThatComeApartInAMotionAreRefused) {
  const DistributedFibers before = RingAndChain().of_rank();
  RingAndChain fibers;
  fibers.start = {1, 1, 0.25};
  const DistributedFibers after = fibers.of_rank();
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  EXPECT_TRUE(ends_with(error_on_all([&] {
                          engine.update_motion(before.parts, after.parts, before.names,
                                               before.topology);
                        }),
                        "the largest radius that meets there or 1e-6 of the largest coordinate"));
}

}  // namespace
}  // namespace fiber::test
