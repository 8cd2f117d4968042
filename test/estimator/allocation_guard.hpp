// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Counts every allocation of the process during the life of a guard. Include it in one source file
// of an executable only: it replaces malloc and related functions, which operator new calls. A
// sanitizer replaces them itself; then its hook counts.

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

/// ThreadSanitizer calls its hook only for malloc, calloc and new.
#ifdef CREMED_HAS_THREAD_SANITIZER
inline constexpr bool kGuardSeesAll = false;
#else
inline constexpr bool kGuardSeesAll = true;
#endif

// volatile: a compiler may assume that malloc and realloc change no variable of the program.
inline volatile bool is_counting_allocations = false;
inline volatile long allocation_count = 0;

/// Allocations since the guard was made; one guard at a time, one thread.
class AllocationGuard {
 public:
  AllocationGuard() {
    allocation_count = 0;
    is_counting_allocations = true;
  }
  ~AllocationGuard() { is_counting_allocations = false; }
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// Stops counting and returns the count.
  static long stop() {
    is_counting_allocations = false;
    return allocation_count;
  }
  static void note() {
    if (is_counting_allocations) {
      allocation_count = allocation_count + 1;
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

// glibc's own functions under their second names.
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
