// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Compiles one copy of a function for each width of vectors of x86-64, chosen when the program starts; the bits are the
// same if multiplications and additions stay separate (-ffp-contract=off). The sanitizers cannot start a program that
// chooses this way.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define KILN_ANY_VECTOR_WIDTH __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define KILN_ANY_VECTOR_WIDTH
#endif
