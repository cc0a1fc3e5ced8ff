/* Counts checks. A program of C tests ends with `return finish("name");`. */
#ifndef TEST_H
#define TEST_H

#include <stdio.h>

static int passed, failed;

#define CHECK(condition) check((condition) ? 1 : 0, #condition, __FILE__, __LINE__)

static void check(int holds, const char *text, const char *file, int line) {
    if (holds) {
        ++passed;
    } else {
        ++failed;
        printf("%s:%d: %s\n", file, line, text);
    }
}

static int finish(const char *name) {
    printf("%s: %d passed, %d failed\n", name, passed, failed);
    return failed != 0;
}

#endif
