"""Counts how often a loop runs that adds a step until a limit, in binary and in decimal arithmetic.

    python3 tests/verify/rounding.py > tests/verify/rounding.tsv

The third column is the count in doubles, the fourth the one of exact decimals. The last digit decides what the machine does
where the two differ, and where a sum that doubles do not hold exactly lies so near the limit that other errors than
theirs would put it on the other side: the fifth column says yes or no.
"""

from decimal import Decimal

ROWS = [
    ("0.1", "1"), ("0.1", "0.95"), ("0.1", "0.8"), ("0.1", "2"), ("0.25", "1"), ("0.5", "3"), ("1", "7"),
    ("0.3", "0.9"), ("0.3", "1"), ("0.7", "2.1"), ("0.7", "4.9"), ("0.01", "0.06"), ("0.01", "0.065"),
    ("0.05", "1"), ("0.15", "0.6"), ("0.35", "0.7"), ("1.1", "3.3"), ("1.1", "9.9"),
]


def count(step, limit):
    value, times = type(step)(0), 0
    while value < limit:
        value, times = value + step, times + 1
    return times


def hangs(step, limit):
    """Whether a sum may lie on either side of the limit, each that doubles do not hold being off by 1e-13 of it."""
    exact, double, off, hangs = Decimal(0), 0.0, 0.0, False
    while exact < Decimal(limit):
        exact, double = exact + Decimal(step), double + float(step)
        if off > 0 or double != float(exact):
            off += 1e-13 * double
        hangs |= off > 0 and abs(float(exact) - float(limit)) <= off
    return hangs


for step, limit in ROWS:
    decides = "yes" if hangs(step, limit) else "no"
    print(step, limit, count(float(step), float(limit)), count(Decimal(step), Decimal(limit)), decides, sep="\t")
