// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cerrno>
#include <cstring>

#include <dlfcn.h>
#include <elf.h>
#include <linux/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

/// For LD_PRELOAD of user-mode-linux. Its kernel 6.1 sets the vector registers of a process from a
/// buffer of the size that processors had before AMX; newer kernels refuse a buffer that does not
/// hold all registers (EFAULT), and the guest panics at its first process. Such a buffer is
/// completed with the present content of the registers that it lacks.
extern "C" long ptrace(int request, pid_t process, void* address, void* data) {
  using Ptrace = long (*)(int, ...);
  static Ptrace next = nullptr;
  if (next == nullptr) {
    next = reinterpret_cast<Ptrace>(::dlsym(RTLD_NEXT, "ptrace"));
  }
  const long result = next(request, process, address, data);
  if (result == 0 || errno != EFAULT || request != PTRACE_SETREGSET ||
      address != reinterpret_cast<void*>(NT_X86_XSTATE)) {
    return result;
  }
  static std::array<char, 65536> registers;  // 11 KiB with AMX.
  const iovec& some = *static_cast<const iovec*>(data);
  iovec all{registers.data(), registers.size()};
  if (next(PTRACE_GETREGSET, process, address, &all) != 0 || some.iov_len > all.iov_len) {
    return -1;
  }
  std::memcpy(registers.data(), some.iov_base, some.iov_len);
  return next(PTRACE_SETREGSET, process, address, &all);
}
