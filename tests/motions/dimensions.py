"""Corners and angles of lathes, as drawings give them: docs/lathe.md, rows Q2, Q3 and R9.

Outside a profile a corner is an event after the move to the corner's own point (Q2), so the list has that point and a
line for the corner. In a profile corners are geometry (R9). An angle counts from Z+ toward X+ (C6), so 180 goes toward
the chuck; where such a line ends is not a word, and is not rounded. Programs are in programs/fanuc/dimensions-*.nc and
programs/haas/dimensions-*.nc.
"""

from motion import number, tan
from turning import Lathe, leg

NO_COMMA = "[parameters]\n3405.4 = 1"


class Drawn(Lathe):
    folder, says = "expected-live", "corners = true\n"

    def __init__(self, control, name, about, **more):
        super().__init__(control, f"dimensions-{name}", about, **more)

    def corner(self, kind, size):
        """The corner after the last move: round, its radius; chamfer, how much of each line it takes."""
        self.lines.append(f"corner {number(size * self.unit)} {kind}")

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
    part.cut(z=-15.0, f=0.2)
    part.corner(first, 3.0)
    part.cut(x=40.0)
    part.corner("chamfer", 2.0)
    part.cut(z=-30.0)


def coned(part):
    part.corner("round", 1.5)
    part.cut(50.0, -35.0)
    part.cut(z=-45.0)
    part.go(x=60.0)


CORNERS = "A fillet of 3, a chamfer of 2 and a round of 1.5 before a cone, each after the move to its corner: "
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
    part.cut(90.0, -55.0)
    part.corner("chamfer", 1.0)
    part.cut(z=-60.0)
    part.go(x=100.0)


for name, how, settings in (("angles", ",A", ""), ("angles-letters", "A without a comma (parameter 3405.4)", NO_COMMA)):
    angled(Drawn("fanuc", name,
                 f"Lines by {how}: 135 degrees to a diameter, 180 to a Z, 90 to a diameter, 150 to a Z; a line of 180 "
                 "whose end the next block gives (120 degrees to X80. Z-50.); 135 with a chamfer of 1 after it.",
                 settings=settings))

# ---------------------------------------------------------------------------------------------------------------------
# A profile with letters: geometry, while roughing and finishing.

class Profile(Drawn):
    says = ""


part = Profile("fanuc", "profile",
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
