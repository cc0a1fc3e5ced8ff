#!/bin/sh
# Writes include/qdist.h. With --check: fails when that would change it.
set -eu
cd "$(dirname "$0")/.."
version=0.29.4
out=$(mktemp)
trap 'rm -f "$out" "$out.toml" "$out.warnings"' EXIT

if ! cbindgen --version 2>/dev/null | grep -qF "cbindgen $version"; then
    echo "installing cbindgen $version" >&2
    cargo install --quiet --locked cbindgen --version "=$version"
fi

# Functions of the chapter $2 with the settings $1. A file by itself refers to types of other files: those warnings are left out;
# the C compiler checks the whole.
chapter() {
    sed -n 's|^//! \{0,1\}||p' "$2" | awk -v suffix="$3" '
        NR == 1 {
            title = $0 suffix
            line = sprintf("%" int((126 - length(title)) / 2) "s", "")
            gsub(/ /, "=", line)
            text = "\n/* " line " " title " " line
            next
        }
        suffix == "" { text = text "\n *" ($0 == "" ? "" : " " $0) }
        END { print text " */\n" }'
    cbindgen --config "$1" "$2" 2>"$out.warnings" || { cat "$out.warnings" >&2; exit 1; }
    grep -vE "^WARN: (Can't find qdist_|Skip .*::_ |Skip .*not .pub.|Skipping .*not .no_mangle.)|^$" "$out.warnings" >&2 || true
}

{
    cat src/capi/prelude.h
    for file in status version symmetry f64/solver f64/sets f64/shapes f64/points f64/combine f64/gauges f64/query f64/span f64/warm; do
        chapter cbindgen.toml "src/capi/$file.rs" ""
    done
    { echo 'documentation = false'; cat cbindgen.toml; } >"$out.toml"
    for file in solver sets shapes points combine gauges query span warm; do
        chapter "$out.toml" "src/capi/f32/$file.rs" ", FLOAT"
    done
    printf '\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n'
} | cat -s >"$out"

if [ "${1:-}" = --check ]; then
    diff -u include/qdist.h "$out" || { echo "include/qdist.h: stale; run \`make header\`" >&2; exit 1; }
else
    cp "$out" include/qdist.h
    chmod 644 include/qdist.h
fi
