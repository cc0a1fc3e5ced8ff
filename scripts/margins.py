#!/usr/bin/env python3
"""Takes each rounding margin away, one at a time, and requires that a test fails.

The list below names the margins: file, and the code with the margin between @ signs; then what stands in its place when it is gone. All of them are put
behind a switch in a copy of the sources (target/margins), which is built once; the environment variable MARGIN says which one is gone. Takes a few minutes.

    scripts/margins.py                  all of them
    scripts/margins.py bounds rays      those whose names contain one of the words
    scripts/margins.py --list           their names
"""

import os
import re
import subprocess
import sys
from pathlib import Path

# name | file in src/ | code | what is left without the margin
MARGINS = """
bounds: rounding of heights | bounds.rs | else { @2 * n + 4@ } | 0
bounds: unknown extent | bounds.rs | { @18 * n + 4@ } | 2 * n + 4
bounds: the set's error | bounds.rs | @self.support_error@ + T::count(operations) | T::zero()
bounds: upper, rounded up | bounds.rs | if up { @value + slack@ } | value
bounds: lower, rounded down | bounds.rs | else { @value - slack@ } | value
bounds: upper of a ball, margin | bounds.rs | (height + @margin@ + self.radius) * per_ball | T::zero()
bounds: lower of a ball, margin | bounds.rs | (offset - @margin@ + self.radius) * per_ball | T::zero()
bounds: upper of any Q, margin | bounds.rs | let top = height + @margin@ | T::zero()
bounds: upper of any Q, error of Q | bounds.rs | { @unit - unit_error@ } | unit
bounds: negative upper of any Q, error of Q | bounds.rs | else { @unit + unit_error@ } | unit
bounds: by direction, the set's errors | bounds.rs | let sum = @sum_along(n, &self.errors)@ | T::zero()
bounds: by direction, rounding of heights | bounds.rs | + @T::count(2 * N + 4) * T::ROUNDOFF * sum_along(n, &self.reach)@; | T::zero()
bounds: by direction, rounding of the sum | bounds.rs | @sum + sum * (T::count(2 * N + 4) * T::ROUNDOFF)@ | sum

bracket: simplex, margin along | query/bracket.rs | let margin = @axes.margin(&(point / distance))@ | T::zero()
bracket: simplex, second order | query/bracket.rs | + @whole * (whole / (distance + distance)) * T::of(1.01)@ | T::zero()
bracket: simplex, point without a direction | query/bracket.rs | if !(@distance > whole@) | distance > T::zero()
bracket: crossing, margin along | query/bracket.rs | lower_ball(-height, @axes.margin(&line)@ | T::zero()
bracket: crossing, points off | query/bracket.rs | let safe = @self.margin() * T::count(3)@ | T::zero()
bracket: crossing, weights off | query/bracket.rs | + @norm(&across(&simplex.point()))@; | T::zero()
bracket: crossing, certain | query/bracket.rs | if !(@corner.weight * over > safe@) | true
bracket: origin beneath the lowest facet | query/bracket.rs | (@offset > margin@).then | offset > T::zero()
bracket: origin beneath each facet, by direction | query/bracket.rs | if !(@facet.offset > margin@) | facet.offset > T::zero()
bracket: any Q by direction, margin | query/bracket.rs | (facet.key - @facet.key * (margin / facet.offset)@) | T::zero()
bracket: any Q by direction, rounding | query/bracket.rs | * @(T::one() - T::count(16) * T::ROUNDOFF)@, | T::one()
bracket: origin beneath each facet, any Q | query/bracket.rs | (@inradius > margin@).then | inradius > T::zero()
bracket: any Q, margin | query/bracket.rs | least.at_most(key - @key * (margin / offset)@) | T::zero()
bracket: any Q, rounding | query/bracket.rs | least * @(T::one() - T::count(16) * T::ROUNDOFF)@) | T::one()
bracket: known floor that is disproved | query/bracket.rs | self.floor.lower > T::zero() && @self.floor.lower <= self.best.ratio@ && | true

query: certainly outside | query/asking.rs | height + @self.margin_along(direction)@ < | T::zero()
query: known floor that is no normal number | query/floor.rs | if @lower >= T::TINY@ && | lower > T::zero()
query: subnormal bounds | query/mod.rs | { @value + outward * T::TINY@ } | value
query: Q without extent | query/asking.rs | if @unit <= self.unit_error@ | unit <= T::zero()
query: keys, error of Q | query/sets.rs | self.value_of_q(normal)? + @self.unit_error@ | T::zero()

expansion: from the key to the offset | plan/expansion.rs | - @whole.abs() * (T::count(5) * T::ROUNDOFF)@ | T::zero()
expansion: thin first simplex | plan/expansion.rs | let thin = @self.resolution_along(&direction) + margin + margin@ | T::zero()
polytope: surface folded over | polytope/plane.rs | @self.sound = false@; | ()
polytope: centre beneath a facet, rounding | polytope/plane.rs | offset, @3 * N + 8@, 1) | 0
polytope: centre beneath a facet by direction, rounding | polytope/plane.rs | offset, 3 * N + 8, @1@) | 0
polytope: centre beneath a point, in two words | polytope/plane.rs | height, @16 * N@, 2) | 0
polytope: visible facets | polytope/insert.rs | height > @tolerance@ | T::zero()

conewise: points off | plan/conewise.rs | query.margin() * T::count(@3@ + | 0
conewise: each halving | plan/conewise.rs | query.margin() * T::count(3 + @cone.depth()@) | 0

rays: points off | plan/rays.rs | N>| @query.margin()@ + error | T::zero()
rays: crossings off | plan/rays.rs | query.margin() + @error@ + least | T::zero()
rays: vertices of Q off | plan/rays.rs | + @least * query.unit_error()@; | T::zero()
rays: rounding of the lower bound | plan/rays.rs | lower - @lower.abs() * (T::count(8) * T::ROUNDOFF)@ | T::zero()
rays: loss in a ball of Q | plan/rays.rs | Ok(Some(@margin(query) / inner@)) | T::zero()
rays: loss in a ball of A | plan/rays.rs | .map(|radius| @least * (margin / radius)@) | T::zero()
rays: loss in a ball along a ray | plan/rays.rs | .map(|radius| @least * rest * (margin / radius)@) | T::zero()
rays: ball of A, points off | plan/rays.rs | radius.filter(|&radius| @radius > margin@).map(|radius| least * (margin | true
rays: ball along a ray, points off | plan/rays.rs | let along = along.filter(|&radius| @radius > margin@) | true
rays: ball along a ray, seen from there | plan/rays.rs | margin(query) + @query.resolution()@; | T::zero()
rays: ball of A, crossings off | plan/rays.rs | inradius - @rays.error@ | T::zero()
rays: artificial corners | plan/ray.rs | if @!carried@ | false
rays: negative weights | plan/ray.rs | let left = @(self.weights[i] - shares[i] * step).at_least(T::zero())@ | self.weights[i] - shares[i] * step
rays: negative weights of a polished inverse | plan/ray.rs | .map(|w| @w.at_least(T::zero())@) | w

tracker: move | solver/warm.rs | { before - @moved / inner@ } | T::zero()
tracker: move of a set apart | solver/warm.rs | before - @steps(moved)@ | T::zero()
tracker: move apart, in the less favourable unit | solver/warm.rs | @left.at_most(left * inner)@ | left
tracker: rounding | solver/warm.rs | (lower - @slack@) | T::zero()
tracker: rounding, in units of Q | solver/warm.rs | { @slack / inner@ } | slack

span: tilt of A | solver/span.rs | total(self.inner.error(), @self.blur@) | T::zero()
span: tilt of Q | solver/span.rs | self.inner.error() + @self.blur@ | T::zero()
span: tilt of Q, inner radius | solver/span.rs | * T::of(0.999) - @self.blur@ | T::zero()
span: axes off by the points | solver/span.rs | tilt += @T::count(4 * N) * (query.margin() + query.resolution()) / start.least_width()@ | T::zero()
span: axes off by rounding | solver/span.rs | let mut tilt = @T::count(8 * N) * T::ROUNDOFF@ | T::zero()

second look: extents of a measured set | support/combine/measured.rs | (T::one() + @T::count(32 * N) * T::ROUNDOFF@) | T::zero()
distance: ball put back, error | plan/distance.rs | total(self.0.error(), @T::count(8 + N) * T::ROUNDOFF * self.0.radius()@) | T::zero()

pair: rounding of the bodies' points | solver/depth/pair.rs | let rounding = (@cores * T::count(20)@ + | T::zero()
pair: rounding of the offset | solver/depth/pair.rs | T::count(20) + @apart * T::count(4)@) | T::zero()
pair: matrices that stretch | solver/depth/pair.rs | + rounding) * @T::of(1.01)@ + left; | T::one()
pair: offset of far anchors | solver/depth/pair.rs | T::of(1.01) + @left@; | T::zero()
pair: by direction, rounding of the points | solver/depth/pair.rs | let rounding = (@spans * T::count(13)@ + | spans * T::zero()
pair: by direction, rounding of the offset | solver/depth/pair.rs | T::count(13) + @offsets * T::count(4)@) | offsets * T::zero()
pair: by direction, matrices that stretch | solver/depth/pair.rs | + rounding) * @T::of(1.01)@).add_scalar | T::one()
pair: by direction, offset of far anchors | solver/depth/pair.rs | .add_scalar(@self.extra@) | T::zero()
pair: body of unknown extent | solver/depth/body.rs | .at_least(@T::count(16 * N) * T::ROUNDOFF * extent@) | T::zero()
pair: ball under a matrix that stretches | solver/depth/body.rs | if @skew > T::count(SKEW_ROUNDOFFS) * T::ROUNDOFF@ | false
pair: ball that is an image | solver/depth/body.rs | anchor.error += @self.ball_error()@; | T::zero()
pair: by direction, ball that is an image | solver/depth/body.rs | errors.add_scalar(@self.ball_error()@) | T::zero()
pair: ball in the points, rounding | solver/depth/body.rs | (@T::count(8) * self.inflation@ + self.ball) * T::ROUNDOFF | T::zero()
pair: ball beside the points, rounding | solver/depth/body.rs | + @self.ball@) * T::ROUNDOFF | T::zero()
pair: ball that is an image, rounding of what is measured | solver/depth/body.rs | (&self.rotation) + @T::count(4) * T::ROUNDOFF@) | T::zero()

meridian: axes aside | solver/depth/axis.rs | let moved = @axis.aside@ + | T::zero()
meridian: matrices that stretch | solver/depth/axis.rs | axis.aside + @axis.stretched + axis.stretched@ + | T::zero()
meridian: rounding of what is measured | solver/depth/axis.rs | axis.stretched + @T::count(4) * T::ROUNDOFF@; | T::zero()
sectors: matrices that stretch | solver/depth/arcs.rs | (@off@ + T::count(32) | T::zero()
sectors: rounding of points | solver/depth/arcs.rs | (off + @T::count(32) * T::ROUNDOFF@) | T::zero()
sectors: halves of a sector | solver/depth/sectors/sector.rs | across.at_least(@m / self.cosine@) | m
sectors: disc, scale | solver/depth/sectors/sector.rs | (T::one() - @slack@) | T::zero()
sectors: disc, rounding | solver/depth/sectors/sector.rs | let rounding = @k * (T::count(8) * T::ROUNDOFF)@ | T::zero()
ellipsoids: centres apart | solver/depth/ellipsoids.rs | serves.then(|| @apart@ + | T::zero()
ellipsoids: axes aside | solver/depth/ellipsoids.rs | let turned = @aside * T::of(2.1)@ + | T::zero()
ellipsoids: matrices that stretch | solver/depth/ellipsoids.rs | T::of(2.1) + @stretched * T::count(32)@ + | T::zero()
ellipsoids: rounding of what is measured | solver/depth/ellipsoids.rs | T::count(32) + @T::count(64) * T::ROUNDOFF@; | T::zero()

half spaces: rounding of heights | solver/depth/half_space/plane.rs | (sum.value(), @T::count(TWOFOLD_ROUNDOFFS) * lost@) | T::zero()
half spaces: rounding of a ball's height | solver/depth/half_space/plane.rs | terms += @ball.abs() * self.length@ | T::zero()
half spaces: rounding of the depth | solver/depth/half_space/plane.rs | @T::count(N + 8) * T::ROUNDOFF * parts@ | T::zero()
half spaces: lower, the set's error | solver/depth/half_space/plane.rs | let off = @deepest.error * along@ | T::zero()
half spaces: upper, the set's error | solver/depth/half_space/plane.rs | let beyond = @deepest.error * along@ + | T::zero()
half spaces: upper, direction astray | solver/depth/half_space/plane.rs | + @deepest.astray * (anchor.extent + deepest.error) * T::count(2)@; | T::zero()
half spaces: direction, rounding | solver/depth/half_space/deepest.rs | * T::of(1.01) + @lost@; | T::zero()
half spaces: direction in two words, rounding | solver/depth/half_space/deepest.rs | error, astray: @lost@ } | T::zero()
half spaces: a point in two words | solver/depth/half_space/deepest.rs | @a.shape.extents().sum() * (T::count(1 << 10) * T::ROUNDOFF * T::ROUNDOFF)@ | T::zero()
half spaces: opposite for certain | solver/depth/half_space/plane.rs | let upper = if @told.is_some()@ | true
half spaces: not opposite for certain | solver/depth/half_space/plane.rs | across > @rounding@) | T::zero()

boxes: one word, lower | solver/depth/boxes/mod.rs | *lower = (height - @error@) | T::zero()
boxes: one word, lower, length | solver/depth/boxes/mod.rs | (length + @T::count(16) * T::ROUNDOFF@); | T::zero()
boxes: one word, upper | solver/depth/boxes/mod.rs | let most = (height + @error@) * inverse | T::zero()
boxes: parallel edges | solver/depth/boxes/mod.rs | moved = @error * T::count(3)@; | T::zero()
boxes: both senses of an axis | solver/depth/boxes/mod.rs | let doubtful = @magnitude(along) <= self.error_in_one_word()@; | false
boxes: lower of two words | solver/depth/boxes/mod.rs | Level::new(n, [T::zero(); 2], @self.error(&n.high, &blur)@) | T::zero()
boxes: upper of two words | solver/depth/boxes/mod.rs | [ball, T::zero()], @self.error(n, &Vector::zeros())@ + | T::zero()
boxes: nearest point | solver/depth/boxes/mod.rs | let error = @along.at_most(whole)@ + | T::zero()
boxes: nearest point, rounding | solver/depth/boxes/mod.rs | -(distance + error + @(distance.abs() + slip.abs()) * (T::count(4) * T::ROUNDOFF)@) | T::zero()
boxes: edges that are nearly across | solver/depth/boxes/zonotope.rs | if @magnitude(height) <= T::count(16) * T::ROUNDOFF@ { | false
boxes: edges that are nearly parallel | solver/depth/boxes/zonotope.rs | e.high.abs() * (@T::of(0.0625) / length@)); | T::zero()

fine: lower, error of heights | solver/depth/fine/level.rs | least.at_most(distance - @error@) | T::zero()
fine: upper, error of heights | solver/depth/fine/level.rs | distance + @error@ | T::zero()
fine: points in two words | solver/depth/fine/level.rs | (distance, @self.error@ + | T::zero()
fine: rounding of distances | solver/depth/fine/level.rs | self.error + @(shrink.abs() + distance.abs()) * (T::count(16) * T::ROUNDOFF)@ | T::zero()
fine: vector that is not of unit length | solver/depth/fine/level.rs | for term in [-@shrink@, | T::zero()
fine: nearest point aside | solver/depth/fine/nearest.rs | level.lower(&points) - @aside * (aside / least)@ | T::zero()
fine: nearest point aside, its error | solver/depth/fine/nearest.rs | T::of(1.01) + @blur@; | T::zero()
fine: ball of a turned body | solver/depth/fine/recorder.rs | (T::one() - @T::count(8) * off@) | T::zero()
fine: ball of a turned body, rounding | solver/depth/fine/recorder.rs | skew(&body.rotation) + @T::count(8) * T::ROUNDOFF@; | T::zero()
fine: origin beneath each facet | solver/depth/fine/facets.rs | @(facet.offset > margin)@.then | (facet.offset > T::zero())
"""

# Margins that no test misses, and why they are there.
HIDDEN = {
    "bracket: simplex, point without a direction": "the second order is true there too, only large; it keeps a division from nearly 0",
    "bracket: crossing, weights off": "a fourth margin where three have been enough",
    "bracket: origin beneath the lowest facet": "what makes the winding certain; of a ball, d >= e - m holds near 0 as well",
    "bracket: any Q by direction, rounding": "hidden by the rounding of heights",
    "bracket: any Q, rounding": "hidden by the rounding of heights, which is rarely as large as its bound",
    "expansion: from the key to the offset": "hidden by the rounding of the bound itself",
    "polytope: surface folded over": "slivers that fold have not made a bound false; the proof needs it",
    "polytope: centre beneath a facet, rounding": "as above",
    "polytope: centre beneath a facet by direction, rounding": "as above",
    "polytope: visible facets": "makes slivers rare; the proof does not need it (bounds.rs, \"Around the origin\")",
    "conewise: each halving": "hidden by three margins, of which a halving takes a thirtieth at most",
    "rays: rounding of the lower bound": "hidden by the rounding of heights",
    "rays: ball of A, crossings off": "second order: a share of the ball, of a loss that is small itself",
    "tracker: rounding, in units of Q": "the quotient is no more than both bounds together, which count already",
    "span: tilt of Q, inner radius": "second order: a share of a loss that is small itself",
    "span: axes off by rounding": "hidden by the rounding of heights",
    "second look: extents of a measured set": "second order: a few roundoffs of a margin",
    "distance: ball put back, error": "hidden by the rounding of heights, as large",
    "polytope: centre beneath a point, in two words": "as \"surface folded over\": the proof needs it",
    "rays: ball along a ray, seen from there": "one roundoff, of which the rounding of heights has ten",
    "pair: by direction, matrices that stretch": "errors are spread by the matrix as it is; the rest is hidden by the rounding of the sum",
    "pair: ball under a matrix that stretches": "left as it is, the ball is charged what it is off: true as well, only wider",
    "pair: ball beside the points, rounding": "a roundoff of the radius, where heights have ten of a reach that is as large; half spaces take the difference unrounded",
    "pair: ball in the points, rounding": "the ball counts in the core's extent and its twenty roundoffs",
    "pair: ball that is an image, rounding of what is measured": "four of the bound's own six roundoffs",
    "meridian: rounding of what is measured": "three roundoffs, where points are charged twenty",
    "sectors: matrices that stretch": "64 roundoffs of a radius, where 68 of the size are charged",
    "sectors: disc, scale": "hides and is hidden by the disc's rounding, as large",
    "sectors: disc, rounding": "as above",
    "ellipsoids: matrices that stretch": "32 roundoffs of a semi axis, where ball and points are charged 52",
    "ellipsoids: rounding of what is measured": "of some twenty roundoffs the square is lost",
    "half spaces: direction, rounding": "a roundoff's square beside low words of a roundoff",
    "half spaces: rounding of a ball's height": "shallow, the offset is as large a term; deep, a roundoff of the depth hides it",
    "half spaces: direction in two words, rounding": "hidden by that of the point, as large",
    "half spaces: a point in two words": "hidden by the rounding of heights, as large, of which it takes a few hundredths",
    "fine: nearest point aside, its error": "squared, over a length that is larger",
    "fine: origin beneath each facet": "as \"origin beneath the lowest facet\": the proof needs it",
}

# Of the test program `core`, and of the library's own tests, where a query has room for what a part of it loses.
TESTS = ["boxes::", "exact_margins::", "depth_margins::", "far_points::", "half_spaces::"]
OWN_TESTS = ["solver::depth::pair::", "solver::depth::sectors::"]
SWITCH = """
/// Is this margin taken away?
#[cfg(feature = "std")]
pub(crate) fn margin_is_gone(number: usize) -> bool {
    static GONE: std::sync::OnceLock<usize> = std::sync::OnceLock::new();
    let gone = || std::env::var("MARGIN").ok().and_then(|n| n.parse().ok()).unwrap_or(usize::MAX);
    *GONE.get_or_init(gone) == number
}
"""


def listed():
    for line in MARGINS.splitlines():
        if line.strip():
            name, file, code, without = (part.strip() for part in re.split(r" \| ", line))
            yield name, file, code, without


def switched(root, copy):
    """Writes the copy with all margins behind the switch."""
    files = [root / name for name in ["Cargo.toml", "Cargo.lock", "README.md"]]
    for folder in ["src", "capi", "cli", "tests", "benches", "examples", "fuzz"]:
        files += [file for file in (root / folder).rglob("*") if file.is_file()]
    texts = {str(file.relative_to(root)): file.read_text() for file in files}
    spans = {}
    for number, (name, file, code, without) in enumerate(listed()):
        before, margin, after = code.split("@")
        text, whole = texts[f"src/{file}"], before + margin + after
        if text.count(whole) != 1:
            sys.exit(f"{name}: `{whole}` is {text.count(whole)} times in src/{file}")
        start = text.index(whole) + len(before)
        spans.setdefault(f"src/{file}", []).append((start, start + len(margin), number, without))
    for file, list_ in spans.items():
        text = texts[file]
        for start, end, number, without in sorted(list_, reverse=True):
            switch = f"(if crate::margin_is_gone({number}) {{ {without} }} else {{ {text[start:end]} }})"
            text = text[:start] + switch + text[end:]
        texts[file] = text
    texts["src/lib.rs"] = "#![allow(unused_parens)]\n" + texts["src/lib.rs"] + SWITCH
    for file in copy.rglob("*"):
        if file.is_file() and str(file.relative_to(copy)) not in texts:
            file.unlink()
    for file, text in texts.items():
        # (What is as it was is not built again.)
        if not (copy / file).exists() or (copy / file).read_text() != text:
            (copy / file).parent.mkdir(parents=True, exist_ok=True)
            (copy / file).write_text(text)


def built(copy):
    """Builds the tests of the copy: programs, and what of each is run."""
    command = ["cargo", "test", "--locked", "--features", "std", "--no-run", "--target-dir", copy.parent, "--lib", "--test", "core"]
    run = subprocess.run(command, cwd=copy, stderr=subprocess.PIPE, text=True)
    if run.returncode != 0:
        sys.exit(run.stderr)
    program = lambda name: re.search(rf"\(([^()]*/{name}-[0-9a-f]+)\)", run.stderr).group(1)
    return [[program("qdist"), *OWN_TESTS], [program("core"), *TESTS]]


def failing(programs, copy, number):
    """The tests that fail without the margin; `None`: all pass."""
    failed = []
    for program in programs:
        try:
            run = subprocess.run(program, cwd=copy, env={**os.environ, "MARGIN": str(number)}, capture_output=True, text=True, timeout=120)
        except subprocess.TimeoutExpired:
            return "(does not end)"
        if run.returncode != 0:
            failed += re.findall(r"^test (\S+) \.\.\. FAILED", run.stdout, re.M) or ["(stops)"]
    return ", ".join(failed) or None


def main():
    root = Path(__file__).resolve().parent.parent
    words = [word for word in sys.argv[1:] if word != "--list"]
    wanted = [(n, name) for n, (name, *_) in enumerate(listed()) if not words or any(word in name for word in words)]
    if "--list" in sys.argv:
        print("\n".join(name for _, name in wanted))
        return
    target = Path(os.environ.get("CARGO_TARGET_DIR", root / "target")).resolve()
    copy = target / "margins"
    copy.mkdir(parents=True, exist_ok=True)
    switched(root, copy)
    programs = built(copy)
    if (failed := failing(programs, copy, -1)) is not None:
        sys.exit(f"a test fails with all margins: {failed}")
    missing = 0
    for number, name in wanted:
        found = failing(programs, copy, number)
        missing += found is None and name not in HIDDEN
        print(f"{name:55} {found or '(' + HIDDEN[name] + ')' if name in HIDDEN else found or 'NO TEST FAILS'}", flush=True)
    print(f"{len(wanted)} margins, {missing} of them without a test that fails or a reason")
    sys.exit(missing > 0)


if __name__ == "__main__":
    main()
