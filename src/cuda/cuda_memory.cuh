#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/cuda/pinned_copy.hpp"

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

/// @throws std::runtime_error saying how much was needed and how much there is
inline void* allocate(std::size_t bytes) {
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

/// Memory of the GPU.
template <class T>
class CudaBuffer {
 public:
  CudaBuffer() = default;
  ~CudaBuffer() { cudaFree(data_); }
  CudaBuffer(const CudaBuffer&) = delete;
  CudaBuffer& operator=(const CudaBuffer&) = delete;

  /// Takes an eighth more than it needs: finding memory takes the GPU longer than a query.
  void resize(std::size_t count) {
    if (count > capacity_) {
      cudaFree(data_);
      data_ = nullptr;
      capacity_ = 0;
      size_ = 0;
      capacity_ = count + count / 8;
      data_ = static_cast<T*>(allocate(capacity_ * sizeof(T)));
    }
    size_ = count;
  }
  void swap(CudaBuffer& other) {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Memory of the host that the GPU reads and writes by itself: what goes over passes through it, in
/// pieces, while the next is copied.
class PinnedPieces {
 public:
  static constexpr std::size_t piece_bytes = std::size_t{1} << 22U;

  PinnedPieces() {
    for (Piece& piece : pieces_) {
      check(cudaMallocHost(&piece.data, piece_bytes));
      check(cudaEventCreateWithFlags(&piece.done, cudaEventDisableTiming));
    }
  }
  ~PinnedPieces() {
    for (Piece& piece : pieces_) {
      cudaEventDestroy(piece.done);
      cudaFreeHost(piece.data);
    }
  }
  PinnedPieces(const PinnedPieces&) = delete;
  PinnedPieces& operator=(const PinnedPieces&) = delete;

  void upload(const void* from, std::size_t bytes, void* to, cudaStream_t stream) {
    for (std::size_t begin = 0; begin < bytes; begin += piece_bytes) {
      const Piece& piece = next();
      check(cudaEventSynchronize(piece.done));  // that the GPU has read what was there
      const std::size_t size = std::min(piece_bytes, bytes - begin);
      copy_on_threads(piece.data, static_cast<const char*>(from) + begin, size);
      check(cudaMemcpyAsync(static_cast<char*>(to) + begin, piece.data, size,
                            cudaMemcpyHostToDevice, stream));
      check(cudaEventRecord(piece.done, stream));
    }
  }

  void download(const void* from, std::size_t bytes, void* to, cudaStream_t stream) {
    std::size_t asked = 0;
    std::size_t got = 0;
    int first = 0;
    int count = 0;
    while (got < bytes) {
      for (; asked < bytes && count < piece_count; ++count) {
        const Piece& piece = pieces_[(first + count) % piece_count];
        const std::size_t size = std::min(piece_bytes, bytes - asked);
        check(cudaMemcpyAsync(piece.data, static_cast<const char*>(from) + asked, size,
                              cudaMemcpyDeviceToHost, stream));
        check(cudaEventRecord(piece.done, stream));
        asked += size;
      }
      const Piece& piece = pieces_[first];
      check(cudaEventSynchronize(piece.done));
      const std::size_t size = std::min(piece_bytes, bytes - got);
      copy_on_threads(static_cast<char*>(to) + got, piece.data, size);
      got += size;
      first = (first + 1) % piece_count;
      --count;
    }
  }

 private:
  static constexpr int piece_count = 4;
  struct Piece {
    void* data = nullptr;
    cudaEvent_t done = nullptr;
  };

  const Piece& next() {
    next_ = (next_ + 1) % piece_count;
    return pieces_[next_];
  }

  Piece pieces_[piece_count];
  int next_ = 0;
};

}  // namespace fiber
