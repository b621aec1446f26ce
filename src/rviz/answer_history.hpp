#pragma once

#include <deque>
#include <string>
#include <vector>

#include "fiber_proximity/Statistics.h"

namespace fiber_proximity_rviz {

/// How far the smallest distance of an answer may be from the truth, and that of the contact about
/// which least is known [m]: what has been proven of them. Infinity where an answer is not about
/// all that there is, or not all of it was looked at.
double proven_uncertainty(const fiber_proximity::Statistics& answer);

/// The times of the answers of the last seconds, and how sure they were.
class AnswerHistory {
 public:
  struct Answer {
    double time;                     ///< [s] when it came
    double total;                    ///< [s]
    std::vector<double> part_times;  ///< [s] by parts(); those that came later are missing
    double uncertainty;              ///< as proven_uncertainty()
  };

  /// Something that happened: a setting was changed.
  struct Mark {
    double time;  ///< [s]
    std::string text;
  };

  /// @param length [s] how long answers are kept
  explicit AnswerHistory(double length) : length_(length) {}

  /// @param now [s]
  void add(double now, const fiber_proximity::Statistics& answer);
  void mark(double now, const std::string& text);
  void clear();

  /// Drops what is older than the length.
  void forget(double now);

  double length() const { return length_; }
  const std::deque<Answer>& answers() const { return answers_; }
  const std::deque<Mark>& marks() const { return marks_; }

  /// The names of all parts of answers so far, in the order in which they were seen.
  const std::vector<std::string>& parts() const { return parts_; }

 private:
  double length_;
  std::deque<Answer> answers_;
  std::deque<Mark> marks_;
  std::vector<std::string> parts_;
};

}  // namespace fiber_proximity_rviz
