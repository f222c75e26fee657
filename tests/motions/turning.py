"""Moves of a lathe: X is a diameter, in what a part says and in what is written; lengths and angles are real ones.

The order of a cycle's moves is that of docs/lathe.md, whose rows are named here. Where the moves go, the parts of
lathe.py say from their own sizes: nothing here cuts a contour or reads a word of a program.
"""

import math
import textwrap

from motion import INCH, Motion, number

OUTSIDE, INSIDE = 1, -1


class Lathe(Motion):
    """A part on a lathe; G54 lies 5 mm over the machine's X and 120 under its Z."""

    folder = "expected-lathe"

    def __init__(self, control, name, about, *, settings="", run=None, **more):
        more = {"start": (300.0, 0.0, 200.0), "home": (400.0, 0.0, 350.0), "offsets": {1: (5.0, 0.0, -120.0)}, **more}
        units = "inch" if more.get("unit", 1.0) == INCH else "metric"
        profile = f'machine = "lathe"\nunits = "{units}"\n{settings}'
        run = [run or f"tests/motions/programs/{control}/{name}.nc"]
        about = textwrap.fill(about, 116, break_on_hyphens=False)
        super().__init__(control, name, run, about, profile=profile, **more)
        self.mode = "per_turn"
        self.work(1)

    # Single moves.

    def go(self, x=None, z=None):
        self.rapid(x, None, z)

    def cut(self, x=None, z=None, f=None):
        self.feed(x, None, z, f)

    def thread(self, x=None, z=None, lead=None):
        at = self.place(x, None, z)
        self._write("thread", at, number(lead * self.unit))
        self.now = at

    def round(self, x, z, centre, turn, f=None):
        """An arc about a centre (diameter, Z); turn is +1 for G3, -1 for G2 (C6)."""
        if f is not None:
            self.set_feed(f)
        at, middle = self.place(x, None, z), self.place(centre[0], None, centre[1])
        angles, radii = [], []
        for point in (self.now, at):
            up, along = (point[0] - middle[0]) / 2.0, point[2] - middle[2]
            angles.append(math.degrees(math.atan2(up, along)))
            radii.append(math.hypot(up, along))
        assert abs(radii[0] - radii[1]) < 1e-9, (self.name, radii)
        sweep = turn * ((angles[1] - angles[0]) * turn % 360.0)
        self._write("arc", at, *map(number, middle), number(sweep), number(self.speed), self.mode)
        self.now = at

    def plunge(self, how, x=None, z=None):
        """The move to depth: as the first block of the profile has it."""
        (self.go if how == "rapid" else self.cut)(x, z)

    # Passes of roughing.

    def along(self, passes, *, level, e, side=OUTSIDE, away=1, how="rapid"):
        """K6: passes in Z that begin at Z level: their diameters and where they end; back by e at 45 degrees."""
        for x, z in passes:
            self.plunge(how, x=x)
            self.cut(z=z)
            self.go(x + 2 * e * side, z + e * away)
            self.go(z=level)

    def across(self, passes, *, level, e, side=OUTSIDE, away=1, how="rapid"):
        """L1: passes in X that begin at X level: their Z and where they end."""
        for z, x in passes:
            self.plunge(how, z=z)
            self.cut(x=x)
            self.go(x + 2 * e * side, z + e * away)
            self.go(x=level)

    def valley(self, passes, e, side=OUTSIDE):
        """W4, W5: passes down into a valley: diameter, where the pass begins and ends, the point to which the tool
        follows the flank, and the diameter of the level before."""
        for x, begin, end, flank, before in passes:
            self.go(z=begin)
            self.cut(x=x)
            self.cut(z=end)
            self.cut(*flank)
            self.go(x=before + 2 * e * side)

    # Single cycles.

    def turned(self, x, z, taper=0.0, f=None):
        """B3."""
        back = self.here()
        self.go(x=x + 2 * taper)
        self.cut(x, z, f)
        self.cut(x=back[0])
        self.go(z=back[2])

    def threaded(self, x, z, taper=0.0, lead=None):
        """B4."""
        back = self.here()
        self.go(x=x + 2 * taper)
        self.thread(x, z, lead)
        self.go(x=back[0])
        self.go(z=back[2])

    def faced(self, x, z, taper=0.0, f=None):
        """B5."""
        back = self.here()
        self.go(z=z + taper)
        self.cut(x, z, f)
        self.cut(z=back[2])
        self.go(x=back[0])

    # Pecks.

    def face_pecks(self, columns, depths, e, relief=0.0, f=None):
        """G3 to G6: columns are diameters, depths are Z; the relief is toward the column before."""
        self.columns(0, columns, depths, e, relief, f)

    def side_pecks(self, columns, depths, e, relief=0.0, f=None):
        """G10: columns are Z, depths are diameters."""
        self.columns(2, columns, depths, e, relief, f)

    def columns(self, axis, columns, depths, e, relief, f):
        if f is not None:
            self.set_feed(f)
        names, back = {0: "x", 2: "z"}, self.here()
        step, peck = names[axis], names[2 - axis]
        scale = {"x": 2.0, "z": 1.0}
        top = back[2 - axis]
        out = (1.0 if top > depths[-1] else -1.0) * e * scale[peck]
        for at, column in enumerate(columns):
            self.go(**{step: column})
            for depth in depths:
                self.cut(**{peck: depth})
                if depth != depths[-1]:
                    self.go(**{peck: depth + out})
            if at > 0 and relief:
                toward = 1.0 if columns[0] > columns[-1] else -1.0
                self.go(**{step: column + toward * relief * scale[step]})
            self.go(**{peck: top})
        self.go(**{step: columns[0]})

    # Threads in many passes.

    def screw(self, x, z, heights, *, height, lead, side=OUTSIDE, angle=0.0, taper=0.0, both=False):
        """P7, P8: a pass at each depth under the crest; x is the root at the thread's end.

        P6: both flanks in turn, the second pass along the other flank of the thread that is ready at full height.
        """
        back = self.here()
        way = 1.0 if z > back[2] else -1.0
        for at, depth in enumerate(heights):
            flank = math.tan(math.radians(angle / 2.0))
            begin = back[2] + way * depth * flank
            if both and at % 2 == 1:
                # The tip stands off the other flank by what is missing to the height, on the far side of the middle.
                begin = back[2] + way * (height * flank + (height - depth) * flank)
            end = x + 2.0 * side * (height - depth)
            self.go(end + 2.0 * taper * (z - begin) / (z - back[2]), begin)
            self.thread(end, z, lead)
            self.go(x=back[0])
            self.go(z=back[2])


def equal_chips(first, least, last):
    """P5: depths that take equal chips, until the step would be under the least one; the last is last."""
    depths = [min(first, last)]
    while depths[-1] < last - 1e-9:
        count = len(depths) + 1
        depths.append(min(max(first * math.sqrt(count), depths[-1] + least), last))
    return depths


def leg(radius, other):
    """The other leg of a right triangle under a radius."""
    return math.sqrt(radius * radius - other * other)
