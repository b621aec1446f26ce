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

void DirtySegments::clear() {
  for (const std::uint32_t point : first_points_) {
    is_outdated_[point] = 0;
  }
  first_points_.clear();
}

void DirtySegments::add(const FiberAssembly& fibers, std::uint32_t fiber) {
  is_outdated_.resize(fibers.point_count());
  for (std::uint32_t point = fibers.offsets()[fiber]; point + 1 < fibers.offsets()[fiber + 1];
       ++point) {
    if (is_outdated_[point] == 0) {
      is_outdated_[point] = 1;
      first_points_.push_back(point);
    }
  }
}

void DirtySegments::fit(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
  tree_.build({fibers, origin}, first_points_);
}

std::size_t DirtySegments::memory_bytes() const {
  return first_points_.capacity() * sizeof(std::uint32_t) + is_outdated_.capacity() +
         tree_.memory_bytes();
}

}  // namespace fiber
