"""Cases of public reports and test suites: `./x compare`, told as numbers."""

import statistics
import sys
from collections import Counter, defaultdict

from report import tables
from report.job import ROOT, run

sys.path.insert(0, str(ROOT / "ffi-tests"))
import compare_table

# The fixtures of a clone, and the larger sets that lie beside it.
SETS = {"fixtures": "tests/data", "all": "../shared/data/convex"}
NAMES = {
    "qdist_f64": "qdist, `f64`",
    "qdist_f32": "qdist, `f32`",
    "fcl_signed": "FCL, signed distance",
    "libccd_epa": "libccd, EPA",
    "fcl_libccd": "FCL, collide (libccd)",
    "libccd_mpr": "libccd, MPR",
}
# Families of fewer pairs have no ratio of their own.
LEAST = 5


def measure(job):
    totals, ratios = [], []
    for name, folder in SETS.items():
        files = sorted((ROOT / folder).glob("*.txt"))
        if not files or (job.quick and name != "fixtures"):
            continue
        output = f"{name}.csv"

        def work():
            words = ["make", "--no-print-directory", "compare", f"CASES={' '.join(map(str, files))}", f"OUT={job.out}"]
            run(words, cwd=ROOT)
            job.path("compare.csv").rename(job.path(output))

        job.step(name, [output], work)
        rows = judged(job, output, files)
        totals += [{"set": name, **row} for row in summed(rows)]
        ratios += [{"set": name, **row} for row in beside(rows)]
    job.write_rows("totals.csv", totals, list(totals[0]))
    job.write_rows("ratios.csv", ratios, list(ratios[0]))


def judged(job, output, files):
    cases = [case for file in files for case in compare_table.read_cases(str(file))]
    solvers, rows = compare_table.read_rows(job.path(output), cases)
    return {solver: [row for row in rows if row.solver == solver] for solver in solvers}


def summed(rows):
    for solver, mine in rows.items():
        kinds = Counter(row.fail for row in mine if row.fail)
        yield {
            "solver": solver,
            "cases": len(mine),
            "failed": sum(kinds.values()),
            "hangs": kinds["hang"],
            "crashes": kinds["exception"] + kinds["abort"],
            "false_brackets": sum(row.violation for row in mine),
            "converged": sum(row.bracket and row.converged() for row in mine) if solver in compare_table.QDIST else "",
            "median_ns": f"{compare_table.quantile([row.ns for row in mine], 0.5):.0f}",
        }


def beside(rows):
    """Median time of qdist over a peer's, by family, over the cases that both finish."""
    for peer, theirs in rows.items():
        families = defaultdict(list)
        for ours, their in zip(rows["qdist_f64"], theirs):
            families[ours.case.family].append((ours, their))
        for family, pairs in sorted(families.items()):
            ratio, count = compare_table.ratio(pairs)
            if peer not in compare_table.QDIST and count:
                yield {"peer": peer, "family": family, "cases": count, "ratio": f"{ratio:.3g}"}


# ------------------------------------------------------------------------------------------------------------ the page

INTRODUCTION = """## Cases of public reports

Convex pairs that users of FCL, libccd, MuJoCo, Bullet and others reported, random overlaps and stress sets, with references in quadruple precision. A solver fails where it
has no result for an overlap, or a depth that is off by more than 1 %.
"""


def tell(job):
    totals, ratios = job.rows("totals.csv"), job.rows("ratios.csv")
    text = [INTRODUCTION]
    for name, title in (("all", "All sets ({cases} pairs)"), ("fixtures", "The fixtures of a clone ({cases} pairs)")):
        mine = [row for row in totals if row["set"] == name]
        if not mine:
            text.append("The larger sets, which lie beside the project and not in it, were not asked.\n")
            continue
        text.append(f"**{title.format(cases=mine[0]['cases'])}.** Times are medians over all pairs. Ratios are those of families in which both finish at least {LEAST} pairs, and over these, also where the peer is wrong.\n")
        text.append(summary(mine, [row for row in ratios if row["set"] == name]))
    text.append("Run it: `./x compare OUT=dir` prints families and sets, too, and the ratios over the cases that a peer gets right.\n")
    return "\n".join(text)


def summary(totals, ratios):
    """The table of a set: README has it, too."""
    order = {row["solver"]: row for row in totals}
    lines = [line(order[solver], ratios) for solver in NAMES if solver in order]
    head = ["", "wrong or missing", "converged", "median time", "qdist's time / theirs, families"]
    return tables.table(head, lines, ["---", "---", "---", "---:", "---"])


def line(row, ratios):
    ours = row["solver"] in compare_table.QDIST
    failed = row["failed"]
    broken = [f"{key}: {row[key]}" for key in ("hangs", "crashes") if row[key] != "0"]
    if broken:
        failed += f" ({', '.join(broken)})"
    if ours:
        failed += f" (false brackets: {row['false_brackets']})"
    of = [float(r["ratio"]) for r in ratios if r["peer"] == row["solver"] and int(r["cases"]) >= LEAST]
    spread = f"{min(of):.2g} to {max(of):.2g}, median {statistics.median(of):.2g}" if of else ""
    return [NAMES[row["solver"]], failed, f"{int(row['converged']):,}" if ours else "-", tables.duration(float(row["median_ns"])), spread]
