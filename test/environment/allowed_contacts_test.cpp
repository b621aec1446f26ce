#include "src/environment/allowed_contacts.hpp"

#include <gtest/gtest.h>

#include "test/support/error_of.hpp"

namespace fiber {
namespace {

using test::error_of;
using Pairs = std::vector<NamedPair>;

NamedPair pair(const std::string& object, const std::string& fiber,
               const std::vector<std::int32_t>& segments = {}) {
  return {object, fiber, segments};
}

void allow(const Pairs& pairs, AllowedContacts& contacts) { contacts.apply(false, {}, pairs); }

TEST(AllowedContacts, NamesBecomeTheIndicesOfTheFibresThereAre) {
  AllowedContacts contacts;
  allow({pair("gripper", "left", {-3, -1}), pair("", "right"), pair("table", ""),
         pair("cloud", "absent")},
        contacts);
  const AllowedPairs pairs = resolve(contacts.pairs(), {"right", "left", "other", "left"});
  ASSERT_EQ(pairs.size(), 4U);
  EXPECT_EQ(pairs[0].object, "gripper");
  EXPECT_EQ(pairs[0].fiber, 1U);
  EXPECT_EQ(pairs[0].first_segment, -3);
  EXPECT_EQ(pairs[0].last_segment, -1);
  EXPECT_EQ(pairs[1].fiber, 3U);
  EXPECT_EQ(pairs[1].first_segment, -3);
  EXPECT_EQ(pairs[2].object, "");
  EXPECT_EQ(pairs[2].fiber, 0U);
  EXPECT_EQ(pairs[2].first_segment, 0);
  EXPECT_EQ(pairs[2].last_segment, -1);
  EXPECT_EQ(pairs[3].object, "table");
  EXPECT_EQ(pairs[3].fiber, AllowedPair::every_fiber);
}

TEST(AllowedContacts, WhatIsAllowedTwiceIsAllowedOnce) {
  AllowedContacts contacts;
  allow({pair("gripper", "left"), pair("gripper", "left")}, contacts);
  allow({pair("gripper", "left")}, contacts);
  EXPECT_EQ(contacts.pairs().size(), 1U);
}

TEST(AllowedContacts, AResetComesFirstAndThenWhatIsTakenBack) {
  AllowedContacts contacts;
  allow({pair("gripper", "left"), pair("gripper", "left", {0, 4})}, contacts);
  contacts.apply(false, {pair("gripper", "left")}, {pair("table", "left")});
  ASSERT_EQ(contacts.pairs().size(), 2U);
  EXPECT_EQ(contacts.pairs()[0].segments, (std::vector<std::int32_t>{0, 4}));
  EXPECT_EQ(contacts.pairs()[1].object, "table");
  contacts.apply(true, {}, {pair("gripper", "right")});
  ASSERT_EQ(contacts.pairs().size(), 1U);
  EXPECT_EQ(contacts.pairs()[0].fiber, "right");
}

TEST(AllowedContacts, ABadPairChangesNothing) {
  AllowedContacts contacts;
  allow({pair("gripper", "left")}, contacts);
  const auto error_with = [&contacts](const NamedPair& bad) {
    return error_of([&] { contacts.apply(true, {}, {pair("table", "left"), bad}); });
  };
  EXPECT_EQ(error_with(pair("table", "right", {1})),
            "pair of object 'table' and fiber 'right', segments [1]: segments must be the first "
            "and the last one, or empty");
  EXPECT_EQ(error_with(pair("table", "right", {2, 1})),
            "pair of object 'table' and fiber 'right', segments [2, 1]: the first segment comes "
            "after the last");
  EXPECT_EQ(error_with(pair("table", "right", {-1, -2})),
            "pair of object 'table' and fiber 'right', segments [-1, -2]: the first segment comes "
            "after the last");
  ASSERT_EQ(contacts.pairs().size(), 1U);
  EXPECT_EQ(contacts.pairs()[0].object, "gripper");
  EXPECT_EQ(error_with(pair("table", "right", {2, -1})), "no error");
  contacts = AllowedContacts();
  allow({pair("gripper", "left")}, contacts);
  EXPECT_EQ(error_of([&] {
              contacts.apply(false, {pair("gripper", "left", {0, -1})}, {pair("table", "left")});
            }),
            "pair of object 'gripper' and fiber 'left', segments [0, -1]: it is not allowed, so it "
            "cannot be taken back");
  ASSERT_EQ(contacts.pairs().size(), 1U);
  EXPECT_EQ(contacts.pairs()[0].object, "gripper");
}

}  // namespace
}  // namespace fiber
