"""Writes fanuc.txt and haas.txt: programs by seed, and what `interpreter.py` makes of them. See README.md."""

import os
import random

from interpreter import Alarm, Edge, Machine

PROGRAMS = 120
# What a program must do at the least to be kept.
MOVES, SETS = 3, 3
# The Haas' remainder and arc tangent are not stated (facts/haas.md 2).
SPOKEN = {"fanuc": (["+", "-", "*", "/", "MOD"], ["ATAN"]), "haas": (["+", "-", "*", "/"], [])}


class Writer:
    """Draws the blocks of a program and of one that it calls."""

    def __init__(self, dialect, seed):
        self.draw, self.labels = random.Random(seed), 0
        self.operators, more = SPOKEN[dialect]
        self.functions = ["SIN", "COS", "SQRT", "ABS", "ROUND", "FIX"] + more

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


def case(dialect, seed):
    """The text of a case; none where a program does too little, or hangs on last digits."""
    programs = Writer(dialect, seed).programs()
    machine, end = Machine(programs), "ended"
    try:
        machine.run(1)
    except Alarm:
        end = "alarm"
    except Edge:
        return None
    places = [(0.0, 0.0, 0.0)] + [place for _, place in machine.moves]
    moves = []
    for before, (kind, place) in zip(places, machine.moves):
        # A move that goes nowhere is left out.
        if max(abs(a - b) for a, b in zip(before, place)) > 1e-6:
            moves.append(kind + "".join(f" {axis:.9g}" for axis in place))
    values = [f"#{n} {value:.9g}" for n, value in sorted(machine.common.items()) if value is not None and n != 110]
    if len(moves) < MOVES or len(values) < SETS or len(moves) > 40:
        return None
    text = "".join(f"O{number}\n" + "".join(line + "\n" for line in lines) for number, lines in programs.items())
    return f"== {seed}: {end}\n{text}--\n" + "".join(line + "\n" for line in moves + values)


here = os.path.dirname(os.path.abspath(__file__))
for dialect in SPOKEN:
    cases, seed = [], 0
    while len(cases) < PROGRAMS:
        seed += 1
        cases += [text for text in [case(dialect, seed)] if text]
    with open(os.path.join(here, f"{dialect}.txt"), "w", encoding="utf-8", newline="\n") as file:
        file.write("\n".join(cases))
    print(f"{dialect}: {len(cases)} programs of {seed}, {sum(': alarm' in text for text in cases)} with an alarm")
