#include <cuda_runtime.h>

#include <algorithm>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/version.cuh>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/cuda/cuda_memory.cuh"
#include "src/cuda/device_of.hpp"
#include "src/cuda/device_warp.cuh"
#include "src/cuda/pinned_pieces.cuh"

// Arguments that are not copied by each thread: compilers know that from 11.7 on.
#if CUDART_VERSION >= 11070
#define FIBER_GRID_CONSTANT __grid_constant__
#else
#define FIBER_GRID_CONSTANT
#endif

namespace fiber {
namespace {

constexpr int warps_per_block = 4;
constexpr int threads_per_block = warps_per_block * warp_width;

template <class Call>
__global__ void __launch_bounds__(threads_per_block)
    run_each(std::uint32_t count, const FIBER_GRID_CONSTANT Call call) {
  const std::uint32_t index = blockIdx.x * threads_per_block + threadIdx.x;
  if (index < count) {
    call(index);
  }
}

template <class Call>
__global__ void __launch_bounds__(threads_per_block)
    run_warps(std::uint32_t count, const FIBER_GRID_CONSTANT Call call) {
  __shared__ typename Call::Scratch scratch[warps_per_block];
  const std::uint32_t warp = threadIdx.x / warp_width;
  const std::uint32_t index = blockIdx.x * warps_per_block + warp;
  if (index < count) {
    call(DeviceWarp(), index, scratch[warp]);
  }
}

/// The GPU that is the thread's where this is made, in a stream of its own.
class CudaExecutor {
 public:
  template <class T>
  using Buffer = DeviceBuffer<T, CudaMemory>;
  template <class T>
  using HostBuffer = DeviceBuffer<T, PinnedMemory>;

  static constexpr std::uint32_t min_judged_at_once = std::uint32_t{1} << 17U;

  /// CUB counts in int before CUDA 13, and would count what is more as something else.
  static constexpr std::uint64_t max_values = CUB_VERSION >= 300000
                                                  ? std::numeric_limits<std::uint32_t>::max()
                                                  : std::numeric_limits<std::int32_t>::max();

  /// Time of the GPU.
  class Clock {
   public:
    Clock() = default;
    ~Clock() {
      for (const cudaEvent_t event : events_) {
        cudaEventDestroy(event);
      }
    }
    Clock(const Clock&) = delete;
    Clock& operator=(const Clock&) = delete;

    void start(CudaExecutor& executor) {
      stages_.clear();
      record(executor, 0);
    }
    void end(CudaExecutor& executor, const char* stage) {
      record(executor, stages_.size() + 1);
      stages_.push_back(stage);
    }
    std::vector<DeviceStage> stages() const {
      std::vector<DeviceStage> stages;
      for (std::size_t i = 0; i < stages_.size(); ++i) {
        float milliseconds = 0.0F;
        check(cudaEventSynchronize(events_[i + 1]));
        check(cudaEventElapsedTime(&milliseconds, events_[i], events_[i + 1]));
        stages.push_back({stages_[i], 1e-3 * static_cast<double>(milliseconds)});
      }
      return stages;
    }

   private:
    /// The end of so many stages.
    void record(CudaExecutor& executor, std::size_t stages) {
      if (events_.size() == stages) {
        cudaEvent_t event = nullptr;
        check(cudaEventCreate(&event));
        events_.push_back(event);
      }
      check(cudaEventRecord(events_[stages], executor.stream_));
    }

    std::vector<const char*> stages_;
    std::vector<cudaEvent_t> events_;  // one more
  };

  /// A point in the work that the GPU has been given.
  class Mark {
   public:
    Mark() { check(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming)); }
    ~Mark() { cudaEventDestroy(event_); }
    Mark(const Mark&) = delete;
    Mark& operator=(const Mark&) = delete;

    void set(CudaExecutor& executor) { check(cudaEventRecord(event_, executor.stream_)); }
    void wait() const { check(cudaEventSynchronize(event_)); }

   private:
    cudaEvent_t event_ = nullptr;
  };

  class Turn : GpuTurn {
   public:
    explicit Turn(const CudaExecutor& executor) : GpuTurn(executor.own_) {}
  };

  CudaExecutor() = default;
  CudaExecutor(const CudaExecutor&) = delete;
  CudaExecutor& operator=(const CudaExecutor&) = delete;

  template <class T>
  void upload(const T* from, std::size_t count, Buffer<T>& to) {
    to.resize(count);
    pinned_.upload(from, count * sizeof(T), to.data(), stream_);
  }
  template <class T>
  void upload_in_place(const T* from, std::size_t count, Buffer<T>& to) {
    if (!is_page_locked(from, count * sizeof(T))) {
      upload(from, count, to);
      return;
    }
    to.resize(count);
    const cudaError_t error =
        cudaMemcpyAsync(to.data(), from, count * sizeof(T), cudaMemcpyHostToDevice, stream_);
    if (error == cudaErrorInvalidValue) {
      cudaGetLastError();  // not all of it is page-locked, or not by one lock
      upload(from, count, to);
      return;
    }
    check(error);
  }

  template <class T>
  void download(const Buffer<T>& from, std::size_t first, std::size_t count, T* to) {
    download_from(from.data() + first, count, to);
  }
  template <class T>
  void download_from(const T* from, std::size_t count, T* to) {
    pinned_.download(from, count * sizeof(T), to, stream_);
  }

  template <class T>
  void send(const Buffer<T>& from, std::size_t first, std::size_t count, HostBuffer<T>& to) {
    check(cudaMemcpyAsync(to.data() + first, from.data() + first, count * sizeof(T),
                          cudaMemcpyDeviceToHost, sending_));
  }
  void wait_for_sent() { check(cudaStreamSynchronize(sending_)); }

  std::shared_ptr<void> lock_pages(const void* data, std::size_t bytes) {
    return std::make_shared<PageLock>(data, bytes);
  }

  std::optional<int> gpu() const { return own_; }

  std::size_t memory_bytes() const {
    return memory_.bytes() + other_keys_.bytes() + other_values_.bytes() + other_pairs_.bytes();
  }

  void require_own(const void* pointer) {
    cudaPointerAttributes attributes;
    check(cudaPointerGetAttributes(&attributes, pointer));
    const bool is_readable =
        attributes.type == cudaMemoryTypeDevice || attributes.type == cudaMemoryTypeManaged;
    if (!is_readable || attributes.device != own_) {
      throw std::invalid_argument(
          is_readable ? "the points are on GPU " + std::to_string(attributes.device) +
                            ", the engine is on GPU " + std::to_string(own_)
                      : std::string("the points are not in the memory of a GPU"));
    }
  }

  void wait_for_others() { check(cudaDeviceSynchronize()); }

  void add_up(Buffer<std::uint32_t>& values, std::size_t first, std::size_t count) {
    std::uint32_t* const from = values.data() + first;
    with_memory([&](void* memory, std::size_t& bytes) {
      return cub::DeviceScan::InclusiveSum(memory, bytes, from, from, count, stream_);
    });
  }

  template <class T>
  void zero(Buffer<T>& buffer) {
    check(cudaMemsetAsync(buffer.data(), 0, buffer.size() * sizeof(T), stream_));
  }

  template <class Call>
  void for_each(std::uint32_t count, const Call& call) {
    const std::uint32_t blocks = (count + threads_per_block - 1) / threads_per_block;
    run_each<<<blocks, threads_per_block, 0, stream_>>>(count, call);
    check(cudaGetLastError());
  }

  template <class Call>
  void for_each_warp(std::uint32_t count, const Call& call) {
    const std::uint32_t blocks = (count + warps_per_block - 1) / warps_per_block;
    run_warps<<<blocks, threads_per_block, 0, stream_>>>(count, call);
    check(cudaGetLastError());
  }

  void sort_by_key(Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, std::size_t count,
                   int bits) {
    other_keys_.resize(count);
    other_values_.resize(count);
    with_memory([&](void* memory, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortPairs(memory, bytes, keys.data(), other_keys_.data(),
                                             values.data(), other_values_.data(), count, 0, bits,
                                             stream_);
    });
    keys.swap(other_keys_);
    values.swap(other_values_);
  }

  void sort(Buffer<std::uint64_t>& keys, std::size_t count, int bits) {
    constexpr int half = 32;
    other_pairs_.resize(keys.size());
    for (const int first : {0, half}) {
      with_memory([&](void* memory, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortKeys(memory, bytes, keys.data(), other_pairs_.data(),
                                              count, first, first + bits, stream_);
      });
      keys.swap(other_pairs_);
    }
  }

 private:
  /// Calls as CUB wants it: once to learn how many bytes it works in.
  template <class Call>
  void with_memory(const Call& call) {
    std::size_t bytes = 0;
    check(call(nullptr, bytes));
    memory_.resize(std::max<std::size_t>(bytes, 1));
    check(call(memory_.data(), bytes));
  }

  /// Work that the GPU does one after the other.
  class Stream {
   public:
    Stream() { check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking)); }
    ~Stream() { cudaStreamDestroy(stream_); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    operator cudaStream_t() const { return stream_; }

   private:
    cudaStream_t stream_ = nullptr;
  };

  const int own_ = current_gpu();
  Stream stream_;
  Stream sending_;
  PinnedPieces pinned_{own_};
  Buffer<char> memory_;
  Buffer<std::uint32_t> other_keys_;
  Buffer<std::uint32_t> other_values_;
  Buffer<std::uint64_t> other_pairs_;
};

/// @throws std::runtime_error if there is no GPU that serves
void require_device() {
  const std::string wanted =
      "cuda_tree needs an NVIDIA GPU of compute capability 7.5 or newer and a driver for CUDA " +
      std::to_string(CUDART_VERSION / 1000) + "; ";
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error != cudaSuccess) {
    cudaGetLastError();
    throw std::runtime_error(wanted + "asked for one, CUDA says: " + cudaGetErrorString(error));
  }
  if (count == 0) {
    throw std::runtime_error(wanted + "CUDA finds none");
  }
  cudaDeviceProp device;
  check(cudaGetDeviceProperties(&device, current_gpu()));
  if (10 * device.major + device.minor < 75) {
    throw std::runtime_error(wanted + "this one is " + device.name + ", of " +
                             std::to_string(device.major) + "." + std::to_string(device.minor));
  }
}

}  // namespace

/// The symbol that device_module.cpp looks for.
extern "C" FIBER_PROXIMITY_EXPORT Device* fiber_proximity_make_cuda_device() {
  require_device();
  return std::make_unique<DeviceOf<CudaExecutor>>(std::make_shared<CudaExecutor>()).release();
}

}  // namespace fiber
