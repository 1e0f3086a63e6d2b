// The only file that is compiled by CUDA.
#include <cuda_runtime.h>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <memory>
#include <string>

#include "bernal/core/error.hpp"
#include "soft/coloured_spheres.hpp"

namespace bernal {
namespace {

void check(cudaError_t code, const char* what) {
  if (code == cudaSuccess) return;
  throw Error(ErrorCode::bad_scene,
              std::string("the GPU cannot ") + what + ": " + cudaGetErrorString(code) +
                  (code == cudaErrorMemoryAllocation ? "; leave \"device\" out, or pack fewer spheres" : ""));
}

template <class T>
class GpuArray {
 public:
  GpuArray() = default;
  ~GpuArray() { cudaFree(data_); }
  GpuArray(const GpuArray&) = delete;
  GpuArray& operator=(const GpuArray&) = delete;

  std::size_t size() const { return size_; }
  T* data() const { return data_; }
  void resize_anew(std::size_t n) {
    if (n > room_) {
      cudaFree(data_);
      data_ = nullptr;
      room_ = size_ = 0;
      check(cudaMalloc(&data_, n * sizeof(T)), "give memory");
      room_ = n;
    }
    size_ = n;
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0, room_ = 0;
};

constexpr unsigned threads_a_block = 128;

template <class Function>
__global__ void call_each(std::uint32_t n, Function function) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < n) function(i);
}

/// All calls go into the default stream, one after the other.
class Gpu {
 public:
  template <class T>
  using Array = GpuArray<T>;

  Gpu() {
    int count = 0;
    const cudaError_t code = cudaGetDeviceCount(&count);
    if (code != cudaSuccess || count == 0)
      throw Error(ErrorCode::bad_scene,
                  std::string("no NVIDIA GPU answers here (") +
                      (code != cudaSuccess ? cudaGetErrorString(code) : "there is none") +
                      "); leave \"device\" out, and the processor packs");
    cudaDeviceProp about{};
    check(cudaGetDeviceProperties(&about, 0), "be asked what it is");
    name_ = about.name;
    check(cudaSetDevice(0), "be used");
  }

  std::string name() const { return name_; }

  template <class T>
  void to(Array<T>& array, const std::vector<T>& values) {
    check(cudaMemcpy(array.data(), values.data(), values.size() * sizeof(T), cudaMemcpyHostToDevice),
          "take values");
  }
  template <class T>
  std::vector<T> from(const Array<T>& array, std::size_t count) {
    std::vector<T> values(count);
    check(cudaMemcpy(values.data(), array.data(), count * sizeof(T), cudaMemcpyDeviceToHost), "give values");
    return values;
  }
  template <class T>
  void set(Array<T>& array, std::size_t k, const T& value) {
    check(cudaMemcpy(array.data() + k, &value, sizeof(T), cudaMemcpyHostToDevice), "take a value");
  }
  template <class T>
  T at(const Array<T>& array, std::size_t k) {
    T value{};
    check(cudaMemcpy(&value, array.data() + k, sizeof(T), cudaMemcpyDeviceToHost), "give a value");
    return value;
  }
  template <class T>
  void fill_zero(Array<T>& array, std::size_t n) {
    check(cudaMemsetAsync(array.data(), 0, n * sizeof(T)), "fill memory");
  }

  template <class Function>
  void each(std::uint32_t n, const Function& function) {
    if (n == 0) return;
    call_each<<<(n + threads_a_block - 1) / threads_a_block, threads_a_block>>>(n, function);
    check(cudaGetLastError(), "start a kernel");
  }

  void sort(Array<std::uint32_t>& keys, Array<std::uint32_t>& values, std::size_t n, int bits) {
    other_keys_.resize_anew(n);
    other_values_.resize_anew(n);
    const auto call = [&](void* room, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortPairs(room, bytes, keys.data(), other_keys_.data(), values.data(),
                                             other_values_.data(), n, 0, bits);
    };
    with_room(call, "sort");
    copy(keys, other_keys_, n);
    copy(values, other_values_, n);
  }
  void sums_before(Array<std::uint32_t>& array, std::size_t n) {
    fill_zero_at(array, n);
    with_room(
        [&](void* room, std::size_t& bytes) {
          return cub::DeviceScan::ExclusiveSum(room, bytes, array.data(), array.data(), n + 1);
        },
        "add up");
  }
  void wait() { check(cudaDeviceSynchronize(), "go on"); }

 private:
  /// CUB says first how much room it needs.
  template <class Call>
  void with_room(const Call& call, const char* what) {
    std::size_t bytes = 0;
    check(call(nullptr, bytes), what);
    room_.resize_anew(bytes);
    check(call(room_.data(), bytes), what);
  }
  template <class T>
  void copy(Array<T>& to, const Array<T>& from, std::size_t n) {
    check(cudaMemcpyAsync(to.data(), from.data(), n * sizeof(T), cudaMemcpyDeviceToDevice), "copy");
  }
  void fill_zero_at(Array<std::uint32_t>& array, std::size_t k) {
    check(cudaMemsetAsync(array.data() + k, 0, sizeof(std::uint32_t)), "fill memory");
  }

  std::string name_;
  Array<std::uint32_t> other_keys_, other_values_;
  Array<unsigned char> room_;
};

}  // namespace

void require_gpu() { Gpu gpu; }
std::unique_ptr<DeviceSpheres> spheres_on_gpu() { return std::make_unique<ColouredSpheres<Gpu>>(); }

}  // namespace bernal
