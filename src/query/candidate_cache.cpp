#include "src/query/candidate_cache.hpp"

#include <algorithm>

namespace fiber {

CandidateKey::CandidateKey(const PairOptions& options) {
  // All are named: an option that is new does not compile before it is told here whether candidates
  // depend on it. On how many contacts may be reported, and on what they may cost, they do not.
  const auto& [margin, max_contacts, pairing, neighbour_skip, neighbour_skip_length, deadline,
               contact_limit, pair_limit] = options;
  margin_ = margin;
  pairing_ = pairing;
  neighbour_skip_ = neighbour_skip;
  neighbour_skip_length_ = neighbour_skip_length;
}

bool CandidateKey::operator==(const CandidateKey& other) const {
  return margin_ == other.margin_ && pairing_ == other.pairing_ &&
         neighbour_skip_ == other.neighbour_skip_ &&
         neighbour_skip_length_ == other.neighbour_skip_length_;
}

CandidateCache::State CandidateCache::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

double CandidateCache::margin() const {
  const std::lock_guard lock(mutex_);
  return key_.margin();
}

void CandidateCache::become(State worse) {
  const std::lock_guard lock(mutex_);
  state_ = std::min(state_, worse);
}

CandidateCache::Keys CandidateCache::find(const QueryOptions& options, State state) const {
  const std::lock_guard lock(mutex_);
  return state_ == state && key_ == CandidateKey(options) ? keys_ : nullptr;
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
  key_ = CandidateKey(options);
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
    is_dirty_[point] = 0;
  }
  first_points_.clear();
}

void DirtySegments::add(const FiberAssembly& fibers, std::uint32_t fiber) {
  is_dirty_.resize(fibers.point_count());
  for (std::uint32_t point = fibers.offsets()[fiber]; point + 1 < fibers.offsets()[fiber + 1];
       ++point) {
    if (is_dirty_[point] == 0) {
      is_dirty_[point] = 1;
      first_points_.push_back(point);
    }
  }
}

void DirtySegments::fit(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
  tree_.build({fibers, origin}, first_points_);
}

std::size_t DirtySegments::memory_bytes() const {
  return first_points_.capacity() * sizeof(std::uint32_t) + is_dirty_.capacity() +
         tree_.memory_bytes();
}

}  // namespace fiber
