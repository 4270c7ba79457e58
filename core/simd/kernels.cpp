#include "kernels.hpp"

#include <cstdlib>
#include <stdexcept>

namespace carom {

namespace baseline {
Kernels kernels();
}
#if defined(CAROM_X86)
namespace avx2 {
Kernels kernels();
}
namespace avx512 {
Kernels kernels();
}
#endif

namespace {

// Those that this machine can run, slowest first.
const std::vector<Kernels>& available() {
    static const std::vector<Kernels> all = [] {
        std::vector<Kernels> found{baseline::kernels()};
#if defined(CAROM_X86)
        __builtin_cpu_init();
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
            found.push_back(avx2::kernels());
            if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
                found.push_back(avx512::kernels());
        }
#endif
        return found;
    }();
    return all;
}

}  // namespace

std::vector<std::string> simd_levels() {
    std::vector<std::string> names;
    for (const Kernels& k : available()) names.emplace_back(k.name);
    return names;
}

const Kernels& kernels(const std::string& level) {
    static const char* const forced = std::getenv("CAROM_SIMD");
    const std::string wanted = level.empty() && forced != nullptr ? forced : level;
    if (wanted.empty()) return available().back();
    std::string names;
    for (const Kernels& k : available()) {
        if (k.name == wanted) return k;
        names += (names.empty() ? "" : ", ") + std::string(k.name);
    }
    throw std::invalid_argument("this machine cannot run the instruction set '" + wanted +
                                "': choose one of " + names);
}

}  // namespace carom
