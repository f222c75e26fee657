"""Milling with the C axis on the face and on the side of a part: docs/lathe.md, rows V1 to V8.

On the face the part is a drawing in x and y about the centre of the spindle, x a radius; on the side it is the unrolled side, y round
the part and z along it. In the list X is a diameter, Y the length y, and C stays where it stood; after the milling C is where the tool
stands as seen from the centre, counted on over whole turns. Programs are in programs/fanuc/face-*.nc and programs/haas/face-*.nc.
"""

import math

from live import Live
from motion import INCH, number


class Face(Live):
    """The drawing's x and y."""

    def __init__(self, control, name, about, **more):
        super().__init__(control, name, about, run=f"tests/motions/programs/{control}/{name}.nc", **more)
        self.name = name

    def at(self, x=None, y=None, z=None):
        at = self.place(None if x is None else 2.0 * x, y, z)
        at[3:] = [self.now[3]]
        return at

    def line(self, x=None, y=None, z=None, f=None):
        self._feed(self.at(x, y, z), f, None)

    def bend(self, x, y, centre, turn):
        """An arc about a centre; turn is +1 from x to y."""
        at, middle = self.at(x, y), self.at(*centre)
        angles, reaches = [], []
        for place in (self.now, at):
            along, across = (place[0] - middle[0]) / 2.0, place[1] - middle[1]
            angles.append(math.degrees(math.atan2(across, along)))
            reaches.append(math.hypot(across, along))
        assert abs(reaches[0] - reaches[1]) < 1e-9, (self.name, reaches)
        sweep = (angles[1] - angles[0]) * turn % 360.0 or 360.0
        self._write("arc", at, *map(number, middle), number(turn * sweep), number(self.speed), self.mode)
        self.now = at

    def leaves(self, x, c):
        """The milling ends at this diameter, C having turned so far; no move comes of it."""
        self.now = self.place(x, 0.0)
        self.now[3:] = [float(c)]


class Side(Face):
    """The unrolled side of a radius: degrees of C are lengths round it."""

    radius = 0.0

    def round(self, degrees):
        return math.radians(degrees) * self.radius

    def groove(self, z=None, c=None, f=None):
        self.line(None, None if c is None else self.round(c), z, f)

    def bent(self, z, c, radius, turn):
        """The arc of less than half a turn; turn is +1 from y to z."""
        y0, z0 = self.now[1], self.now[2] - self.shift[2]
        y1 = self.round(c)
        dy, dz = y1 - y0, z - z0
        chord = math.hypot(dy, dz)
        height = math.sqrt(radius * radius - chord * chord / 4.0)
        # Left of the way where it turns from y to z.
        middle = ((y0 + y1) / 2.0 - turn * height * dz / chord, (z0 + z) / 2.0 + turn * height * dy / chord)
        sweep = 2.0 * math.degrees(math.asin(chord / 2.0 / radius))
        at, centre = self.at(None, y1, z), self.at(None, middle[0], middle[1])
        self._write("arc", at, *map(number, centre), number(turn * sweep), number(self.speed), self.mode)
        self.now = at


# ---------------------------------------------------------------------------------------------------------------------
# The face.

part = Face("fanuc", "face-square",
            "A square of 40 with corners of 5, from the right side at the height of the centre, counter-clockwise at 3 deep: "
            "two corners by R, two by I and J. X words are diameters, C words lengths (V1). C has turned once (V5).")
part.turn(0, 80.0, 2.0)
part.rapid(z=-3.0)
part.line(20.0, f=300.0)
part.line(y=15.0)
part.bend(15.0, 20.0, (15.0, 15.0), 1)
part.line(-15.0)
part.bend(-20.0, 15.0, (-15.0, 15.0), 1)
part.line(y=-15.0)
part.bend(-15.0, -20.0, (-15.0, -15.0), 1)
part.line(15.0)
part.bend(20.0, -15.0, (15.0, -15.0), 1)
part.line(y=0.0)
part.line(40.0)
part.leaves(80.0, 360.0)
part.rapid(z=20.0)
part.turn(0, 100.0)

part = Face("fanuc", "face-inch-b",
            "In inches and system B: 1 off the centre, up by .5 in increments, to the left by .5 (an increment of a diameter is "
            "1.) and up by .25, over the middle, down to the left side, and back under the middle. C has turned once.",
            unit=INCH, settings='[settings]\ngcode_system = "B"')
part.turn(0, 3.0, 0.1)
part.line(1.0, f=10.0)
part.line(y=0.5)
part.line(0.5, 0.75)
part.line(0.0)
part.line(-1.0, 0.0)
part.line(y=-0.5)
part.line(1.0)
part.line(y=0.0)
part.line(1.5)
part.leaves(3.0, 360.0)
part.rapid(z=1.0)

part = Face("fanuc", "face-half",
            "From C30. half round and no further: the plane lies at C30. (V2). The tool ends 15 to the left, where X is 30 and C "
            "has turned by 180; then from there, clockwise over the upper half, back.")
part.turn(30, 60.0, 1.0)
part.line(15.0, f=200.0)
part.bend(-15.0, 0.0, (0.0, 0.0), 1)
part.leaves(30.0, 210.0)
part.rapid(z=5.0)
part.rapid(z=1.0)
part.bend(-15.0, 0.0, (0.0, 0.0), -1)
part.leaves(30.0, 30.0)
part.rapid(z=5.0)

part = Face("haas", "face-obround",
            "Two half rounds of 10 about x -12 and 12 and the lines between, at 4 deep, counter-clockwise; then, from where that "
            "ends, a whole circle of 22 clockwise: C turns once and back. X words are radii, Y words lengths (V1).")
part.turn(0, 70.0, 2.0)
part.line(z=-4.0, f=120.0)
part.line(22.0, f=250.0)
part.bend(12.0, 10.0, (12.0, 0.0), 1)
part.line(-12.0)
part.bend(-12.0, -10.0, (-12.0, 0.0), 1)
part.line(12.0)
part.bend(22.0, 0.0, (12.0, 0.0), 1)
part.bend(22.0, 0.0, (0.0, 0.0), -1)
part.line(35.0)
part.line(z=2.0)
part.leaves(70.0, 0.0)
part.turn(x=90.0, z=20.0)

# ---------------------------------------------------------------------------------------------------------------------
# The side.

part = Side("fanuc", "face-groove",
            "A groove in a side of radius 57.296, 2 deep: along Z, a bend of 5 to C5., round to C40., a bend of 5, along Z, and "
            "back by H-45. G18: from Z to C is counter-clockwise (V8). Then, from there, the same bend under G19, where from C to "
            "Z is. Feed is along the side (V7).")
part.radius = 57.296
part.turn(0, 120.0, -10.0)
part.feed(110.592, f=80.0)
part.groove(z=-20.0, f=200.0)
part.bent(-25.0, 5.0, 5.0, 1)
part.groove(c=40.0)
part.bent(-30.0, 45.0, 5.0, -1)
part.groove(z=-40.0)
part.groove(c=0.0)
part.leaves(110.592, 0.0)
part.rapid(120.0)
part.turn(10)
part.feed(110.592, f=80.0)
# C stands at 10 while the side is milled: so much round it.
part.now[1] = part.round(10.0)
part.bent(-45.0, 15.0, 5.0, 1)
part.groove(c=20.0)
part.leaves(110.592, 20.0)
part.rapid(120.0)
