#include <gtest/gtest.h>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/support/error_of.hpp"

namespace fiber {
namespace {

using Names = std::vector<std::string>;

TEST(FiberNamesTest, NumbersInOrderAreIndices) {
  EXPECT_TRUE(FiberNames().are_indices());
  EXPECT_TRUE(FiberNames(Names{}).are_indices());
  EXPECT_TRUE(FiberNames({"0", "1", "2"}).are_indices());
  EXPECT_EQ(FiberNames({"0", "1", "2"}), FiberNames());
  for (const Names& names : {Names{"1", "0"}, Names{"0", "01"}, Names{"0", "2"}, Names{"a"}}) {
    const FiberNames made(names);
    EXPECT_FALSE(made.are_indices());
    EXPECT_NE(made, FiberNames());
    EXPECT_EQ(made, FiberNames(names));
    EXPECT_EQ(made.list(made.size()), names);
  }
  EXPECT_EQ(FiberNames().of(12), "12");
  EXPECT_EQ(FiberNames().list(2), (Names{"0", "1"}));
}

TEST(FiberNamesTest, SomeOfThem) {
  const FiberNames names({"rope", "tube", "wire"});
  EXPECT_EQ(names.select({2, 0}).list(2), (Names{"wire", "rope"}));
  EXPECT_EQ(FiberNames().select({2, 0}).list(2), (Names{"2", "0"}));
  EXPECT_TRUE(FiberNames().select({0, 1}).are_indices());
}

TEST(FiberNamesTest, RefusesWhatIsNoName) {
  const auto error = [](const Names& names) {
    return test::error_of([&] { FiberNames made(names); });
  };
  const std::string rule = "; names are of one line of 1 to 4096 bytes, and each is another one";
  EXPECT_EQ(error({"a", ""}), "fibre 1: the name '' is empty" + rule);
  EXPECT_EQ(error({"a", "b\nc"}), "fibre 1: the name 'b\\nc' has several lines" + rule);
  EXPECT_EQ(error({"a", "b", "a"}), "fibre 2: the name 'a' is that of another, too" + rule);
  EXPECT_NE(error({std::string(4097, 'a')}).find("is too long"), std::string::npos);
  EXPECT_EQ(FiberNames({std::string(4096, 'a')}).size(), 1U);
}

}  // namespace
}  // namespace fiber
