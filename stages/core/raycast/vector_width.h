// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// One copy of a function for each width of vectors that x86-64 has, chosen when the program starts; the bits are the
// same where multiplications and additions stay apart (-ffp-contract=off). The sanitizers cannot start a program that
// chooses this way.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define KILN_ANY_VECTOR_WIDTH __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define KILN_ANY_VECTOR_WIDTH
#endif
