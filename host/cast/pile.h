// An array that grows and keeps its memory.
#pragma once
#include <algorithm>
#include <cstring>
#include <memory>
#include <span>

namespace solidcast {

/// Things of which more are put at the end, without being cleared first.
template <class T>
class Pile {
 public:
  /// Room for more at the end, of which so much is kept as is taken.
  T* room(std::size_t count) {
    if (used_ + count > room_) {
      room_ = std::max<std::size_t>({2 * room_, used_ + count, 4096});
      auto bigger = std::make_unique_for_overwrite<T[]>(room_);
      if (used_ > 0) std::memcpy(bigger.get(), data_.get(), used_ * sizeof(T));
      data_ = std::move(bigger);
    }
    return data_.get() + used_;
  }
  void take(std::size_t count) { used_ += count; }
  void add(const T& one) { *room(1) = one, take(1); }
  void clear() { used_ = 0; }
  std::size_t size() const { return used_; }
  const T* data() const { return data_.get(); }
  operator std::span<const T>() const { return {data_.get(), used_}; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  std::unique_ptr<T[]> data_;
  std::size_t room_ = 0, used_ = 0;
};

}  // namespace solidcast
