// The floating-point environments that solvers are asked in.
#pragma once

#include <cfenv>
#include <string>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

// The one of this name (up, down, zero, ftz; any other: as usual) while it lives. (Bodies are made before, numbers printed behind.)
struct Mode {
    explicit Mode(const std::string &name) {
        if (name == "up") std::fesetround(FE_UPWARD);
        if (name == "down") std::fesetround(FE_DOWNWARD);
        if (name == "zero") std::fesetround(FE_TOWARDZERO);
#ifdef __SSE2__
        if (name == "ftz") _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
    }
    ~Mode() {
        std::fesetround(FE_TONEAREST);
#ifdef __SSE2__
        _mm_setcsr(_mm_getcsr() & ~0x8040u);
#endif
    }
};
