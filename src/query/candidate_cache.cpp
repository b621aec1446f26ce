#include "src/query/candidate_cache.hpp"

#include <algorithm>

namespace fiber {

CandidateCache::State CandidateCache::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

void CandidateCache::become(State worse) {
  const std::lock_guard lock(mutex_);
  state_ = std::min(state_, worse);
}

CandidateCache::Keys CandidateCache::find(const QueryOptions& options, State state) const {
  const std::lock_guard lock(mutex_);
  const bool same = state_ == state && options.margin == margin_ &&
                    options.neighbour_skip == neighbour_skip_ && options.pairing == pairing_;
  return same ? keys_ : nullptr;
}

CandidateCache::Keys CandidateCache::make() {
  const std::lock_guard lock(mutex_);
  Keys& unused = state_ == State::NONE && keys_ != nullptr ? keys_ : spare_;
  if (unused == nullptr || unused.use_count() > 1) {
    return std::make_shared<std::vector<std::uint64_t>>();
  }
  return std::move(unused);
}

void CandidateCache::keep(const QueryOptions& options, const Keys& keys) {
  const std::lock_guard lock(mutex_);
  state_ = State::CURRENT;
  margin_ = options.margin;
  neighbour_skip_ = options.neighbour_skip;
  pairing_ = options.pairing;
  if (keys_ != nullptr) {
    spare_ = std::move(keys_);
  }
  keys_ = keys;
}

std::size_t CandidateCache::memory_bytes() const {
  const std::lock_guard lock(mutex_);
  const auto bytes = [](const Keys& keys) {
    return keys == nullptr ? 0 : keys->capacity() * sizeof(std::uint64_t);
  };
  return bytes(keys_) + bytes(spare_);
}

}  // namespace fiber
