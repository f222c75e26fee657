"""Corners and angles of lathes, as drawings give them: docs/lathe.md, rows Q2, Q3 and R9.

A corner is geometry: a chamfer takes its size of each of its two lines, a round touches both. An angle counts from Z+
toward X+ (C6), so 180 goes toward the chuck; where such a line ends is not a word, and is not rounded. Programs are in
programs/fanuc/dimensions-*.nc and programs/haas/dimensions-*.nc.
"""

from motion import cos, sin, tan
from turning import INSIDE, Lathe, leg

NO_COMMA = "[parameters]\n3405.4 = 1"


class Drawn(Lathe):
    folder = "expected-live"

    def __init__(self, control, name, about, **more):
        super().__init__(control, f"dimensions-{name}", about, **more)

    def angle(self, degrees, *, x=None, z=None, f=None):
        """A line at this angle to a diameter or to a Z."""
        at = self.here()
        if x is None:
            x = at[0] + 2.0 * (z - at[2]) * tan(degrees)
        else:
            z = at[2] + (x - at[0]) / 2.0 / tan(degrees)
        self.cut(x, z, f)


# ---------------------------------------------------------------------------------------------------------------------
# Corners: a fillet of 3 to the face at Z-15., a chamfer of 2 to 40, a round of 1.5 before a cone.


def cornered(part, first="round"):
    part.go(20.0, 2.0)
    part.cut(z=-12.0, f=0.2)
    if first == "round":
        part.round(26.0, -15.0, (26.0, -12.0), -1)
    else:
        part.cut(26.0, -15.0)
    part.cut(x=36.0)
    part.cut(40.0, -17.0)


def coned(part):
    # From 180 degrees to 135: the round begins this far before the corner at Z-30.
    before = 1.5 * tan(22.5)
    part.cut(z=-30.0 + before)
    part.round(40.0 + 2.0 * before * sin(45), -30.0 - before * cos(45), (43.0, -30.0 + before), -1)
    part.cut(50.0, -35.0)
    part.cut(z=-45.0)
    part.go(x=60.0)


CORNERS = "A fillet of 3, a chamfer of 2 and a round of 1.5 before a cone: "
for control, name, how, settings in (
    ("fanuc", "comma", "by ,R and ,C.", ""),
    ("fanuc", "letters", "by R and C without a comma, as parameter 3405.4 (CCR) says; C is no axis.", NO_COMMA),
    ("haas", "comma", "by ,R and ,C.", ""),
):
    part = Drawn(control, name, CORNERS + how, settings=settings)
    cornered(part)
    coned(part)

part = Drawn("fanuc", "signs", "Chamfers of 3 and 2 by I and K: I is a radius, its sign that of the next move in X, K's that "
                               "of the next move in Z.")
cornered(part, "chamfer")
part.cut(z=-30.0)
part.go(x=60.0)

# ---------------------------------------------------------------------------------------------------------------------
# Angles.


def angled(part):
    part.go(20.0, 0.0)
    # 10 up (radius) at 135 degrees: 10 along.
    part.cut(40.0, -10.0, 0.2)
    part.cut(z=-20.0)
    part.cut(x=50.0)
    # 10 along at 150 degrees.
    part.angle(150.0, z=-30.0)
    # Straight on until a line at 120 degrees that ends at 80, Z-50.
    up = (80.0 - part.here()[0]) / 2.0
    part.cut(z=-50.0 - up / tan(120.0))
    part.cut(80.0, -50.0)
    # A chamfer of 1 between two lines given by angles.
    part.cut(90.0 - 2.0 * sin(45), -55.0 + cos(45))
    part.cut(90.0, -56.0)
    part.cut(z=-60.0)
    part.go(x=100.0)


for name, how, settings in (("angles", ",A", ""), ("angles-letters", "A without a comma (parameter 3405.4)", NO_COMMA)):
    angled(Drawn("fanuc", name,
                 f"Lines by {how}: 135 degrees to a diameter, 180 to a Z, 90 to a diameter, 150 to a Z; a line of 180 "
                 "whose end the next block gives (120 degrees to X80. Z-50.); 135 with a chamfer of 1 after it.",
                 settings=settings))

# ---------------------------------------------------------------------------------------------------------------------
# A profile with letters: geometry, while roughing and finishing.
part = Drawn("fanuc", "profile",
             "G71 and G70 over a profile with R3. between 20 and the face at Z-15 (from Z-12 to X26.), C2. at 40 (X36. to "
             "Z-17.) and a line of 135 degrees from Z-25. to 50, without commas. By 3 from 54 with .4 and .1 left; the "
             "level of 24 meets the fillet 1 under its middle, those of 48 and 42 the cone 4 and 1 up.",
             settings=NO_COMMA)
part.go(54.0, 2.0)
part.set_feed(0.2)
part.go(54.4, 2.1)
part.along([(48.4, -28.9), (42.4, -25.9), (36.4, -14.9), (30.4, -14.9), (24.4, -12.0 - leg(3.0, 1.0) + 0.1)],
           level=2.1, e=0.5)
part.go(x=20.4)
for u, w, f in ((0.4, 0.1, None), (0.0, 0.0, 0.1)):
    part.cut(z=-12.0 + w, f=f)
    part.round(26.0 + u, -15.0 + w, (26.0 + u, -12.0 + w), -1)
    part.cut(x=36.0 + u)
    part.cut(40.0 + u, -17.0 + w)
    part.cut(z=-25.0 + w)
    part.cut(50.0 + u, -30.0 + w)
    part.cut(x=54.0 + u)
    part.go(54.0, 2.0)
    if u:
        part.go(x=20.0)

# ---------------------------------------------------------------------------------------------------------------------
# A bore: 60 to Z-10, a cone of 240 degrees by its angle alone to 30, rounds of 2 and 1.5 at its ends. The cone goes 15
# in, so its end lies 15 / tan(60) after its beginning.

MEETS = -10.0 - 15.0 / tan(60)
part = Drawn("fanuc", "bore",
             "G71 and G70 over a bore: 60 to Z-10, R2., a line of 240 degrees alone, R1.5, and 30 to Z-40 by X, Z and 180 "
             "degrees. By 3 from 20 with .4 and .1 left; all levels but the first end on the cone.")
part.go(20.0, 2.0)
part.set_feed(0.2)
part.go(19.6, 2.1)
on_cone = [(x, MEETS + 0.1 + (x / 2.0 - 14.8) / tan(60)) for x in (31.6, 37.6, 43.6, 49.6, 55.6)]
part.along([(25.6, -39.9), *on_cone], level=2.1, e=0.5, side=INSIDE)
part.go(x=59.6)
# The lines turn by 60 degrees at both corners.
wide, narrow = 2.0 * tan(30), 1.5 * tan(30)
for u, w, f in ((-0.4, 0.1, None), (0.0, 0.0, 0.1)):
    part.cut(z=-10.0 + wide + w, f=f)
    part.round(60.0 - 2.0 * wide * sin(60) + u, -10.0 - wide * cos(60) + w, (56.0 + u, -10.0 + wide + w), 1)
    part.cut(30.0 + 2.0 * narrow * sin(60) + u, MEETS + narrow * cos(60) + w)
    part.round(30.0 + u, MEETS - narrow + w, (33.0 + u, MEETS - narrow + w), -1)
    part.cut(z=-40.0 + w)
    part.cut(x=20.0 + u)
    part.go(20.0, 2.0)
    if u:
        part.go(x=60.0)

# ---------------------------------------------------------------------------------------------------------------------
# A face: in to 50, a line of 210 degrees alone to the face at Z-8, in to 10, and down a hole, with chamfers of 1.5, 1
# and 2 between. The line goes 8 along, so 8 * tan(30) in.


def faced(part):
    part.go(64.0, 0.0)
    part.cut(x=53.0, f=0.15)
    part.cut(50.0 - 2.0 * 1.5 * sin(30), -1.5 * cos(30))
    meets = 50.0 - 2.0 * 8.0 * tan(30)
    part.cut(meets + 2.0 * sin(30), -8.0 + cos(30))
    part.cut(meets - 2.0, -8.0)
    part.cut(x=14.0)
    part.cut(10.0, -10.0)
    part.cut(z=-20.0)
    part.go(x=8.0)
    part.go(z=2.0)


FACE = ("A face: in to 50, a line of 210 degrees alone, in along Z-8 to 10 by X, Z and 270 degrees, and to Z-20, with "
        "chamfers of 1.5, 1 and 2 between.")
for control in ("fanuc", "haas"):
    faced(Drawn(control, "face", FACE))
