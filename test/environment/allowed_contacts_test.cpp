#include "fiber_proximity/environment/allowed_contacts.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"

namespace fiber {
namespace {

using test::error_of;
using Change = AllowedContacts::Change;

NamedPair pair(const std::string& object, const std::string& fiber,
               const std::vector<std::int32_t>& segments = {}) {
  return {object, fiber, segments};
}

Change allow(const std::vector<NamedPair>& pairs) { return {false, {}, pairs}; }

TEST(AllowedContacts, NamesBecomeTheIndicesOfTheFibresThereAre) {
  AllowedContacts contacts;
  contacts.apply(allow({pair("gripper", "left", {-3, -1}), pair("", "right"), pair("table", ""),
                        pair("cloud", "absent")}));
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
  contacts.apply(allow({pair("gripper", "left"), pair("gripper", "left")}));
  contacts.apply(allow({pair("gripper", "left")}));
  EXPECT_EQ(contacts.pairs().size(), 1U);
}

TEST(AllowedContacts, AResetComesFirstAndThenWhatIsTakenBack) {
  AllowedContacts contacts;
  contacts.apply(allow({pair("gripper", "left"), pair("gripper", "left", {0, 4})}));
  Change change;
  change.forbid = {pair("gripper", "left")};
  change.allow = {pair("table", "left")};
  contacts.apply(change);
  ASSERT_EQ(contacts.pairs().size(), 2U);
  EXPECT_EQ(contacts.pairs()[0].segments, (std::vector<std::int32_t>{0, 4}));
  EXPECT_EQ(contacts.pairs()[1].object, "table");
  change = allow({pair("gripper", "right")});
  change.reset = true;
  contacts.apply(change);
  ASSERT_EQ(contacts.pairs().size(), 1U);
  EXPECT_EQ(contacts.pairs()[0].fiber, "right");
}

TEST(AllowedContacts, ABadPairChangesNothing) {
  AllowedContacts contacts;
  contacts.apply(allow({pair("gripper", "left")}));
  const auto error_with = [&contacts](const NamedPair& bad) {
    Change change = allow({pair("table", "left"), bad});
    change.reset = true;
    return error_of([&] { contacts.apply(change); });
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
  contacts.apply(allow({pair("gripper", "left")}));
  Change change;
  change.allow = {pair("table", "left")};
  change.forbid = {pair("gripper", "left", {0, -1})};
  EXPECT_EQ(error_of([&] { contacts.apply(change); }),
            "pair of object 'gripper' and fiber 'left', segments [0, -1]: it is not allowed, so it "
            "cannot be taken back");
  ASSERT_EQ(contacts.pairs().size(), 1U);
  EXPECT_EQ(contacts.pairs()[0].object, "gripper");
}

}  // namespace
}  // namespace fiber
