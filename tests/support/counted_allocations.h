// Counts the allocations of a program by replacing the global operators. For one file of a program alone.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace tutu::test {

inline std::atomic<long> allocations{0};

/// Null where there is no memory.
inline void* counted_allocation(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) noexcept {
  ++allocations;
  const std::size_t whole = (std::max<std::size_t>(size, 1) + alignment - 1) / alignment * alignment;
  return std::aligned_alloc(alignment, whole);
}

inline void* or_throw(void* memory) {
  if (!memory) throw std::bad_alloc();
  return memory;
}

} // namespace tutu::test

// GCC 12 pairs the replaced operators wrongly when it inlines one of them.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

// All that the standard library and AddressSanitizer have of their own, so that none of theirs meets one of ours.
void* operator new(std::size_t size) { return tutu::test::or_throw(tutu::test::counted_allocation(size)); }
void* operator new[](std::size_t size) { return tutu::test::or_throw(tutu::test::counted_allocation(size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return tutu::test::or_throw(tutu::test::counted_allocation(size, static_cast<std::size_t>(alignment)));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return tutu::test::or_throw(tutu::test::counted_allocation(size, static_cast<std::size_t>(alignment)));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return tutu::test::counted_allocation(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return tutu::test::counted_allocation(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
