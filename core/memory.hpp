// Memory: what limits the speed and the size of a large run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace carom {

// Asks for a cache line that will be needed in a moment. Volatile, because a compiler may find that
// a function which only asks has no effect, and drop the call.
inline void fetch(const void* line) {
#if defined(__GNUC__) && defined(__x86_64__)
    asm volatile("prefetcht1 %0" : : "m"(*static_cast<const char*>(line)));
#elif defined(__GNUC__)
    __builtin_prefetch(line);
#else
    (void)line;
#endif
}

// Brings a line from the large caches to the small one. Few at a time: the request is dropped when
// as many are under way as the processor can follow.
inline void fetch_near(const void* line) {
#if defined(__GNUC__) && defined(__x86_64__)
    asm volatile("prefetcht0 %0" : : "m"(*static_cast<const char*>(line)));
#else
    fetch(line);
#endif
}

// Large arrays start on a page of 2 MiB and ask for pages of that size, so that the processor finds
// its way among 300 MB with few looks into the page table.
template <class T>
struct LargePages {
    using value_type = T;
    static constexpr size_t kPage = size_t(1) << 21;

    LargePages() = default;
    template <class U>
    LargePages(const LargePages<U>&) {}
    template <class U>
    bool operator==(const LargePages<U>&) const {
        return true;
    }
    static size_t alignment(size_t bytes) {
        return bytes >= 2 * kPage ? kPage : std::max<size_t>(alignof(T), 64);
    }
    T* allocate(size_t n) {
        const size_t bytes = n * sizeof(T);
        void* p = ::operator new(bytes, std::align_val_t(alignment(bytes)));
#if defined(__linux__)
        if (bytes >= 2 * kPage) madvise(p, bytes, MADV_HUGEPAGE);
#endif
        return static_cast<T*>(p);
    }
    void deallocate(T* p, size_t n) {
        ::operator delete(p, std::align_val_t(alignment(n * sizeof(T))));
    }
};

// An array with one entry per sphere.
template <class T>
using Array = std::vector<T, LargePages<T>>;

// Grows a large array by an eighth instead of doubling it.
template <class T>
void grow(Array<T>& v) {
    if (v.size() == v.capacity()) v.reserve(v.size() + v.size() / 8 + 64);
    v.emplace_back();
}

}  // namespace carom
