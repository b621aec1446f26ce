#include "fiber_proximity/compare/fcl_comparer.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "src/compare/fcl_broad_phase.hpp"
#include "src/compare/pair_oracle.hpp"
#include "src/query/contact_evaluator.hpp"

namespace fiber {
namespace {

/// [s] that a call takes.
template <class Call>
double time_of(const Call& call) {
  const auto begin = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

QueryOptions all_pairs(const QueryOptions& options) {
  QueryOptions all;
  all.margin = options.margin;
  all.pairing = options.pairing;
  all.neighbour_skip = options.neighbour_skip;
  all.neighbour_skip_length = options.neighbour_skip_length;
  all.kernel = options.kernel;
  validate(all);
  if (!std::isfinite(all.margin)) {
    throw std::invalid_argument(
        "margin is infinite, it must be finite to compare with FCL, whose boxes have to hold it");
  }
  return all;
}

bool is_before(const PairAnswered& a, const PairAnswered& b) {
  return pair_key(a.pair) < pair_key(b.pair);
}

void to_answers(const FiberAssembly& fibers, const std::vector<Contact>& contacts,
                std::vector<PairAnswered>& answers) {
  answers.clear();
  for (const Contact& contact : contacts) {
    const PointPair pair{fibers.offsets()[contact.fiber_a] + contact.segment_a,
                         fibers.offsets()[contact.fiber_b] + contact.segment_b};
    answers.push_back({pair, true, {contact.distance, contact.lower, contact.upper}});
  }
  assert(std::adjacent_find(answers.begin(), answers.end(), [](const auto& a, const auto& b) {
           return !is_before(a, b);
         }) == answers.end());
}

void to_answers(const FiberAssembly& fibers, const std::vector<FclDistance>& distances,
                std::vector<PairAnswered>& answers) {
  answers.clear();
  for (const auto& [pair, gap] : distances) {
    const double error = fcl_error(fibers.capsule(pair.a), fibers.capsule(pair.b));
    answers.push_back({pair, !std::isnan(gap), {gap, gap - error, gap + error}});
  }
  std::sort(answers.begin(), answers.end(), is_before);
}

}  // namespace

const char* name_of(Verdict verdict) {
  constexpr const char* names[] = {"both", "ours", "fcl", "neither"};
  return names[static_cast<int>(verdict)];
}

const char* name_of(FclStyle style) { return style == FclStyle::USER ? "user" : "best"; }

std::uint64_t StyleComparison::count(Verdict verdict) const {
  return static_cast<std::uint64_t>(
      std::count_if(disagreements.begin(), disagreements.end(),
                    [=](const Disagreement& each) { return each.verdict == verdict; }));
}

std::uint64_t Comparison::count(Verdict verdict) const {
  std::uint64_t count = 0;
  for (const StyleComparison& style : styles) {
    count += style.count(verdict);
  }
  return count;
}

bool Comparison::ours_is_right() const {
  return count(Verdict::FCL) + count(Verdict::NEITHER) == 0;
}

/// FCL's trees over the fibres of the last comparison.
class FclComparer::Trees {
 public:
  Comparison compare(const FiberAssembly& fibers, const ProximityEngine& engine,
                     const QueryOptions& options) {
    const QueryOptions all = all_pairs(options);
    prepare(fibers, all.margin);
    const PairOracle oracle(fibers, all);
    Comparison comparison;
    comparison.margin = all.margin;
    auto& [user, best] = comparison.styles;
    ask_engine(fibers, engine, all, comparison);
    ask_user_style(fibers, all, user);
    fiber::compare(oracle, ours_, fcl_, user);
    ask_best_style(fibers, all, best);
    fiber::compare(oracle, ours_, fcl_, best);
    offsets_ = fibers.offsets();
    return comparison;
  }

 private:
  /// From here to the end of a comparison it is unknown what the trees hold.
  void prepare(const FiberAssembly& fibers, double margin) {
    if (boxes_ == nullptr || margin != margin_) {
      capsules_ = make_fcl_capsules(margin);
      boxes_ = nullptr;
      boxes_ = make_fcl_boxes(margin);
      margin_ = margin;
      offsets_.clear();
    }
    same_topology_ = std::exchange(offsets_, {}) == fibers.offsets();
  }

  void ask_engine(const FiberAssembly& fibers, const ProximityEngine& engine,
                  const QueryOptions& options, Comparison& comparison) {
    comparison.detect_time = time_of([&] { engine.query(options, result_); });
    comparison.pair_tests = result_.counts.primitive_tests;
    comparison.contacts = result_.contacts.size();
    to_answers(fibers, result_.contacts, ours_);
  }

  void ask_user_style(const FiberAssembly& fibers, const QueryOptions& options,
                      StyleComparison& style) {
    style.style = FclStyle::USER;
    style.update_time = time_of([&] { capsules_->update(fibers, same_topology_); });
    style.detect_time = time_of([&] {
      const NarrowPhase test(fibers, options);
      style.pair_tests = capsules_->measure(test, distances_);
    });
    to_answers(fibers, distances_, fcl_);
    style.contacts = static_cast<std::uint64_t>(std::count_if(
        fcl_.begin(), fcl_.end(), [](const PairAnswered& each) { return each.has_answer; }));
  }

  void ask_best_style(const FiberAssembly& fibers, const QueryOptions& options,
                      StyleComparison& style) {
    style.style = FclStyle::BEST;
    style.update_time = time_of([&] { boxes_->update(fibers, same_topology_); });
    style.detect_time = time_of([&] {
      result_ = QueryResult();
      PairCollector collector(fibers, options, result_);
      boxes_->collide(collector);
      collector.finish();
    });
    style.pair_tests = result_.counts.primitive_tests;
    style.contacts = result_.contacts.size();
    to_answers(fibers, result_.contacts, fcl_);
  }

  double margin_ = 0.0;                 // [m] of the trees
  std::vector<std::uint32_t> offsets_;  // of the fibres they hold; empty: none
  bool same_topology_ = false;
  std::unique_ptr<FclCapsules> capsules_;
  std::unique_ptr<FclBroadPhase> boxes_;

  // Members for their memory.
  QueryResult result_;
  std::vector<FclDistance> distances_;
  std::vector<PairAnswered> ours_;
  std::vector<PairAnswered> fcl_;
};

FclComparer::FclComparer() : trees_(std::make_unique<Trees>()) {}

FclComparer::~FclComparer() = default;

Comparison FclComparer::compare(const FiberAssembly& fibers, const ProximityEngine& engine,
                                const QueryOptions& options) {
  return trees_->compare(fibers, engine, options);
}

}  // namespace fiber
