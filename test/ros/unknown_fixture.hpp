#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <algorithm>
#include <limits>
#include <map>

#include "fiber_proximity/CheckFibers.h"
#include "fiber_proximity/TimeToContact.h"
#include "test/ros/unknown_sources.hpp"

/// What the outputs and services of the running node say while sources fail.
namespace unknown_test {

using fiber_proximity::CheckFibers;
using fiber_proximity::ContactArray;
using fiber_proximity::QueryProximity;
using fiber_proximity::TimeToContact;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What one answer says.
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

/// What an answer depends on.
enum class About { NOTHING, FIBERS, ENVIRONMENT, BOTH };

class UnknownTest : public FailingSources {
 protected:
  UnknownTest() { start(); }

  static CheckFibers::Response check(bool with_fibers, bool with_environment, bool moves) {
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

  static QueryProximity::Response query(std::uint8_t against) {
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

  /// What the services say, by what they were asked.
  void ask_services(std::map<std::string, std::pair<About, Verdict>>& verdicts) const {
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

  /// What the newest message of each output says.
  std::map<std::string, std::pair<About, Verdict>> verdicts() const {
    std::map<std::string, std::pair<About, Verdict>> verdicts;
    const auto of_array = [](const ContactArray& answer) {
      return Verdict{answer.complete != 0, answer.minimum_lower > -infinity, answer.unknown};
    };
    if (!contacts.messages.empty()) {
      verdicts.emplace("contacts",
                       std::make_pair(About::FIBERS, of_array(*contacts.messages.back())));
    }
    if (!around_.messages.empty()) {
      verdicts.emplace("environment_contacts",
                       std::make_pair(About::BOTH, of_array(*around_.messages.back())));
    }
    if (!times_.messages.empty()) {
      const TimeToContact& told = *times_.messages.back();
      const auto of_part = [&told](const fiber_proximity::PredictedContact& part) {
        return Verdict{part.complete != 0, part.time_lower > 0.0, told.unknown};
      };
      verdicts.emplace("time_to_contact",
                       std::make_pair(About::BOTH, Verdict{told.complete != 0, told.complete != 0,
                                                           told.unknown}));
      verdicts.emplace("time_to_contact environment",
                       std::make_pair(About::BOTH, of_part(told.environment)));
      for (const auto* part : {&told.same_fiber, &told.different_fibers}) {
        Verdict verdict = of_part(*part);
        if (verdict.is_complete) {
          verdict.unknown.clear();  // those are of the environment
        }
        verdicts.emplace(part == &told.same_fiber ? "time_to_contact same fibre"
                                                  : "time_to_contact different fibres",
                         std::make_pair(About::FIBERS, verdict));
      }
    }
    if (!statistics.messages.empty()) {
      const fiber_proximity::Statistics& told = *statistics.messages.back();
      verdicts.emplace("statistics",
                       std::make_pair(About::BOTH, Verdict{told.complete != 0, told.complete != 0,
                                                           told.unknown}));
    }
    ask_services(verdicts);
    return verdicts;
  }

  static bool depends(About about, const Source& source) {
    return about == About::BOTH ||
           about == (source.is_of_fibers ? About::FIBERS : About::ENVIRONMENT);
  }

  /// Why the answers are not those of a node that lacks these sources and no others; empty if they
  /// are.
  std::string problem(const std::vector<const Source*>& lacking) const {
    if (contacts.messages.empty() || around_.messages.empty() || times_.messages.empty() ||
        statistics.messages.empty()) {
      return "not all outputs have been heard";
    }
    const auto verdicts = this->verdicts();
    for (const auto& [output, answer] : verdicts) {
      const auto& [about, verdict] = answer;
      bool is_complete = true;
      for (const Source* source : lacking) {
        if (depends(about, *source)) {
          is_complete = false;
          if (!verdict.names(source->name)) {
            return output + " does not say that " + source->name + " is unknown";
          }
        }
      }
      if (verdict.is_complete != is_complete || verdict.is_free != is_complete ||
          verdict.unknown.empty() != is_complete) {
        return output +
               (is_complete ? " is incomplete, for "
                            : " is complete or free without what it is about, for ") +
               (verdict.unknown.empty() ? "nothing" : verdict.unknown.front());
      }
    }
    for (const Source& source : sources_) {
      const bool is_lacking = std::any_of(lacking.begin(), lacking.end(),
                                          [&](const Source* each) { return each == &source; });
      const int level = level_of(source.status);
      if (is_lacking ? level == 0 : level > 0 && source.fault == Fault::NONE) {
        return "/diagnostics has the level " + std::to_string(level) + " for " + source.status;
      }
    }
    return "";
  }

  /// Of the newest report; -1 if there is none.
  int level_of(const std::string& name) const {
    if (!diagnostics_.messages.empty()) {
      for (const auto& status : diagnostics_.messages.back()->status) {
        if (status.name == "proximity: " + name) {
          return status.level;
        }
      }
    }
    return -1;
  }

  /// Goes on until the answers are those, and a while longer.
  void expect(const std::vector<const Source*>& lacking) {
    std::string why;
    ASSERT_TRUE(node_test::wait_for([&] {
      step();
      why = problem(lacking);
      return why.empty();
    })) << why;
    for (int i = 0; i < 10; ++i) {
      step();
      ASSERT_EQ(problem(lacking), "") << "not for good";
    }
  }

  void heal_all() {
    for (Source& source : sources_) {
      source.fault = Fault::NONE;
    }
    expect({});
  }

  node_test::Recorder<ContactArray> around_{node, "/proximity/environment_contacts"};
  node_test::Recorder<TimeToContact> times_{node, "/proximity/time_to_contact"};
  node_test::Recorder<diagnostic_msgs::DiagnosticArray> diagnostics_{node, "/diagnostics"};
};

}  // namespace unknown_test
