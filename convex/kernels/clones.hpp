#pragma once

/// Loops so marked are compiled for several generations of x86-64 and the best is chosen when the program
/// starts, so that one binary runs anywhere at the machine's speed. Results are the same bit by bit: products
/// and sums are not contracted.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define MOREAU_CLONES [[gnu::target_clones("arch=skylake-avx512", "arch=haswell", "default")]]
#else
#define MOREAU_CLONES
#endif
