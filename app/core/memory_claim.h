#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace pregrasp {

/// Bytes that are held somewhere and counted together with others of one meter, for as long as the
/// claim lives. The meter may end before its claims.
class MemoryClaim {
 public:
  using Meter = std::shared_ptr<std::size_t>;

  MemoryClaim() = default;
  explicit MemoryClaim(Meter meter, std::size_t bytes = 0) : meter_(std::move(meter)) {
    Grow(bytes);
  }
  ~MemoryClaim() { Release(); }
  MemoryClaim(MemoryClaim&& other) noexcept
      : meter_(std::move(other.meter_)), bytes_(std::exchange(other.bytes_, 0)) {}
  MemoryClaim& operator=(MemoryClaim&& other) noexcept {
    if (this == &other) return *this;
    Release();
    meter_ = std::move(other.meter_);
    bytes_ = std::exchange(other.bytes_, 0);
    return *this;
  }
  MemoryClaim(const MemoryClaim&) = delete;
  MemoryClaim& operator=(const MemoryClaim&) = delete;

  std::size_t bytes() const { return bytes_; }

  /// Nothing without a meter.
  void Grow(std::size_t bytes) {
    if (!meter_) return;
    *meter_ += bytes;
    bytes_ += bytes;
  }

 private:
  void Release() {
    if (meter_) *meter_ -= bytes_;
    bytes_ = 0;
  }

  Meter meter_;
  std::size_t bytes_ = 0;
};

}  // namespace pregrasp
