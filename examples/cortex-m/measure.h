/* Counts instructions and stack of queries, and makes one number of all that they answer: the same on every machine. */
#ifndef MEASURE_H
#define MEASURE_H

#include "board.h"
#include <stddef.h>

enum { POSES = 120 };

/* Before a query, and after it. */
void measure_begin(void);
void measure_end(void);
/* Whether the answer is what was asked for, and its numbers. */
void measure_answer(int converged);
void measure_numbers(const void *numbers, size_t bytes);
/* Prints `query,asked,converged,median,worst,stack,workspace,answers` and begins anew. */
void measure_report(const char *query, uint32_t workspace);
/* Ends the program: prints why, if a call was refused. */
int measure_refused(const char *call);

/* In [-1, 1), the same on every machine. */
float dice(void);
/* A random rotation, row by row. */
void random_rotation(float *rotation);

#endif
