#include "benchmark/agreement.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace fiber {
namespace {

bool same_pairs(const std::vector<Contact>& a, const std::vector<Contact>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Contact& x, const Contact& y) {
    return x.key() == y.key() && x.distance == y.distance && x.s == y.s && x.t == y.t;
  });
}

}  // namespace

void Agreement::begin_frame(std::uint32_t frame) {
  frame_ = frame;
  previous_name_.clear();
}

void Agreement::check(const std::string& name) {
  if (disagreement_.empty() && !previous_name_.empty() &&
      !same_pairs(previous_.contacts, next_.contacts)) {
    disagreement_ = "frame " + std::to_string(frame_) + ": the pairs of " + previous_name_ + " (" +
                    std::to_string(previous_.contacts.size()) + ") and " + name + " (" +
                    std::to_string(next_.contacts.size()) + ") differ";
  }
  std::swap(previous_, next_);
  previous_name_ = name;
}

}  // namespace fiber
