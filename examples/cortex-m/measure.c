#include "measure.h"

static struct {
    uint32_t begin, asked, converged, stack, counts[1024];
    uint64_t answers;
} m;

void measure_begin(void) {
    board_paint();
    m.begin = board_instructions();
}

void measure_end(void) {
    const uint32_t count = board_instructions() - m.begin, stack = board_painted();
    uint32_t i = m.asked < 1024 ? m.asked : 1023;
    if (stack > m.stack) m.stack = stack;
    for (; i > 0 && m.counts[i - 1] > count; --i) m.counts[i] = m.counts[i - 1]; /* in order */
    m.counts[i] = count;
    m.asked++;
}

void measure_answer(int converged) { m.converged += converged != 0; }

void measure_numbers(const void *numbers, size_t bytes) {
    const unsigned char *p = numbers;
    while (bytes--) m.answers = (m.answers ^ *p++) * UINT64_C(0x100000001B3); /* Fowler, Noll & Vo */
}

static void print_number(uint64_t n, unsigned base, char end) {
    char text[24], *p = text + sizeof text;
    *--p = 0, *--p = end;
    do *--p = "0123456789abcdef"[n % base];
    while ((n /= base) != 0);
    board_print(p);
}

void measure_report(const char *query, uint32_t workspace) {
    board_print(query), board_print(",");
    print_number(m.asked, 10, ','), print_number(m.converged, 10, ',');
    print_number(m.counts[m.asked / 2], 10, ','), print_number(m.counts[m.asked - 1], 10, ',');
    print_number(m.stack, 10, ','), print_number(workspace, 10, ',');
    print_number(m.answers, 16, '\n');
    m.asked = m.converged = m.stack = 0, m.answers = 0;
}

int measure_refused(const char *call) {
    board_print(call), board_print(" is refused\n");
    return 1;
}

static uint64_t dice_state = 1;

float dice(void) {
    dice_state = dice_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (float)((int32_t)(dice_state >> 40) - (1 << 23)) / (float)(1 << 23);
}

/* R = I + 2 (w [v] + [v]^2) / (w^2 + |v|^2) of a quaternion (v, w) of any length: no root. */
void random_rotation(float *rotation) {
    float q[4], square;
    do {
        square = 0;
        for (int i = 0; i < 4; ++i) q[i] = dice(), square += q[i] * q[i];
    } while (square > 1 || square < 0.0625f);
    const float two = 2 / square;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        rotation[3 * i + i] = 1 - two * (q[j] * q[j] + q[k] * q[k]);
        rotation[3 * i + j] = two * (q[i] * q[j] - q[k] * q[3]);
        rotation[3 * i + k] = two * (q[i] * q[k] + q[j] * q[3]);
    }
}
