"""Boards of the Wadkin course (seed 004): sizes from its tables and drawings, in mm.

Every board lies with its lower left corner at the datum that VX and VY name. The tool comes down beside
the corner, cuts round, goes up and the head parks. The tool in use adds its length to Z.
"""

from math import sqrt

from motion import Motion, cos, sin, tan

LENGTH = 80.0
CYCLE = "corpus/cc100/cycle20-auto-offset.nc"


class Board(Motion):
    def __init__(self, name, about, *, datum=(200.0, 200.0), library=(CYCLE,), **more):
        more = {"start": (500.0, 400.0, 60.0), "tools": {1: LENGTH}, **more}
        run = [f"corpus/cc100/{name}.nc", *library]
        super().__init__("cc100", name, run, about, **more)
        # The head goes up first, without a shift and without a tool.
        self.rapid(z=0.0)
        self.shift = (*datum, 0.0)
        self.tool(1)

    def down(self, depth, before=(-20.0, -20.0), at=(-10.0, 0.0), fast=6000.0):
        """Beside the board above the material, to the side of the first edge, down."""
        self.rapid(*before, 5.0)
        self.feed(*at, f=fast)
        self.feed(z=depth, f=1500.0)

    def up_and_park(self, beside=(-20.0, -20.0), park=(650.0, 800.0)):
        self.rapid(z=5.0)
        self.rapid(*beside)
        self.tool(0)
        self.shift = (0.0, 0.0, 0.0)
        self.rapid(*park, 0.0)

    def cut(self, *corners, f=4000.0):
        for x, y in corners:
            self.feed(x, y, f=f)


# Example 1: along the base by A, the top right corner at (C, B), back to the left edge (table at 71-73).
for number, (base, height, top) in enumerate([(50, 25, 40), (90, 30, 60), (45, 18, 32)], start=1):
    for name in (f"example1-comp{number}", f"example1-nc-comp{number}"):
        board = Board(name, f"Example 1, component {number}: {base} along, the corner at ({top}, {height}).")
        board.down(-10.0)
        board.cut((base, 0), (top, height), (0, height), (0, -10))
        board.up_and_park()

# Example 2: edges of 20 and 50, the base of 126.603, the slope of 100 at 30 degrees.
board = Board("example2", "Example 2: the corner R lies 100 sin 30 up, and sqrt(50^2 - (50 - 20)^2) from the left.")
board.down(-10.0)
up = 100 * sin(30)
board.cut((126.603, 0), (sqrt(50**2 - (up - 20) ** 2), up), (0, 20), (0, -10))
board.up_and_park()

# Example 4: 90 by 50 with quarter arcs of 15 at the right corners. The course writes a minus before the radius
# of every arc, and all its arcs are shorter than half a turn.
for name in ("example4-a", "example4-b"):
    board = Board(name, "Example 4: a board of 90 by 50, 15 thick, cut 1 mm deeper; G2 with R-15 is the quarter "
                        "arc,\nwhich for a clockwise turn lies about the corner of the board.")
    board.down(-16.0)
    board.cut((75, 0))
    board.arc(90, 15, (90, 0), -1)
    board.cut((90, 35))
    board.arc(75, 50, (90, 50), -1)
    board.cut((0, 50), (0, -10))
    board.up_and_park()

# Example 9: 100 by 70, 20 thick; 21 mm in three passes.
board = Board("example9", "Example 9: three passes of 7 mm round a board of 100 by 70 with an arc of 30.")
for depth in (-7.0, -14.0, -21.0):
    board.down(depth)
    board.cut((100, 0), (100, 40))
    board.arc(70, 70, (100, 70), -1)
    board.cut((0, 70), (0, -10))
    board.rapid(z=5.0)
    board.rapid(-20.0, -20.0)
board.up_and_park(park=(450.0, 600.0))

# Example 10: an ellipse of 300 by 180 in steps of 2 degrees, round its centre.
for name, out in (("example10-ellipse", 20.0), ("example10-ellipse-flex", 20.0)):
    board = Board(name, "Example 10: X = 150 cos a, Y = 90 sin a for a from 0 to 360 in steps of 2.\n"
                        "The loop runs while 360 - a >= 0, so the point at 360 is there too.", datum=(400.0, 300.0))
    board.down(-10.0, before=(170.0, -40.0), at=(150.0, -20.0))
    board.cut((150, 0))
    board.cut(*[(150 * cos(angle), 90 * sin(angle)) for angle in range(0, 362, 2)])
    board.cut((150, out))
    board.up_and_park(beside=(170.0, 40.0), park=(450.0, 600.0))

# Example 11: shoulders of radius 80 about (28, 540) and (272, 540), the crown of 163 about (150, 330). The arcs
# meet on the lines between the centres; the control gets ends and radii.
board = Board("example11-panel", "Example 11: the panel's arcs meet where the lines between their centres say;\n"
                                 "each is the arc shorter than half a turn through its two ends.")
board.down(-15.0, before=(-70.0, -20.0), at=(-50.0, 0.0))
board.cut((300, 0), (300, 460), (300 - 28, 460))
across, above = 300 / 2 - 28, 460 - 330 + 80
meet = (163 * across / (163 + 80), 330 + 163 * above / (163 + 80))
board.arc_of_radius(150 + meet[0], meet[1], 80, -1)
board.arc_of_radius(150 - meet[0], meet[1], 163, +1)
board.arc_of_radius(28, 460, 80, -1)
board.cut((0, 460), (0, -50))
board.up_and_park(beside=(-20.0, -70.0), park=(450.0, 600.0))

# Example 13: G54 holds X340 Y265.
board = Board("example13-zero-shift", "Example 13: beside the datum of G54, then home.", datum=(340.0, 265.0),
              library=(), offsets={1: (340.0, 265.0)})
board.rapid(-20.0, -20.0, 5.0)
board.tool(0)
board.shift = (0.0, 0.0, 0.0)
board.rapid(450.0, 600.0, 0.0)

# Problem 1: A by B.
for number, (a, b) in enumerate([(120, 40), (180, 80), (100, 50), (90, 60)], start=1):
    board = Board(f"problem1-comp{number}", f"Problem 1, component {number}: {a} by {b} (table at 145-148).")
    board.down(-10.0)
    board.cut((a, 0), (a, b), (0, b), (0, -10))
    board.up_and_park()

# Problem 2: base A, the top from C back to B at height D.
for number, (a, b, c, d) in enumerate([(100, 25, 75, 50), (200, 50, 150, 100), (300, 75, 225, 150)], start=1):
    board = Board(f"problem2-comp{number}", f"Problem 2, component {number}: base {a}, top from {c} to {b} at {d}.")
    board.down(-10.0)
    board.cut((a, 0), (c, d), (b, d), (0, 0), (-5, -10))
    board.up_and_park()

# Problem 3: 100 wide, 60 high on the right, a flat top of 40, 30 high on the left.
board = Board("problem3", "Problem 3: the top is 40 long, then the edge falls to 30 on the left.")
board.down(-10.0, fast=5000.0)
board.cut((100, 0), (100, 60), (60, 60), (0, 30), (0, -10))
board.up_and_park(park=(450.0, 600.0))

# Problem 4: a triangle 80 high, 76 degrees at its foot.
board = Board("problem4", "Problem 4: a triangle 80 high whose base angle is 76 degrees: base 80 / tan 76.")
board.down(-10.0)
board.cut((80 / tan(76), 0), (0, 80), (0, -10))
board.up_and_park(park=(450.0, 600.0))

# Problem 5: base 60, to 100 at 40 degrees, 50 up, back.
board = Board("problem5", "Problem 5: the lower right edge climbs 40 along at 40 degrees.")
board.down(-10.0, fast=5000.0)
rise = (100 - 60) * tan(40)
board.cut((60, 0), (100, rise), (100, 50 + rise), (0, 50 + rise), (0, -10))
board.up_and_park(park=(450.0, 600.0))

# Problem 6: a house 100 wide, walls of 50, a roof of 40 degrees.
board = Board("problem6", "Problem 6: walls of 50, and a roof of 40 degrees over a base of 100.")
board.down(-10.0)
board.cut((100, 0), (100, 50), (50, 50 + 50 * tan(40)), (0, 50), (0, -10))
board.up_and_park(park=(450.0, 600.0))

# Problem 7: a zigzag top: quarters of 30, slopes of 30 degrees. V4=V3/4 is the errata's reading of V3/V4.
board = Board("problem7", "Problem 7: 120 wide, 40 high, then back in four quarters of 30 at 30 degrees, 30 between.")
board.down(-10.0, fast=5000.0)
slope = 30 * tan(30)
board.feed(0, f=4000.0)
for x, y in [(120, 0), (0, 40), (-30, slope), (0, 30), (-30, slope), (-30, -slope), (0, -30), (-30, -slope)]:
    board.feed_by(x, y)
board.feed(y=-10)
board.up_and_park(park=(450.0, 600.0))

# Problem 8a: a 300 board has (300 - 100) / 50 + 1 slots, 15 long, 50 apart, the first at 42.5.
board = Board("problem8a", "Problem 8a: five slots 15 long and 5 deep, 50 apart.")
board.rapid(42.5, 50.0, 5.0)
for slot in range(5):
    board.rapid(42.5 + 50 * slot)
    board.feed(z=-5.0, f=1500.0)
    board.feed(42.5 + 50 * slot + 15, f=3000.0)
    board.rapid(z=5.0)
board.tool(0)
board.shift = (0.0, 0.0, 0.0)
board.rapid(450.0, 600.0, 0.0)

# Problem 8b lacks the G91 of 8a before the plunge (errata 59): Z-10, X15 and Z10 are then absolute, and each way of
# 35 begins at X15.
board = Board("problem8b-ok", "Problem 8b as printed: without its G91 (errata 59) every slot ends at X15, 10 deep,\n"
                              "and the next one begins 35 farther, at X50.")
board.rapid(42.5, 50.0, 5.0)
for slot in range(5):
    if slot:
        board.rapid(15 + 35)
    board.feed(z=-10.0, f=1500.0)
    board.feed(15.0, f=3000.0)
    board.rapid(z=10.0)
board.tool(0)
board.shift = (0.0, 0.0, 0.0)
board.rapid(450.0, 600.0, 0.0)

# Polar words (facts/cc100.md 5): G20 names the pole, A is the angle, D the distance; under G91 both count from the tool.
part = Motion("cc100", "polar", ["tests/motions/programs/cc100/polar.nc"],
              "Five at 30 degrees from (10, 20), eight above it, eight beside it; then 4 along X and 3 against Y.",
              start=(100.0, 100.0, 50.0))
part.rapid(0.0, 0.0, 5.0)
part.rapid(10 + 5 * cos(30), 20 + 5 * sin(30))
part.feed(10.0, 28.0, f=1000.0)
part.feed(2.0, 20.0)
part.feed(6.0, 20.0)
part.feed(6.0, 17.0)
part.feed(1.0, 2.0)

# G81: V1 is taken for the retract plane and V2 for the depth, and G0 drills under it (seed 004:1586-1590). There is no
# code for the return plane: the tool goes back to where it came from.
part = Motion("cc100", "drill", ["tests/motions/programs/cc100/drill.nc"],
              "Holes from Z5 to -10, by G0 and by places alone, then one from Z8 to -4; back to Z30 each time, and none after G80.",
              start=(100.0, 100.0, 50.0))
part.rapid(10.0, 20.0, 30.0)
part.set_feed(500.0)
for x, y in ((20.0, 20.0), (30.0, 25.0), (40.0, 35.0)):
    part.hole(x, y, r=5.0, bottom=-10.0, back=30.0)
part.hole(0.0, 0.0, r=8.0, bottom=-4.0, back=30.0)
part.rapid(50.0, 50.0)
