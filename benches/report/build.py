"""Builds the programs that are measured, with every peer that is here; one that is not is left out, and told."""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

from report.job import ROOT

CPP = ROOT / "benches/report/cpp"
FFI = ROOT / "ffi-tests"
# Templates and inline functions of peers are compiled with the same flags as what they are compared with.
FLAGS = ["-std=c++17", "-O2", "-DNDEBUG", "-Wall", "-Wextra"]
EIGEN = "/usr/include/eigen3"
# As `ffi-tests/peers.cpp` needs them.
LIBRARIES = ["-lfcl", "-lccd", "-lqhullcpp", "-lqhull_r"]


def build(job, name="depth"):
    """Compiles a program of solvers (`depth`, `stiff`) where a source is newer, and returns its path."""
    adapters = [adapter for adapter in (bullet(), mujoco(), coal()) if is_here(job, adapter)]
    makers = {
        "peers": (FFI / "peers.cpp", [EIGEN]),
        "cases": (FFI / "cases.cpp", []),
        "qdist_query": (FFI / "qdist_query.cpp", []),
        **{adapter["name"]: (CPP / f"{adapter['name']}.cpp", adapter["includes"]) for adapter in adapters},
        name: (CPP / f"{name}.cpp", []),
    }
    has = [f"-DHAS_{adapter['name'].upper()}" for adapter in adapters]
    objects = [compiled(job, part, source, includes, has if part == name else []) for part, (source, includes) in makers.items()]
    link = [word for adapter in adapters for word in adapter["link"]]
    program = job.built / "+".join([name, *(adapter["name"] for adapter in adapters)])
    return made(program, [*objects, library()], [*cxx(), *objects, library(), *LIBRARIES, *link])


def build_parry(job):
    """Builds `depth_parry` and returns its path; None where that cannot be (crates.io is out of reach)."""
    package, target = ROOT / "benches/report/parry", job.built / "parry"
    job.say("building parry's program (a minute the first time)")
    try:
        call([os.environ.get("CARGO", "cargo"), "build", "--quiet", "--release", "--locked"], cwd=package, env={**os.environ, "CARGO_TARGET_DIR": str(target)})
    except subprocess.CalledProcessError:
        job.say("parry is left out: it cannot be built here")
        return None
    return target / "release/depth_parry"


def build_pdg(job):
    """Compiles FCL's part of the bench of meshes, and returns its path."""
    source = ROOT / "benches/pdg/fcl.cpp"
    return made(job.built / "pdg_fcl", [source, source.with_name("exchange.hpp")], [*cxx(), *FLAGS, "-isystem", EIGEN, source, "-lfcl", "-lccd"])


def build_triangles(job):
    """Compiles the programs that tell the deepest pair of triangles: {library: path}, of those that are here."""
    source = ROOT / "benches/pdg/triangles.cpp"
    programs = {"FCL": (["-isystem", EIGEN], ["-lfcl", "-lccd"])}
    if is_here(job, coal()):
        programs["coal"] = (["-DCOAL", *(word for folder in coal()["includes"] for word in ("-isystem", folder))], coal()["link"])
    return {name: made(job.built / f"triangles_{name}", [source, source.with_name("exchange.hpp")], [*cxx(), *FLAGS, *flags, source, *link]) for name, (flags, link) in programs.items()}


def build_growth(job):
    """Compiles `growth`, which has the library alone, and returns its path."""
    growth = compiled(job, "growth", CPP / "growth.cpp", [], [])
    return made(job.built / "growth", [growth, library()], [*cxx(), growth, library()])


def build_extremes(job):
    """Compiles `extremes`, which has the library and its own truth, and returns its path."""
    sources = [CPP / "extremes.cpp", library()]
    return made(job.built / "extremes", [*sources, CPP / "environment.hpp"], [*cxx(), "-std=gnu++17", "-O2", f"-I{ROOT / 'include'}", *sources, "-lquadmath"])


def build_oracle(job):
    """Compiles `oracle` where a source is newer, and returns its path."""
    sources = [CPP / "oracle.cpp", FFI / "cases.cpp"]
    return made(job.built / "oracle", sources, [*cxx(), "-std=gnu++17", "-O2", *sources, "-lquadmath", "-lqhullcpp", "-lqhull_r"])


# A peer: its name, which is its adapter's file too; the folders of its headers, and one header that is looked for; what it is linked with.


def bullet():
    return {"name": "bullet", "includes": ["/usr/include/bullet"], "header": "btBulletCollisionCommon.h", "link": ["-lBulletCollision-float64", "-lLinearMath-float64"]}


def mujoco():
    folder = wheels() / "mujoco"
    named = sorted(folder.glob("libmujoco.so.*")) or [folder / "libmujoco.so"]  # it has its version in its name
    return {"name": "mujoco", "includes": [folder / "include"], "header": "mujoco/mujoco.h", "link": [named[-1], f"-Wl,-rpath,{folder}"]}


def coal():
    folder = wheels() / "cmeel.prefix"
    # (Its own libraries are found beside it; the linker has to be told.)
    link = [folder / "lib/libcoal.so", f"-Wl,-rpath,{folder / 'lib'}", f"-Wl,-rpath-link,{folder / 'lib'}"]
    return {"name": "coal", "includes": [folder / "include", EIGEN], "header": "coal/collision.h", "link": link}


def wheels():
    """Where pip has put packages: this Python is the one of the report's virtual environment."""
    return Path(sysconfig.get_path("purelib"))


def is_here(job, adapter):
    files = [Path(adapter["includes"][0]) / adapter["header"], *(word for word in adapter["link"] if isinstance(word, Path))]
    missing = [file for file in files if not file.exists()]
    if missing:
        job.say(f"{adapter['name']} is left out: there is no {missing[0]}")
    return not missing


def compiled(job, name, source, includes, flags):
    """An object file. Which sources it is made from is told by the compiler; another set of peers is another file."""
    output = job.built / f"{name}{''.join(flags)}.o"
    depends = output.with_suffix(".d")
    sources = [source]
    if depends.exists():
        sources = [Path(word) for word in depends.read_text().replace("\\\n", " ").split()[1:]]
    folders = [f"-I{ROOT / 'include'}", *(word for folder in includes for word in ("-isystem", folder))]
    command = [*cxx(), *FLAGS, *flags, *folders, "-MD", "-MF", depends, "-c", source]
    return made(output, sources, command)


def made(output, sources, command):
    """Runs the command, with `-o output`, unless the output is newer than all of its sources."""
    if not output.exists() or any(not source.exists() or source.stat().st_mtime > output.stat().st_mtime for source in sources):
        call([*command, "-o", output])
    return output


def library():
    """The C library as it is released."""
    path = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "release/libqdist.a"
    sources = [file for folder in ("src", "capi") for file in (ROOT / folder).rglob("*.rs")]
    if not path.exists() or any(file.stat().st_mtime > path.stat().st_mtime for file in sources):
        call(["make", "--no-print-directory", "lib"], cwd=ROOT, stdout=sys.stderr)
    return path


def cxx():
    return os.environ.get("CXX", "c++").split()


def call(command, **more):
    subprocess.run([str(word) for word in command], check=True, **more)
