#include "benchmark/continuous/motion_accuracy.hpp"

#include <algorithm>
#include <atomic>
#include <future>

namespace fiber {
namespace {

constexpr std::uint32_t motions_per_chunk = 100;
constexpr std::size_t max_wrong = 5;  // to keep

/// Chunks of one seed have different motions.
std::uint64_t seed_of(std::uint64_t seed, std::uint32_t chunk) {
  return seed + 0x9E3779B97F4A7C15U * chunk;
}

std::vector<MotionAccuracy> accuracy_of(const std::vector<HardMotion>& motions,
                                        const std::vector<double>& tolerances,
                                        const AnswerMotion& answer) {
  std::vector<MotionAccuracy> found(tolerances.size());
  for (const HardMotion& motion : motions) {
    const double extent = extent_of(motion);
    for (std::size_t i = 0; i < tolerances.size(); ++i) {
      const double tolerance = tolerances[i] * extent;
      found[i].add({motion, tolerance, answer(motion.motions(), tolerance)});
    }
  }
  return found;
}

}  // namespace

void MotionAccuracy::add(const WrongAnswer& answer) {
  const MotionScore judged = judge(answer.motion, answer.tolerance, answer.answer);
  score += judged;
  if (judged.has_wrong_answers() && wrong.size() < max_wrong) {
    wrong.push_back(answer);
  }
}

MotionAccuracy& MotionAccuracy::operator+=(const MotionAccuracy& more) {
  score += more.score;
  const std::size_t some = std::min(max_wrong - wrong.size(), more.wrong.size());
  wrong.insert(wrong.end(), more.wrong.begin(),
               more.wrong.begin() + static_cast<std::ptrdiff_t>(some));
  return *this;
}

std::vector<MotionAccuracy> motion_accuracy(const MotionFamily& family, const MotionDraw& draw,
                                            const std::vector<double>& tolerances,
                                            std::uint32_t threads, const AnswerMotion& answer) {
  const std::uint32_t chunks = (draw.count + motions_per_chunk - 1) / motions_per_chunk;
  std::vector<std::vector<MotionAccuracy>> found(chunks);
  std::atomic<std::uint32_t> begun{0};
  const auto work = [&] {
    for (std::uint32_t chunk = begun++; chunk < chunks; chunk = begun++) {
      const std::uint32_t count =
          std::min(motions_per_chunk, draw.count - chunk * motions_per_chunk);
      found[chunk] =
          accuracy_of(hard_motions(family, count, seed_of(draw.seed, chunk)), tolerances, answer);
    }
  };
  std::vector<std::future<void>> workers;
  for (std::uint32_t i = 0; i < threads; ++i) {
    workers.push_back(std::async(std::launch::async, work));
  }
  for (std::future<void>& worker : workers) {
    worker.get();
  }
  std::vector<MotionAccuracy> sum(tolerances.size());
  for (const std::vector<MotionAccuracy>& of_chunk : found) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += of_chunk[i];
    }
  }
  return sum;
}

}  // namespace fiber
