#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/CheckFibers.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

/// How complete the services of the running node say that their answers are.
namespace unknown_test {

using fiber_proximity::CheckFibers;
using fiber_proximity::FiberArray;
using fiber_proximity::QueryProximity;
using test_messages::header;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How complete an answer says that it is.
struct Verdict {
  bool is_complete;
  bool is_free;  // or has bounds that exclude anything near
  std::vector<std::string> unknown;

  bool names(const std::string& what) const {
    return std::any_of(unknown.begin(), unknown.end(), [&what](const std::string& text) {
      return text.rfind(what + " since ", 0) == 0;
    });
  }
};

/// The sources that an answer depends on.
enum class About { NOTHING, FIBERS, ENVIRONMENT, BOTH };

inline CheckFibers::Response check(bool with_fibers, bool with_environment, bool moves) {
  CheckFibers service;
  service.request.ignore_fibers = !with_fibers;
  service.request.ignore_environment = !with_environment;
  FiberArray candidate = test_messages::fiber_array(header("world"), {{0, 20, 0}, {0, 20, 1}});
  candidate.radii = {0.01};
  service.request.candidates.assign(moves ? 2 : 1, candidate);
  if (moves) {
    service.request.waypoint_offsets = {0, 2};
  }
  EXPECT_TRUE(node_test::call_service("/proximity/check_fibers", service));
  return service.response;
}

inline QueryProximity::Response query(std::uint8_t against) {
  QueryProximity service;
  service.request.against = against;
  service.request.type = QueryProximity::Request::ALL;
  service.request.margin = 0.1;
  service.request.shapes.resize(1);
  service.request.shapes[0].points.resize(1);
  service.request.shapes[0].points[0].y = 20.0;
  EXPECT_TRUE(node_test::call_service("/proximity/query", service));
  return service.response;
}

/// Asks the services, and adds what they say by what they were asked.
inline void ask_services(std::map<std::string, std::pair<About, Verdict>>& verdicts) {
  for (const bool moves : {false, true}) {
    const std::string what = moves ? "check_motions " : "check ";
    for (const About about : {About::NOTHING, About::FIBERS, About::ENVIRONMENT, About::BOTH}) {
      const bool with_fibers = about == About::FIBERS || about == About::BOTH;
      const bool with_environment = about == About::ENVIRONMENT || about == About::BOTH;
      const CheckFibers::Response answer = check(with_fibers, with_environment, moves);
      Verdict verdict{false, false, answer.unknown};
      if (answer.success) {
        EXPECT_TRUE(answer.contacts.empty());
        EXPECT_EQ(answer.decided, answer.free) << "it touches nothing that is known";
        verdict.is_complete = answer.complete[0] != 0;
        verdict.is_free = answer.free[0] != 0;
      } else {
        EXPECT_NE(answer.message.find("no fresh input"), std::string::npos) << answer.message;
        EXPECT_TRUE(with_fibers && answer.free.empty());
        continue;  // it has answered nothing
      }
      verdicts.emplace(what + std::to_string(static_cast<int>(about)),
                       std::make_pair(about, verdict));
    }
  }
  const std::pair<std::uint8_t, About> queries[] = {
      {QueryProximity::Request::FIBERS, About::FIBERS},
      {QueryProximity::Request::ENVIRONMENT, About::ENVIRONMENT},
      {QueryProximity::Request::EVERYTHING, About::BOTH}};
  for (const auto& [against, about] : queries) {
    const QueryProximity::Response answer = query(against);
    if (answer.success) {
      verdicts.emplace(
          "query " + std::to_string(against),
          std::make_pair(about, Verdict{answer.complete != 0, answer.minimum_lower[0] > -infinity,
                                        answer.unknown}));
    }
  }
}

}  // namespace unknown_test
