"""What the interpreters share: numbers, alarms, and what is left out."""

import math

NEAR = 1e-7
STEPS = 20_000


class Alarm(Exception):
    """The control stops with an alarm."""


class Edge(Exception):
    """Something that no manual decides: last digits, or a case that is not stated."""


def nearest(x):
    """The nearest whole number, halves away from zero."""
    if abs(abs(x) % 1.0 - 0.5) < NEAR:
        raise Edge
    return math.copysign(math.floor(abs(x) + 0.5), x)


def whole(x, f):
    """`f` of a number; not of one that is whole but for its last digits."""
    if x != round(x) and abs(x - round(x)) < NEAR:
        raise Edge
    return float(f(x))


def apart(a, b):
    """A comparison of nearly equal numbers hangs on their last digits."""
    if a != b and abs(a - b) < NEAR:
        raise Edge


def root(x):
    if x < 0:
        raise Alarm
    return math.sqrt(x)


class Words:
    """The words of one block, read from left to right."""

    def __init__(self, pattern, text, machine):
        self.words, self.at, self.machine = pattern.findall(text), 0, machine

    def peek(self):
        return self.words[self.at] if self.at < len(self.words) else None

    def take(self, wanted=None):
        word = self.peek()
        assert wanted is None or word == wanted, (self.words, wanted)
        self.at += 1
        return word


class Moves:
    """Straight moves, absolute or incremental, in millimetres."""

    def __init__(self):
        self.place, self.absolute, self.rapid, self.list = [0.0] * 3, True, True, []

    def code(self, number):
        if number in (0, 1):
            self.rapid = number == 0
        elif number in (90, 91):
            self.absolute = number == 90

    def go(self, words):
        """`words` are values by axis letter."""
        before = list(self.place)
        for letter, value in words.items():
            axis = "XYZ".index(letter)
            self.place[axis] = value if self.absolute else self.place[axis] + value
        # A move that goes nowhere is left out.
        if max(abs(a - b) for a, b in zip(before, self.place)) > 1e-6:
            self.list.append(("rapid" if self.rapid else "feed", tuple(self.place)))
