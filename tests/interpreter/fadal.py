"""Runs Fadal macros, from the rules of its manual (seed 000, section 18), on the text of programs, and draws programs.

Known to it: V and R variables, macro assignments and expressions, IF THEN, GOTO to labels, L subroutines, R words, and
straight moves.
"""

import math
import random
import re

from common import STEPS, Alarm, Edge, Moves, Words, apart, nearest, root, whole

WORD = re.compile(r"AND|OR|<=|>=|<>|[A-Z]+(?=\()|[VR]\d+|\d*\.\d*|\d+|[-+*/=<>()]")
FUNCTION = {
    "ABS": abs,
    "INT": lambda x: whole(x, math.trunc),
    "SGN": lambda x: -1.0 if x < 0 else 1.0,  # SGN(0) is +1
    "SIN": lambda x: math.sin(math.radians(x)),
    "COS": lambda x: math.cos(math.radians(x)),
    "ATN": lambda x: math.degrees(math.atan(x)),
    "SQR": root,
}


class Expression(Words):
    """From left to right: brackets and functions, minus, * and /, + and -, comparisons, AND and OR."""

    def __init__(self, text, machine):
        super().__init__(WORD, text, machine)

    def condition(self):
        holds = self.comparison()
        if self.peek() in ("AND", "OR"):
            both, other = self.take() == "AND", self.comparison()
            holds = (holds and other) if both else (holds or other)
        return holds

    def comparison(self):
        """The manual brackets each of several comparisons."""
        bracket = any(word in ("AND", "OR") for word in self.words) and bool(self.take("("))
        a, relation, b = self.sum(), self.take(), self.sum()
        if bracket:
            self.take(")")
        apart(a, b)
        return {"=": a == b, "<>": a != b, "<": a < b, ">": a > b, "<=": a <= b, ">=": a >= b}[relation]

    def sum(self):
        value = self.product()
        while self.peek() in ("+", "-"):
            value = value + self.product() if self.take() == "+" else value - self.product()
        return value

    def product(self):
        value = self.factor()
        while self.peek() in ("*", "/"):
            if self.take() == "*":
                value *= self.factor()
            else:
                divisor = self.factor()
                if divisor == 0:
                    raise Edge
                value /= divisor
        return value

    def factor(self):
        word = self.take()
        if word == "-":
            return -self.factor()
        if word == "(":
            value = self.sum()
            self.take(")")
            return value
        if word in FUNCTION or word == "RND":
            self.take("(")
            value = self.sum()
            self.take(")")
            return FUNCTION[word](value) if word in FUNCTION else nearest(value * 100) / 100  # SET RND2
        return self.machine.read(word) if word[0] in "VR" else float(word)


class Machine:
    def __init__(self, lines):
        self.lines, self.values, self.moves, self.steps = lines, {}, Moves(), 0
        self.labels = {line: at for at, line in enumerate(lines) if line.startswith("#:")}
        self.subroutines = {line[1]: at for at, line in enumerate(lines) if re.fullmatch(r"L\d00", line)}

    def read(self, name):
        """What an earlier run left in a variable is not known."""
        if name not in self.values:
            raise Edge
        return self.values[name]

    def run(self, at):
        while True:
            self.steps += 1
            if self.steps > STEPS:
                raise Edge
            line, at = self.lines[at], at + 1
            # A subroutine ends where the next one begins.
            if line in ("M2", "M17") or re.fullmatch(r"L\d00", line):
                return
            if call := re.fullmatch(r"L(\d)(\d\d)", line):
                for _ in range(int(call[2])):
                    self.run(self.subroutines[call[1]] + 1)
            elif line.startswith("#"):
                at = self.macro(line[1:], at)
            else:
                self.words(line)

    def macro(self, text, at):
        if text.startswith(":") or text.startswith("SET"):
            return at
        if text.startswith("IF"):
            condition, text = text[2:].split(" THEN ")
            if not Expression(condition, self).condition():
                return at
        if text.startswith("GOTO"):
            return self.labels["#" + text.split()[1]]
        name, value = text.split("=", 1)
        self.values[name] = Expression(value, self).sum()
        return at

    def words(self, line):
        places = {}
        for letter, sign, value in re.findall(r"(R\d|[A-Z])([-+]?)(R\d|[\d.]+)", line):
            number = self.read(value) if value.startswith("R") else float(value)
            number = -number if sign == "-" else number
            if letter == "G":
                self.moves.code(number)
            elif letter in "XYZ":
                # How far a computed word is rounded is not stated: whole increments only.
                if abs(number * 1000 - round(number * 1000)) > 1e-6:
                    raise Edge
                places[letter] = number
            elif letter.startswith("R"):
                self.values[letter] = number
        if places:
            self.moves.go(places)


class Writer:
    def __init__(self, seed):
        self.draw, self.labels = random.Random(seed), 0

    def pick(self, *choices):
        return self.draw.choice(choices)

    def variable(self):
        return self.pick("V1", "V2", "V3", "V4", "R5", "R6", "R7")

    def value(self, depth=0):
        kind = self.draw.random()
        if depth > 2 or kind < 0.3:
            return self.pick("2.", "0.5", "3.", "10.", "0.25", "1.5", "0.")
        if kind < 0.6:
            return self.variable()
        if kind < 0.85:
            operator = self.pick("+", "-", "*", "/", "+", "-")
            right = self.pick("2.", "4.", "0.5") if operator == "/" else self.value(depth + 1)
            return f"({self.value(depth + 1)}{operator}{right})"
        name = self.pick("ABS", "INT", "SGN", "SIN", "COS", "ATN", "SQR", "RND", "INT")
        return f"{name}({self.pick('', '-') if name != 'SQR' else ''}{self.value(depth + 1)})"

    def comparison(self):
        return f"{self.value(1)}{self.pick('=', '<>', '<', '>', '<=', '>=')}{self.value(2)}"

    def condition(self):
        both = f"({self.comparison()}) {self.pick('AND', 'OR')} ({self.comparison()})"
        return self.pick(self.comparison(), self.comparison(), both)

    def blocks(self, out, most, depth, subs):
        for _ in range(self.draw.randint(2, most)):
            kind = self.draw.random()
            if kind < 0.35:
                out.append(f"#{self.variable()}={self.value()}")
            elif kind < 0.45:
                out.append(f"#IF {self.condition()} THEN {self.variable()}={self.value(1)}")
            elif kind < 0.57:
                self.labels += 1
                label = f":BEHIND{self.labels}"
                out.append(f"#IF {self.condition()} THEN GOTO {label}")
                self.blocks(out, 3, depth, subs)
                out.append(f"#{label}")
            elif kind < 0.65 and depth < 2:
                self.labels += 1
                label, count = f":AGAIN{self.labels}", f"V{9 + depth + 3 * (not subs)}"
                out += [f"#{count}=0", f"#{label}", f"#{count}={count}+1."]
                self.blocks(out, 3, depth + 1, subs)
                out.append(f"#IF {count}<{self.pick('2.', '3.')} THEN GOTO {label}")
            elif kind < 0.73 and subs:
                out.append(self.pick("L101", "L102", "L201"))
            elif kind < 0.8:
                out.append(self.pick("R5+1.5", "R6-2.", "R7+R5", "R5-R6"))
            else:
                axes = self.draw.sample("XYZ", self.draw.randint(1, 3))
                words = [axis + self.pick("1.5", "-3.", "+R5", "-R6", "+R7") for axis in axes]
                code = self.pick("G0 ", "G1 ", "G90 G0 ", "G91 G1 ", "", "G90 ")
                out.append(code + " ".join(words))

    def lines(self):
        lines = []
        for number in (1, 2):
            lines.append(f"L{number}00")
            self.blocks(lines, 5, 1, False)
        start = len(lines) + 2
        lines += ["M17", "M30", "G90 G0 X0 Y0 Z0", "G1 F100.", "#SET RND2"]
        lines += [f"#{name}={self.pick('2.', '-1.5', '0.25', '7.')}" for name in ("V1", "V2", "V3", "V4", "R5", "R6", "R7")]
        self.blocks(lines, 14, 0, True)
        return lines + ["M2"], start


def run(_, seed):
    """The text of a program, its moves, its variables, and whether it ends by an alarm."""
    lines, start = Writer(seed).lines()
    machine, alarm = Machine(lines), False
    try:
        machine.run(start)
    except Alarm:
        alarm = True
    text = "N1 O1\n" + "".join(f"N{at + 2} {line}\n" for at, line in enumerate(lines))
    return text, machine.moves.list, dict(sorted(machine.values.items())), alarm
