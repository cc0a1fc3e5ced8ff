"""Figures in README, made of the tables in docs/report and never typed in.

python3 benches/report/figures.py [--write]

A table stands between `<!-- figures: NAME -->` and `<!-- figures end -->`, and is made whole (TABLES). A figure in a sentence is found by the words around it
(SENTENCES). Without --write nothing is changed, and what differs is an error; so is anything else in README that looks like a measurement.
"""

import functools
import re
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from report import tables
from report.parts import cases

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs/report"


@functools.cache
def rows(name):
    found = tables.read(FOLDER / name)
    if not found:
        raise SystemExit(f"{FOLDER / name} is not there: ./x report COPY=1 makes it")
    return found


def one(name, **wanted):
    """The only row with these values."""
    found = [row for row in rows(name) if all(row[key] == value for key, value in wanted.items())]
    if len(found) != 1:
        raise SystemExit(f"{name}: {len(found)} rows with {wanted}")
    return found[0]


# ------------------------------------------------------------------------------------------------------------- tables


def of_cases():
    totals, ratios = rows("totals.csv"), rows("ratios.csv")
    return cases.summary(*([row for row in list_ if row["set"] == "all"] for list_ in (totals, ratios)))


def of_memory():
    found = rows("memory.csv")
    return tables.table([head.replace(" bytes", "") for head in found[0]], [list(row.values()) for row in found], ["---:"] * 5)


def dq(names, facets, eps=1e-4):
    """The rows of d_Q for these cases, in this memory, to this tolerance."""
    wanted = [row for row in rows("dq.csv") if row["case"] in names and row["scalar"] == "f64" and float(row["eps"]) == eps]
    return [row for row in wanted if int(row["max_facets"]) == facets] if facets else wanted


def slowest(names, facets=None, eps=1e-4):
    found = dq(names, facets, eps)
    found = [max((r for r in found if r["case"] == name), key=lambda r: int(r["max_facets"])) for name in dict.fromkeys(r["case"] for r in found)]
    return max(found, key=lambda row: float(row["median_ns"])) if found else None


def soft():
    return sorted({row["case"] for row in rows("dq.csv") if re.fullmatch(r"soft\d+_.*", row["case"].split("/")[0]) and "/" not in row["case"]})


def of_dq():
    lines = []

    def line(what, names, facets, baselines=True):
        ours = slowest(names, facets)
        if ours is None:
            return
        shown = [ours["max_facets"] if facets else ours["peak_facets"], tables.duration(float(ours["median_ns"]))]
        for suffix in ("/scan", "/expand"):
            theirs = slowest([name + suffix for name in names]) if baselines else None
            shown.append(tables.duration(float(theirs["median_ns"])) if theirs and theirs["outcome"] == "converged" else "")
        lines.append([what, *shown])

    line("a1, ball", ["a1"], 2048)
    line("a1, ball, in 64 KB", ["a1"], 512, False)
    line("a2, ellipsoid", ["a2"], 2048)
    for name, what in (("a3", "cross-polytope"), ("a4", "box"), ("a5", "segment")):
        line(f"{name}, {what}", [name], None)
    line(f"{len(soft())} grasps with soft contacts, ball, the slowest", soft(), 8192)
    line("the same", soft(), 4096, False)
    line("the same", soft(), 512, False)
    random = [row for row in rows("dq.csv") if row["case"].startswith("random_")]
    times = [float(row["median_ns"]) for row in random]
    most = f"{tables.duration(statistics.median(times))} (slowest {tables.duration(max(times))})"
    lines.append([f"{len(random)} random grasps, relative 1e-3, median", random[0]["max_facets"], most, "", ""])
    return tables.table(["query, 6-D", "facets", "qdist", "the paper's bookkeeping", "one polytope, 65,535 facets"], lines, ["---", *["---:"] * 4])


GRASPS = [
    ("force closure, L-infinity", "closed?", "Linf", "0e0"),
    ("d, L1, to 1 %", "efficiency", "L1", "1e-2"),
    ("d, L1, to 0.1 %", "efficiency", "L1", "1e-3"),
    ("d, L-infinity, to 1 %", "efficiency", "Linf", "1e-2"),
    ("d, L-infinity, to 0.1 %", "efficiency", "Linf", "1e-3"),
    ("the best of all, per grasp, L-infinity, 1 %", "best of all", "Linf", "1e-2"),
    ("contact forces, L-infinity, to 1e-9", "forces", "Linf", "1e-9"),
    ("all gradients, L-infinity, after d to 1 %", "gradients", "Linf", "1e-2"),
]
CONTACTS = ("2", "4", "5", "8")


def of_grasps():
    lines = []
    for what, question, norm, relative in GRASPS:
        found = [one("grasp.csv", question=question, norm=norm, relative=relative, contacts=count) for count in CONTACTS]
        lines.append([what, *(tables.digits(float(row["median_ms"])) for row in found)])
    return tables.table(["question", f"{CONTACTS[0]} contacts", *CONTACTS[1:]], lines)


def of_gripper():
    """The controller's loop without the bars behind it."""
    return f"```text\n{(FOLDER / 'gripper.txt').read_text().strip()}\n```\n"


def of_meshes():
    depths, compared, lines = rows("pdg.csv"), rows("proximity.csv"), []
    for group, names in GROUPS.items():
        mine = {metric: [r for r in depths if (r["group"], r["metric"], r["variant"]) == (group, metric, "default")] for metric in ("disp", "sigma")}
        if not mine["disp"]:
            continue
        times = [tables.duration(statistics.median(float(r["median_ns"]) for r in list_)) for list_ in mine.values()]
        within = [f"{sum(float(r['ratio']) <= 1.01 for r in list_)}/{len(list_)}" for list_ in mine.values()]
        touching = [r for r in compared if r["group"] == group and r["contact"] == "true"]
        over = [statistics.median(float(r[ours]) / float(r[theirs]) for r in touching) for ours, theirs in (("ns", "fcl_ns"), ("distance_ns", "fcl_distance_ns"))]
        lines.append([names, *times, ", ".join(within), ", ".join(f"{x:.2f}" for x in over)])
    return tables.table(["pair (triangles)", "DISP", "object norm", "within 1 % of the best known", "solid test, distance over FCL's"], lines)


GROUPS = {
    "knot": "torus knot and L (2,880 and 20)",
    "cad": "pawn and CAD part (304 and 2,442)",
    "hammer": "hammer and bumpy sphere (1,692 and 2,880)",
}


def of_worst():
    found = rows("worst.csv")
    lines = [[*list(row.values())[:-1], tables.digits(float(row["ms"]))] for row in found]
    return "".join(f"  {line}\n" for line in tables.table(list(found[0]), lines, ["---"] * 6).splitlines())


def of_embedded():
    """What `./x embedded` is held against: golden numbers, which it requires to 3 %."""
    found = tables.read(ROOT / "examples/cortex-m/golden.csv")
    number = lambda text: f"{int(text):,}"
    lines = [
        [f"{row['query']}, `{row['scalar']}`", row["cpu"].replace("cortex-m", "M"), f"{row['converged']} of {row['asked']}", *(number(row[key]) for key in SHOWN)]
        for row in found
    ]
    heads = ["query", "Cortex", "converged", "instructions, median", "most", "stack", "workspace", "flash"]
    return tables.table(heads, lines, ["---", "---", *["---:"] * 6])


SHOWN = ("median_instructions", "worst_instructions", "stack", "workspace", "flash")

TABLES = {"embedded": of_embedded, "cases": of_cases, "memory": of_memory, "dq": of_dq, "grasps": of_grasps, "gripper": of_gripper, "meshes": of_meshes, "worst": of_worst}

# ---------------------------------------------------------------------------------------------------------- sentences


def kilobytes(name, **wanted):
    row = one(name, **wanted)
    return f"{float(row.get('text') or row['bytes']) / 1024:.3g}"


def stack(query):
    return f"{float(one('stack.csv', query=query)['bytes']) / 1024:.1f}"


def six(name):
    sizes = [float(row["bytes"]) / 1024 for row in rows(name) if row["query"].startswith("d_Q in 6-D")]
    return [f"{min(sizes):.0f}", f"{max(sizes):.0f}"]


def steps(name):
    found = [float(row["steps"]) for row in rows(name)]
    return [tables.digits(min(found), 1), tables.digits(max(found), 1)]


# The words around a figure, with a group for each, and what they are.
SENTENCES = [
    (
        r"has\n(\S+) KB of code and takes (\S+) KB of stack, in `f64` (\S+) KB of stack; d_Q in six dimensions takes (\S+) to (\S+) KB",
        lambda: [kilobytes("bytes.csv", what="depth of boxes alone, the smallest program", scalar="f32"), stack("depth of boxes, float"), stack("depth of boxes"), *six("stack.csv")],
    ),
    (r"needs (\S+) to (\S+) steps for three digits", lambda: steps("flatter.csv")),
]

# Sizes, tolerances and rates that are asked for, and not measured.
ASKED = [
    "within 5 %",
    "off by more than 1 %",
    "header of 16 bytes",
    " in 64 KB",
    "0.4 ms,",
    "golden ones to 3 %",
]

MEASURED = re.compile(r"\d[\d.,]*(?: to \d[\d.,]*)? ?(?:ns|us|ms|s|KB|MB|bytes|instructions|%|times)\b(?!\w)|\d[\d.,]* %")


def main():
    write = sys.argv[1:] == ["--write"]
    file = ROOT / "README.md"
    text = old = file.read_text()
    rest = text
    for name, make in TABLES.items():
        pattern = re.compile(rf"( *<!-- figures: {name} -->\n).*?( *<!-- figures end -->)", re.S)
        if not pattern.search(text):
            raise SystemExit(f"README has no table {name}")
        text = pattern.sub(lambda match: f"{match[1]}{make()}{match[2]}", text)
        rest = pattern.sub("", rest)
    for pattern, make in SENTENCES:
        match = re.search(pattern, text)
        if not match:
            raise SystemExit(f"README does not say: {pattern}")
        for group, value in reversed(list(enumerate(make(), 1))):
            text = text[: match.start(group)] + value + text[match.end(group) :]
        rest = re.sub(pattern, "", rest)
    for words in ASKED:
        rest = rest.replace(words, "")
    rest = re.sub(r"```.*?```", "", rest, flags=re.S)
    loose = [match[0] for match in MEASURED.finditer(rest)]
    if loose:
        print("README has figures that are in no table of the report:", *loose, sep="\n  ")
    if text != old and write:
        file.write_text(text)
    elif text != old:
        print("README's figures are not those of docs/report: benches/report/figures.py --write renews them")
    failed = bool(loose) or (text != old and not write)
    print(f"figures: {int(not failed)} passed, {int(failed)} failed")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
