"""Writes expected/, expected-lathe/ and expected-live/: see README.md."""

import os

import cc100  # noqa: F401  each module fills motion.ALL
import dimensions  # noqa: F401
import faces  # noqa: F401
import fadal  # noqa: F401
import fanuc  # noqa: F401
import haas  # noqa: F401
import lathe  # noqa: F401
import legalized  # noqa: F401
import live  # noqa: F401
from motion import ALL

for motion in ALL:
    os.makedirs(os.path.dirname(motion.path()), exist_ok=True)
    with open(motion.path(), "w", encoding="utf-8", newline="\n") as file:
        file.write(motion.text())
print(f"{len(ALL)} programs, {sum(len(motion.lines) for motion in ALL)} moves")
