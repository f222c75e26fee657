"""Runs the CC 100's parametric blocks, from the rules of its course (seed 004), on the text of programs, and draws
programs of them.

Known to it: assignments of one operation, the condition register, branches, labels, subprograms, and straight moves.
"""

import math
import random
import re

from common import STEPS, Alarm, Edge, Moves, apart, root, whole

BRANCH = {
    "BEQ": lambda x: x == 0,
    "BNE": lambda x: x != 0,
    "BGT": lambda x: x > 0,
    "BLT": lambda x: x < 0,
    "BGE": lambda x: x >= 0,
    "BLE": lambda x: x <= 0,
}
FUNCTION = {
    "SQR": root,
    "SIN": lambda x: math.sin(math.radians(x)),
    "COS": lambda x: math.cos(math.radians(x)),
    "ATN": lambda x: math.degrees(math.atan(x)),
}


def turn(x):
    """Sine and cosine take -360 to 360 degrees."""
    if abs(x) > 360:
        raise Edge
    return x


def step(value, by):
    """INC and DEC throw the fraction away; what they do below 0 is not stated."""
    if value < 0 and value != math.trunc(value):
        raise Edge
    return whole(value, math.trunc) + by


def word(value):
    """How far a computed word is rounded is not stated: whole increments only."""
    if abs(value * 1000 - round(value * 1000)) > 1e-6:
        raise Edge
    return value


class Machine:
    def __init__(self, lines):
        self.lines, self.values, self.register, self.moves, self.steps = lines, {}, None, Moves(), 0
        self.labels = {line: at for at, line in enumerate(lines) if line.startswith("$")}

    def read(self, text):
        """A variable that nothing has set is not known."""
        if not text.startswith("V"):
            return float(text)
        if text not in self.values:
            raise Edge
        return self.values[text]

    def run(self, at=0):
        while True:
            self.steps += 1
            if self.steps > STEPS:
                raise Edge
            line, at = self.lines[at], at + 1
            if line in ("M30", "G99"):
                return
            if call := re.fullmatch(r"G22 P(\d+)(?: L(\d+))?", line):
                # L counts the runs behind the first one (problem 9).
                for _ in range(1 + int(call[2] or 0)):
                    self.run(self.labels[f"${call[1]}"])
            elif jump := re.fullmatch(r"G24 P(\d+)", line):
                at = self.labels[f"${jump[1]}"]
            elif branch := re.fullmatch(r"(B..) P(\d+)", line):
                if self.register is None:
                    raise Edge
                if BRANCH[branch[1]](self.register):
                    at = self.labels[f"${branch[2]}"]
            elif not line.startswith("$"):
                self.block(line)

    def block(self, line):
        if test := re.fullmatch(r"TST (V\d+)", line):
            self.register = self.read(test[1])
        elif count := re.fullmatch(r"(INC|DEC) (V\d+)", line):
            self.values[count[2]] = self.register = step(self.read(count[2]), 1 if count[1] == "INC" else -1)
        elif calculation := re.fullmatch(r"(V\d+)=(V\d+)([-+*/])(\S+)", line):
            result, a, b = calculation[1], self.read(calculation[2]), self.read(calculation[4])
            if calculation[3] == "/" and b == 0:
                raise Edge
            value = {"+": a + b, "-": a - b, "*": a * b, "/": b and a / b}[calculation[3]]
            apart(value, 0)
            self.values[result] = self.register = value
        elif of := re.fullmatch(r"(V\d+)=(SQR|SIN|COS|ATN) (V\d+)", line):
            x = self.read(of[3])
            self.values[of[1]] = FUNCTION[of[2]](turn(x) if of[2] in ("SIN", "COS") else x)
            self.register = None
        elif load := re.fullmatch(r"(V\d+)=(\S+)", line):
            self.values[load[1]], self.register = self.read(load[2]), None
        else:
            self.words(line)

    def words(self, line):
        places = {}
        for letter, value in re.findall(r"([A-Z])=?(V\d+|-?[\d.]+)", line):
            if letter == "G":
                self.moves.code(int(value))
            elif letter in "XYZ":
                places[letter] = word(self.read(value))
        if places:
            self.moves.go(places)


class Writer:
    def __init__(self, seed):
        self.draw, self.labels = random.Random(seed), 10

    def pick(self, *choices):
        return self.draw.choice(choices)

    def variable(self):
        return f"V{self.draw.randint(30, 35)}"

    def operation(self):
        constant = self.pick("2", "0.5", "-1", "3", "10", "0.25", "4")
        kind = self.draw.random()
        if kind < 0.6:
            operator = self.pick("+", "-", "*", "/", "+", "-")
            right = constant if operator in "/*" else self.pick(constant, self.variable())
            return f"{self.variable()}={self.variable()}{operator}{right}"
        if kind < 0.7:
            return f"{self.variable()}={self.pick('SQR', 'SIN', 'COS', 'ATN')} {self.variable()}"
        return self.pick(f"INC {self.variable()}", f"DEC {self.variable()}", f"{self.variable()}={constant}")

    def label(self):
        self.labels += 1
        return self.labels

    def blocks(self, out, most, depth):
        for _ in range(self.draw.randint(2, most)):
            kind = self.draw.random()
            if kind < 0.4:
                out.append(self.operation())
            elif kind < 0.55:
                behind = self.label()
                out.append(self.pick(f"TST {self.variable()}", f"{self.variable()}={self.variable()}-{self.variable()}"))
                out.append(f"{self.pick(*BRANCH)} P{behind}")
                self.blocks(out, 3, depth)
                out.append(f"${behind}")
            elif kind < 0.65 and depth < 2:
                head, count = self.label(), f"V{40 + depth}"
                out += [f"{count}={self.draw.randint(1, 3)}", f"${head}"]
                self.blocks(out, 3, depth + 1)
                out += [f"DEC {count}", f"BGT P{head}"]
            elif kind < 0.73 and depth == 0:
                out.append(self.pick("G22 P1", "G22 P2", "G22 P1 L2"))
            elif kind < 0.8:
                behind = self.label()
                out += [f"G24 P{behind}", self.operation(), f"${behind}"]
            elif kind < 0.9:
                axes = self.draw.sample("XYZ", self.draw.randint(1, 3))
                out.append(" ".join(f"{axis}={self.variable()}" for axis in axes))
            else:
                axes = self.draw.sample("XYZ", self.draw.randint(1, 3))
                code = self.pick("G0", "G1", "G90 G0", "G91 G1", "G90")
                out.append(" ".join([code] + [f"{axis}{self.pick('5', '-2.5', '40', '0')}" for axis in axes]))

    def lines(self):
        lines = ["G90 G1 X1 Y2 F500"] + [f"V{n}={self.pick('3', '7.5', '-4', '0', '0.5')}" for n in range(30, 36)]
        self.blocks(lines, 12, 0)
        for label in (1, 2):
            lines += ["M30" if label == 1 else "G99", f"${label}"]
            self.blocks(lines, 4, 2)
        return lines + ["G99"]


def run(_, seed):
    """The text of a program, its moves, its variables, and whether it ends by an alarm."""
    lines = Writer(seed).lines()
    machine, alarm = Machine(lines), False
    try:
        machine.run()
    except Alarm:
        alarm = True
    return "".join(line + "\n" for line in lines), machine.moves.list, dict(sorted(machine.values.items())), alarm
