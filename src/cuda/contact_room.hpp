#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "src/cuda/judge_pairs.hpp"

namespace fiber {

/// Memory of contacts, 32 bytes each, and of where those of candidates begin.
template <template <class> class Buffer>
struct ContactRoom {
  Buffer<std::uint32_t> a;
  Buffer<std::uint32_t> b;
  Buffer<double> s;
  Buffer<double> t;
  Buffer<double> distance;
  Buffer<std::uint32_t> candidate_begins;  // by candidate, and one more

  void resize(std::size_t count) {
    a.resize(count);
    b.resize(count);
    s.resize(count);
    t.resize(count);
    distance.resize(count);
  }
  /// How many there is room for.
  std::size_t capacity() const {
    return std::min({a.capacity(), b.capacity(), s.capacity(), t.capacity(), distance.capacity()});
  }
  std::size_t bytes() const {
    return a.bytes() + b.bytes() + s.bytes() + t.bytes() + distance.bytes() +
           candidate_begins.bytes();
  }
  ContactArrays arrays() { return {a.data(), b.data(), s.data(), t.data(), distance.data()}; }
};

/// Memory of the last contacts. Those that somebody holds stay as they are: others go elsewhere.
template <template <class> class Buffer>
class HeldRoom {
 public:
  using Room = ContactRoom<Buffer>;

  /// To be called before others are written.
  void leave_what_is_held() {
    if (room_.use_count() > 1) {
      if (before_ == nullptr || before_.use_count() > 1) {
        before_ = std::make_shared<Room>();
      }
      std::swap(room_, before_);
    }
  }

  Room& operator*() const { return *room_; }
  Room* operator->() const { return room_.get(); }
  std::shared_ptr<const void> hold() const { return room_; }

  std::size_t bytes() const { return room_->bytes() + (before_ != nullptr ? before_->bytes() : 0); }

 private:
  std::shared_ptr<Room> room_ = std::make_shared<Room>();
  std::shared_ptr<Room> before_;  // of the contacts before, if they were held then
};

}  // namespace fiber
