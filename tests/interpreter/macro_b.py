"""Runs the part of Macro B that Fanuc and Haas share, from the manuals' rules, on the text of programs, and draws
programs of it.

Known to it: assignments, expressions, IF GOTO, IF THEN, WHILE, GOTO, G65 with arguments, M98, and straight moves.
"""

import math
import random
import re

from common import STEPS, Alarm, Edge, Moves, Words, apart, nearest, root, whole

WORD = re.compile(
    r"#|\[|\]|ROUND|WHILE|GOTO|THEN|ATAN|SQRT|END|DO|IF|SIN|COS|ABS|FIX|FUP|MOD|EQ|NE|GT|LT|GE|LE"
    r"|[A-Z]|\d*\.\d+|\d+\.?|[-+*/=]"
)
# seed 001: which local variable an address of a macro call sets (argument specification I).
LOCALS = dict(A=1, B=2, C=3, I=4, J=5, K=6, D=7, E=8, F=9, H=11, M=13)
LOCALS.update(Q=17, R=18, S=19, T=20, U=21, V=22, W=23, X=24, Y=25, Z=26)



# The Haas' remainder and arc tangent are not stated (facts/haas.md 2).
OPERATORS = {"fanuc": ["+", "-", "*", "/", "MOD"], "haas": ["+", "-", "*", "/"]}
FUNCTIONS = {"fanuc": ["SIN", "COS", "SQRT", "ABS", "ROUND", "FIX", "ATAN"], "haas": ["SIN", "COS", "SQRT", "ABS", "ROUND", "FIX"]}


def number(value):
    """A vacant variable is 0 in arithmetic (seed 001)."""
    return 0.0 if value is None else value


def function(name, x):
    if name == "SIN":
        return math.sin(math.radians(x))
    if name == "COS":
        return math.cos(math.radians(x))
    if name == "SQRT":
        return root(x)
    if name == "ABS":
        return abs(x)
    if name == "ROUND":
        return nearest(x)
    return whole(x, math.trunc)  # FIX


class Line(Words):
    """The words of one block, read from left to right."""

    def __init__(self, text, machine):
        super().__init__(WORD, text, machine)

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
            apart(a, 0)
            if a == 0:
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
        if a is not None and b is not None:
            apart(a, b)
        if relation in ("EQ", "NE"):  # vacant is vacant, and no number, not even 0
            return (a == b) == (relation == "EQ")
        a, b = number(a), number(b)
        return {"GT": a > b, "LT": a < b, "GE": a >= b, "LE": a <= b}[relation]


class Machine:
    """The variables and the moves."""

    def __init__(self, programs):
        self.programs, self.common, self.levels = programs, {}, [{}]
        self.moves, self.steps = Moves(), 0

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
        places = {}
        for letter, value, computed in words:
            if letter == "G":
                self.moves.code(value)
            # A word whose variable is vacant is not there; a computed one is rounded to .001 mm.
            elif letter in "XYZ" and value is not None:
                places[letter] = nearest(value * 1000) / 1000 if computed else value
        if places:
            self.moves.go(places)


class Writer:
    """Draws the blocks of a program and of one that it calls."""

    def __init__(self, dialect, seed):
        self.draw, self.labels = random.Random(seed), 0
        self.operators, self.functions = OPERATORS[dialect], FUNCTIONS[dialect]

    def pick(self, *choices):
        return self.draw.choice(choices)

    def variable(self):
        return self.pick("#1", "#2", "#3", "#5", "#100", "#101", "#102", "#103", "#[#110+100]")

    def value(self, depth=0):
        kind = self.draw.random()
        if depth > 2 or kind < 0.3:
            return self.pick("0", "1", "2", "3.", "2.5", "0.25", "10", "359.9", "0.004")
        if kind < 0.6:
            return self.variable()
        if kind < 0.85:
            operator = self.draw.choice(self.operators)
            # A divisor that is written must not be 0.
            right = self.pick("3", "#5", "2.5") if operator in ("/", "MOD") else self.value(depth + 1)
            return f"[{self.value(depth + 1)}{operator}{right}]"
        function = self.draw.choice(self.functions)
        if function == "ATAN":
            return f"ATAN[{self.value(depth + 1)}]/[{self.pick('2', '#5', '-1')}]"
        if function == "SQRT":
            return f"SQRT[{self.pick('2', '#5', '#5*#5')}]"
        return f"{function}[{self.pick('', '-')}{self.value(depth + 1)}]"

    def condition(self):
        relation = self.pick("EQ", "NE", "GT", "LT", "GE", "LE")
        return f"[{self.value(1)}{relation}{self.pick(self.value(1), '#0', '0')}]"

    def blocks(self, out, most, depth, inner):
        for _ in range(self.draw.randint(1, most)):
            kind = self.draw.random()
            if kind < 0.4:
                out.append(f"{self.variable()}={self.pick(self.value(), '#0', self.variable(), self.value())}")
            elif kind < 0.5:
                out.append(f"IF{self.condition()}THEN{self.variable()}={self.value()}")
            elif kind < 0.62:
                self.labels += 10
                label = self.labels
                out.append(f"IF{self.condition()}GOTO{label}")
                self.blocks(out, 3, depth, inner)
                out.append(f"N{label}")
            elif kind < 0.72 and depth < 3:
                count = f"#{120 + depth + 4 * inner}"
                out.append(f"{count}=0")
                out.append(f"WHILE[{count}LT{self.draw.randint(1, 4)}]DO{depth + 1}")
                out.append(f"{count}={count}+1")
                self.blocks(out, 3, depth + 1, inner)
                out.append(f"END{depth + 1}")
            elif kind < 0.8 and not inner:
                letters = self.draw.sample("ABCDEXY", self.draw.randint(1, 4))
                given = [letter + self.pick("1.5", "-2.", "#1", "#100", "[#2+1.]", "#3") for letter in letters]
                out.append(self.pick("M98P2", "G65P2" + "".join(given), "G65P2" + "".join(given)))
            else:
                axes = self.draw.sample("XYZ", self.draw.randint(1, 3))
                words = [axis + self.pick("1.5", "-3.", "#1", "#101", "[#102/3]", "[#3+0.0002]") for axis in axes]
                out.append(self.pick("G0", "G1", "G90G0", "G91G1", "", "G90") + "".join(words))

    def programs(self):
        main = ["G21G94", "F100.", "G90G0X0.Y0.Z0.", f"#110={self.draw.randint(0, 3)}"]
        self.blocks(main, 16, 0, 0)
        self.labels, called = 0, []
        self.blocks(called, 8, 0, 1)
        return {1: main + ["M30"], 2: called + ["M99"]}


def run(dialect, seed):
    """The text of a program, its moves, its common variables, and whether it ends by an alarm."""
    programs = Writer(dialect, seed).programs()
    machine, alarm = Machine(programs), False
    try:
        machine.run(1)
    except Alarm:
        alarm = True
    text = "".join(f"O{number}\n" + "".join(line + "\n" for line in lines) for number, lines in programs.items())
    values = {f"#{number}": value for number, value in sorted(machine.common.items()) if value is not None}
    return text, machine.moves.list, values, alarm
