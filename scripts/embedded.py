#!/usr/bin/env python3
"""Builds the programs of examples/cortex-m for a Cortex-M4F and a Cortex-M7, runs them in QEMU, and holds what they say against this machine's answers, to the last
bit, and against golden numbers of instructions, stack and flash (examples/cortex-m/golden.csv, to 3 %).

    scripts/embedded.py OUT [--write]
    scripts/embedded.py --lib CPU [--only "depth3_f32 body_* ..."]

OUT/embedded.csv has a row for every program. A panic that could be reached, a function of a C library, or a routine for double arithmetic in a program in float ends it:
such a program does not link. --write renews the golden numbers. --lib builds the library for a program of yours."""

import argparse
import csv
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAMS = ROOT / "examples" / "cortex-m"
GOLDEN = PROGRAMS / "golden.csv"
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "embedded"
TOLERANCE = 0.03
COLUMNS = ["program", "cpu", "scalar", "query", "asked", "converged", "median_instructions", "worst_instructions", "stack", "workspace", "flash", "ram"]

# Debian's compiler has the source of Rust's core library beside it, which other targets are built from.
RUSTC = "/usr/bin/rustc"
RUST_TARGET = "thumbv7em-none-eabihf"
CPUS = {
    "cortex-m4": {"flags": ["-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16"], "machine": "mps2-an386", "rust": ""},
    "cortex-m7": {"flags": ["-mcpu=cortex-m7", "-mfpu=fpv5-d16"], "machine": "mps2-an500", "rust": "-C target-cpu=cortex-m7"},
}
# What is one and the same for size and for speed.
OPT_LEVEL = "2"
C = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-O2", "-I", str(ROOT / "include")]

# name: (source, processor, defines)
SET = {
    "depth-boxes": ("depth", "cortex-m4", ["-DSCENE=1"]),
    "depth-capsule-ellipsoid": ("depth", "cortex-m4", ["-DSCENE=2"]),
    "depth-cylinder-cone": ("depth", "cortex-m4", ["-DSCENE=3"]),
    "depth-hull": ("depth", "cortex-m4", ["-DSCENE=4"]),
    "depth-callback": ("depth", "cortex-m4", ["-DSCENE=5"]),
    "haptic": ("haptic", "cortex-m4", []),
    "solve6": ("solve6", "cortex-m4", []),
    "in-span6": ("solve6", "cortex-m4", ["-DIN_SPAN"]),
    "quality-f32": ("quality", "cortex-m4", []),
    "quality-f64": ("quality", "cortex-m7", ["-DDOUBLE"]),
    "forces": ("forces", "cortex-m4", []),
    "gripper": ("gripper", "cortex-m4", []),
}


def run(command, **options):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)
    if done.returncode:
        sys.exit(f"{' '.join(str(part) for part in command)}\n{done.stdout}{done.stderr}embedded: that failed ({done.returncode})")
    return done.stdout


def library(cpu, only, features):
    """The static library for a processor, or for this machine, with these functions alone."""
    target = TARGET / (cpu or "host")
    environment = dict(os.environ, QDIST_ONLY=only, CARGO_TARGET_DIR=str(target))
    command = ["cargo", "rustc", "--quiet", "--locked", "--package", "qdist-capi", "--lib", "--release", "--features", features, "--crate-type", "staticlib"]
    if cpu is None:
        run(command, cwd=ROOT, env=environment)
        return target / "release" / "libqdist_capi.a"
    environment.update(RUSTC=RUSTC, RUSTC_BOOTSTRAP="1", RUSTFLAGS=CPUS[cpu]["rust"], CARGO_PROFILE_RELEASE_OPT_LEVEL=OPT_LEVEL)
    run(command + ["--target", RUST_TARGET, "-Zbuild-std=core,compiler_builtins"], cwd=ROOT, env=environment)
    return target / RUST_TARGET / "release" / "libqdist_capi.a"


def compiled(compiler, flags, source, defines, folder):
    """An object of a source file."""
    folder.mkdir(parents=True, exist_ok=True)
    made = folder / ("".join([source, *defines]).replace("-D", "-").replace("=", "") + ".o")
    run([compiler, *C, *flags, *defines, "-c", PROGRAMS / f"{source}.c", "-o", made])
    return made


def functions(objects):
    """The functions of qdist that objects call."""
    return sorted(set(re.findall(r" U (qdist_\w+)", run(["nm", *objects]))))


def arm(cpu):
    return [*CPUS[cpu]["flags"], "-mthumb", "-mfloat-abi=hard", "-ffreestanding", "-ffunction-sections", "-fdata-sections"]


def firmware(name, cpu, objects, lib):
    made = TARGET / cpu / f"{name}.elf"
    run(["arm-none-eabi-gcc", *arm(cpu), "-nostdlib", "-nostartfiles", "-T", PROGRAMS / "mps2.ld", "-Wl,--gc-sections", "-Wl,--no-warn-rwx-segments",
         "-Wl,-z,noexecstack", *objects, lib, "-o", made])
    if cpu == "cortex-m4":
        double = re.findall(r" (__aeabi_d\w+|__aeabi_f2d|__aeabi_[ul]*i?2d)$", run(["arm-none-eabi-nm", made]), re.MULTILINE)
        if double:
            sys.exit(f"embedded: {name} calculates in double: {' '.join(double)}")
    text, data, bss = (int(x) for x in run(["arm-none-eabi-size", made]).splitlines()[1].split()[:3])
    return made, text + data, data + bss


def emulated(cpu, image):
    # (What it prints comes by a device of its own: else it is among QEMU's own messages.)
    return run(["qemu-system-arm", "-chardev", "stdio,id=said", "-M", CPUS[cpu]["machine"], "-cpu", cpu, "-nographic", "-monitor", "none", "-serial", "none", "-semihosting-config",
                "enable=on,target=native,chardev=said", "-icount", "shift=6", "-kernel", image], stdin=subprocess.DEVNULL, timeout=1200)


def measured(out):
    """The rows of all programs."""
    objects = {}
    for name, (source, cpu, defines) in SET.items():
        folder = TARGET / cpu / "objects"
        objects[name] = [compiled("arm-none-eabi-gcc", arm(cpu), unit, defines if unit == source else [], folder) for unit in (source, "measure", "mps2")]
    used = {cpu: functions([path for name, parts in objects.items() if SET[name][1] == cpu for path in parts]) for cpu in CPUS}
    libraries = {}
    for cpu in CPUS:
        print(f"building the library for {cpu}, {len(used[cpu])} functions of it", flush=True)
        libraries[cpu] = library(cpu, " ".join(used[cpu]), "grasp,must-not-panic")
    print("building the same for this machine", flush=True)
    host = library(None, " ".join(sorted(set(sum(used.values(), [])))), "grasp,panic-handler")
    rows = []
    for name, (source, cpu, defines) in SET.items():
        image, flash, ram = firmware(name, cpu, objects[name], libraries[cpu])
        parts = [compiled("cc", ["-O2"], unit, defines if unit == source else [], TARGET / "host" / "objects") for unit in (source, "measure", "host")]
        here = TARGET / "host" / name
        run(["cc", *parts, host, "-Wl,--gc-sections", "-o", here])
        said, expected = emulated(cpu, image).strip(), run([here]).strip()
        query, asked, converged, median, worst, stack, workspace, answers = said.rsplit(",", 7)
        if answers != expected.rsplit(",", 1)[1]:
            sys.exit(f"embedded: {name} answers otherwise than this machine:\n  {said}\n  {expected}")
        scalar = "f64" if "-DDOUBLE" in defines else "f32"
        rows.append(dict(zip(COLUMNS, [name, cpu, scalar, query, asked, converged, median, worst, stack, workspace, flash, ram])))
        print(f"  {name}: {converged} of {asked} converged, {median} instructions, at most {worst}; stack {stack}, workspace {workspace}; flash {flash}", flush=True)
    with open(out, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return rows


def compared(rows):
    """What is off the golden numbers."""
    with open(GOLDEN, newline="") as file:
        golden = {row["program"]: row for row in csv.DictReader(file)}
    off = [f"{name}: golden, and not measured" for name in golden if name not in {row["program"] for row in rows}]
    for row in rows:
        before = golden.get(row["program"])
        for column in COLUMNS if before else []:
            was, now = before[column], str(row[column])
            close = was.isdigit() and now.isdigit() and abs(int(now) - int(was)) <= TOLERANCE * int(was)
            if was != now and not close:
                off.append(f"{row['program']}: {column} was {was}, is {now}")
        if not before:
            off.append(f"{row['program']}: not among the golden ones")
    return off


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", nargs="?", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--lib", choices=CPUS)
    parser.add_argument("--only", default="")
    asked = parser.parse_args()
    if asked.lib:
        made = TARGET.parent / asked.lib / "libqdist.a"
        made.parent.mkdir(parents=True, exist_ok=True)
        made.write_bytes(library(asked.lib, asked.only, "grasp,panic-handler").read_bytes())
        print(f"{made}: {'all functions' if not asked.only else 'functions: ' + asked.only}")
        return
    if not asked.out:
        parser.error("where should embedded.csv go?")
    asked.out.mkdir(parents=True, exist_ok=True)
    rows = measured(asked.out / "embedded.csv")
    if asked.write:
        GOLDEN.write_bytes((asked.out / "embedded.csv").read_bytes())
    off = compared(rows)
    print("\n".join(off))
    print(f"embedded: {len(rows) - len({line.split(':')[0] for line in off})} passed, {len(off)} failed")
    sys.exit(bool(off))


main()
