/* No operating system library at all: own entry point, own memory functions, one system call to leave. The exit status is 0 when
 * the answer is right. x86-64 Linux; a firmware looks the same without the system call. */
#include "qdist.h"

void *memcpy(void *to, const void *from, size_t n) {
    unsigned char *t = to;
    const unsigned char *f = from;
    while (n--) *t++ = *f++;
    return to;
}

void *memmove(void *to, const void *from, size_t n) {
    unsigned char *t = to;
    const unsigned char *f = from;
    if (t < f) return memcpy(to, from, n);
    while (n--) t[n] = f[n];
    return to;
}

void *memset(void *to, int byte, size_t n) {
    unsigned char *t = to;
    while (n--) *t++ = (unsigned char)byte;
    return to;
}

int memcmp(const void *a, const void *b, size_t n) {
    const unsigned char *x = a, *y = b;
    for (; n--; ++x, ++y)
        if (*x != *y) return *x < *y ? -1 : 1;
    return 0;
}

int bcmp(const void *a, const void *b, size_t n) { return memcmp(a, b, n); }

static uint64_t memory[QDIST_WORKSPACE_WORDS_F32(3, 32, 64)];

/* 0: right. */
static int run(void) {
    static const qdist_box_f32 box = {{1.0f, 2.0f, 3.0f}};
    qdist_solver *solver;
    qdist_body_f32 a, b;
    qdist_depth_f32 depth;

    if (qdist_solver_init_f32(memory, sizeof memory, 3, 32, 64, &solver) != QDIST_OK) return 1;
    if (qdist_body_box_f32(&a, &box) != QDIST_OK || qdist_body_box_f32(&b, &box) != QDIST_OK) return 2;
    b.translation[0] = 1.25f;
    b.translation[1] = 0.5f;
    depth.struct_size = sizeof depth;
    if (qdist_depth3_f32(solver, &a, &b, 0, &depth) != QDIST_OK) return 3;
    if (depth.outcome != QDIST_CONVERGED || !(depth.lower <= 0.75f && 0.75f <= depth.upper)) return 4;
    if (!(depth.upper - depth.lower < 1e-3f) || !(depth.normal[0] > 0.999f)) return 5;
    if (qdist_depth3_f32(solver, &a, 0, 0, &depth) != QDIST_ERROR_NULL) return 6;
    return 0;
}

__attribute__((noreturn, used)) static void leave(void) {
    const long code = run();
    __asm__ volatile("syscall" : : "a"(60L), "D"(code) : "rcx", "r11", "memory");
    for (;;) {
    }
}

/* The kernel enters with an aligned stack; a call pushes an address, as the calling convention wants. */
__asm__(".globl _start\n_start:\n\txor %ebp, %ebp\n\tcall leave\n");
