#include "src/rviz/answer_history.hpp"

#include <algorithm>
#include <limits>

namespace fiber_proximity_rviz {

double proven_uncertainty(const fiber_proximity::Statistics& answer) {
  if (!answer.complete) {
    return std::numeric_limits<double>::infinity();
  }
  // Without a pair both bounds are infinite, and nothing is uncertain.
  const double of_minimum = answer.minimum_lower == answer.minimum_upper
                                ? 0.0
                                : answer.minimum_upper - answer.minimum_lower;
  return std::max(of_minimum, answer.contact_error);
}

void AnswerHistory::add(double now, const fiber_proximity::Statistics& answer) {
  Answer added{now, answer.total_time, std::vector<double>(parts_.size(), 0.0),
               proven_uncertainty(answer)};
  for (std::size_t i = 0; i < std::min(answer.parts.size(), answer.part_times.size()); ++i) {
    const auto known = std::find(parts_.begin(), parts_.end(), answer.parts[i]);
    const auto part = static_cast<std::size_t>(known - parts_.begin());
    if (known == parts_.end()) {
      parts_.push_back(answer.parts[i]);
      added.part_times.push_back(0.0);
    }
    added.part_times[part] += answer.part_times[i];
  }
  answers_.push_back(std::move(added));
  forget(now);
}

void AnswerHistory::mark(double now, const std::string& text) { marks_.push_back({now, text}); }

void AnswerHistory::clear() { *this = AnswerHistory(length_); }

void AnswerHistory::forget(double now) {
  const auto drop = [&](auto& from) {
    while (!from.empty() && from.front().time < now - length_) {
      from.pop_front();
    }
  };
  drop(answers_);
  drop(marks_);
}

}  // namespace fiber_proximity_rviz
