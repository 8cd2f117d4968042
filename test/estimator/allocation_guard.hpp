// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Counts every allocation of the process during a guard's lifetime. Include it in one source file
// of an executable only: it replaces malloc and related functions, which operator new calls too.
// With a sanitizer, which replaces them itself, the sanitizer's hook counts instead.

#include <cstddef>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__)
#define CREMED_HAS_SANITIZER_HOOK 1
#elif defined(__SANITIZE_THREAD__)
#define CREMED_HAS_SANITIZER_HOOK 1
#define CREMED_HAS_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CREMED_HAS_SANITIZER_HOOK 1
#elif __has_feature(thread_sanitizer)
#define CREMED_HAS_SANITIZER_HOOK 1
#define CREMED_HAS_THREAD_SANITIZER 1
#endif
#endif

namespace cremed {

/// ThreadSanitizer calls its hook for malloc, calloc and new only.
#ifdef CREMED_HAS_THREAD_SANITIZER
inline constexpr bool kGuardSeesAll = false;
#else
inline constexpr bool kGuardSeesAll = true;
#endif

inline volatile bool is_counting_allocations = false;
inline long allocation_count = 0;

/// Allocations since construction; one guard at a time, one thread.
class AllocationGuard {
 public:
  AllocationGuard() {
    allocation_count = 0;
    is_counting_allocations = true;
  }
  ~AllocationGuard() { is_counting_allocations = false; }
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// Stops counting; returns the number.
  static long stop() {
    is_counting_allocations = false;
    return allocation_count;
  }
  static void note() {
    if (is_counting_allocations) {
      ++allocation_count;
    }
  }
};

}  // namespace cremed

#ifdef CREMED_HAS_SANITIZER_HOOK

extern "C" int __sanitizer_install_malloc_and_free_hooks(  // NOLINT(readability-identifier-naming)
    void (*on_malloc)(const volatile void*, std::size_t), void (*on_free)(const volatile void*));

namespace cremed {
inline const int kInstalledHooks = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { AllocationGuard::note(); },
    [](const volatile void*) {});
}  // namespace cremed

#else

// glibc's functions by their alternative names.
// NOLINTBEGIN(readability-identifier-naming,clang-diagnostic-reserved-identifier)
extern "C" {
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* block, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;

void* malloc(std::size_t size) noexcept {
  cremed::AllocationGuard::note();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  cremed::AllocationGuard::note();
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  cremed::AllocationGuard::note();
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  cremed::AllocationGuard::note();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  cremed::AllocationGuard::note();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  cremed::AllocationGuard::note();
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? 12 : 0;  // ENOMEM
}
}
// NOLINTEND(readability-identifier-naming,clang-diagnostic-reserved-identifier)

#endif
