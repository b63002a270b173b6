#include "host/cli/heap.h"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <new>

namespace solidcast::cli {

void useLargePages() {
  constexpr int room = 64 << 20, most = 32 << 20;  // glibc takes no larger threshold
  constexpr std::uintptr_t page = 2 << 20;
  // Memory that goes back to the system comes back page by page.
  if (!mallopt(M_TOP_PAD, room) || !mallopt(M_MMAP_THRESHOLD, most) || !mallopt(M_TRIM_THRESHOLD, 8 * room)) return;
  const auto before = reinterpret_cast<std::uintptr_t>(sbrk(0));
  void* volatile more = std::malloc(1 << 20);  // more than there is: the heap grows by `room`
  std::free(more);
  const auto from = (before + page - 1) / page * page, to = reinterpret_cast<std::uintptr_t>(sbrk(0)) / page * page;
  if (from < to)
    madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);  // a wish: no matter if it is not heard
}

}  // namespace solidcast::cli

// A large scene's solids, bands and lists: in pages of 4 KiB, going over them is a miss of the address cache every 32
// solids. The sanitizers have an operator of their own.
#ifndef __SANITIZE_ADDRESS__
void* operator new(std::size_t bytes) {
  constexpr std::size_t page = std::size_t{2} << 20;
  for (;;) {
    void* at =
        bytes < 2 * page ? std::malloc(bytes ? bytes : 1) : std::aligned_alloc(page, (bytes + page - 1) / page * page);
    if (at && bytes >= 2 * page) madvise(at, bytes, MADV_HUGEPAGE);
    if (at) return at;
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
}
void operator delete(void* at) noexcept { std::free(at); }
void operator delete(void* at, std::size_t) noexcept { std::free(at); }
#endif
