#pragma once

#include <cstddef>
#include <utility>

namespace fiber {

/// Room for values that grows, and does not keep what was in it when it does.
/// @tparam Memory has allocate(bytes), which throws where there is none; release(data); and
///         room_for(count), how many values to make room for where so many are needed
template <class T, class Memory>
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  ~DeviceBuffer() { Memory::release(data_); }
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;

  /// Without any room if it throws.
  void resize(std::size_t count) {
    if (count > capacity_) {
      Memory::release(data_);
      data_ = nullptr;
      size_ = 0;
      capacity_ = 0;
      const std::size_t room = Memory::room_for(count);
      data_ = static_cast<T*>(Memory::allocate(room * sizeof(T)));
      capacity_ = room;
    }
    size_ = count;
  }
  void swap(DeviceBuffer& other) {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace fiber
