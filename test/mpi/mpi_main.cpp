// All ranks run all tests, in the same order; rank 0 tells how they went, the others what failed
// there.
#include <gtest/gtest.h>
#include <mpi.h>

#include <cstdio>

namespace {

class FailuresOfRank : public testing::EmptyTestEventListener {
 public:
  explicit FailuresOfRank(int rank) : rank_(rank) {}

 private:
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.failed()) {
      std::fprintf(stderr, "rank %d: %s:%d: %s\n", rank_, result.file_name(), result.line_number(),
                   result.summary());
    }
  }

  const int rank_;
};

}  // namespace

int main(int argc, char** argv) {
  int support = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &support);
  testing::InitGoogleTest(&argc, argv);
  // What one rank throws ends it, and with it all; the others would wait for it.
  testing::GTEST_FLAG(catch_exceptions) = false;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != 0) {
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresOfRank(rank));
  }
  const int failed = RUN_ALL_TESTS();
  MPI_Finalize();
  return failed;
}
