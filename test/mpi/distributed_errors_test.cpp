// What one rank does wrong all ranks are told.
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#include "test/mpi/scattered_fibers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"

namespace fiber::test {
namespace {

template <class Error = std::invalid_argument>
std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expect_error(const std::function<void()>& call, const std::string& text) {
  const std::string error = error_of(call);
  EXPECT_NE(error.find(text), std::string::npos) << error;
}

FiberAssembly stretch(double from, int segments) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    points.emplace_back(from + i, 0.0, 0.0);
  }
  return as_fibers({points}, 0.1);
}

/// Segments 0 to 2 on the first rank, these on the last one. With one rank, both on it.
struct TwoParts {
  TwoParts(double from, std::uint64_t first_segment) {
    AssemblyBuilder builder;
    if (own_rank() == 0) {
      builder.add_fiber(stretch(0.0, 3).points());
      names.push_back({7, 0});
    }
    if (own_rank() == rank_count() - 1) {
      builder.add_fiber(stretch(from, 2).points());
      names.push_back({7, first_segment});
    }
    parts = builder.build({0.1});
  }

  FiberAssembly parts;
  std::vector<FiberPart> names;
};

TEST(DistributedErrors, PartsMustMakeWholeFibres) {
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  const auto update_with = [&](double from, std::uint64_t first_segment) {
    return [&engine, from, first_segment] {
      const TwoParts two(from, first_segment);
      engine.update(two.parts, two.names);
    };
  };
  expect_error(update_with(2.0, 2), "fibre 7: rank " + std::to_string(rank_count() - 1) +
                                        " has a part from segment 2 on, which rank 0 has as well");
  expect_error(update_with(4.0, 4), "has a part from segment 4 on, but no rank has segment 3");
  expect_error(update_with(3.5, 3),
               "fibre 7: the part from segment 3 on starts at (3.5, 0, 0) m, the part before ends "
               "at (3, 0, 0) m, which must be the same");
  // An engine that has refused fibres has none, and takes others.
  const std::string error = error_of<std::logic_error>([&] { answer(engine, within(0.1)); });
  EXPECT_NE(error.find("no fibres yet"), std::string::npos) << error;
  update_with(3.0, 3)();
  EXPECT_EQ(answer(engine, within(0.1)).contacts.size(), 0U);
}

TEST(DistributedErrors, TheErrorOfOneRankIsThatOfAll) {
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  const int last = rank_count() - 1;
  expect_error(
      [&] {
        const std::vector<FiberPart> names(own_rank() == last ? 2 : 0);
        engine.update(own_rank() == last ? stretch(0.0, 3) : FiberAssembly(), names);
      },
      "rank " + std::to_string(last) + ": 2 names for 1 parts");
  const TwoParts two(3.0, 3);
  engine.update(two.parts, two.names);
  expect_error([&] { answer(engine, within(own_rank() == last ? -1.0 : 0.1)); },
               "rank " + std::to_string(last) + ": margin is -1");
  if (rank_count() > 1) {
    expect_error([&] { answer(engine, within(own_rank() == 0 ? 0.2 : 0.1)); },
                 "margin is not the same on all ranks");
    expect_error([&] { gather(MPI_COMM_WORLD, {}, rank_count()); }, "there are ranks 0 to");
  }
}

TEST(DistributedErrors, AnEngineBeforeItsFirstUpdateHasNoFibres) {
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  EXPECT_THROW(answer(engine, within(0.1)), std::logic_error);
}

}  // namespace
}  // namespace fiber::test
