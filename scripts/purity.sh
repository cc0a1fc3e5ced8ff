#!/bin/sh
# Proves that no panic, no malloc and no libc symbol can be reached from the exported functions: with `must-not-panic` the
# panic handler calls a symbol that does not exist, and the library is linked with every function of the header as a root
# and nothing else but the mem* functions, which compilers expect everywhere. Then prints sizes.
set -eu
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target}/purity
cc=${CC:-cc}

echo "building the library with must-not-panic"
cargo rustc --quiet --locked --lib --release --features capi,must-not-panic --crate-type staticlib --target-dir "$target"
lib=$target/release/libqdist.a

# Functions of the header, from its declarations after the preprocessor.
functions=$("$cc" -E -P -Iinclude include/qdist.h | tr '\n' ' ' | tr ';' '\n' | sed -n 's/^.*[ *]\(qdist_[a-z0-9_]*\)(.*$/\1/p' | sort -u)
count=$(echo "$functions" | wc -l)
roots=$(echo "$functions" | sed 's/^/-u /')
memory='--defsym=memcpy=0 --defsym=memset=0 --defsym=memmove=0 --defsym=memcmp=0 --defsym=bcmp=0'

echo "linking with $count functions as roots"
# shellcheck disable=SC2086
if ! ld --gc-sections -e qdist_version $roots $memory -o "$target/all" "$lib" 2>"$target/all.log"; then
    cat "$target/all.log" >&2
    echo "purity: something that is not in the library is reachable" >&2
    exit 1
fi
for function in $functions; do
    nm "$target/all" | grep -q " T $function\$" || { echo "purity: $function is not exported" >&2; exit 1; }
done
# Would the link fail if a panic were reachable? The library must contain the call.
cat >"$target/reach.c" <<'C'
extern void qdist_panic_is_reachable(void);
void reach(void) { qdist_panic_is_reachable(); }
C
"$cc" -c "$target/reach.c" -o "$target/reach.o"
# shellcheck disable=SC2086
if ld --gc-sections -e reach $memory -o "$target/reach" "$target/reach.o" "$lib" 2>/dev/null; then
    echo "purity: the check itself does not work" >&2
    exit 1
fi
echo "purity: $count functions reach no panic, no allocation and no libc"

echo "sizes in bytes:"
# shellcheck disable=SC2086
size "$target/all" | awk 'NR == 2 { printf "  whole library: text %d, data %d, bss %d\n", $1, $2, $3 }'
cat >"$target/box.c" <<'C'
#include "qdist.h"
/* The depth of two boxes, float, 3-D: what a firmware would call. */
qdist_status box_depth(qdist_solver *solver, const qdist_box_f32 *a, const qdist_box_f32 *b, qdist_depth_f32 *depth);
qdist_status box_depth(qdist_solver *solver, const qdist_box_f32 *a, const qdist_box_f32 *b, qdist_depth_f32 *depth) {
    qdist_body_f32 x, y;
    if (qdist_body_box_f32(&x, a) != QDIST_OK || qdist_body_box_f32(&y, b) != QDIST_OK) return 1;
    return qdist_depth3_f32(solver, &x, &y, 0, depth);
}
C
"$cc" -O2 -ffunction-sections -ffreestanding -Iinclude -c "$target/box.c" -o "$target/box.o"
# shellcheck disable=SC2086
ld --gc-sections -e box_depth -u qdist_solver_init3_f32 $memory -o "$target/box" "$target/box.o" "$lib"
size "$target/box" | awk 'NR == 2 { printf "  boxes, 3-D, float: text %d, data %d, bss %d\n", $1, $2, $3 }'
# What a program does not use is not linked.
foreign=$(nm -C "$target/box" | grep -E ' [tT] ' | grep -E '_f64|ellipsoid|cone|cylinder|capsule|points|hull|gauge|init[2456]|solve[2-6]' || true)
if [ -n "$foreign" ]; then
    echo "purity: a program of boxes contains what it does not use:" >&2
    echo "$foreign" >&2
    exit 1
fi
