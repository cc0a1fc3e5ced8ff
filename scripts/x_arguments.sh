#!/bin/sh
# What ./x refuses, it refuses at once: with exit code 2 and a word about the argument, before anything is installed or built. (make is one that
# says so when it is called.)
set -u
cd "$(dirname "$0")/.." || exit
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
printf '#!/bin/sh\necho make was called\n' >"$folder/make"
chmod +x "$folder/make"
: >"$folder/empty.txt"
echo a >"$folder/file"
passed=0 failed=0

# refused WORD ARGUMENTS...: the message has the word.
refused() {
    word=$1
    shift
    told=$(PATH="$folder:$PATH" ./x "$@" 2>&1)
    code=$?
    case "$code $told" in
        *'make was called'*) ;;
        "2 "*"$word"*)
            passed=$((passed + 1))
            return
            ;;
    esac
    failed=$((failed + 1))
    echo "./x $*: exit code $code, $told"
}

refused 'one command' need
refused 'one command' need test demo
refused 'no command nothing' need nothing
refused 'no command nothing' nothing
refused 'no file nofile' compare CASES=nofile
refused 'no file nofile' compare CASES="tests/data/std_hull8.txt nofile" "OUT=$folder/out"
refused 'names no file' compare CASES=
refused 'no program `nosuchcc`' lib CC=nosuchcc
refused 'no program' lib CARGO=
refused 'CPU=cortex-m4' lib-arm
refused 'cortex-m7, not' lib-arm CPU=m3
refused 'without qdist_' lib-arm CPU=cortex-m4 'ONLY=depth3_f32; ls'
refused 'is empty' compare "CASES=$folder/empty.txt"
refused 'does not know CASE' compare CASE=tests/data/std_hull8.txt
refused 'OUT' compare OUT=
refused 'OUT' compare "OUT=a b"
refused 'OUT' compare "OUT=$folder/file/out"
refused 'OUT' bench-dq OUT=/proc/out
refused 'QUICK' bench-dq QUICK=0
refused 'CHECK' compare CHECK=yes
refused 'does not know QUIK' bench-pdg QUIK=1
refused 'PART' record PART=convexes
refused 'PART' report PART=depths
refused 'COPY' report COPY=yes
refused 'AGAIN' bench-depth AGAIN=yes
refused 'does not know AGAIN' bench-dq AGAIN=1
refused 'A=dir B=dir' record-compare
refused 'A=dir B=dir' record-compare "A=$folder"
refused 'no folder' record-compare "A=$folder" "B=$folder/nothing"
refused 'not `now`' demo now
refused 'does not know OUT' demo OUT=out
refused 'CARGO_TARGET_DIR' lib "CARGO_TARGET_DIR=$folder/a b"
refused 'CARGO_TARGET_DIR' lib "CARGO_TARGET_DIR=$folder/it's"

# make takes them from the environment, too.
export CASES=nofile
refused 'no file nofile' compare
unset CASES
export PART=depths
refused 'PART' need report
export PART=depth OUT=/proc/out
refused 'no folder' need report
unset PART OUT
for name in 'a b' "it's" 'a"b' 'a,b' 'a$b' 'a`b' 'a\b' 'a;b' 'a#b'; do
    refused 'OUT' bench-dq "OUT=$folder/$name"
    export CARGO_TARGET_DIR="$folder/$name"
    refused 'CARGO_TARGET_DIR' lib
    refused 'CARGO_TARGET_DIR' need lib
    unset CARGO_TARGET_DIR
done

# What is right reaches make.
for command in 'compare CASES=tests/data/std_hull8.txt' "record-compare A=$folder B=$folder" 'demo CC=cc' "bench-dq QUICK=1 OUT=$folder/new"; do
    # shellcheck disable=SC2086
    case $(PATH="$folder:$PATH" ./x $command 2>&1) in
        *'make was called'* | *needs:*) passed=$((passed + 1)) ;;
        *) failed=$((failed + 1)) && echo "./x $command: refused" ;;
    esac
done

# README tells every command.
for command in $(./x | sed -n 's/^  \([a-z][a-z-]*\)\(, \([a-z-]*\)\)\{0,1\} .*/\1 \3/p'); do
    grep -q "^| .*\`./x $command[ \`]" README.md && passed=$((passed + 1)) && continue
    failed=$((failed + 1))
    echo "README's commands lack ./x $command"
done

echo "x_arguments: $passed passed, $failed failed"
[ "$failed" = 0 ]
