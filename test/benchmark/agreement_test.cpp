#include "benchmark/agreement.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace fiber::test {
namespace {

Contact some_contact() {
  Contact contact;
  contact.fiber_a = 1;
  contact.segment_a = 2;
  contact.fiber_b = 3;
  contact.segment_b = 4;
  contact.s = 0.25;
  contact.t = 0.75;
  contact.distance = -0.001;
  contact.point_a = contact.point_b = contact.normal = Eigen::Vector3d::Zero();
  return contact;
}

void answer(Agreement& agreement, const std::string& name, const std::vector<Contact>& contacts) {
  agreement.next().contacts = contacts;
  agreement.check(name);
}

TEST(Agreement, IsThereWhileAnswersAreTheSame) {
  Agreement agreement;
  for (std::uint32_t frame = 1; frame < 4; ++frame) {
    agreement.begin_frame(frame);
    for (const char* const name : {"one", "other", "third"}) {
      answer(agreement, name, std::vector<Contact>(frame, some_contact()));
    }
  }
  EXPECT_EQ(agreement.disagreement(), "") << "frames may differ";
}

TEST(Agreement, EndsWithAnyBitOfAContact) {
  const std::vector<std::function<void(Contact&)>> changes{
      [](Contact& contact) { ++contact.segment_b; },
      [](Contact& contact) { contact.distance += 1e-18; },
      [](Contact& contact) { contact.s += 1e-16; },
      [](Contact& contact) { contact.t += 2e-16; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    SCOPED_TRACE(i);
    Contact changed = some_contact();
    changes[i](changed);
    Agreement agreement;
    agreement.begin_frame(7);
    answer(agreement, "one", {some_contact()});
    answer(agreement, "other", {changed});
    EXPECT_EQ(agreement.disagreement(), "frame 7: the pairs of one (1) and other (1) differ");
  }
}

TEST(Agreement, NamesTheFirstToDiffer) {
  Agreement agreement;
  agreement.begin_frame(2);
  answer(agreement, "one", {some_contact()});
  answer(agreement, "other", {some_contact()});
  answer(agreement, "third", {});
  answer(agreement, "last", {some_contact()});
  EXPECT_EQ(agreement.disagreement(), "frame 2: the pairs of other (1) and third (0) differ");
}

}  // namespace
}  // namespace fiber::test
