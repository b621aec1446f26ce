// The text of the running node encloses the exact answers, whatever it is asked for and whatever is
// unknown.
#include <set>

#include "fiber_proximity/ApplyObstacles.h"
#include "test/ros/answer_claims.hpp"
#include "test/ros/answer_text_fixture.hpp"
#include "test/support/random.hpp"

namespace {

using answer_claims::Claims;
using answer_claims::claims_of;
using answer_claims::infinity;
using fiber::FiberAssembly;
using fiber_proximity::FiberArray;
using fiber_proximity::ProximityConfig;
using node_test::set_parameters;
using test_messages::fiber_array;
using test_messages::header;

/// What is true of a question about pairs.
struct Truth {
  std::vector<fiber::Contact> pairs;  // all there are
  std::size_t contacts = 0;  // pairs within the margin, of bodies where these are asked for
};

/// @param ask for the pairs that are within the margin
template <class Ask>
Truth truth_of(fiber::QueryOptions options, const Ask& ask) {
  options.kernel = fiber::Kernel::EXACT;
  Truth truth;
  const bool is_of_bodies = options.type == fiber::QueryType::FIBER_PAIRS;
  options.type = fiber::QueryType::ALL;
  std::set<std::pair<std::uint32_t, std::uint32_t>> bodies;
  const std::vector<fiber::Contact> within = ask(options).contacts;
  for (const fiber::Contact& contact : within) {
    bodies.emplace(contact.fiber_a, contact.fiber_b);
  }
  truth.contacts = is_of_bodies ? bodies.size() : within.size();
  options.margin = infinity;
  truth.pairs = ask(options).contacts;
  return truth;
}

void expect_true(const std::string& line, const Truth& truth) {
  const Claims claims = claims_of(line);
  EXPECT_LE(claims.min_contacts, truth.contacts) << line;
  EXPECT_GE(claims.max_contacts, truth.contacts) << line;
  const auto closest = std::min_element(truth.pairs.begin(), truth.pairs.end(), fiber::closer);
  if (closest == truth.pairs.end()) {
    EXPECT_EQ(claims.minimum_upper, infinity) << line;
    return;
  }
  EXPECT_LE(claims.minimum_lower, closest->upper) << line;
  EXPECT_GE(claims.minimum_upper, closest->lower) << line;
  const auto nearer = std::count_if(
      truth.pairs.begin(), truth.pairs.end(),
      [&claims](const fiber::Contact& pair) { return pair.upper < claims.others_lower; });
  EXPECT_LE(static_cast<std::size_t>(nearer), claims.min_contacts) << line;
}

/// The objects of answer_text.test.
FiberAssembly objects() {
  const Eigen::Vector3d ball(0.3, 0.1, -0.2);
  const Eigen::Vector3d bead(-0.5, 0.2, 0.4);
  return {{ball, ball, bead, bead}, {0, 2, 4}, {0.2, 0.05}};
}

/// Adds an object that is nowhere, which nothing is known of then, or takes it away.
void place_ghost(bool is_there) {
  fiber_proximity::ApplyObstacles call;
  call.request.obstacles = {test_messages::ball("ghost", 0.0, 0.1, "nowhere")};
  if (!is_there) {
    call.request.obstacles[0].operation = fiber_proximity::Obstacle::REMOVE;
  }
  ASSERT_TRUE(node_test::call_service("/proximity/apply_obstacles", call));
  EXPECT_FALSE(call.response.success) << "there is no such frame, and never was such an object";
}

ProximityConfig random_settings(fiber::test::Random& random, ProximityConfig config) {
  const std::vector<std::string> types{"first", "closest", "limited", "all", "fiber_pairs"};
  const auto some = [&random](double chance, double lowest, double highest) {
    return random.chance(chance) ? std::pow(10.0, random.uniform(lowest, highest)) : 0.0;
  };
  config.query_type = types[static_cast<std::size_t>(random.integer(0, 4))];
  config.margin = some(0.8, -3.0, 0.3);
  config.max_contacts = random.integer(1, 30);
  config.kernel = random.chance(0.3) ? "exact" : "robust";
  config.tolerance = some(0.4, -6.0, -0.5);
  config.relative_tolerance = some(0.3, -4.0, 0.0);
  config.deadline = some(0.4, -9.0, -3.0);
  config.minimum_distance = random.chance(0.8);
  config.contact_limit = random.chance(0.2) ? random.integer(1, 50) : 0;
  config.pair_limit = random.chance(0.2) ? random.integer(1, 300) : 0;
  return config;
}

fiber::QueryOptions question_of(const ProximityConfig& config) {
  fiber::QueryOptions options;
  options.type = fiber::query_type_from_name(config.query_type);
  options.margin = config.margin;
  return options;
}

FiberArray random_fibers(fiber::test::Random& random) {
  const FiberAssembly walks = fiber::test::walks(
      random, random.integer(1, 6), random.integer(1, 12), random.uniform(0.01, 0.3), 0.0);
  FiberArray message = fiber_array(header("world"), walks.points());
  message.offsets = walks.offsets();
  message.radii = {random.uniform(0.0, 0.03)};
  return message;
}

class AnswerTruthTest : public node_test::AnswerTextTest {};

// The rope that is far away counts, too: what is told is held against all that ~fibers has.
TEST_F(AnswerTruthTest, WhatIsToldEnclosesTheExactAnswer) {
  int frames = 0;
  ASSERT_TRUE(ros::param::get("~frames", frames));
  send_rope();
  fiber::test::Random random;
  bool has_ghost = false;
  int cut_off = 0;
  int doubtful = 0;
  for (int frame = 0; frame < frames && !HasFailure(); ++frame) {
    SCOPED_TRACE("frame " + std::to_string(frame) + ", " + fiber::test::seed_message());
    if (random.chance(0.05)) {
      has_ghost = !has_ghost;
      place_ghost(has_ghost);
    }
    const ProximityConfig config = random_settings(random, shown());
    set_parameters(config);
    const std::vector<std::string> lines = lines_about(random_fibers(random));
    const FiberArray* const sent = fibers.wait_for(stamp_);
    ASSERT_NE(sent, nullptr);
    const FiberAssembly about = node_test::to_assembly(*sent);
    expect_true(lines[0], truth_of(question_of(config), [&](const fiber::QueryOptions& options) {
                  return fiber::test::brute_force(about, options);
                }));
    expect_true(lines[1], truth_of(question_of(config), [&](const fiber::QueryOptions& options) {
                  return fiber::test::brute_force(objects(), about, options);
                }));
    if (has_ghost) {
      const Claims claims = claims_of(lines[1]);
      EXPECT_EQ(claims.minimum_lower, -infinity) << lines[1];
      EXPECT_EQ(claims.max_contacts, Claims().max_contacts) << lines[1];
    }
    cut_off += static_cast<int>(lines[0].find("cut off") != std::string::npos);
    doubtful += static_cast<int>(lines[0].find(", true >= ") != std::string::npos);
    forget();
  }
  place_ghost(false);
  fiber::test::expect_enough(cut_off, frames / 10);
  fiber::test::expect_enough(doubtful, frames / 10);
}

}  // namespace
