"""One row of the table of stability: what a solver's answers to an extreme are worth."""

import statistics
from collections import Counter


def verdict(extreme, value, solver, mode, false, none, failed, widths, outcomes):
    """`outcomes`: a word an answer; `widths` of those that are brackets."""
    return {
        "extreme": extreme,
        "value": value,
        "solver": solver,
        "mode": mode,
        "pairs": len(outcomes),
        "false": false,
        "no_answer": none,
        "failed": failed,
        "median_width": f"{statistics.median(widths):.2g}" if widths else "",
        "worst_width": f"{max(widths):.2g}" if widths else "",
        "outcomes": " ".join(f"{name}:{count}" for name, count in sorted(Counter(outcomes).items())),
    }
