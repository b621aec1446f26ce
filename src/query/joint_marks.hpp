#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fiber {

/// Marks the joints that a search has come by; searches of one thread share its memory.
class JointMarks {
 public:
  /// Those of this thread, with none marked.
  static JointMarks& cleared(std::uint32_t joint_count) {
    thread_local JointMarks marks;
    if (++marks.search_ == 0) {
      std::fill(marks.marks_.begin(), marks.marks_.end(), 0);
      marks.search_ = 1;
    }
    marks.marks_.resize(std::max<std::size_t>(marks.marks_.size(), joint_count), 0);
    return marks;
  }

  bool is_marked(std::uint32_t joint) const { return marks_[joint] == search_; }
  void mark(std::uint32_t joint) { marks_[joint] = search_; }

 private:
  std::vector<std::uint32_t> marks_;  // by joint, the last search that has marked it
  std::uint32_t search_ = 0;
};

}  // namespace fiber
