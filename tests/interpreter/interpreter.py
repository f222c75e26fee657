"""Runs the part of Macro B that Fanuc and Haas share, from the manuals' rules, on the text of programs.

Known to it: assignments, expressions, IF GOTO, IF THEN, WHILE, GOTO, G65 with arguments, M98, and straight moves.
What hangs on the last digits of a number raises `Edge`: no manual says how a control decides it.
"""

import math
import re

NEAR = 1e-7
STEPS = 20_000
WORD = re.compile(
    r"#|\[|\]|ROUND|WHILE|GOTO|THEN|ATAN|SQRT|END|DO|IF|SIN|COS|ABS|FIX|FUP|MOD|EQ|NE|GT|LT|GE|LE"
    r"|[A-Z]|\d*\.\d+|\d+\.?|[-+*/=]"
)
# seed 001: which local variable an address of a macro call sets (argument specification I).
LOCALS = dict(A=1, B=2, C=3, I=4, J=5, K=6, D=7, E=8, F=9, H=11, M=13)
LOCALS.update(Q=17, R=18, S=19, T=20, U=21, V=22, W=23, X=24, Y=25, Z=26)


class Alarm(Exception):
    """The control stops with an alarm."""


class Edge(Exception):
    """A decision that hangs on the last digits."""


def number(value):
    """A vacant variable is 0 in arithmetic (seed 001)."""
    return 0.0 if value is None else value


def nearest(x):
    if abs(abs(x) % 1.0 - 0.5) < NEAR:
        raise Edge
    return math.copysign(math.floor(abs(x) + 0.5), x)


def whole(x, f):
    """`f` of a number that is no whole number but for its last digits."""
    if x != round(x) and abs(x - round(x)) < NEAR:
        raise Edge
    return float(f(x))


def function(name, x):
    if name == "SIN":
        return math.sin(math.radians(x))
    if name == "COS":
        return math.cos(math.radians(x))
    if name == "SQRT":
        if x < 0:
            raise Alarm
        return math.sqrt(x)
    if name == "ABS":
        return abs(x)
    if name == "ROUND":
        return nearest(x)
    if name == "FIX":
        return whole(x, math.trunc)
    return math.copysign(whole(abs(x), math.ceil), x)  # FUP


class Line:
    """The words of one block, read from left to right."""

    def __init__(self, text, machine):
        self.words, self.at, self.machine = WORD.findall(text), 0, machine

    def peek(self):
        return self.words[self.at] if self.at < len(self.words) else None

    def take(self, wanted=None):
        word = self.peek()
        assert wanted is None or word == wanted, (self.words, wanted)
        self.at += 1
        return word

    def sum(self):
        value = self.product()
        while self.peek() in ("+", "-"):
            sign = 1 if self.take() == "+" else -1
            value = number(value) + sign * number(self.product())
        return value

    def product(self):
        value = self.factor()
        while self.peek() in ("*", "/", "MOD"):
            operator, a, b = self.take(), number(value), number(self.factor())
            if operator == "*":
                value = a * b
                continue
            if operator == "MOD":  # seed 001: both operands are rounded first
                a, b = nearest(a), nearest(b)
            if b == 0:
                raise Alarm
            value = a / b if operator == "/" else math.fmod(a, b)
        return value

    def bracket(self):
        self.take("[")
        value = self.sum()
        self.take("]")
        return value

    def factor(self):
        word = self.peek()
        if word == "-":
            self.take()
            return -number(self.factor())
        if word == "[":
            return self.bracket()
        if word == "#":
            return self.machine.read(self.variable())
        if word == "ATAN":
            self.take()
            a = number(self.bracket())
            self.take("/")
            b = number(self.bracket())
            if abs(a) < NEAR:
                raise Edge
            return math.degrees(math.atan2(a, b)) % 360.0
        if word[0].isalpha():
            return function(self.take(), number(self.bracket()))
        return float(self.take())

    def variable(self):
        self.take("#")
        return int(nearest(number(self.bracket()))) if self.peek() == "[" else int(self.take())

    def condition(self):
        self.take("[")
        a, relation, b = self.sum(), self.take(), self.sum()
        self.take("]")
        if a is not None and b is not None and a != b and abs(a - b) < NEAR:
            raise Edge
        if relation in ("EQ", "NE"):  # vacant is vacant, and no number, not even 0
            return (a == b) == (relation == "EQ")
        a, b = number(a), number(b)
        return {"GT": a > b, "LT": a < b, "GE": a >= b, "LE": a <= b}[relation]


class Machine:
    """The variables, the place of the tool and its moves; millimetres."""

    def __init__(self, programs):
        self.programs, self.common, self.levels = programs, {}, [{}]
        self.place, self.absolute, self.rapid, self.moves, self.steps = [0.0] * 3, True, True, [], 0

    def store(self, variable):
        return self.levels[-1] if variable <= 33 else self.common

    def read(self, variable):
        return None if variable == 0 else self.store(variable).get(variable)

    def run(self, name):
        lines = [re.fullmatch(r"(?:N(\d+))?(.*)", line).groups() for line in self.programs[name]]
        places = {int(n): at for at, (n, _) in reversed(list(enumerate(lines))) if n}
        heads, ends, open_loops = {}, {}, []
        for at, (_, text) in enumerate(lines):
            if text.startswith("WHILE"):
                open_loops.append(at)
            elif text.startswith("END"):
                heads[at] = open_loops.pop()
                ends[heads[at]] = at
        at = 0
        while lines[at][1] not in ("M99", "M30"):
            self.steps += 1
            if self.steps > STEPS:
                raise Edge
            line, to = Line(lines[at][1], self), at + 1
            word = line.peek()
            if word == "IF":
                line.take()
                holds = line.condition()
                if line.take() == "GOTO":
                    to = places[int(line.take())] if holds else to
                elif holds:
                    self.assign(line)
            elif word == "GOTO":
                line.take()
                to = places[int(line.take())]
            elif word == "WHILE":
                line.take()
                to = to if line.condition() else ends[at] + 1
            elif word == "END":
                to = heads[at]
            elif word == "#":
                self.assign(line)
            elif word is not None:
                self.block(line)
            at = to

    def assign(self, line):
        variable = line.variable()
        line.take("=")
        value = line.sum()
        self.store(variable)[variable] = value

    def block(self, line):
        words = []
        while line.peek():
            letter = line.take()
            negative = line.peek() == "-" and bool(line.take())
            computed = line.peek() in ("#", "[")
            value = line.factor()
            words.append((letter, None if value is None else -value if negative else value, computed))
        codes = [(letter, value) for letter, value, _ in words if letter in "GM"]
        if ("G", 65.0) in codes:  # a level of its own, which holds nothing but the arguments
            level = {LOCALS[letter]: value for letter, value, _ in words if letter not in "GP"}
            self.levels.append(level)
            self.run(next(int(value) for letter, value, _ in words if letter == "P"))
            self.levels.pop()
        elif ("M", 98.0) in codes:  # the caller's locals are the subprogram's
            self.run(next(int(value) for letter, value, _ in words if letter == "P"))
        else:
            self.move(words)

    def move(self, words):
        goes = False
        for letter, value, computed in words:
            if letter == "G" and value in (0.0, 1.0):
                self.rapid = value == 0.0
            elif letter == "G" and value in (90.0, 91.0):
                self.absolute = value == 90.0
        for letter, value, computed in words:
            if letter in "XYZ" and value is not None:  # a word whose variable is vacant is not there
                axis, goes = "XYZ".index(letter), True
                value = nearest(value * 1000) / 1000 if computed else value
                self.place[axis] = value if self.absolute else self.place[axis] + value
        if goes:
            self.moves.append(("rapid" if self.rapid else "feed", tuple(self.place)))
