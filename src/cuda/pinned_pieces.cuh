#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>

#include "src/cuda/cuda_memory.cuh"
#include "src/cuda/on_threads.hpp"

namespace fiber {

/// Page-locked memory that passes on what comes from memory that is not, or goes there: each thread
/// copies a piece of its own, which the GPU reads while others are copied.
class PinnedPieces {
 public:
  static constexpr std::size_t piece_bytes = std::size_t{1} << 19U;

  explicit PinnedPieces(int gpu) : gpu_(gpu) {}

  void upload(const void* from, std::size_t bytes, void* to, cudaStream_t stream) {
    in_pieces(bytes, [=](const Piece& piece, std::size_t begin, std::size_t size) {
      check(cudaEventSynchronize(piece.done));  // the GPU has read what was there
      std::memcpy(piece.data, static_cast<const char*>(from) + begin, size);
      check(cudaMemcpyAsync(static_cast<char*>(to) + begin, piece.data, size,
                            cudaMemcpyHostToDevice, stream));
      check(cudaEventRecord(piece.done, stream));
    });
  }

  /// Waits until it is there.
  void download(const void* from, std::size_t bytes, void* to, cudaStream_t stream) {
    in_pieces(bytes, [=](const Piece& piece, std::size_t begin, std::size_t size) {
      check(cudaMemcpyAsync(piece.data, static_cast<const char*>(from) + begin, size,
                            cudaMemcpyDeviceToHost, stream));
      check(cudaEventRecord(piece.done, stream));
      check(cudaEventSynchronize(piece.done));
      std::memcpy(static_cast<char*>(to) + begin, piece.data, size);
    });
  }

 private:
  // Three for each of 16 threads: one is copied while the GPU reads the others. Where there are
  // more threads, each has one.
  static constexpr std::size_t most_waiting = 48;

  struct Piece {
    Piece() : data(PinnedMemory::allocate(piece_bytes)) {
      const cudaError_t error = cudaEventCreateWithFlags(&done, cudaEventDisableTiming);
      if (error != cudaSuccess) {
        PinnedMemory::release(data);
        check(error);
      }
    }
    ~Piece() {
      cudaEventDestroy(done);
      PinnedMemory::release(data);
    }
    Piece(const Piece&) = delete;
    Piece& operator=(const Piece&) = delete;

    /// Whether the GPU needs it no longer.
    bool is_read() const {
      const cudaError_t error = cudaEventQuery(done);
      if (error == cudaErrorNotReady) {
        cudaGetLastError();  // it is no error, but reported as one
        return false;
      }
      check(error);
      return true;
    }

    void* data;
    cudaEvent_t done = nullptr;
  };

  /// Calls with a piece that nobody else has.
  template <class Use>
  void in_pieces(std::size_t bytes, const Use& use) {
    on_threads((bytes + piece_bytes - 1) / piece_bytes, [&](std::size_t job) {
      const GpuTurn turn(gpu_);  // threads that help have chosen none
      const std::size_t begin = job * piece_bytes;
      std::unique_ptr<Piece> piece = take();
      use(*piece, begin, std::min(piece_bytes, bytes - begin));
      const std::lock_guard<std::mutex> lock(mutex_);
      idle_.push_back(std::move(piece));
    });
  }

  /// The one that has waited longest, or a new one while the GPU still reads that.
  std::unique_ptr<Piece> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (idle_.empty() || (idle_.size() < most_waiting && !idle_.front()->is_read())) {
      return std::make_unique<Piece>();
    }
    std::unique_ptr<Piece> piece = std::move(idle_.front());
    idle_.pop_front();
    return piece;
  }

  int gpu_;
  std::mutex mutex_;
  std::deque<std::unique_ptr<Piece>> idle_;
};

}  // namespace fiber
