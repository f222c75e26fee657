"""Programs in programs/haas/, written with what the Haas class (seed 002, facts/haas.md) says: few programs
of the corpus move. Computed words are rounded to .0001 inch or .001 mm. M codes act when the move of their block is
done (seed 002:1496).
"""

from decimal import ROUND_HALF_UP, Decimal

import math

from motion import INCH, Motion, cos, sin

FRAME = {1: (300.0, 150.0, -100.0)}


def least(value, increment="0.0001"):
    return float((Decimal(repr(round(value, 9))) / Decimal(increment)).quantize(Decimal(1), ROUND_HALF_UP)
                 * Decimal(increment))


class Milled(Motion):
    def __init__(self, name, about, *, metric=False, run=None, profile="", **more):
        more = {"start": (10.0, 20.0, 30.0), "offsets": FRAME, **more}
        units = "metric" if metric else "inch"
        profile = f'units = "{units}"\noptions = ["macros", "rotation"]\n{profile}'
        run = run or [f"tests/motions/programs/haas/{name}.nc"]
        super().__init__("haas", name, run, about, unit=1.0 if metric else INCH, profile=profile, **more)


# The class's own program: no axis moves; on for two seconds.
part = Milled("o9000-problem3", "The output is on for P2. seconds (a point: seconds, seed 002:222); nothing moves.",
              run=["corpus/haas/o9000-problem3.nc"])
part.dwell(2.0)

part = Milled("bolt-circle", "Six holes 60 degrees apart from 15 on a circle of 1.25 about (2, -1.5). L0 stores the cycle; G98 goes\n"
                             "back to Z1.", tools={1: 63.5}, home=(0.0, 0.0, 5.0))
part.work(1)
part.rapid(0.0, 0.0)
part.tool(1)
part.rapid(z=1.0)
for hole in range(6):
    angle = 15 + 60 * hole
    part.hole(least(2 + 1.25 * cos(angle)), least(-1.5 + 1.25 * sin(angle)), r=0.1, bottom=-0.6, back=1.0, f=8.0)
part.machine(z=5.0)

part = Milled("rows-m97", "Three rows of four, 1.25 by .75 apart, from (.5, .25), in pecks of .4 from R.1 with .25 s at the bottom;\n"
                          "the first drops from Z.5, G99 keeps the tool at R.1 for the others. M97 L3 runs three times.",
              tools={2: 40.0})
part.work(1)
part.rapid(0.5, 0.25)
part.tool(2)
part.rapid(z=0.5)
for row in range(3):
    for column in range(4):
        part.peck(0.5 + 1.25 * column, 0.25 + 0.75 * row, r=0.1, bottom=-1.0, steps=[0.4] * 3, f=6.0, dwell=0.25)
part.rapid(z=2.0)

part = Milled("ellipse", "72 chords of an ellipse of 4 by 2.5, its points rounded to .0001.")
part.work(1)
part.rapid(2.0, 0.0)
part.rapid(z=0.1)
part.feed(z=-0.125, f=5.0)
for angle in range(5, 365, 5):
    part.feed(least(2 * cos(angle)), least(1.25 * sin(angle)), f=20.0)
part.rapid(z=0.1)

part = Milled("helix", "Four turns of radius 8 about (12, 10), 1.5 deeper each, a flat one, then the quarter to (12, 18).",
              metric=True)
part.work(1)
part.rapid(20.0, 10.0)
part.rapid(z=2.0)
part.feed(z=0.0, f=200.0)
for turn in range(1, 5):
    part.arc(20, 10, (12, 10), +1, z=-1.5 * turn, f=100.0)
part.arc(20, 10, (12, 10), +1, f=150.0)
part.arc(12, 18, (12, 10), +1)
part.feed(12, 10)
part.rapid(z=2.0)

part = Milled("bare-numbers", "Without a point X, Y, Z and F count .0001 inch (settings 162 and 77 as delivered); G04 P250 are\n"
                              "milliseconds, P2. seconds; X#1 and F[3.5] are what they are.")
part.work(1)
part.rapid(0.0005, -0.001)
part.feed(z=-0.0025, f=0.0012)
part.feed(2.0, 0.5, f=3.5)
part.dwell(0.25)
part.dwell(2.0)
part.feed(0.0)
part.rapid(z=1.0)

part = Milled("frames", "G154 P3, G52 over it and off, G154 P4 as G10 L20 wrote it, G53 for one block, G55, and a turn of 30 degrees\n"
                        "about (10, 0) with an arc in it.", metric=True,
              offsets={1: FRAME[1][:2] + (0.0,), 2: (7.0, 8.0, 0.0), 103: (-10.0, 40.0, 0.0)})
part.work(1)
part.rapid(0.0, 0.0)
part.work(103)
part.rapid(10.0, 5.0)
part.shift = (90.0, 20.0, 0.0)
part.rapid(10.0, 5.0)
part.shift = (-50.0, -60.0, -70.0)
part.rapid(1.0, 2.0, 3.0)
part.machine(z=-5.0)
part.work(2)
part.rapid(0.0, 0.0)


def turned(x, y):
    return 10 + (x - 10) * cos(30) - y * sin(30), (x - 10) * sin(30) + y * cos(30)


part.rapid(*turned(30, 0))
part.feed(*turned(30, 10), f=300.0)
# Clockwise a quarter from (30, 10) to (40, 20): its centre is (40, 10).
part.arc(*turned(40, 20), turned(40, 10), -1)
part.rapid(0.0, 0.0)

part = Milled("mirror", "A corner with a quarter arc; the same with X mirrored at 0, where the arc turns the other way; the same\n"
                        "twice as large about (0, 0).", metric=True)
part.work(1)
part.rapid(0.0, 0.0)
for x, y in ((1, 1), (-1, 1), (2, 2)):
    part.rapid(5 * x, 5 * y)
    part.feed(15 * x, 5 * y, f=400.0)
    part.arc(20 * x, 10 * y, (15 * x, 10 * y), 1 if x > 0 else -1)
    part.feed(20 * x, 20 * y)
    part.rapid(0.0, 0.0)

part = Milled("branches", "X1., X2., X3. by a jump back without IF; Y.5 because #2 is true; GOTO 20.4 goes to N20; Y#33 is vacant and\n"
                          "left out; 1 AND 3 is 1; M99 without IF returns before Y97.")
part.work(1)
part.rapid(0.0, 0.0)
for x in (1.0, 2.0, 3.0):
    part.rapid(x)
part.feed(y=0.5, f=10.0)
part.rapid(7.5)
part.rapid(y=1.25)

part = Milled("cycles", "G82 with half a second, G85 out at feed, G73 in steps of 8, 5, then 4 (I, J less each, not below K), 1 mm back\n"
                        "each time. G98 goes back to Z20., G99 stays at R2.", metric=True, tools={3: 33.0})
part.work(1)
part.rapid(0.0, 0.0)
part.tool(3)
part.rapid(z=20.0)
part.hole(10.0, 0.0, r=2.0, bottom=-3.0, back=20.0, f=120.0, dwell=0.5)
part.hole(20.0, 0.0, r=2.0, bottom=-8.0, back=20.0, f=80.0, out="feed")
for x, back in ((30.0, None), (40.0, 20.0)):
    part.peck(x, 0.0, r=2.0, bottom=-20.0, steps=[8, 5, 4, 4, 4], back=back, f=150.0, dwell=0.5, chips=True)
part.rapid(z=50.0)

part = Milled("alias", "Parameter 91 is 170: G170 calls O9010 with its words. Full circles of .75 and .5 from the right end, in at half\n"
                       "the feed; the second without Z goes .1 deep.", profile="[parameters]\n91 = 170")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=0.5)
for x, size, depth, feed in ((1.0, 0.75, -0.3, 12.0), (3.0, 0.5, -0.1, 9.0)):
    part.rapid(x + size / 2, 2.0)
    part.feed(z=depth, f=feed / 2)
    part.arc(x + size / 2, 2.0, (x, 2.0), -1, f=feed)
    part.rapid(z=0.5)

part = Milled("repeat-arguments", "G65 L4: the arguments are loaded for the first pass only (96-8000 Rev AC), so X goes by 2, 4, 8, 16 and Y\n"
                                  "by 1 once.", metric=True)
part.work(1)
part.rapid(0.0, 0.0)
for x, y in ((2, 1), (4, 0), (8, 0), (16, 0)):
    part.by(x, y)
part.rapid(0.0)

part = Milled("planes", "Quarters in the ZX and YZ planes and a helix in XY; in ZX counter-clockwise turns Z to X, in YZ Y to Z.",
              metric=True)
part.work(1)
part.rapid(0.0, 0.0, 0.0)
part.arc(10.0, None, (0.0, 10.0), -1, z=-10.0, f=200.0, plane=(2, 0))
part.arc(None, 10.0, (0.0, 0.0), +1, z=0.0, plane=(1, 2))
part.arc(0.0, 0.0, (0.0, 10.0), +1, z=5.0)

part = Milled("tap", "Two tapped holes at 500 * 1.25 = 625 mm a minute, in and out; G99 stays at R2., G98 goes back to Z20. That feed stays.",
              metric=True)
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=20.0)
part.hole(10.0, 0.0, r=2.0, bottom=-12.0, f=625.0, out="feed")
part.hole(20.0, 0.0, r=2.0, bottom=-12.0, back=20.0, out="feed")
part.feed(30.0)

TURNS = '[parameters]\n"278.cncr_spindle" = 0'

part = Milled("taps", "G74 with M04 stays at R3. (G99), then back to Z20. (G98); G84 twice by L2 under G91 from\n"
                      "R20-16 to 4-14. The feed stays.", metric=True, tools={3: 33.0}, turns=True, profile=TURNS)
part.work(1)
part.rapid(0.0, 0.0)
part.spindle("counter_clockwise", 400.0)
part.tool(3)
part.rapid(z=20.0)
part.tap(10.0, 5.0, r=3.0, bottom=-12.0, f=500.0)
part.tap(20.0, 5.0, r=3.0, bottom=-12.0, back=20.0)
part.spindle("clockwise")
for x in (30.0, 40.0):
    part.tap(x, 5.0, r=20.0 - 16.0, bottom=4.0 - 14.0, f=300.0)
part.feed(95.0)
# M30 stops the spindle (seed 002:216).
part.spindle("stopped")
part.to("fanuc", "codes/beside_moves.rs", "codes/pauses.rs", "codes/pauses/after.rs")

part = Milled("bores", "Each bore back to the initial level (G98) and to R2. (G99). G76 and G77 go aside by I and J where no Q stands (96-8000,\n"
                       "1999, p. 188); G77 dives to R-25. and cuts up to Z-20., from Z2. where G80 left the tool. G88 is bore, dwell, out by\n"
                       "hand, G87 the same without the dwell (seed 002:1368). L repeats under G91; G80 took the\n"
                       "dwell away.", metric=True,
              tools={3: 33.0}, turns=True, profile=TURNS)
part.work(1)
part.rapid(0.0, 0.0)
part.spindle("clockwise", 600.0)
part.tool(3)
part.rapid(z=30.0)
part.set_feed(60.0)
for y, back in ((5.0, 30.0), (15.0, None)):
    part.bore_finely(10.0, y, r=2.0, bottom=-8.0, by=(0.3, -0.4), dwell=0.2, back=back)
for y, back in ((5.0, 30.0), (15.0, None)):
    part.bore_and_stop(20.0, y, r=2.0, bottom=-8.0, back=back)
for y, bottom, back in ((5.0, -8.0, 30.0), (15.0, -4.0, None)):
    part.hole(30.0, y, r=2.0, bottom=bottom, out="feed", back=back)
part.bore_by_hand(40.0, 5.0, r=2.0, bottom=-4.0, dwell=0.1, back=30.0)
part.bore_by_hand(40.0, 15.0, r=2.0, bottom=-4.0)
for y, back in ((5.0, 30.0), (15.0, None)):
    part.hole(50.0, y, r=2.0, bottom=-4.0, dwell=0.25, out="feed", back=back)
for y in (5.0, 15.0):
    part.bore_back(60.0, y, r=-25.0, bottom=-20.0, by=(-1.0, 0.0), f=40.0, back=2.0)
part.rapid(z=30.0)
for x in (50.0, 40.0, 30.0):
    part.hole(x, 15.0, r=30.0 - 28.0, bottom=2.0 - 5.0, out="feed", back=30.0)
for x in (20.0, 10.0):
    part.hole(x, 15.0, r=2.0, bottom=2.0 - 4.0, out="feed")
part.rapid(z=60.0)
part.spindle("stopped")

part = Milled("obstacle", "The cycle's own block drills where the tool stands (setting 28, as preferred); X45. L0 goes past a corner at R2. and\n"
                          "drills nothing; a Z alone tells the holes to come (manual of 2017, p. 243 to 247).", metric=True)
part.work(1)
part.rapid(10.0, -5.0)
part.rapid(z=5.0)
part.hole(10.0, -5.0, r=2.0, bottom=-20.0, f=150.0)
part.hole(30.0, -5.0, r=2.0, bottom=-20.0)
part.rapid(45.0, -5.0)
part.hole(45.0, -20.0, r=2.0, bottom=-20.0)
part.hole(45.0, -40.0, r=2.0, bottom=-25.0)
part.rapid(z=5.0)

part = Milled("turns", "An arc in G91 with L5 is cut five times, 1.5 higher each (manual of 2017, p. 257).", metric=True)
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=2.0)
part.feed(z=-20.0, f=200.0)
part.feed(6.0, f=100.0)
for turn in range(1, 6):
    part.arc(6.0, 0.0, (0.0, 0.0), +1, z=-20.0 + 1.5 * turn, f=120.0)
part.feed(0.0)
part.rapid(z=5.0)
part.to("fanuc", "calls/repeats.rs")

part = Milled("hole-circles", "Twelve holes on a circle of 5 about (0, 0) from 15 degrees on, then four on an arc of 3 about (1, 2), from 90\n"
                              "degrees on by 22.5, clockwise (manual of 2017, p. 286, p. 287), then three on a line at 30 degrees, 1.5 apart,\n"
                              "the first where the tool stands (the maker's page on G72). L0 stores the cycle.")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=1.0)
for (cx, cy), radius, start, step, count in (((0.0, 0.0), 5.0, 15.0, 30.0, 12), ((1.0, 2.0), 3.0, 90.0, -22.5, 4)):
    part.rapid(cx, cy)
    for at in range(count):
        angle = math.radians(start + at * step)
        x, y = round(cx + radius * math.cos(angle), 4), round(cy + radius * math.sin(angle), 4)
        part.hole(x, y, r=0.1, bottom=-1.0, back=1.0, f=15.0)
part.rapid(1.0, 2.0)
for at in range(3):
    x, y = round(1.0 + 1.5 * at * math.cos(math.radians(30.0)), 4), round(2.0 + 1.5 * at * math.sin(math.radians(30.0)), 4)
    part.hole(x, y, r=0.1, bottom=-1.0, back=1.0, f=15.0)
part.rapid(0.0, 0.0)
part.to("fanuc", "cycles/hole_circles.rs")

part = Milled("pockets", "Round pockets: G13 with I.4 alone, then with K1. and Q.25 (circles of .4, .65, .9 and 1.), then G12 in G91, twice\n"
                         "deeper by .1. Half circles go out from the centre and back (96-8000, 1999, p. 237; machine:pocket.path). D0 takes\n"
                         "no radius off.", metric=False)
part.work(1)
part.rapid(2.0, 1.5)
part.rapid(z=0.1)


def pocket(cx, cy, radii, turn, f=None):
    """Half circles from circle to circle along X, on the two sides of the centre in turn."""
    at, side = cx, 1.0
    for radius in radii:
        to = cx + side * radius
        part.arc(to, cy, ((at + to) / 2.0, cy), turn, f=f)
        part.arc(to, cy, (cx, cy), turn)
        at, side, f = to, -side, None
    part.arc(cx, cy, ((at + cx) / 2.0, cy), turn)


part.feed(z=-0.2, f=20.0)
pocket(2.0, 1.5, [0.4], +1)
part.feed(z=-0.3, f=10.0)
pocket(2.0, 1.5, [0.4, 0.65, 0.9, 1.0], +1)
part.rapid(z=0.1)
part.rapid(5.0, 1.5)
part.feed(z=0.0, f=30.0)
for depth in (-0.1, -0.2):
    part.feed(z=depth, f=15.0)
    pocket(5.0, 1.5, [0.5], -1)
part.feed(6.0, 1.5)
part.rapid(z=0.1)
part.to("fanuc", "cycles/pockets.rs", "cycles/pockets/path.rs")

part = Milled("way-back", "G28 goes by (30, 40) to the reference position, and G29 by that point to (50, 60) (manual of 2017, p. 263).",
              metric=True, home=(7.0, 8.0, 0.0))
part.work(1)
part.rapid(10.0, 20.0)
part.rapid(z=5.0)
part.rapid(30.0, 40.0)
part.machine(x=7.0, y=8.0)
part.rapid(30.0, 40.0)
part.rapid(50.0, 60.0)
