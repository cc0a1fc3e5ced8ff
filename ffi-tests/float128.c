/* A program with arithmetic in 113 bits, whose functions come from the library's compiler, links without dropping unused sections. */
#include "qdist.h"
#include "test.h"

int main(int count, char **arguments) {
    const qdist_box_f64 box = {{1, 2, 3}};
    qdist_body_f64 body;
    (void)arguments;
#ifdef __SIZEOF_FLOAT128__
    __extension__ __float128 x = count;
    x = x * x / 3 + (long long)count;
    CHECK((double)x * 3 == (double)count * count + 3.0 * count);
#endif
    CHECK(count > 0 && qdist_body_box_f64(&body, &box) == QDIST_OK);
    return finish("float128");
}
