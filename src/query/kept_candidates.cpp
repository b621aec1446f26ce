#include "fiber_proximity/query/kept_candidates.hpp"

namespace fiber {

void KeptCandidates::forget() {
  const std::lock_guard lock(mutex_);
  valid_ = false;
}

KeptCandidates::Keys KeptCandidates::find(const QueryOptions& options) const {
  const std::lock_guard lock(mutex_);
  const bool same =
      valid_ && options.margin == margin_ && options.neighbour_skip == neighbour_skip_;
  return same ? keys_ : nullptr;
}

KeptCandidates::Keys KeptCandidates::make() {
  const std::lock_guard lock(mutex_);
  if (valid_ || keys_ == nullptr || keys_.use_count() > 1) {
    return std::make_shared<std::vector<std::uint64_t>>();
  }
  return std::move(keys_);
}

void KeptCandidates::keep(const QueryOptions& options, const Keys& keys) {
  const std::lock_guard lock(mutex_);
  valid_ = true;
  margin_ = options.margin;
  neighbour_skip_ = options.neighbour_skip;
  keys_ = keys;
}

std::size_t KeptCandidates::memory_bytes() const {
  const std::lock_guard lock(mutex_);
  return keys_ == nullptr ? 0 : keys_->capacity() * sizeof(std::uint64_t);
}

}  // namespace fiber
