"""Holes by live tools and positions of the C axis, on the emulated Fanuc and Haas lathes.

The order of the moves is that of docs/lathe.md, rows Q4 to Q9; where they go is worked out here from the sizes of the
part: bolt circles, depths, plane. Programs are in programs/fanuc/live-*.nc and programs/haas/live-*.nc.

Each place has a fourth number, C in degrees. X is a diameter; depths of pecks and the plane's R along X are radii.
"""

import math

from motion import number
from turning import Lathe

AXES = 'axes = ["X", "Z", "C"]\n'


class Live(Lathe):
    """A part on a lathe whose spindle can be an axis: C stands at 45 degrees at the start, and its home is 0."""

    folder, says = "expected-live", "c_axis = true\n"

    def __init__(self, control, name, about, *, settings="", **more):
        more = {"start": (300.0, 0.0, 200.0, 0.0, 0.0, 45.0), "home": (400.0, 0.0, 350.0), **more}
        super().__init__(control, f"live-{name}", about, settings=AXES + settings, **more)
        self.now = [*map(float, self.start[:3]), self.start[5]]
        self.mode = "per_minute"

    # Moves.

    def spot(self, x=None, z=None, c=None):
        at = self.place(x, None, z)
        at[3] = at[3] if c is None else float(c)
        return at

    def turn(self, c=None, x=None, z=None):
        """A rapid move of all that is named, all in one (Q4, Q5 step 1)."""
        self._rapid(self.spot(x, z, c))

    def turn_at(self, c, x=None, z=None, f=None):
        """A feed move with C."""
        self._feed(self.spot(x, z, c), f, None)

    def turn_by(self, c):
        """A feed move of C by so much, at the feed in force."""
        self._feed(self.spot(c=self.now[3] + c), None, None)

    def reference(self):
        """All three axes in one rapid move to the reference point (Z1)."""
        self._rapid([*map(float, self.home[:3]), 0.0])

    # Holes: along Z at X and C, along X at Z and C.

    def face(self, bottom, *, x=None, c=None, r, **more):
        """Q5: over X and C, to the plane r in Z, to the bottom, and out."""
        self.drill("z", bottom, x=x, c=c, r=r, **more)

    def side(self, bottom, *, z=None, c=None, r, **more):
        """Q6: over Z and C, to the plane r in X (a diameter), to the bottom, and out."""
        self.drill("x", bottom, z=z, c=c, r=r, **more)

    def drill(self, axis, bottom, *, r, x=None, z=None, c=None, back=None, f=None, dwell=0.0, out="rapid", tap=False,
              hand=None, steps=(), chips=False, clear=1.0):
        """A hole: steps are lengths of pecks, clear the clearance of a peck, real lengths (Q7).

        hand: of a thread whose cycle turns the tool by itself (Q9). out "stop": the spindle stops at the bottom, and turns on
        at the end.
        """
        if f is not None:
            self.set_feed(f)
        kept = (self.speed, self.mode)
        if hand:
            # A tap advances its lead with each turn (Q11).
            self.speed, self.mode = self.speed * self.rpm, "per_minute"
        self.turn(c, x, z)
        self.rapid(**{axis: r})
        self._write("hole", self.now, number(self.place(**{axis: bottom})[0 if axis == "x" else 2]))
        for depth, again in self.pecks(axis, bottom, r, steps, clear):
            if again is not None and not chips:
                self.rapid(**{axis: r})
            if again is not None:
                self.rapid(**{axis: again})
            self.feed(**{axis: depth})
        if dwell:
            self.dwell(dwell)
        if tap:
            before = self.turning
            self.spindle("clockwise" if before == "counter_clockwise" else "counter_clockwise")
            self.feed(**{axis: r})
            self.spindle(before)
        elif hand:
            ways = ("clockwise", "counter_clockwise") if hand == "right" else ("counter_clockwise", "clockwise")
            self.spindle(ways[1])
            self.feed(**{axis: r})
            self.spindle(ways[0])
            self.speed, self.mode = kept
        elif out == "stop":
            before = self.turning
            self.turned("stopped")
            self.rapid(**{axis: r})
            self.rapid(**{axis: back})
            self.turned(before)
            return
        elif out == "feed":
            self.feed(**{axis: r})
        else:
            self.rapid(**{axis: r})
        if back is not None:
            self.rapid(**{axis: back})

    def turned(self, way):
        """The spindle turns so: said where it did not before."""
        if self.turning != way:
            self.spindle(way)

    @staticmethod
    def pecks(axis, bottom, r, steps, clear):
        """Depths, and where the tool goes on from after it came back."""
        scale = math.copysign(2.0 if axis == "x" else 1.0, r - bottom)
        depth, again = r, None
        for step in steps:
            depth -= scale * step
            if (depth - bottom) * scale <= 0:
                break
            yield depth, again
            again = depth + scale * clear
        yield bottom, again


def systems(name, about, made):
    """The same part in systems B and C, in a program each."""
    for system in "BC":
        made(Live("fanuc", f"{name}-{system.lower()}", f"{about} System {system}.",
                  settings=f'[settings]\ngcode_system = "{system}"'))


# ---------------------------------------------------------------------------------------------------------------------
# Holes in the face, Fanuc: G83, G84, G85 (Q5).

part = Live("fanuc", "drill-a",
            "Holes on a circle of 60: at C0, C90 by G83, at C180 by H90.; at X40. C270. 2 less deep. The plane is 3 "
            "under the start at Z5. G85 from the plane 8 down (W-8.), .3 s there and out at feed; system A always goes "
            "back to the start. Then G83 ends by G0 (Q5: a code of group 01).")
part.turn(0, 60.0, 5.0)
for c in (None, 90, 180):
    part.face(-12.0, c=c, r=2.0, back=5.0, f=60.0)
part.face(-10.0, x=40.0, c=270, r=2.0, back=5.0)
part.face(2.0 - 8.0, x=40.0, c=0, r=2.0, back=5.0, f=50.0, dwell=0.3, out="feed")
part.face(-4.0, x=50.0, c=45, r=4.0, back=5.0)
part.turn(x=100.0)


def face_holes(part):
    part.turn(0, 60.0, 5.0)
    part.face(-12.0, c=30, r=2.0, f=60.0)
    part.face(-12.0, c=75, r=2.0)
    part.face(-12.0, c=120, r=2.0, back=5.0)
    part.face(2.0 - 9.0, c=180, r=2.0, back=5.0)
    part.face(-12.0, x=40.0, c=0, r=2.0, back=5.0)
    part.face(-6.0, c=90, r=2.0, f=50.0, dwell=0.25, out="feed")
    for c in (135, 180, 225):
        part.face(2.0 - 8.0, c=c, r=2.0, dwell=0.4, out="feed")
    part.turn(x=100.0)
    part.turn(z=20.0)


systems("drill", "Holes on a circle of 60 by G83: two that end at the plane (G99), then back to the start (G98); one by "
                 "increments, C60. further, 9 under the plane; one at 40. G85 at C90., then three more by K3 with C45. in "
                 "increments, out at feed, ending at the plane.", face_holes)

part = Live("fanuc", "repeats",
            "K in system A: C0, then four holes by H60. K4, two by U-10. K2 at that angle: 40 and 30. G85 at C0 once "
            "more.")
part.turn(0, 50.0, 3.0)
part.face(-9.0, r=1.0, back=3.0, f=70.0)
for c in (60, 120, 180, 240):
    part.face(-7.0, c=c, r=1.0, back=3.0)
for x in (40.0, 30.0):
    part.face(-7.0, x=x, r=1.0, back=3.0)
part.face(-3.0, c=0, r=1.0, back=3.0, out="feed")
part.turn(x=80.0)

for name, chips in (("pecks-back", True), ("pecks-out", False)):
    part = Live("fanuc", name,
                "Pecks (Q7): 6, 6, 5 from the plane at Z2., then 8, 8, 1; the third block has no Q, which counts only in "
                "its own: one feed. "
                + ("Parameter 5101.2 is 0: back by the clearance of 1." if chips
                   else "Parameter 5101.2 is 1: back to the plane, down to 1 over the last depth."),
                settings=f"[parameters]\n5101.2 = {0 if chips else 1}",
                run="tests/motions/programs/fanuc/live-pecks.nc")
    part.turn(0, 50.0, 4.0)
    part.face(-15.0, r=2.0, back=4.0, f=80.0, steps=[6.0] * 3, chips=chips)
    part.face(-15.0, c=120, r=2.0, back=4.0, steps=[8.0] * 3, chips=chips)
    part.face(-15.0, c=240, r=2.0, back=4.0)
    part.turn(z=50.0)

part = Live("fanuc", "taps",
            "Threads of 1.25 at 500 a minute: 625. G84 into the face at C0 and C180, G88 into a side at Z-15. and, by "
            "W-10., at Z-25.: in, .2 s, the spindle turned back, out at feed, turned as before.", turns=True)
part.turn(0, 40.0, 6.0)
part.spindle("clockwise", 500.0)
part.face(-10.0, r=3.0, back=6.0, f=625.0, tap=True)
part.face(-10.0, c=180, r=3.0, back=6.0, tap=True)
part.turn(x=70.0)
part.turn(0, z=-15.0)
part.side(44.0, r=64.0, back=70.0, dwell=0.2, tap=True)
part.side(44.0, z=-25.0, c=90, r=64.0, back=70.0, dwell=0.2, tap=True)
part.turn(x=100.0)

# ---------------------------------------------------------------------------------------------------------------------
# Holes in the side, Fanuc: G87, G88, G89 (Q6).

part = Live("fanuc", "side-a",
            "Holes into a side of 50, from X60.: the plane is 5 (radius) under the start, at 50. At Z-20. C0 and C90 "
            "down to 30, at Z-30. by W-10.; G89 down by U-16. from the plane, .2 s, out at feed.")
part.turn(0, 60.0, 5.0)
part.side(30.0, z=-20.0, r=50.0, back=60.0, f=60.0)
part.side(30.0, c=90, r=50.0, back=60.0)
part.side(30.0, z=-30.0, c=180, r=50.0, back=60.0)
part.side(50.0 - 16.0, z=-40.0, c=0, r=50.0, back=60.0, f=40.0, dwell=0.2, out="feed")
part.turn(z=20.0)


def side_holes(part):
    part.turn(0, 60.0, -20.0)
    part.side(30.0, c=45, r=50.0, f=60.0)
    part.side(30.0, z=-30.0, r=50.0)
    part.side(30.0, c=90, r=50.0, back=60.0)
    for c in (120, 150):
        part.side(50.0 - 12.0, c=c, r=50.0, back=60.0)
    part.side(36.0, z=-40.0, c=0, r=50.0, f=40.0, dwell=0.2, out="feed")
    part.turn(x=80.0)
    part.turn(z=20.0)


systems("side", "Holes into a side from X60., plane 50: two end at the plane (G99), one at the start (G98), two more by K2 "
                "and C30., 12 (diameter) under the plane; G89 under G99.", side_holes)

for name, chips in (("side-pecks-back", True), ("side-pecks-out", False)):
    part = Live("fanuc", name,
                "Pecks into a side, 10 (radius) deep by 4: from the plane at 50 to 42, 34, 30. "
                + ("Back by 1 (radius)." if chips else "Back to the plane, down to 1 (radius) over the last depth."),
                settings=f"[parameters]\n5101.2 = {0 if chips else 1}",
                run="tests/motions/programs/fanuc/live-side-pecks.nc")
    part.turn(0, 60.0, -20.0)
    part.side(30.0, r=50.0, back=60.0, f=60.0, steps=[4.0] * 3, chips=chips)
    part.side(30.0, z=-28.0, c=60, r=50.0, back=60.0, steps=[4.0] * 3, chips=chips)
    part.turn(x=90.0)

# ---------------------------------------------------------------------------------------------------------------------
# The C axis alone (Q4), and home (Z1).


def turned(part, feeds=True):
    part.turn(90)
    part.turn(0, 40.0, 5.0)
    part.turn(180, 30.0)
    part.turn(135)
    part.turn(165, z=-2.0)
    if feeds:
        part.turn_at(210, f=360.0)
        part.turn_at(240, x=34.0, f=120.0)
        part.feed(z=-4.0)
        part.turn_by(-30)
    else:
        part.feed(z=-4.0, f=120.0)
    part.reference()


ABOUT = "C alone, with X and Z in one move, by increments back and on; "
FEEDS = "at feed alone and with X; "
HOME = "home of all three axes in one move, from where the tool stands."
turned(Live("fanuc", "turn-a", ABOUT + FEEDS + HOME))
systems("turn", ABOUT + FEEDS + HOME, turned)
turned(Live("haas", "turn", ABOUT + HOME), feeds=False)

# ---------------------------------------------------------------------------------------------------------------------
# Haas: G81 to G85 (Q9); G241 to G245 by a post for the ST-20Y (see README.md).

part = Live("haas", "face",
            "From Z10., plane at Z2. (R is a place): G81 at C0 and C90, G83 by Q8. out to the plane and down to 1 over the "
            "last depth, G85 out at feed, G82 with .5 s; each ends at Z10. Then from Z1. with the plane at Z3., which is "
            "higher: the tool ends at the plane.")
part.turn(0, 50.0, 10.0)
part.face(-8.0, r=2.0, back=10.0, f=80.0)
part.face(-8.0, c=90, r=2.0, back=10.0)
part.face(-20.0, c=270, r=2.0, back=10.0, f=60.0, steps=[8.0] * 3)
part.face(-6.0, x=30.0, c=0, r=2.0, back=10.0, f=40.0, out="feed")
part.face(-3.0, c=180, r=2.0, back=10.0, dwell=0.5)
part.turn(z=1.0)
part.face(-4.0, c=45, r=3.0)
part.turn(z=30.0)

part = Live("haas", "tap", "G84 on the centre line with feed a turn: in and out by the lead of 1.25, at 500 turns 625 a minute (Q11), from Z8., plane Z3.")
part.turn(0, 0.0, 8.0)
part.face(-15.0, r=3.0, back=8.0, f=1.25 * 500, out="feed")
part.turn(z=40.0)

part = Live("haas", "side",
            "Into a side, from X70.: R62. and X are diameters and places. G241 at Z-20. C0 and C90, G243 by Q5. (radius) out "
            "to the plane and down to 1 over the last depth, G245 out at feed, G242 with .5 s; each ends at X70.")
part.turn(0, 70.0, -20.0)
part.side(40.0, r=62.0, back=70.0, f=60.0)
part.side(40.0, c=90, r=62.0, back=70.0)
part.side(36.0, z=-30.0, c=180, r=62.0, back=70.0, steps=[5.0] * 3)
part.side(50.0, c=270, r=62.0, back=70.0, f=30.0, out="feed")
part.side(56.0, z=-40.0, c=0, r=62.0, back=70.0, dwell=0.5)
part.turn(x=100.0)

part = Live("haas", "taps",
            "F is the lead, S500 before. Into the face from Z6., plane Z3.: G95 at C0 and C180 of 40, left-handed by G186 at "
            "C90 of 30. Into a side without R, from where the tool stands: G195 at X70., G196 after a move to X60. On the centre "
            "line left-handed by G184. With the spindle on: G86 stops it at the bottom, out by rapid; G89 waits .3 s, out at feed. "
            "G246 and G249 do the same into a side, R66. a diameter. M30 stops the spindle.", turns=True)
part.mode = "per_turn"
part.turn(0, 40.0, 6.0)
part.spindle("stopped", 500.0)
part.face(-10.0, r=3.0, back=6.0, f=1.25, hand="right")
part.face(-10.0, c=180, r=3.0, back=6.0, hand="right")
part.face(-8.0, x=30.0, c=90, r=3.0, back=6.0, f=1.0, hand="left")
part.turn(x=70.0)
part.turn(0, z=-15.0)
part.side(44.0, r=70.0, f=1.25, hand="right")
part.turn(x=60.0)
part.side(50.0, z=-25.0, c=45, r=60.0, f=1.0, hand="left")
part.turn(x=100.0)
part.turn(0, 0.0, 6.0)
part.face(-12.0, r=3.0, back=6.0, f=1.5, hand="left")
part.turned("clockwise")
part.face(-20.0, r=3.0, back=6.0, f=0.1, out="stop")
part.face(-25.0, r=3.0, back=6.0, dwell=0.3, out="feed")
part.turn(x=72.0)
part.turn(z=-20.0)
part.side(60.0, r=66.0, back=72.0, out="stop")
part.side(58.0, z=-30.0, r=66.0, back=72.0, dwell=0.4, out="feed")
part.turn(x=100.0)
part.spindle("stopped")
