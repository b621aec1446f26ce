// Work that is scattered out is done once, whatever ranks do with it.
#include "src/mpi/work_queue.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "test/mpi/scattered_fibers.hpp"

namespace fiber::test {
namespace {

constexpr std::uint64_t first_number = 5;

/// Who has done what.
class DealtNumbers {
 public:
  explicit DealtNumbers(std::uint64_t count) : done_(count) {}

  WorkRange all() const { return {first_number, first_number + done_.size()}; }

  void note(const WorkRange& range) {
    for (std::uint64_t number = range.begin; number < range.end; ++number) {
      ++done_.at(number - first_number);
    }
  }

  /// How many this rank has done.
  int own() const { return std::accumulate(done_.begin(), done_.end(), 0); }

  /// Collective.
  void expect_each_once() const {
    std::vector<int> all(done_.size());
    MPI_Allreduce(done_.data(), all.data(), static_cast<int>(all.size()), MPI_INT, MPI_SUM,
                  MPI_COMM_WORLD);
    EXPECT_EQ(all, std::vector<int>(all.size(), 1));
  }

 private:
  std::vector<int> done_;
};

TEST(WorkQueue, EachNumberIsDoneOnce) {
  const Communicator ranks(MPI_COMM_WORLD);
  for (const std::uint64_t count : {0, 1, 2, 3, 6, 100, 1000}) {
    for (const std::uint64_t max_chunk : {1, 7, 64}) {
      SCOPED_TRACE(std::to_string(count) + " numbers, at most " + std::to_string(max_chunk));
      DealtNumbers numbers(count);
      std::uint64_t shown = first_number;
      WorkQueue work{numbers.all(), max_chunk};
      work.work = [&](const WorkRange& range, const std::vector<char>& packed) {
        EXPECT_LT(range.begin, range.end);
        EXPECT_LE(range.end - range.begin, max_chunk);
        EXPECT_TRUE(packed.empty());
        numbers.note(range);
      };
      work.show = [&](std::uint64_t end) {
        EXPECT_GE(end, shown);
        shown = end;
      };
      run_work_queue(ranks, work);
      numbers.expect_each_once();
      EXPECT_EQ(shown, own_rank() == 0 ? numbers.all().end : first_number);
    }
  }
}

TEST(WorkQueue, SlowRanksLeaveNothingUndone) {
  const Communicator ranks(MPI_COMM_WORLD);
  for (int slow = 0; slow < rank_count(); ++slow) {
    SCOPED_TRACE("rank " + std::to_string(slow) + " is slow");
    DealtNumbers numbers(40);
    WorkQueue work{numbers.all(), 4};
    work.work = [&](const WorkRange& range, const std::vector<char>&) {
      if (own_rank() == slow) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      numbers.note(range);
    };
    run_work_queue(ranks, work);
    numbers.expect_each_once();
  }
}

TEST(WorkQueue, OthersDoWhatARankHasNoTimeFor) {
  const Communicator ranks(MPI_COMM_WORLD);
  const Communicator signals(MPI_COMM_WORLD);
  const int last = rank_count() - 1;
  if (last == 0) {
    return;
  }
  // The last rank goes on with its first number only once all have been scattered out.
  bool has_waited = false;
  const auto wait = [&] {
    if (own_rank() == last && !has_waited) {
      MPI_Recv(nullptr, 0, MPI_BYTE, 0, 0, signals.handle(), MPI_STATUS_IGNORE);
      has_waited = true;
    }
  };
  DealtNumbers numbers(50);
  WorkQueue work{numbers.all(), 1};
  work.work = [&](const WorkRange& range, const std::vector<char>&) {
    wait();
    numbers.note(range);
  };
  bool has_told = false;
  work.show = [&](std::uint64_t end) {
    if (end == numbers.all().end && !has_told) {
      MPI_Send(nullptr, 0, MPI_BYTE, last, 0, signals.handle());
      has_told = true;
    }
  };
  run_work_queue(ranks, work);
  wait();  // if the others were faster than it could ask for any
  numbers.expect_each_once();
  if (own_rank() == last) {
    EXPECT_LE(numbers.own(), 2);
  }
}

/// Longer for some ranges than for others, nothing for a few.
std::string letters_of(const WorkRange& range) {
  std::string text;
  for (std::uint64_t number = range.begin; number < range.end; ++number) {
    text += std::string(number % 3, static_cast<char>('a' + number % 26));
  }
  return text;
}

TEST(WorkQueue, WhatIsPackedGoesWithItsRange) {
  const Communicator ranks(MPI_COMM_WORLD);
  DealtNumbers numbers(300);
  WorkQueue work{numbers.all(), 16};
  work.pack = [](const WorkRange& range) {
    EXPECT_EQ(own_rank(), 0);
    const std::string text = letters_of(range);
    return std::vector<char>(text.begin(), text.end());
  };
  work.work = [&](const WorkRange& range, const std::vector<char>& packed) {
    EXPECT_EQ(std::string(packed.begin(), packed.end()), own_rank() == 0 ? "" : letters_of(range));
    numbers.note(range);
  };
  run_work_queue(ranks, work);
  numbers.expect_each_once();
}

/// Has one rank fail in an endless work: that it ever gets a number does not depend on the others.
std::string error_of_endless_work(const Communicator& ranks, int failing, bool in_pack) {
  WorkQueue work{{0, UINT64_MAX}, 1};
  work.work = [&](const WorkRange& range, const std::vector<char>&) {
    if (!in_pack && own_rank() == failing) {
      throw std::runtime_error("cannot do " + std::to_string(range.begin / UINT64_MAX));
    }
  };
  if (in_pack) {
    work.pack = [](const WorkRange&) -> std::vector<char> {
      throw std::runtime_error("cannot pack");
    };
  }
  try {
    run_work_queue(ranks, work);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(WorkQueue, TheErrorOfOneRankIsThatOfAll) {
  const Communicator ranks(MPI_COMM_WORLD);
  for (int failing = 0; failing < rank_count(); ++failing) {
    EXPECT_EQ(error_of_endless_work(ranks, failing, false),
              "rank " + std::to_string(failing) + ": cannot do 0");
  }
  if (rank_count() > 1) {
    EXPECT_EQ(error_of_endless_work(ranks, 0, true), "rank 0: cannot pack");
  }
  // Nothing of it is left over.
  DealtNumbers numbers(20);
  WorkQueue work{numbers.all(), 2};
  work.work = [&](const WorkRange& range, const std::vector<char>&) { numbers.note(range); };
  run_work_queue(ranks, work);
  numbers.expect_each_once();
}

}  // namespace
}  // namespace fiber::test
