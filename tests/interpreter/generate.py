"""Writes a file a control: programs by seed, and what the interpreters make of them. See README.md."""

import os

import cc100
import fadal
import macro_b
from common import Edge

PROGRAMS = 120
# What a program must do at the least to be kept, and at the most.
MOVES, VALUES, MOST = 3, 3, 40


def case(module, dialect, seed):
    """The text of a case; none where a program does too little, or what no manual decides."""
    try:
        text, moves, values, alarm = module.run(dialect, seed)
    except Edge:
        return None
    if not MOVES <= len(moves) <= MOST or len(values) < VALUES:
        return None
    moves = "".join(kind + "".join(f" {axis:.9g}" for axis in place) + "\n" for kind, place in moves)
    values = ", ".join(f"{key(name)} = {value:.9g}" for name, value in values.items())
    return f"""[[case]]
name = "seed {seed}"
from = "{dialect}"
ends = "{'alarm' if alarm else 'ended'}"
source = '''
{text}'''
moves = '''
{moves}'''
variables = {{ {values} }}
"""


def key(name):
    """A variable as a key of TOML."""
    return name if name.isalnum() else f'"{name}"'


here = os.path.dirname(os.path.abspath(__file__))
for module, dialect in [(macro_b, "fanuc"), (macro_b, "haas"), (fadal, "fadal"), (cc100, "cc100")]:
    cases, seed = [], 0
    while len(cases) < PROGRAMS:
        seed += 1
        cases += [text for text in [case(module, dialect, seed)] if text]
    with open(os.path.join(here, f"{dialect}.toml"), "w", encoding="utf-8", newline="\n") as file:
        file.write("\n".join(cases))
    alarms = sum('ends = "alarm"' in text for text in cases)
    print(f"{dialect}: {len(cases)} programs of {seed}, {alarms} with an alarm")
