#pragma once

#include <cstddef>
#include <functional>
#include <type_traits>

namespace fiber {

/// Calls in a child process and waits for its end, however that comes. What it prints is lost; it
/// hands on what it writes to SharedArrays. No other thread may be running.
/// @return whether the call came back
/// @throws std::runtime_error if there are no more processes
bool survives(const std::function<void()>& call);

/// Zeroed memory that child processes write to and their parent reads.
class SharedMemory {
 public:
  /// @throws std::runtime_error if there is none
  explicit SharedMemory(std::size_t bytes);
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory();

  void* begin() const { return begin_; }

 private:
  std::size_t bytes_;
  void* begin_;
};

/// Values in shared memory, zero at first.
template <class Value>
class SharedArray {
  static_assert(std::is_trivially_copyable_v<Value> && std::is_trivially_destructible_v<Value>);

 public:
  explicit SharedArray(std::size_t size) : memory_((size + 1) * sizeof(Value)), size_(size) {}

  Value* begin() const { return static_cast<Value*>(memory_.begin()); }
  Value* end() const { return begin() + size_; }
  Value& operator[](std::size_t index) const { return begin()[index]; }

 private:
  SharedMemory memory_;
  std::size_t size_;
};

}  // namespace fiber
