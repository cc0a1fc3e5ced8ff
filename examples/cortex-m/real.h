/* The scalar of a program: float, or double with -DDOUBLE (a Cortex-M7 has an FPU for it). */
#ifndef REAL_H
#define REAL_H

#ifdef DOUBLE
typedef double real;
#define Q(name) qdist_##name##_f64
#define WORDS QDIST_WORKSPACE_WORDS_F64
#define WITHIN 1e-2
#else
typedef float real;
#define Q(name) qdist_##name##_f32
#define WORDS QDIST_WORKSPACE_WORDS_F32
#define WITHIN 1e-2f
#endif

#endif
