#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <limits>
#include <new>

namespace delquad {

/// Allocates large arrays that are read in no order on pages of two megabytes, where the system has them:
/// finding the place of a small page in memory costs about as much as reading from it.
template <class Item>
struct HugePageAllocator {
  using value_type = Item;

  HugePageAllocator() = default;
  template <class Other>
  HugePageAllocator(const HugePageAllocator<Other>&) {}

  Item* allocate(std::size_t n) {
    if (n > std::numeric_limits<std::size_t>::max() / sizeof(Item)) throw std::bad_array_new_length();
    const std::size_t size = n * sizeof(Item);
    void* const items = ::operator new(size, alignment(size));
#ifdef MADV_HUGEPAGE
    if (size >= kPage) madvise(items, size, MADV_HUGEPAGE);  // a hint: nothing depends on it
#endif
    return static_cast<Item*>(items);
  }
  void deallocate(Item* items, std::size_t n) { ::operator delete(items, alignment(n * sizeof(Item))); }
  template <class Other>
  bool operator==(const HugePageAllocator<Other>&) const {
    return true;
  }

 private:
  static constexpr std::size_t kPage = std::size_t{1} << 21;
  static std::align_val_t alignment(std::size_t size) {
    return std::align_val_t{size >= kPage ? kPage : alignof(Item)};
  }
};

}  // namespace delquad
