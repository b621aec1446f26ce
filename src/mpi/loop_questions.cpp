#include "src/mpi/loop_questions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "src/query/loop_rule.hpp"

namespace fiber {
namespace {

/// Who owns segments of a fibre that follow each other.
struct OwnedRun {
  GlobalSegment first;
  std::uint64_t count = 0;
  int rank = 0;
};

bool comes_first(const OwnedRun& x, const OwnedRun& y) { return x.first < y.first; }

/// A question as it travels.
struct PlainQuestion {
  GlobalSegment first;     // whose start is the first point to look at
  std::uint64_t last = 0;  // segment whose start is the last one
  PlainPoint a0{}, a1{}, b0{}, b1{};
  double radius_a = 0.0;
  double radius_b = 0.0;
};

/// For each question of the rule, by its bit, whether a point goes too far.
using Answers = std::uint8_t;
static_assert(loop_question_count <= 8);

Capsule capsule_of(const PlainPoint& p0, const PlainPoint& p1, double radius) {
  return {vector_of(p0), vector_of(p1), radius};
}

SegmentDistance nearest_of(const Capsule& a, const Capsule& b) {
  return segment_distance(a.p0, a.p1, b.p0, b.p1);
}

/// A rank's runs, with boxes.
class OwnRuns {
 public:
  explicit OwnRuns(const NamedFibers& own) : own_(own), boxes_(own.runs().size()) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const FiberRun& run = own.runs()[i];
      for (std::uint64_t k = 0; k < run.count; ++k) {
        boxes_[i].extend(own.fibers().points()[run.begin + k]);
      }
    }
  }

  std::vector<OwnedRun> joined(int rank) const {
    std::vector<OwnedRun> runs;
    for (const FiberRun& run : own_.runs()) {
      if (!runs.empty() && runs.back().first.fiber == run.first.fiber &&
          runs.back().first.segment + runs.back().count == run.first.segment) {
        runs.back().count += run.count;
      } else {
        runs.push_back({run.first, run.count, rank});
      }
    }
    return runs;
  }

  /// What this rank's points say to a question.
  Answers answer(const PlainQuestion& question) const {
    const Capsule a = capsule_of(question.a0, question.a1, question.radius_a);
    const Capsule b = capsule_of(question.b0, question.b1, question.radius_b);
    Answers answers = 0;
    makes_loop_by(a, b, nearest_of(a, b),
                  [&](int number, const LoopPlace& x, const LoopPlace& y, double limit) {
                    if (any_beyond(question, LoopReach(x, limit), LoopReach(y, limit))) {
                      answers = static_cast<Answers>(answers | 1U << static_cast<unsigned>(number));
                    }
                    return number == 0;  // whatever others say: so that all questions come
                  });
    return answers;
  }

 private:
  /// Whether any point that this rank has of those asked about is beyond either limit.
  bool any_beyond(const PlainQuestion& question, const LoopReach& x, const LoopReach& y) const {
    const std::vector<FiberRun>& runs = own_.runs();
    auto run = std::upper_bound(
        runs.begin(), runs.end(), question.first,
        [](const GlobalSegment& first, const FiberRun& other) { return first < other.first; });
    if (run != runs.begin()) {
      --run;  // may have begun before
    }
    for (; run != runs.end(); ++run) {
      const GlobalSegment& first = run->first;
      if (first.fiber > question.first.fiber ||
          (first.fiber == question.first.fiber && first.segment > question.last)) {
        return false;
      }
      const Eigen::AlignedBox3d& box = boxes_[static_cast<std::size_t>(run - runs.begin())];
      if (first.fiber != question.first.fiber || (x.holds(box) && y.holds(box))) {
        continue;
      }
      for (std::uint64_t i = 0; i < run->count; ++i) {
        const std::uint64_t segment = first.segment + i;
        const Eigen::Vector3d& point = own_.fibers().points()[run->begin + i];
        if (segment >= question.first.segment && segment <= question.last &&
            (x.is_beyond(point) || y.is_beyond(point))) {
          return true;
        }
      }
    }
    return false;
  }

  const NamedFibers& own_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // around the points of those that start a segment
};

/// Asks for the owners of the fibres that the questions are about; sorted.
std::vector<OwnedRun> find_owners(const Communicator& ranks, const OwnRuns& own,
                                  const std::vector<LoopQuestion>& questions) {
  // Each fibre has a rank that knows who owns it.
  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<OwnedRun> notices(size);
  for (const OwnedRun& run : own.joined(ranks.rank())) {
    notices[run.first.fiber % size].push_back(run);
  }
  std::vector<OwnedRun> known;
  for (const std::vector<OwnedRun>& some : ranks.exchange(std::move(notices))) {
    known.insert(known.end(), some.begin(), some.end());
  }
  std::sort(known.begin(), known.end(), comes_first);

  PerRank<std::uint64_t> fibers(size);
  for (const LoopQuestion& question : questions) {
    fibers[question.fiber % size].push_back(question.fiber);
  }
  for (std::vector<std::uint64_t>& some : fibers) {
    std::sort(some.begin(), some.end());
    some.erase(std::unique(some.begin(), some.end()), some.end());
  }
  fibers = ranks.exchange(std::move(fibers));
  PerRank<OwnedRun> replies(size);
  for (std::size_t other = 0; other < size; ++other) {
    for (const std::uint64_t fiber : fibers[other]) {
      auto run =
          std::lower_bound(known.begin(), known.end(), OwnedRun{{fiber, 0}, 0, 0}, comes_first);
      for (; run != known.end() && run->first.fiber == fiber; ++run) {
        replies[other].push_back(*run);
      }
    }
  }
  std::vector<OwnedRun> owners;
  for (const std::vector<OwnedRun>& some : ranks.exchange(std::move(replies))) {
    owners.insert(owners.end(), some.begin(), some.end());
  }
  std::sort(owners.begin(), owners.end(), comes_first);
  return owners;
}

/// The ranks that own points from the start of segment a + 1 to that of segment b.
std::vector<int> ranks_between(const std::vector<OwnedRun>& owners, const LoopQuestion& question) {
  std::vector<int> ranks;
  auto run =
      std::upper_bound(owners.begin(), owners.end(),
                       OwnedRun{{question.fiber, question.segment_a + 1}, 0, 0}, comes_first);
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

PlainQuestion plain_question(const LoopQuestion& question) {
  PlainQuestion asked;
  asked.first = {question.fiber, question.segment_a + 1};
  asked.last = question.segment_b;
  asked.a0 = plain(question.a.p0);
  asked.a1 = plain(question.a.p1);
  asked.b0 = plain(question.b.p0);
  asked.b1 = plain(question.b.p1);
  asked.radius_a = question.a.radius;
  asked.radius_b = question.b.radius;
  return asked;
}

}  // namespace

std::vector<bool> find_loops(const Communicator& ranks, const NamedFibers& own,
                             const std::vector<LoopQuestion>& questions) {
  std::vector<bool> loops(questions.size());
  if (ranks.sum(questions.size()) == 0) {
    return loops;
  }
  const auto size = static_cast<std::size_t>(ranks.size());
  const OwnRuns runs(own);
  const std::vector<OwnedRun> owners = find_owners(ranks, runs, questions);
  PerRank<PlainQuestion> asked(size);
  PerRank<std::size_t> numbers(size);  // of the questions asked
  for (std::size_t i = 0; i < questions.size(); ++i) {
    for (const int rank : ranks_between(owners, questions[i])) {
      asked[static_cast<std::size_t>(rank)].push_back(plain_question(questions[i]));
      numbers[static_cast<std::size_t>(rank)].push_back(i);
    }
  }
  asked = ranks.exchange(std::move(asked));
  PerRank<Answers> answers(size);
  for (std::size_t other = 0; other < size; ++other) {
    for (const PlainQuestion& question : asked[other]) {
      answers[other].push_back(runs.answer(question));
    }
  }
  answers = ranks.exchange(std::move(answers));
  std::vector<Answers> by_question(questions.size(), 0);
  for (std::size_t other = 0; other < size; ++other) {
    for (std::size_t i = 0; i < answers[other].size(); ++i) {
      Answers& all = by_question[numbers[other][i]];
      all = static_cast<Answers>(all | answers[other][i]);
    }
  }
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const LoopQuestion& question = questions[i];
    loops[i] = makes_loop_by(
        question.a, question.b, nearest_of(question.a, question.b),
        [&](int number, const LoopPlace& /*x*/, const LoopPlace& /*y*/, double /*limit*/) {
          return (by_question[i] >> static_cast<unsigned>(number) & 1U) != 0;
        });
  }
  return loops;
}

}  // namespace fiber
