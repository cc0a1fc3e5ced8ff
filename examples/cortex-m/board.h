/* What the programs of this folder ask of the machine they run on: mps2.c is a Cortex-M board, host.c the machine that builds. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Instructions since some moment; 0 where nobody counts. */
uint32_t board_instructions(void);
/* Paints the free stack below the caller. */
void board_paint(void);
/* Bytes of stack that were touched below the last caller of board_paint. */
uint32_t board_painted(void);
void board_print(const char *text);
/* What main returns to: the code is the exit code of the emulator. */
int main(void);

#endif
