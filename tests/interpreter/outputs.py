"""Runs what macroglot writes for a Fadal and a CC 100, by the manuals' rules, beside `macroglot run`.

    python3 tests/interpreter/outputs.py target/quick/macroglot

Converts the libraries of macroglot.toml, runs each file that was written from several start values, and compares
moves, how the run ends and the variables that are left. Whole programs: calls, fixtures and zero shifts, machine
coordinates, arcs (their ends), tables. What no manual decides, and drilling cycles, is left out and counted. Knows nothing
of src/. Python 3.11, no packages.
"""

import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import tomllib

from cc100 import BRANCH
from common import Edge

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
STEPS = 60_000
DRAWS = 4
NEAR = 1e-6


class Ended(Exception):
    """The program ends."""


class Alarm(Exception):
    """The control stops with an alarm."""


class LeftOut(Exception):
    """Something that this interpreter does not know."""


class Tool:
    """Where the tool is, in millimetres of the machine, and what counts in its coordinates."""

    def __init__(self, scale):
        self.scale, self.place, self.absolute, self.motion = scale, [0.0] * 3, True, None
        self.offsets, self.offset, self.moves = {}, None, []

    def code(self, number):
        if number in (0, 1, 2, 3):
            self.motion = number
        elif number in (90, 91):
            self.absolute = number == 90

    def shift(self, axis):
        return self.offsets.get((self.offset, axis), 0.0)

    def go(self, words, machine=False, radius=None):
        if not words:
            return
        if self.motion is None:
            raise Edge
        before = list(self.place)
        for letter, value in words.items():
            axis = "XYZ".index(letter)
            to = value * self.scale
            if machine:
                self.place[axis] = to
            elif self.absolute:
                self.place[axis] = to + self.shift(letter) * self.scale
            else:
                self.place[axis] += to
        chord = math.dist(before[:2], self.place[:2])
        if self.motion in (2, 3) and radius is not None and chord > 2 * abs(radius) * self.scale + 0.05:
            self.place = before
            raise Alarm
        moved = max(abs(a - b) for a, b in zip(before, self.place)) > 1e-6
        if moved:
            self.moves.append((("rapid", "feed", "arc", "arc")[self.motion], tuple(self.place)))


class Control:
    def __init__(self, values, scale):
        self.values, self.tool, self.steps, self.known = dict(values), Tool(scale), 0, set(values)

    def step(self):
        self.steps += 1
        if self.steps > STEPS:
            raise LeftOut("very many blocks, or an alarm that nothing gets past")

    def read(self, name):
        # What an earlier run left is not known: a start value that was not given is asked for.
        if name not in self.values:
            raise KeyError(name)
        return self.values[name]


# The CC 100.


class Cc100(Control):
    """One file: its own labels, no calls of others."""

    def __init__(self, text, values, scale, inch):
        super().__init__(values, scale)
        lines = [re.sub(r"^N\d+ ?", "", line).strip() for line in text.splitlines()]
        self.lines = [re.sub(r"\(.*", "", line).strip() for line in lines]
        self.labels = {line: at for at, line in enumerate(self.lines) if line.startswith("$")}
        self.register, self.inch, self.tool.motion = None, inch, None

    def run(self, at=0):
        while at < len(self.lines):
            self.step()
            line, at = self.lines[at], at + 1
            if not line or line.startswith("$"):
                continue
            if line == "M30":
                raise Ended
            if line == "G99":
                return
            if call := re.fullmatch(r"G22 P(\d+)(?: L(\d+))?", line):
                for _ in range(1 + int(call[2] or 0)):
                    self.run(self.labels[f"${call[1]}"] + 1)
            elif jump := re.fullmatch(r"G24 P(\d+)", line):
                at = self.labels[f"${jump[1]}"]
            elif branch := re.fullmatch(r"(B..) P(\d+)", line):
                if self.register is None:
                    raise Edge
                if BRANCH[branch[1]](self.register):
                    at = self.labels[f"${branch[2]}"]
            else:
                self.block(line)

    def value(self, text):
        return self.read(text) if text.startswith("V") else float(text)

    def put(self, name, value, register=None):
        self.values[name], self.register = value, register

    def block(self, line):
        name = r"V(?:\d+|[A-Z])"
        if line == "TST QM":
            # It is set with metric dimensions (seed 004:1664).
            self.register = 0.0 if not self.inch else 1.0
        elif test := re.fullmatch(rf"TST ({name})", line):
            self.register = self.value(test[1])
        elif count := re.fullmatch(rf"(INC|DEC) ({name})", line):
            before = self.value(count[2])
            if before < 0 and before != math.trunc(before):
                raise Edge
            after = math.trunc(before) + (1 if count[1] == "INC" else -1)
            self.put(count[2], float(after), float(after))
        elif two := re.fullmatch(rf"({name})=({name}) ?([-+*/]) ?(-?{name}|-?[\d.]+)", line):
            a, b = self.value(two[2]), self.value(two[4])
            if two[3] == "/" and b == 0:
                raise Alarm
            result = {"+": a + b, "-": a - b, "*": a * b, "/": b and a / b}[two[3]]
            self.put(two[1], result, result)
        elif of := re.fullmatch(rf"({name})=(SQR|SIN|COS|ATN) ({name})", line):
            x = self.value(of[3])
            if of[2] == "SQR" and x < 0:
                raise Alarm
            if of[2] in ("SIN", "COS") and abs(x) > 360:
                raise Edge
            result = {"SQR": lambda: math.sqrt(x), "SIN": lambda: math.sin(math.radians(x)),
                      "COS": lambda: math.cos(math.radians(x)), "ATN": lambda: math.degrees(math.atan(x))}[of[2]]()
            self.put(of[1], result)
        elif re.fullmatch(rf"({name}=(-?[\d.]+|{name}) ?)+", line):
            # Loads may share a block (seed 004:603).
            for load in re.findall(rf"({name})=(-?[\d.]+|{name})", line):
                self.put(load[0], self.value(load[1]))
        elif table := re.fullmatch(r"TRF=G(5[4-9]) (.*)", line):
            for part in table[2].split():
                left, right = part.split("=")
                if left in "XYZ":
                    self.tool.offsets[(table[1], left)] = self.value(right)
                else:
                    self.put(left, self.tool.offsets.get((table[1], right), 0.0))
        elif re.match(r"(COR|TIM|TRF|DAT)\b|G8[0-9]\d|V\w+=[T-Z]$", line):
            raise LeftOut(line)
        else:
            self.words(line)

    def words(self, line):
        places, radius = {}, None
        for letter, value in re.findall(r"([A-Z])=?(-?V\d+|-?[\d.]+)", line):
            number = self.value(value)
            if letter == "G":
                if number == 53:
                    self.tool.offset = None
                elif 54 <= number <= 59:
                    self.tool.offset = str(int(number))
                elif number in (20, 92, 93) or number > 80 and number not in (90, 91):
                    raise LeftOut(f"G{value}")
                else:
                    self.tool.code(int(number))
            elif letter in "XYZ":
                places[letter] = number
            elif letter == "R":
                radius = number
        self.tool.go(places, radius=radius)


# The Fadal.

RELATION = {"EQ": "==", "NE": "!=", "LT": "<", "LE": "<=", "GT": ">", "GE": ">=", "AND": "and", "OR": "or",
            "=": "==", "<>": "!="}


def root(x):
    if x < 0:
        raise Alarm
    return math.sqrt(x)


class Fadal(Control):
    """All programs of the folder, called by number; the first one of the file runs."""

    def __init__(self, programs, values, scale, _):
        super().__init__(values, scale)
        self.programs = programs
        self.functions = {
            "ABS": abs, "INT": lambda x: float(math.trunc(x)), "SGN": lambda x: -1.0 if x < 0 else 1.0,
            "SIN": lambda x: math.sin(math.radians(x)), "COS": lambda x: math.cos(math.radians(x)),
            "ATN": lambda x: math.degrees(math.atan(x)), "SQR": root,
        }

    def evaluate(self, text):
        names = dict(self.functions)
        names["__builtins__"] = {}

        def variable(found):
            word = found[0]
            if word in self.functions:
                return word
            if word in RELATION:
                return f" {RELATION[word]} "
            if re.fullmatch(r"[VR]\d+", word):
                names[word] = self.read(word)
                return word
            if re.fullmatch(r"F[XYZ]\d+", word):
                names[word] = self.tool.offsets.get((int(word[2:]), word[1]), 0.0)
                return word
            raise LeftOut(text)

        text = re.sub(r"[A-Z]+\d*|<>|(?<![<>])=", variable, text)
        try:
            return eval(text, names)  # numbers, operators and the names above alone
        except ZeroDivisionError:
            raise Alarm from None
        except TypeError:
            raise LeftOut(text) from None

    def run(self, number, depth=0):
        if number not in self.programs:
            raise LeftOut(f"O{number} is not there")
        if depth > 20:
            raise LeftOut("calls in calls")
        lines = self.programs[number]
        labels = {line[2:]: at for at, line in enumerate(lines) if line.startswith("#:")}
        at = 0
        while at < len(lines):
            self.step()
            line, at = lines[at], at + 1
            if line.startswith("#"):
                to = self.macro(line[1:])
                if to is not None:
                    at = labels[to]
            elif re.match(r"L\d", line) or re.search(r"\bG66\b|\bG68\b|\bG92\b|\bG52\b|\bG28\b|\bG31\b", line):
                raise LeftOut(line)
            elif call := re.fullmatch(r"M98 P(\d+)(?: L(\d+))?", line):
                for _ in range(int(call[2] or 1)):
                    self.run(int(call[1]), depth + 1)
            elif line == "M99":
                return
            elif re.fullmatch(r"M(2|30)", line):
                raise Ended
            elif line:
                self.words(line)

    def macro(self, text):
        """The label that it jumps to, if it does."""
        if text.startswith(":") or re.match(r"SET DEGREES|WAIT|S?PRINT", text):
            return None
        if text.startswith("IF "):
            condition, text = text[3:].split(" THEN ")
            if not self.evaluate(condition):
                return None
        if text.startswith("GOTO "):
            return text[5:].strip().lstrip(":")
        place, value = text.split("=", 1)
        if table := re.fullmatch(r"F([XYZ])(\d+)", place):
            self.tool.offsets[(int(table[2]), table[1])] = self.evaluate(value)
        elif re.fullmatch(r"O\(\d+\)", place):
            self.evaluate(value)  # an output, which moves nothing
        elif re.fullmatch(r"[VR]\d+", place):
            self.values[place] = float(self.evaluate(value))
        else:
            raise LeftOut(text)
        return None

    def words(self, line):
        places, machine, radius = {}, "G53" in line.split(), None
        for letter, sign, value in re.findall(r"(R0|[A-Z])([-+]?)(R\d|[\d.]+)", line):
            number = self.read(value) if value.startswith("R") else float(value)
            number = -number if sign == "-" else number
            if letter == "G":
                if 73 <= number <= 76 or 81 <= number <= 89:
                    raise LeftOut("a drilling cycle")
                self.tool.code(int(number))
            elif letter == "E":
                self.tool.offset = int(number)
            elif letter in "XYZ":
                places[letter] = number
            elif letter == "R0":
                radius = number
        self.tool.go(places, machine, radius)


def fadal_programs(text):
    programs, number = {}, None
    for line in text.splitlines():
        line = re.sub(r"^N\d+ ?", "", line.strip())
        line = line.split("'")[0] if line.startswith("#") else line.split("(")[0]
        line = line.strip()
        if name := re.fullmatch(r"O(\d+)", line):
            number = int(name[1])
            programs[number] = []
        elif line != "%" and number is not None:
            programs[number].append(line)
    return programs


def mine(make, start, values):
    """What this interpreter makes of a run; start values are added until none is missing."""
    draw = random.Random(start)
    while True:
        control = make(values)
        try:
            try:
                control.run(control.first)
                end = "ended"
            except Ended:
                end = "ended"
            except Alarm:
                end = "alarm"
            return control, end
        except KeyError as missing:
            name = missing.args[0]
            if not re.fullmatch(r"[VR]\w+", str(name)):
                raise LeftOut(f"no label {name}") from None
            values[name] = draw.choice([0.0, 0.0, 1.0, 2.0, -1.5, 10.0, 4.25])


def theirs(binary, dialect, path, folder, profile, values, inch):
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as scenario:
        scenario.write(f"inch = {'true' if inch else 'false'}\n")
        scenario.flush()
        command = [binary, "run", path, "--dialect", dialect, "--trace", "json", "--library", folder,
                   "--scenario", scenario.name, "--steps", str(2 * STEPS)]
        command += ["--machine", profile] if profile else []
        for name, value in values.items():
            command += ["--set", f"{name}={value}"]
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
    moves, end, left, place = [], None, {}, (0.0, 0.0, 0.0)
    for line in done.stdout.splitlines():
        event = json.loads(line)
        kind = event["event"]
        if kind in ("rapid", "feed", "arc"):
            to = tuple(event["to"].get(axis, 0.0) for axis in "xyz")
            before = tuple(event["from"].get(axis, 0.0) for axis in "xyz")
            if max(abs(a - b) for a, b in zip(to, before)) > 1e-6:
                moves.append((kind, to))
        elif kind == "result":
            end, left = event["end"], event["variables"]
    if end is None:
        raise LeftOut(done.stderr.strip()[:80])
    return moves, end, left


def differs(control, end, other):
    moves, end_there, left = other
    if end != end_there:
        return f"ends by {end}, there by {end_there}"
    # How far a computed word is rounded is not stated: the moves lie within an increment.
    near = 1.1e-3 if control.tool.scale == 1.0 else 2.6e-3
    for at, (a, b) in enumerate(zip(control.tool.moves, moves)):
        if a[0] != b[0] or max(abs(x - y) for x, y in zip(a[1], b[1])) > near:
            return f"move {at}: {a}, there {b}"
    if len(control.tool.moves) != len(moves):
        return f"{len(control.tool.moves)} moves, there {len(moves)}"
    for name, value in control.values.items():
        there = left.get(name)
        if there is None or abs(value - there) > NEAR * max(1.0, abs(value)):
            return f"{name} is {value}, there {there}"
    return None


def main():
    binary = os.path.abspath(sys.argv[1])
    with open(os.path.join(ROOT, "macroglot.toml"), "rb") as file:
        project = tomllib.load(file)
    subprocess.run([binary, "convert", "--quiet"], cwd=ROOT, capture_output=True)
    found, counts, left_out = [], {}, {}
    for library in project["libraries"].values():
        for machine, folder in library["targets"].items():
            dialect = project["machines"][machine]["dialect"]
            if dialect not in ("fadal", "cc100"):
                continue
            folder = os.path.join(ROOT, folder)
            profile = project["machines"][machine].get("profile")
            names = sorted(name for name in os.listdir(folder) if name.endswith(".nc"))
            texts = {}
            for name in names:
                with open(os.path.join(folder, name), encoding="utf-8") as file:
                    texts[name] = file.read()
            every = {}
            for text in texts.values():
                every.update(fadal_programs(text) if dialect == "fadal" else {})
            for name, text in texts.items():
                inch = bool(re.search(r"\bG20\b|SET THE CONTROL TO INCH", text))
                for start in range(DRAWS):
                    values = {}

                    def make(values):
                        scale = 25.4 if inch else 1.0
                        if dialect == "fadal":
                            # Where two files have one number, a file's own program is meant.
                            own = fadal_programs(text)
                            control = Fadal({**every, **own}, values, scale, inch)
                            control.first = next(iter(own))
                        else:
                            control = Cc100(text, values, scale, inch)
                            control.first = 0
                        return control

                    key = (dialect, os.path.basename(folder))
                    try:
                        control, end = mine(make, start, values)
                        other = theirs(binary, dialect, os.path.join(folder, name), folder, profile, values, inch)
                    except (Edge, LeftOut) as why:
                        reason = str(why) or "what no manual decides"
                        left_out.setdefault(reason, set()).add(f"{key[1]}/{name}")
                        counts[key] = counts.get(key, [0, 0])
                        counts[key][1] += 1
                        continue
                    counts[key] = counts.get(key, [0, 0])
                    counts[key][0] += 1
                    wrong = differs(control, end, other)
                    if wrong:
                        found.append(f"{key[1]}/{name}, from {values}: {wrong}")
    for (_, folder), (compared, left) in sorted(counts.items()):
        print(f"{folder}: {compared} runs compared, {left} left out")
    for why, files in sorted(left_out.items()):
        print(f"left out, {why}: {len(files)} files, {sorted(files)[0]}")
    for wrong in found:
        print("DIFFERS", wrong)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
