// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include <dlfcn.h>
#include <elf.h>
#include <linux/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

/// For LD_PRELOAD of user-mode-linux. Its kernel 6.1 sets the vector registers of a process from a
/// buffer of the size that processors had before AMX; newer kernels refuse a buffer that does not
/// hold all registers (EFAULT), and the guest panics at its first process. Such a buffer is
/// completed with registers that are not in use.
extern "C" long ptrace(int request, pid_t process, void* address, void* data) {
  using Ptrace = long (*)(int, ...);
  static Ptrace next = nullptr;
  static std::array<char, 65536> registers;  // 11 KiB with AMX.
  static std::size_t size = 0;               // Of all of them; 0: buffers are not too small.
  if (next == nullptr) {
    next = reinterpret_cast<Ptrace>(::dlsym(RTLD_NEXT, "ptrace"));
  }
  if (request != PTRACE_SETREGSET || address != reinterpret_cast<void*>(NT_X86_XSTATE)) {
    return next(request, process, address, data);
  }
  iovec all{registers.data(), registers.size()};
  if (size == 0) {
    const long result = next(request, process, address, data);
    if (result == 0 || errno != EFAULT || next(PTRACE_GETREGSET, process, address, &all) != 0) {
      return result;
    }
    size = all.iov_len;
  }
  const iovec& some = *static_cast<const iovec*>(data);
  std::memcpy(registers.data(), some.iov_base, std::min(some.iov_len, size));
  all.iov_len = size;
  return next(request, process, address, &all);
}
