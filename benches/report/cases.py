"""Pairs of bodies, in the format of the case files. The same seed gives the same numbers on every machine."""

import math
import random
from decimal import Decimal

from report.job import run


class Dice(random.Random):
    """Random numbers, directions and rotations."""

    def between(self, low, high):
        return low + (high - low) * self.random()

    def direction(self):
        while True:
            v = [self.between(-1, 1) for _ in range(3)]
            length = math.sqrt(sum(x * x for x in v))
            if 0.1 < length < 1:
                return [x / length for x in v]

    def rotation(self):
        """Rows of a rotation matrix, uniform: from a unit quaternion."""
        while True:
            q = [self.between(-1, 1) for _ in range(4)]
            length = math.sqrt(sum(x * x for x in q))
            if 0.1 < length < 1:
                break
        return matrix([x / length for x in q])


def matrix(q):
    w, x, y, z = q
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]


class Body:
    """A shape of the case files in a pose."""

    def __init__(self, kind, numbers, rotation=IDENTITY, translation=(0, 0, 0)):
        self.kind, self.numbers, self.rotation, self.translation = kind, list(numbers), rotation, list(translation)

    def height(self, u):
        """The support function, in double precision: good enough to place bodies by."""
        n = self.numbers
        w = [sum(self.rotation[i][j] * u[i] for i in range(3)) for j in range(3)]
        across = math.hypot(w[0], w[1])
        own = {
            "sphere": lambda: n[0],
            "box": lambda: sum(abs(x) * h for x, h in zip(w, n)),
            "ellipsoid": lambda: math.sqrt(sum((x * h) ** 2 for x, h in zip(w, n))),
            "cylinder": lambda: n[0] * across + n[1] * abs(w[2]),
            "capsule": lambda: n[0] + n[1] * abs(w[2]),
            "cone": lambda: max(n[1] * w[2], n[0] * across - n[1] * w[2]),
            "hull": lambda: max(w[0] * n[i] + w[1] * n[i + 1] + w[2] * n[i + 2] for i in range(0, len(n), 3)),
        }[self.kind]()
        return own + sum(x * t for x, t in zip(u, self.translation))

    def lines(self):
        numbers = " ".join(repr(float(x)) for x in self.numbers)
        count = len(self.numbers) // 3 if self.kind == "hull" else len(self.numbers)
        pose = " ".join(repr(float(x)) for x in [*sum(map(list, self.rotation), []), *self.translation])
        return f"S {self.kind} {count} {numbers}", f"P {pose}"


def case(name, a, b, size=1.0):
    """One case, as text. The format has a place for a reference, which is not known here."""
    return "\n".join([f"CASE {name}", *a.lines(), *b.lines(), f"T nan nan nan {size!r} nan nan nan"]) + "\n"


def write(path, cases):
    path.write_text("".join(cases))


def shape(dice, kind, size=1.0):
    """A random shape; `hull-50` has 50 points on a sphere, all of which are corners."""
    length = lambda: size * dice.between(0.3, 1)
    if kind.startswith("hull-"):
        return "hull", [size * x for _ in range(int(kind[5:])) for x in dice.direction()]
    count = {"sphere": 1, "box": 3, "ellipsoid": 3}.get(kind, 2)
    return kind, [length() for _ in range(count)]


def kept(job, oracle, count, draw, most=40):
    """`count` cases of those that `draw(k)` makes: the first that overlap in truth. (Along a random direction bodies may seem to overlap and be apart.) Where too few
    of `most` times as many do, the others make up for them."""
    file = job.path("drawn.cases")
    inside, others, k = [], [], 0
    while len(inside) < count and k < most * count:
        texts = [draw(k + i) for i in range(count)]
        k += count
        write(file, texts)
        truth = [line.split(",") for line in run([oracle, file, "1e-6", "400"]).splitlines()[1:]]
        for text, (_, lower, *_) in zip(texts, truth, strict=True):
            (inside if Decimal(lower) > 0 else others).append(text)
    return (inside + others)[:count]


def overlapping(dice, kinds, share):
    """Two random bodies, the second moved along a random direction until this share of their reach along it is overlap."""
    a, b = (Body(*shape(dice, kind), dice.rotation()) for kind in kinds)
    u = dice.direction()
    reach = a.height(u) + b.height([-x for x in u])
    b.translation = [x * reach * (1 - share) for x in u]
    return a, b
