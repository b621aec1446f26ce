#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <stdexcept>
#include <string>

#include "src/cuda/device_buffer.hpp"

namespace fiber {

inline std::string in_megabytes(std::size_t bytes) {
  constexpr std::size_t megabyte = 1000000;
  return std::to_string((bytes + megabyte - 1) / megabyte) + " MB";
}

/// @throws std::runtime_error
inline void check(cudaError_t error) {
  if (error != cudaSuccess) {
    throw std::runtime_error(std::string("cuda_tree: the GPU has failed: ") +
                             cudaGetErrorString(error) + " (" + cudaGetErrorName(error) +
                             "); this process cannot use it any more");
  }
}

/// That of this thread, as CUDA counts them.
inline int current_gpu() {
  int current = 0;
  check(cudaGetDevice(&current));
  return current;
}

/// While it lives, the calls of this thread go to one GPU, whichever others have chosen, which is
/// theirs again afterwards.
class GpuTurn {
 public:
  explicit GpuTurn(int gpu) : gpu_(gpu) {
    if (others_ != gpu_) {
      check(cudaSetDevice(gpu_));
    }
  }
  ~GpuTurn() {
    if (others_ != gpu_) {
      cudaSetDevice(others_);
    }
  }
  GpuTurn(const GpuTurn&) = delete;
  GpuTurn& operator=(const GpuTurn&) = delete;

 private:
  int gpu_;
  int others_ = current_gpu();
};

/// Memory of the GPU, an eighth more than is needed: finding some takes the GPU longer than a
/// query.
struct CudaMemory {
  static std::size_t room_for(std::size_t count) { return count + count / 8; }

  /// @throws std::runtime_error saying how much was needed and how much there is
  static void* allocate(std::size_t bytes) {
    void* data = nullptr;
    const cudaError_t error = cudaMalloc(&data, bytes);
    if (error == cudaErrorMemoryAllocation) {
      cudaGetLastError();  // it is reported once
      std::size_t available = 0;
      std::size_t total = 0;
      check(cudaMemGetInfo(&available, &total));
      throw std::runtime_error("cuda_tree: the GPU has no room for " + in_megabytes(bytes) +
                               " more: " + in_megabytes(available) + " of " + in_megabytes(total) +
                               " are free");
    }
    check(error);
    return data;
  }
  static void release(void* data) { cudaFree(data); }
};

/// Memory of the host that the GPU reads and writes by itself: its pages stay where they are.
struct PinnedMemory {
  static std::size_t room_for(std::size_t count) { return CudaMemory::room_for(count); }

  /// @throws std::runtime_error saying how much was needed
  static void* allocate(std::size_t bytes) {
    void* data = nullptr;
    const cudaError_t error = cudaMallocHost(&data, bytes);
    if (error == cudaErrorMemoryAllocation) {
      cudaGetLastError();
      throw std::runtime_error("cuda_tree: the host has no room for " + in_megabytes(bytes) +
                               " of page-locked memory");
    }
    check(error);
    return data;
  }
  static void release(void* data) { cudaFreeHost(data); }
};

/// Locks pages of the host for as long as it lives.
class PageLock {
 public:
  /// @throws std::invalid_argument if they are locked already, std::runtime_error where they cannot
  /// be
  PageLock(const void* data, std::size_t bytes) : data_(const_cast<void*>(data)) {
    const cudaError_t error = cudaHostRegister(data_, bytes, cudaHostRegisterDefault);
    if (error == cudaSuccess) {
      return;
    }
    cudaGetLastError();
    if (error == cudaErrorHostMemoryAlreadyRegistered) {
      throw std::invalid_argument("this memory of the host is page-locked already");
    }
    throw std::runtime_error("cuda_tree: " + in_megabytes(bytes) +
                             " of the host cannot be page-locked: " + cudaGetErrorString(error) +
                             " (" + cudaGetErrorName(error) + ")");
  }
  ~PageLock() { cudaHostUnregister(data_); }
  PageLock(const PageLock&) = delete;
  PageLock& operator=(const PageLock&) = delete;

 private:
  void* data_;
};

/// Whether the GPU reads these bytes of the host by itself.
inline bool is_page_locked(const void* data, std::size_t bytes) {
  const auto is_locked = [](const char* byte) {
    cudaPointerAttributes attributes;
    check(cudaPointerGetAttributes(&attributes, byte));
    return attributes.type == cudaMemoryTypeHost;
  };
  const auto* const first = static_cast<const char*>(data);
  return bytes > 0 && is_locked(first) && is_locked(first + bytes - 1);
}

}  // namespace fiber
