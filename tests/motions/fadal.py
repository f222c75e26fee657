"""Programs of the Fadal manual's macro section (seed 000), in inches.

Fixture offsets are shifts that E1, E2 ... select; H adds the tool's length to Z. E0 is the machine's own zero.
"""

from math import sqrt

from motion import INCH, Motion, cos, sin

FIXTURE = (254.0, -127.0, 0.0)


class Part(Motion):
    def __init__(self, name, about, *, library=(), **more):
        run = [f"corpus/fadal/{file}.nc" for file in (name, *library)]
        more = {"start": (25.4, 50.8, 0.0), "offsets": {1: FIXTURE}, "tools": {1: -152.4, 2: -127.0}, **more}
        super().__init__("fadal", name, run, about, unit=INCH, profile='units = "inch"', **more)

    def away(self, *, z=True, length_off=True):
        """Up to the machine's Z0 without a length, then over the machine's X0 Y0."""
        if length_off:
            self.tool(0)
        if z:
            self.rapid(z=0.0)
        self.work(0)
        self.rapid(0.0, 0.0)


# R1=V1+2 and R2=V2-1 from nothing; X+R1 Y-R2.
part = Part("ex-r-transfer", "R1 = 0 + 2 and R2 = 0 - 1: X+R1 Y-R2 is X2. Y1.", scenario="",
            tables="[variables]\nV1 = 0\nV2 = 0")
part.work(1)
part.rapid(2.0, 1.0)

# The slots: a race track of two half circles and two straights of 1 inch, entered from its middle. Four passes of
# .1, .1, .05 and .01 under Z.01; the last pass goes round twice (R2=202).
part = Part("slot-parametric", "Three slots with straights of 1 inch: radius .19, .19 and .255. Passes of .1, .1, .05\n"
                               "and .01 go down from Z.01; the last goes round twice. A block under G3 without centre\n"
                               "is a straight move, or no slot closes (ambiguities.md 1). G49 at the end of the first\n"
                               "slot takes the length off for the others, as printed.")
part.work(1)
part.rapid(1.5, -0.876)
part.tool(1)
part.rapid(z=0.1)
part.feed(z=0.01, f=30.0)


def slot(x, y, radius):
    part.feed(z=0.01)
    depth = 0.01
    for step, rounds in ((0.1, 1), (0.1, 1), (0.05, 1), (0.01, 2)):
        depth -= step
        part.feed(x - 1, y, depth)
        part.feed(x - 1 - radius, y)
        for _ in range(rounds):
            part.arc(x - 1, y - radius, (x - 1, y), +1)
            part.feed(x, y - radius)
            part.arc(x, y + radius, (x, y), +1)
            part.feed(x - 1, y + radius)
            part.arc(x - 1 - radius, y, (x - 1, y), +1)
        part.feed(x - 1, y)
        part.feed(x, y)
    part.tool(0)
    part.rapid(z=0.1)


slot(1.5, -0.876, 0.19)
for x, y, radius in ((4.0, -0.876, 0.19), (4.0, -3.45, 0.255)):
    part.rapid(x, y)
    slot(x, y, radius)
part.rapid(1.5, -3.45)

# Rectangular pocket 4 by 2.
part = Part("o600-rect-pocket", "A pocket of 4 by 2, counter-clockwise from the middle of its lower side. G90 stands\n"
                                "after Y+R4 in the last block, so that is an increment: back to the middle, as it began.",
            scenario="called = true\nanswers = [4, 2]")
part.work(1)
part.rapid(z=0.1)
part.rapid(0.0, 0.0)
part.feed(z=-0.25, f=20.0)
for x, y in [(0, -1), (2, -1), (2, 1), (-2, 1), (-2, -1), (0, -1), (0, 0)]:
    part.feed(x, y)
part.rapid(z=0.1)

# The same with corners of .5.
part = Part("o700-rect-pocket-radius", "A pocket of 4 by 2 with corners of .5 (V3 of the errata's R7 and R8). Straight\n"
                                       "sides follow the arcs under G3 without a centre: straight moves.",
            scenario="called = true\nanswers = [4, 2, 0.5]")
part.work(1)
part.tool(1)
part.rapid(z=0.1)
part.rapid(0.0, 0.0)
part.feed(z=-0.25, f=20.0)
part.feed(0, -1)
part.feed(1.5, -1)
part.arc(2, -0.5, (1.5, -0.5), +1)
part.feed(2, 0.5)
part.arc(1.5, 1, (1.5, 0.5), +1)
part.feed(-1.5, 1)
part.arc(-2, 0.5, (-1.5, 0.5), +1)
part.feed(-2, -0.5)
part.arc(-1.5, -1, (-1.5, -0.5), +1)
part.feed(0, -1)
part.feed(0, 0)
part.rapid(z=0.1)

# The D-hole: circle of 2 about (2, -3), blends of .5, a flat .7 to the left.
part = Part("o1-dhole-main", "The D-hole about (2, -3): circle of 2, blends of .5 that touch the circle inside and the\n"
                             "flat at X-.7. As printed, -V6 at N55 and N59 sends the last arc to +.7, .4 off its\n"
                             "circle (ambiguities.md 5). AX and AY are work positions: the hole stays where it was\n"
                             "drilled.", library=("o800-dhole", "o900-rotate"))
part.work(1)
part.rapid(2.0, -3.0)
part.tool(1)
part.rapid(z=0.1)
part.hole(r=0.1, bottom=-0.6, f=40.0)
part.tool(0)
part.rapid(z=0.0)
part.tool(2)
part.rapid(z=0.1)
part.feed(z=-0.3, f=30.0)
blend = sqrt((2 - 0.5) ** 2 - (0.7 - 0.5) ** 2)
# On the circle, in line with its centre and that of the blend.
touch = (-0.2 * 2 / 1.5, blend * 2 / 1.5)
part.feed(2 - 0.7, -3, f=45.0)
part.feed(2 - 0.7, -3 - blend)
part.arc(2 + touch[0], -3 - touch[1], (2 - 0.2, -3 - blend), +1)
part.arc(2 + touch[0], -3 + touch[1], (2, -3), +1)
part.arc(2 + 0.7, -3 + blend, (2 - 0.2, -3 + blend), +1)
part.feed(2 + 0.7, -3)
part.feed(2, -3)
part.rapid(z=0.1)
part.away()

# Rows and columns: the macro counts moves, so rows have four holes and start one column later (MANIFEST.tsv).
part = Part("o10-row-column-main", "16 holes: a row has one hole more than R9 says and the way back is one step short,\n"
                                   "so that each row starts one column farther (MANIFEST.tsv, o810).",
            library=("o810-row-column",))
part.work(0)
part.rapid(0.0, 0.0)
part.work(1)
part.rapid(0.0, 0.0)
part.tool(1)
part.rapid(z=0.1)
for row in range(4):
    for column in range(4):
        part.hole(row + column, -row, r=0.1, bottom=-1.0, f=100.0)
part.away()

# Grids of ten by ten; the block of the cycle drills at X0 Y0 as well (ambiguities.md 3).
for name, dx, dy in (("o1234-drill-grid", 1.0, 1.0), ("o1235-drill-grid-dec", 0.375, 0.5)):
    part = Part(name, f"100 holes {dx} by {dy} apart, X from the first step on, and one at X0 Y0 where the cycle's own\n"
                      "block stands (ambiguities.md 3, errata 22). G98: back to Z.1, which is the plane R too.")
    part.work(1)
    part.rapid(z=0.0)
    part.rapid(0.0, 0.0)
    part.tool(1)
    part.rapid(z=0.1)
    for x, y in [(0, 0)] + [(x, y) for y in range(10) for x in range(1, 11)]:
        part.hole(dx * x, dy * y, r=0.1, bottom=-0.75, f=20.0)
    part.tool(0)
    part.rapid(z=0.0)
    part.work(0)
    part.rapid(0.0, 0.0, 0.0)

# Tool setting: fixture 23 has the probe's top as Z0. The numbers of fixtures above 6 begin at 101 in a scenario.
touches = [(500.0, 206.35, -301.0), (500.0, 206.35, -300.9)]
part = Part("o99-check-tool", "The tool touches, backs off .05, touches again slowly. E24 has X and Y of the probe, E23\n"
                              "its Z. The feeds are those of the blocks: 20., and 1. from the second touch on.",
            start=(25.4, 50.8, 10.0), offsets={117: (0.0, 0.0, -300.0), 118: (500.0, 200.0, 0.0)},
            tools={1: 0.0},
            scenario="called = true\nprobes = [{ at = [500, 206.35, -301, 0, 0, 0, 0, 0, 0, 0] }, "
                     "{ at = [500, 206.35, -300.9, 0, 0, 0, 0, 0, 0, 0] }]")
part.work(118)
part.rapid(0.0, 0.25)
part.work(117)
part.rapid(z=1.0)
part.probe((None, None, -0.1), touches[0], f=20.0)
part.feed_by(z=0.05)
part.probe((None, None, -0.1), touches[1], f=1.0)
part.rapid(z=0.0)
part.work(0)
part.rapid(0.0, 0.0, 0.0)

# Tool breakage: the tool's side must touch before Y0.
part = Part("o2-tool-breakage", "The tool is whole: the probe touches at Y.05 of fixture 24, so R9=AY is above zero and the stop\n"
                  "M0 is passed by. H99 is H(R8)+FZ23: the length of the tool over the probe. The move back ends\n"
                  "at the machine's Z0, X0 and Y0 in one block (E0 H0).",
            start=(25.4, 50.8, 10.0), offsets={117: (0.0, 0.0, -300.0), 118: (500.0, 200.0, 0.0)},
            tools={1: -25.4},
            scenario="called = true\ntool = 1\nprobes = [{ at = [500, 201.27, -325.4, 0, 0, 0, 0, 0, 0, 0] }]")
part.work(118)
part.rapid(0.0, 0.25)
part.length = -25.4 - 300.0
part.rapid(z=1.0)
part.feed(z=-0.1)
part.probe((None, 0.0, None), (500.0, 201.27, -325.4))
part.rapid(y=0.25)
part.length = 0.0
part.work(0)
part.rapid(0.0, 0.0, 0.0)

# Tool time: tools 20 and 21, each drills the row; M45 drills the first hole, L20 repeats the step of .5.
part = Part("o3-tool-time", "A row of holes .5 apart with tools 20 and 21, whose times are up: one at X0 by M45 and 20\n"
                            "by L20. G98: back to Z.1, which is the plane R too.", tools={20: -50.8, 21: -63.5},
            scenario="tool = 20")
part.work(1)
part.rapid(0.0, 0.0)
for tool in (20, 21):
    part.tool(tool)
    part.rapid(z=0.1)
    for hole in range(21):
        part.hole(0.5 * hole, 0.0, r=0.1, bottom=-0.1, f=50.0)
    part.rapid(0.0, 0.0)

# Big drill: .015 down and 4.5 ms, until Z-1 is reached; at three places.
part = Part("o4-big-drill", "30 % of .05 down at a time from Z.1, each with a dwell of (6000 / 1000) * .75 ms as printed\n"
                            "(errata 25: the text has 60000), until AZ > -1 fails; then up at 50. The subroutine leaves\n"
                            "G1 in force, so X1. and X2. are feed moves. G66 itself drills nothing, M45 does.")
part.work(1)
part.rapid(0.0, 0.0)
part.tool(1)
part.rapid(z=1.0)
part.rapid(z=0.1)
for x in (0.0, 1.0, 2.0):
    part.feed(x)
    step = 0
    while 0.1 - 0.015 * step > -1 + 1e-9:
        step += 1
        part.feed(z=0.1 - 0.015 * step, f=5.0)
        part.dwell(0.0045)
    part.feed(z=0.1, f=50.0)
part.away()

# Bolt circle.
part = Part("o5-bolt-pattern", "Ten holes on a circle of 5, the first at 30 degrees from +Y (X by the sine), the others\n"
                               "turned by 36 counter-clockwise each; the test leaves out the one at 324 (errata 27).\n"
                               "A G68 block drills at the turned place (ambiguities.md 4). G98: back to Z5.",
            home=(10.0, 20.0, 30.0))
part.work(1)
first = (2.5 * sin(30), 2.5 * cos(30))
part.rapid(*first)
part.tool(1)
part.rapid(z=5.0)
for hole in range(9):
    turn = 36 * hole
    x, y = first[0] * cos(turn) - first[1] * sin(turn), first[0] * sin(turn) + first[1] * cos(turn)
    part.hole(x, y, r=0.1, bottom=-1.0, back=5.0, f=10.0)
part.tool(0)
part.rapid(z=0.0)
part.rapid(0.0, 0.0, 0.0)
part.machine(10.0, 20.0, 30.0)

# Rectangle with sides of five degrees.
part = Part("o7-taper-rectangle", "169 passes, each .01 higher and .00087 larger on every side; from Z-1.687 up to +.003.\n"
                                  "Z-R7. is Z-R7 (errata 29).")
part.work(1)
part.rapid(z=0.0)
part.rapid(0.0, 0.0)
part.tool(1)
part.rapid(z=0.05)
part.feed(z=-1.687, f=50.0)
for turn in range(169):
    half, long = 0.8736 + 0.00087 * turn, 1.3556 + 0.00087 * turn
    for x, y in [(0, -half), (long, -half), (long, half), (-long, half), (-long, -half), (0, -half)]:
        part.feed(x, y)
    part.feed(z=-(1.687 - 0.01 * (turn + 1)))
part.rapid(z=0.5)
part.tool(0)
part.work(0)
part.rapid(0.0, 0.0, 0.0)

# Sine wave on a cylinder; the Y axis is mirrored, the wrapping turns Y into the fourth axis on the machine.
part = Part("o7-sine-wave", "180 moves of 2 degrees: X = .625 sin a, Y = a/360 of the way round a diameter of 1.5, mirrored\n"
                            "by G51.1 Y0. Cam wrapping (G17 Q) is a state; positions are those before it.",
            home=(10.0, 20.0, 30.0), tables="[variables]\nV12 = 0\nV13 = 0")
part.work(1)
part.rapid(z=0.0)
part.rapid(0.0, 0.0)
part.tool(1)
part.rapid(z=1.0)
part.feed(z=0.65, f=15.0)
for step in range(1, 181):
    part.feed(0.625 * sin(2 * step), -(3.141593 * 1.5 / 180 * step), f=20.0)
part.rapid(z=1.0)
part.rapid(y=0.0)
part.tool(0)
part.work(0)
part.rapid(0.0, 0.0, 0.0)
part.machine(10.0, 20.0, 30.0)

# Ellipse 3 by 2.
part = Part("o9-ellipse", "X falls from 1.5 by .01 and Y is the root of 1 - X^2/2.25. After 299 points the step to -1.5\n"
                          "ends a hair beyond, and the root of a negative number halts the run (errata 31).",
            scenario="answers = [3, 2]", ends="alarm")
part.work(1)
part.rapid(z=0.0)
part.rapid(0.0, 0.0, 0.0)
part.rapid(1.5, 0.0)
part.tool(1)
part.rapid(z=0.1)
part.feed(z=-0.25, f=20.0)
for step in range(1, 300):
    x = 1.5 - 0.01 * step
    part.feed(x, sqrt(1 - x * x / 2.25))

# A tap turns F times a minute and advances Q each turn: 400 * .05 are 20 inches a minute, in and out; the feed of 10
# from before it is in force behind it.
part = Motion("fadal", "tap", ["tests/motions/programs/fadal/tap.nc"], "Two tapped holes, 20 inches a minute; back to Z1. each time.",
              unit=INCH, start=(0.0, 0.0, 50.0), offsets={1: (100.0, 50.0, -200.0)}, profile='units = "inch"')
part.work(1)
part.rapid(1.0, 1.0, 1.0)
part.feed(2.0, f=10.0)
for x in (3.0, 4.0):
    part.hole(x, 1.0, r=0.1, bottom=-0.5, back=1.0, f=20.0, out="feed")
part.feed(5.0, f=10.0)

# Left: the spindle turns counter-clockwise, and clockwise on the way out. 300 * .1 are 30 inches a minute.
part = Motion("fadal", "left-tap", ["tests/motions/programs/fadal/left-tap.nc"],
              "G74 at 20 inches a minute with M4, G84.1 at 30 with M3; back to Z1. (G98) or to the plane R0 (G99). The feed of 10 is in\n"
              "force behind them, for F is their speed.",
              unit=INCH, start=(0.0, 0.0, 50.0), offsets={1: (100.0, 50.0, -200.0)}, profile='units = "inch"', turns=True)
part.spindle("counter_clockwise")
part.work(1)
part.rapid(1.0, 1.0, 1.0)
part.feed(2.0, f=10.0)
part.spindle("counter_clockwise", 400.0)
part.tap(3.0, 1.0, r=0.1, bottom=-0.5, back=1.0, f=20.0)
part.tap(4.0, 1.0, r=0.1, bottom=-0.5)
part.spindle("clockwise")
part.rapid(z=1.0)
part.spindle("clockwise", 300.0)
part.tap(5.0, 1.0, r=0.2, bottom=-0.25, f=30.0)
part.tap(6.0, 1.0, r=0.2, bottom=-0.25, back=1.0)
part.feed(7.0, f=10.0)

part = Motion("fadal", "bores", ["tests/motions/programs/fadal/bores.nc"],
              "G76 goes aside by I and J at the bottom (facts/fadal.md 6) and comes back over the hole where the cycle ends; G86's spindle\n"
              "turns again there. Each back to Z1. (G98) and to the plane R0 (G99). P are milliseconds, for G82 and G89 only.",
              unit=INCH, start=(0.0, 0.0, 50.0), offsets={1: (100.0, 50.0, -200.0)}, profile='units = "inch"', turns=True)
part.spindle("clockwise", 800.0)
part.work(1)
part.rapid(0.0, 0.0, 1.0)
part.set_feed(5.0)
for y, back in ((1.0, 1.0), (2.0, None)):
    part.bore_finely(1.0, y, r=0.1, bottom=-0.5, by=(0.02, -0.03), back=back)
for y, back in ((1.0, 1.0), (2.0, None)):
    part.bore_and_stop(2.0, y, r=0.1, bottom=-0.5, back=back)
for y, bottom, back in ((1.0, -0.5, 1.0), (2.0, -0.25, None)):
    part.hole(3.0, y, r=0.1, bottom=bottom, out="feed", back=back)
for y, back in ((1.0, 1.0), (2.0, None)):
    part.hole(4.0, y, r=0.1, bottom=-0.25, dwell=0.25, out="feed", back=back)
part.hole(5.0, 1.0, r=0.1, bottom=-0.25, dwell=0.5, back=1.0)
part.hole(6.0, 1.0, r=0.1, bottom=-0.25, back=1.0)
part.feed(7.0)
part.spindle("stopped")
