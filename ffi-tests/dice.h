/* Random numbers of the C tests: the same ones on every machine. */
#ifndef DICE_H
#define DICE_H

#include <math.h>
#include <stdint.h>

static uint64_t dice_state = 1;

/* In [-1, 1). */
static inline double dice(void) {
    dice_state = dice_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(int64_t)(dice_state ^ dice_state >> 31) / 9223372036854775808.0;
}

static inline double between(double low, double high) { return low + (high - low) * 0.5 * (dice() + 1); }

/* 10 to the power of a number in [low, high). */
static inline double decade(double low, double high) { return pow(10, between(low, high)); }

/* 0 to n - 1. */
static inline unsigned below(unsigned n) {
    const unsigned k = (unsigned)(0.5 * (dice() + 1) * n);
    return k < n ? k : n - 1;
}

/* A random unit vector. */
static inline void random_direction(double *u, int n) {
    double square;
    do {
        square = 0;
        for (int i = 0; i < n; ++i) u[i] = dice(), square += u[i] * u[i];
    } while (square > 1 || square < 0.01);
    for (int i = 0; i < n; ++i) u[i] /= sqrt(square);
}

#endif
