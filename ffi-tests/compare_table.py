#!/usr/bin/env python3
"""Tables from the output of `compare`: accuracy, failures, brackets and speed of qdist and its peers.

usage: compare_table.py [--check] compare.csv CASE_FILE...

CASE_FILE: the files that `compare` was given; the references are read from there, never by the solvers.
--check:   exit 1 if a qdist bracket excludes the reference, or a case has no qdist_f64 or qdist_f32 row with a bracket.
"""
import csv
import math
import os
import sys
from collections import Counter, defaultdict

QDIST = ("qdist_f64", "qdist_f32")
PEERS = ("libccd_epa", "libccd_mpr", "fcl_libccd", "fcl_signed")
BROKEN = ("exception", "abort", "hang", "nan")

# The tolerances that `compare` asks of qdist: (relative, absolute per size).
ASKED = {"qdist_f64": (1e-6, 1e-12), "qdist_f32": (1e-4, 1e-5)}

LEGEND = """\
err       |depth - reference| / size, over the rows that have a depth (median, 99th percentile, maximum)
fail      no result although the reference overlaps by more than 1e-12 size; exception, abort, hang, nan; no row;
          or error above max(1 % of |depth|, 1e-9 size). f32: above max(1 % of |depth|, 1e-5 size + rounding of its input)
normal    bad normals / normals judged: angle to the reference above 1e-3 rad; 1e-2 for f32 and where |depth| < 1e-9 size,
          because near the minimum a depth that is right to d leaves the direction free by sqrt(2 d / size).
          Not judged: no unique reference normal; no depth; no normal where the bodies touch to 1e-12 size.
viol      brackets [lower, upper] that do not meet the reference's [lb, ub]. f64: up to the rounding of the printed
          reference, 2^-52 |depth|. f32: up to the rounding of its input, 8 * 2^-24 (radii + |translations|): it gets the
          numbers of the file rounded to float, which is another problem than the one the reference has solved
conv      upper - lower <= max(relative |upper|, absolute size) with the tolerances asked: f64 1e-6, 1e-12; f32 1e-4, 1e-5
ns        median over the cases of the median time of one query; rows with exception, abort or hang have none"""


class Case:
    def __init__(self, name, set_name, family, extent, reference):
        self.id, self.set, self.family, self.extent = name, set_name, family, extent
        self.depth, self.lb, self.ub, self.size = reference[:4]
        self.normal = unit(reference[4:])


def unit(v):
    """v / |v|, or None if that is no direction."""
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v] if math.isfinite(length) and length > 0.5 else None


def radius(kind, p):
    """Largest distance of a point of the shape from the origin of its frame."""
    if kind == "hull":
        return max(math.hypot(*p[i:i + 3]) for i in range(0, len(p), 3))
    if kind == "ellipsoid":
        return max(p)
    return sum(p) if kind == "capsule" else math.hypot(*p)


def read_cases(path):
    set_name = os.path.splitext(os.path.basename(path))[0]
    with open(path, encoding="ascii") as file:
        tokens = iter(file.read().split())

    def expect(word):
        token = next(tokens)
        if token != word:
            raise ValueError(f"{path}: expected {word}, found {token}")

    def numbers(count):
        return [float(next(tokens)) for _ in range(count)]

    for token in tokens:
        if token != "CASE":
            raise ValueError(f"{path}: expected CASE, found {token}")
        name, kinds, extent = next(tokens), [], 0.0
        for _ in "AB":
            expect("S")
            kind, count = next(tokens), int(next(tokens))
            extent += radius(kind, numbers(3 * count if kind == "hull" else count))
            kinds.append(f"hull{count}" if kind == "hull" else kind)
            expect("P")
            extent += math.hypot(*numbers(12)[9:])
        expect("T")
        kinds.sort()
        if all(k.startswith("hull") for k in kinds) and kinds[0] != kinds[1]:
            kinds = ["hull", "hull"]  # a few odd pairs: one family
        yield Case(name, set_name, "-".join(kinds), extent, numbers(7))


class Row:
    """A line of the CSV, judged against its case."""

    def __init__(self, solver, case, line):
        self.solver, self.case = solver, case
        get = lambda column: float(line[column]) if line and line[column] else math.nan
        self.outcome = line["outcome"] if line else "missing"
        self.lower, self.upper, self.depth, self.ns = get("lower"), get("upper"), get("depth"), get("median_ns")
        self.normal = unit([get("nx"), get("ny"), get("nz")])
        self.has_depth = math.isfinite(self.depth)
        self.error = abs(self.depth - case.depth) / case.size if self.has_depth else math.nan
        self.fail = self.judge_depth()
        self.bad_normal = self.judge_normal()
        self.bracket = not (math.isnan(self.lower) or math.isnan(self.upper))
        self.violation = self.bracket and self.judge_bracket()

    def input_rounding(self):
        return 8 * 2.0**-24 * self.case.extent if self.solver == "qdist_f32" else 0.0

    def judge_depth(self):
        """The kind of failure, or None."""
        case = self.case
        if self.outcome in BROKEN or self.outcome == "missing":
            return self.outcome
        if self.outcome.startswith("status:"):
            return "status"
        if not self.has_depth:
            return "no result" if case.depth > 1e-12 * case.size else None
        floor = 1e-5 * case.size + self.input_rounding() if self.solver == "qdist_f32" else 1e-9 * case.size
        return "wrong depth" if self.error * case.size > max(0.01 * abs(case.depth), floor) else None

    def judge_normal(self):
        """True: bad, False: good, None: not judged."""
        case = self.case
        if case.normal is None or not self.has_depth:
            return None
        if self.normal is None:
            return None if abs(case.depth) <= 1e-12 * case.size else True
        loose = self.solver == "qdist_f32" or abs(case.depth) < 1e-9 * case.size
        return angle(self.normal, case.normal) > (1e-2 if loose else 1e-3)

    def judge_bracket(self):
        case = self.case
        slack = 2.0**-52 * max(abs(case.lb), abs(case.ub)) + self.input_rounding()
        return self.lower > self.upper or self.lower > case.ub + slack or self.upper < case.lb - slack

    def converged(self):
        relative, absolute = ASKED[self.solver]
        tolerance = max(relative * abs(self.upper), absolute * self.case.size)
        return self.bracket and self.upper - self.lower <= tolerance * (1 + 1e-6)

    def right(self):
        return self.fail is None and self.error <= 1e-6


def angle(a, b):
    cross = [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]
    return math.atan2(math.hypot(*cross), sum(x * y for x, y in zip(a, b)))


def read_rows(path, cases):
    """Rows by solver and case, in the order of the cases; for qdist and every other solver that the file has."""
    lines = defaultdict(list)  # a list: an id may come back in another case file
    with open(path, newline="", encoding="ascii") as file:
        for line in csv.DictReader(file):
            lines[line["case"], line["solver"]].append(line)
    present = {solver for _, solver in lines}
    solvers = [s for s in QDIST + PEERS if s in present] + sorted(present - set(QDIST + PEERS))
    seen, rows = Counter(), []
    for case in cases:
        nth = seen[case.id]
        seen[case.id] += 1
        for solver in solvers:
            of_case = lines.get((case.id, solver), [])
            rows.append(Row(solver, case, of_case[nth] if nth < len(of_case) else None))
    return solvers, rows


def quantile(values, q):
    """Nearest rank; nan if there is none."""
    values = sorted(v for v in values if math.isfinite(v))
    return values[max(0, math.ceil(q * len(values)) - 1)] if values else math.nan


def number(value, form):
    return "-" if math.isnan(value) else format(value, form)


def summary(solver, rows):
    errors = [r.error for r in rows]
    judged = [r.bad_normal for r in rows if r.bad_normal is not None]
    columns = [f"{len(rows):5d}"]
    columns += [f"{number(quantile(errors, q), '.1e'):>8}" for q in (0.5, 0.99, 1)]
    columns += [f"{sum(r.fail is not None for r in rows):5d}", f"{f'{sum(judged)}/{len(judged)}':>10}"]
    if solver in QDIST:
        columns += [f"{sum(r.violation for r in rows):5d}", f"{sum(r.converged() for r in rows):5d}"]
    else:
        columns += [f"{'':>5}", f"{'':>5}"]
    return "  ".join(columns + [f"{number(quantile([r.ns for r in rows], 0.5), '.0f'):>9}"])


HEAD = "  ".join(f"{h:>{w}}" for h, w in zip(
    ("n", "err med", "p99", "max", "fail", "normal", "viol", "conv", "ns"), (5, 8, 8, 8, 5, 10, 5, 5, 9)))


def group(rows, *keys):
    groups = defaultdict(list)
    for row in rows:
        groups[tuple(key(row) for key in keys)].append(row)
    return groups


def print_sets(solvers, rows):
    for (set_name,), of_set in group(rows, lambda r: r.case.set).items():
        print(f"\n== {set_name}\n{'family':22}{'solver':12}{HEAD}")
        families = group(of_set, lambda r: r.case.family)
        blocks = sorted((family, of_family) for (family,), of_family in families.items())
        if len(blocks) > 1:
            blocks.append(("(all)", of_set))
        for family, of_family in blocks:
            for solver in solvers:
                print(f"{family:22}{solver:12}{summary(solver, [r for r in of_family if r.solver == solver])}")


def ratio(pairs):
    """Median time of qdist over median time of the peer, both over the same cases."""
    pairs = [(q, p) for q, p in pairs if math.isfinite(q.ns) and math.isfinite(p.ns)]
    if not pairs:
        return math.nan, 0
    return quantile([q.ns for q, _ in pairs], 0.5) / quantile([p.ns for _, p in pairs], 0.5), len(pairs)


def print_ratios(solvers, rows):
    peers = [s for s in solvers if s not in QDIST]
    if "qdist_f64" not in solvers:
        print("\nNo qdist rows: no ratios.")
        return
    print("\n== median qdist_f64 time / median peer time, per family over all sets; below 1: qdist is faster"
          "\nright: only cases that the peer and qdist get right to 1e-6 of size (their number in brackets); all: every case"
          "\nthat both finish, also where the peer is wrong, or says no more than 'no collision'")
    print(f"{'':22}" + "".join(f"{peer:^26}" for peer in peers))
    print(f"{'family':22}" + "".join(f"{'right':>16}{'all':>7}   " for _ in peers))
    means = defaultdict(list)
    for (family,), of_family in sorted(group(rows, lambda r: r.case.family).items()):
        by_solver = {s: [r for r in of_family if r.solver == s] for s in solvers}
        line = f"{family:22}"
        for peer in peers:
            pairs = list(zip(by_solver["qdist_f64"], by_solver[peer]))
            right, count = ratio([(q, p) for q, p in pairs if q.right() and p.right()])
            every, _ = ratio(pairs)
            means[peer, "right"].append(right)
            means[peer, "all"].append(every)
            line += f"{number(right, '.2f') + f' ({count})':>16}{number(every, '.2f'):>7}   "
        print(line)

    def mean(values):
        values = [math.log(v) for v in values if math.isfinite(v)]
        return number(math.exp(sum(values) / len(values)) if values else math.nan, ".2f")

    print(f"{'(geometric mean)':22}"
          + "".join(f"{mean(means[p, 'right']) + '     ':>16}{mean(means[p, 'all']):>7}   " for p in peers))


def print_totals(solvers, rows):
    print(f"\n== totals\n{'':22}{'solver':12}{HEAD}")
    for solver in solvers:
        print(f"{'':22}{solver:12}{summary(solver, [r for r in rows if r.solver == solver])}")
    for title, what in (("failures", lambda r: r.fail), ("outcomes", lambda r: r.outcome)):
        print(f"\n{title}")
        for solver in solvers:
            counts = Counter(what(r) for r in rows if r.solver == solver and what(r) is not None)
            print(f"  {solver:12}" + (", ".join(f"{word} {n}" for word, n in counts.most_common()) or "none"))


def check(solvers, rows, cases):
    """The number of things that must not be; each is printed."""
    count = 0
    for solver in QDIST:
        if solver not in solvers:
            print(f"CHECK {solver}: no rows for {len(cases)} cases")
            count += len(cases)
    for row in rows:
        if row.solver in QDIST and (row.violation or not row.bracket):
            case = row.case
            what = (f"[{row.lower!r}, {row.upper!r}] excludes the reference [{case.lb!r}, {case.ub!r}]"
                    if row.bracket else "no bracket")
            print(f"CHECK {case.set} {case.id} {row.solver}: {row.outcome}: {what}")
            count += 1
    return count


def main(arguments):
    wants_check = "--check" in arguments
    paths = [a for a in arguments if a != "--check"]
    if len(paths) < 2 or any(p.startswith("-") for p in paths):
        print(__doc__, file=sys.stderr)
        return 2
    cases = [case for path in paths[1:] for case in read_cases(path)]
    solvers, rows = read_rows(paths[0], cases)
    print(LEGEND)
    print_sets(solvers, rows)
    print_ratios(solvers, rows)
    print_totals(solvers, rows)
    if wants_check:
        found = check(solvers, rows, cases)
        print(f"\ncheck: {len(cases)} cases, {found} problems")
        return 1 if found else 0
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
