/* Start-up of a Cortex-M4F or M7 without any library: vectors, FPU, memory; of a C library nothing is needed. Semihosting prints and leaves. */
#include "board.h"

extern uint32_t data_begin[], data_end[], data_image[], bss_begin[], bss_end[], stack_top[];

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define TIMER_CONTROL REGISTER(0x40000000) /* the board's first timer counts 32 bits downwards */
#define TIMER_VALUE REGISTER(0x40000004)
#define TIMER_RELOAD REGISTER(0x40000008)
#define COPROCESSORS REGISTER(0xE000ED88)

/* Semihosting's operations. */
enum { WRITE0 = 0x04, EXIT_EXTENDED = 0x20 };

static void host(uint32_t operation, const void *argument) {
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

static void leave(uint32_t code) {
    const uint32_t reason_and_code[2] = {0x20026, code}; /* the application has come to its end */
    host(EXIT_EXTENDED, reason_and_code);
    for (;;) {
    }
}

static void fault(void) {
    board_print("fault\n");
    leave(255);
}

__attribute__((noreturn)) void reset(void) {
    COPROCESSORS |= 0xFu << 20; /* the FPU may be used */
    __asm__ volatile("dsb\n\tisb");
    for (uint32_t *to = data_begin, *from = data_image; to < data_end;) *to++ = *from++;
    for (uint32_t *to = bss_begin; to < bss_end;) *to++ = 0;
    TIMER_RELOAD = TIMER_VALUE = UINT32_MAX;
    TIMER_CONTROL = 1;
    leave((uint32_t)main());
    __builtin_unreachable();
}

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handler[15])(void);
} vectors = {stack_top, {reset, fault, fault, fault, fault, fault}};

/* Ticks are 25 MHz, and with -icount shift=6 an instruction takes 64 ns. */
uint32_t board_instructions(void) { return (uint32_t)((uint64_t)(UINT32_MAX - TIMER_VALUE) * 5 >> 3); }

void board_print(const char *text) { host(WRITE0, text); }

static uint32_t *painted_from;
enum { PAINT = 0xA5A5A5A5, PAINTED = 64 * 1024 / 4 };

__attribute__((noinline)) void board_paint(void) {
    painted_from = (uint32_t *)__builtin_frame_address(0);
    for (volatile uint32_t *p = painted_from - PAINTED; p < painted_from - 16; ++p) *p = PAINT;
}

__attribute__((noinline)) uint32_t board_painted(void) {
    const volatile uint32_t *p = painted_from - PAINTED;
    while (p < painted_from && *p == PAINT) ++p;
    return (uint32_t)((uintptr_t)painted_from - (uintptr_t)p);
}
