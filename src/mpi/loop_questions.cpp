#include "src/mpi/loop_questions.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "src/query/loop_rule.hpp"

namespace fiber {
namespace {

/// Who owns a fibre from a segment on.
struct OwnedRun {
  GlobalSegment first;
  int rank = 0;
};

bool comes_first(const OwnedRun& x, const OwnedRun& y) { return x.first < y.first; }

/// A bit for each question of the rule: whether a point goes too far.
using Answers = std::uint8_t;
static_assert(loop_question_count <= 8);

SegmentDistance nearest_of(const Capsule& a, const Capsule& b) {
  return segment_distance(a.p0, a.p1, b.p0, b.p1);
}

/// Answers a question by the points of these runs.
Answers answer(const LoopQuestion& question, std::initializer_list<KnownRuns*> known) {
  Answers answers = 0;
  makes_loop_by(question.a, question.b, nearest_of(question.a, question.b),
                [&](int number, const LoopPlace& x, const LoopPlace& y, double limit) {
                  const LoopReach by_x(x, limit);
                  const LoopReach by_y(y, limit);
                  if (std::any_of(known.begin(), known.end(), [&](KnownRuns* runs) {
                        return runs->any_beyond(question, by_x, by_y);
                      })) {
                    answers = static_cast<Answers>(answers | 1U << static_cast<unsigned>(number));
                  }
                  return number == 0;  // whatever others say: so that all questions come
                });
  return answers;
}

bool makes_loop(const LoopQuestion& question, Answers answers) {
  return makes_loop_by(
      question.a, question.b, nearest_of(question.a, question.b),
      [&](int number, const LoopPlace& /*x*/, const LoopPlace& /*y*/, double /*limit*/) {
        return (answers >> static_cast<unsigned>(number) & 1U) != 0;
      });
}

/// Asks for the owners of the fibres that the open questions are about; sorted.
std::vector<OwnedRun> find_owners(const Communicator& ranks, const LocalFibers& own,
                                  const std::vector<LoopQuestion>& questions,
                                  const std::vector<std::size_t>& open) {
  // Each fibre has a rank that knows who owns it.
  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<OwnedRun> notices(size);
  for (const GlobalSegment& first : own.first_ids()) {
    notices[first.fiber % size].push_back({first, ranks.rank()});
  }
  std::vector<OwnedRun> known = joined(ranks.exchange(std::move(notices)));
  std::sort(known.begin(), known.end(), comes_first);

  PerRank<std::uint64_t> fibers(size);
  for (const std::size_t i : open) {
    fibers[questions[i].fiber % size].push_back(questions[i].fiber);
  }
  for (std::vector<std::uint64_t>& some : fibers) {
    std::sort(some.begin(), some.end());
    some.erase(std::unique(some.begin(), some.end()), some.end());
  }
  fibers = ranks.exchange(std::move(fibers));
  PerRank<OwnedRun> replies(size);
  for (std::size_t other = 0; other < size; ++other) {
    for (const std::uint64_t fiber : fibers[other]) {
      auto run = std::lower_bound(known.begin(), known.end(), OwnedRun{{fiber, 0}, 0}, comes_first);
      for (; run != known.end() && run->first.fiber == fiber; ++run) {
        replies[other].push_back(*run);
      }
    }
  }
  std::vector<OwnedRun> owners = joined(ranks.exchange(std::move(replies)));
  std::sort(owners.begin(), owners.end(), comes_first);
  return owners;
}

/// The ranks that own points from the start of segment a + 1 to that of segment b.
std::vector<int> ranks_between(const std::vector<OwnedRun>& owners, const LoopQuestion& question) {
  std::vector<int> ranks;
  auto run =
      std::upper_bound(owners.begin(), owners.end(), OwnedRun{question.first(), 0}, comes_first);
  run -= run == owners.begin() ? 0 : 1;
  for (; run != owners.end() && run->first.fiber == question.fiber &&
         run->first.segment <= question.segment_b;
       ++run) {
    ranks.push_back(run->rank);
  }
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  return ranks;
}

}  // namespace

std::vector<bool> find_loops(const Communicator& ranks, const LocalFibers& own,
                             const LocalFibers& halo, const std::vector<LoopQuestion>& questions) {
  KnownRuns own_runs(own);
  KnownRuns halo_runs(halo);
  std::vector<bool> loops(questions.size());
  std::vector<Answers> by_question(questions.size(), 0);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const LoopQuestion& question = questions[i];
    by_question[i] = answer(question, {&own_runs, &halo_runs});
    // More points can only answer more questions with yes, and that only makes loops.
    loops[i] = makes_loop(question, by_question[i]);
    const std::uint64_t count = question.segment_b - question.segment_a;
    if (!loops[i] && own_runs.count(question) + halo_runs.count(question) < count) {
      open.push_back(i);
    }
  }
  if (ranks.sum(open.size()) == 0) {
    return loops;
  }
  const auto size = static_cast<std::size_t>(ranks.size());
  const std::vector<OwnedRun> owners = find_owners(ranks, own, questions, open);
  PerRank<LoopQuestion> asked(size);
  PerRank<std::size_t> numbers(size);  // of the questions asked
  for (const std::size_t i : open) {
    for (const int rank : ranks_between(owners, questions[i])) {
      asked[static_cast<std::size_t>(rank)].push_back(questions[i]);
      numbers[static_cast<std::size_t>(rank)].push_back(i);
    }
  }
  asked = ranks.exchange(std::move(asked));
  PerRank<Answers> answers(size);
  for (std::size_t other = 0; other < size; ++other) {
    for (const LoopQuestion& question : asked[other]) {
      answers[other].push_back(answer(question, {&own_runs, &halo_runs}));
    }
  }
  answers = ranks.exchange(std::move(answers));
  for (std::size_t other = 0; other < size; ++other) {
    for (std::size_t i = 0; i < answers[other].size(); ++i) {
      Answers& all = by_question[numbers[other][i]];
      all = static_cast<Answers>(all | answers[other][i]);
    }
  }
  for (const std::size_t i : open) {
    loops[i] = makes_loop(questions[i], by_question[i]);
  }
  return loops;
}

bool is_known_loop(KnownRuns& own, const LoopQuestion& question) {
  return makes_loop(question, answer(question, {&own}));
}

}  // namespace fiber
