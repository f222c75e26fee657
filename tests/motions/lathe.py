"""Parts on the emulated Fanuc and Haas lathes; see docs/lathe.md and turning.py.

The numbers are those of the part: diameters, Z, allowances, depths. Where a level line meets a cone or a fillet is
worked out at the part, by similar triangles or Pythagoras. Programs are in programs/fanuc/lathe-*.nc and
programs/haas/lathe-*.nc.
"""

from motion import INCH
from turning import INSIDE, OUTSIDE, Lathe, equal_chips, leg


def fanuc(name, about, *, settings="", **more):
    return Lathe("fanuc", f"lathe-{name}", about, settings=settings, **more)


def haas(name, about, settings="", **more):
    lines = "".join(f"{key} = \"{value}\"\n" for key, value in (item.split("=") for item in settings.split()))
    return Lathe("haas", f"lathe-{name}", about, settings=f"[settings]\n{lines}" if lines else "", **more)


# ---------------------------------------------------------------------------------------------------------------------
# One shaft in the three systems of codes.


def shaft(name, system):
    part = fanuc(name,
                 f"A shaft from a bar of 50 in system {system}: faced in two cuts, roughed by 3 with .6 (diameter) "
                 "and .1 left, finished at .12, a groove from 36 down to 28 in three plunges, a thread by two single "
                 "passes and by passes of equal chips, a cut at .1 and home. The same moves come of A, B and C.",
                 settings=f'[settings]\ngcode_system = "{system}"')
    part.go(54.0, 2.0)
    for z in (0.5, 0.0):
        part.faced(-1.0, z, f=0.2)
    # 24 to Z-20, a cone to 36 at Z-32, 36 to Z-45, a face. The rough shape lies .6 and .1 off.
    part.set_feed(0.3)
    part.go(54.6, 2.1)
    part.along([(48.6, -44.9), (42.6, -44.9), (36.6, -44.9), (30.6, -20.0 - 6.0 + 0.1)], level=2.1, e=0.5)
    part.go(x=24.6)
    part.cut(z=-19.9)
    part.cut(36.6, -31.9)
    part.cut(z=-44.9)
    part.cut(x=54.6)
    part.go(54.0, 2.0)
    part.go(x=24.0)
    part.cut(z=-20.0, f=0.12)
    part.cut(36.0, -32.0)
    part.cut(z=-45.0)
    part.cut(x=54.0)
    part.go(54.0, 2.0)
    part.go(100.0, 60.0)
    part.go(40.0, -38.0)
    part.side_pecks([-38.0, -41.0, -43.0], [36.0, 32.0, 28.0], 0.2, f=0.08)
    part.go(100.0, 60.0)
    part.go(30.0, 4.0)
    for x in (23.2, 22.8):
        part.threaded(x, -16.0, lead=1.5)
    part.go(30.0, 4.0)
    part.screw(22.2, -16.0, equal_chips(0.35, 0.1, 0.85) + [0.9], height=0.9, lead=1.5, angle=60.0)
    part.go(28.0, 2.0)
    part.turned(23.8, -10.0, f=0.1)
    part.go(23.0, 1.0)
    part.feed_by(z=-1.0, f=100.0, mode="per_minute")
    part.machine(x=400.0, z=350.0)


shaft("shaft-a", "A")
shaft("shaft-b", "B")
shaft("shaft-c", "C")

# ---------------------------------------------------------------------------------------------------------------------
# G71, G70 on Fanuc.

# A stepped shaft from 60: 20 to Z-15, cone to 30 at Z-25, 30 to Z-32, fillet of 5 to the shoulder 40 to 50 at Z-37,
# round of 5 to 60 at Z-42, 60 to Z-50. Level lines: at 34 the fillet is 3 off its middle, so 4 along; at 54 the round
# is 2 off its middle.
SHAFT_ENDS = {59.0: -42.0 + leg(5.0, 4.5), 54.0: -42.0 + leg(5.0, 2.0), 49.0: -37.0, 44.0: -37.0,
              39.0: -32.0 - leg(5.0, 0.5), 34.0: -36.0, 29.0: -24.0, 24.0: -19.0}


def stepped(part, u, w, feeds=(None, None)):
    """Along the stepped shaft from Z2, so far off it; the rounds may have a feed of their own."""
    part.cut(z=-15.0 + w, f=feeds[0])
    part.cut(30.0 + u, -25.0 + w)
    part.cut(z=-32.0 + w)
    part.round(40.0 + u, -37.0 + w, (40.0 + u, -32.0 + w), -1, f=feeds[1])
    part.cut(x=50.0 + u, f=feeds[0])
    part.round(60.0 + u, -42.0 + w, (50.0 + u, -42.0 + w), 1)
    part.cut(z=-50.0 + w)


def roughed(part):
    """The stepped shaft in passes of 2.5 with .4 (diameter) and .1 left, and the pass along it."""
    part.go(64.0, 2.0)
    part.set_feed(0.3)
    part.go(64.4, 2.1)
    part.along([(x + 0.4, SHAFT_ENDS[x] + 0.1) for x in sorted(SHAFT_ENDS, reverse=True)], level=2.1, e=0.5)
    part.go(x=20.4)
    stepped(part, 0.4, 0.1)
    part.go(64.0, 2.0)


part = fanuc("g71-outside",
             "A stepped shaft with a fillet and a round: passes of 2.5 from 64 with .4 (diameter) and .1 left, "
             "eight levels, the pass along the shape, and G70 at the profile's own feeds .15 and .08. G71 roughs at "
             ".3.")
roughed(part)
part.go(x=20.0)
stepped(part, 0.0, 0.0, (0.15, 0.08))
part.go(64.0, 2.0)
part.go(100.0, 50.0)

part = fanuc("g71-one-block", "The stepped shaft by the older form in one block: D is the depth of a pass, in thousandths without a "
             "point, and parameter 5133 how far it goes back.",
             settings='[parameters]\n"0001.1" = 1\n5133 = 0.5')
roughed(part)
part.go(100.0, 50.0)

part = fanuc("g71-steps-alone", "The same with parameter 5105.1 as 1: the levels, and no pass along the shape.",
             run="tests/motions/programs/fanuc/lathe-g71-one-block.nc",
             settings='[parameters]\n"0001.1" = 1\n5133 = 0.5\n"5105.1" = 1\n"5105.2" = 0')
part.go(64.0, 2.0)
part.set_feed(0.3)
part.go(64.4, 2.1)
part.along([(x + 0.4, SHAFT_ENDS[x] + 0.1) for x in sorted(SHAFT_ENDS, reverse=True)], level=2.1, e=0.5)
part.go(64.0, 2.0)
part.go(100.0, 50.0)

# A bore: 50 to Z-10, cone to 40 at Z-20, 40 to Z-30, corner of 5 to the step 30 at Z-35, 30 to Z-45, face down to 18.
BORE_ENDS = {22.0: -45.0, 26.0: -45.0, 30.0: -45.0, 34.0: -30.0 - leg(5.0, 2.0), 38.0: -33.0, 42.0: -18.0, 46.0: -14.0}


def bored(part, u, w, f=None):
    part.cut(z=-10.0 + w, f=f)
    part.cut(40.0 + u, -20.0 + w)
    part.cut(z=-30.0 + w)
    part.round(30.0 + u, -35.0 + w, (30.0 + u, -30.0 + w), 1)
    part.cut(z=-45.0 + w)
    part.cut(x=18.0 + u)


part = fanuc("g71-inside",
             "A bore from 18: passes of 2 outward with -.6 (diameter) and .1 left. The level at 29.4 lies on the "
             "step of 30 less .6 and goes to its end; the level at 49.4 would lie on the bottom, so there is none. "
             "G70 follows.")
part.go(18.0, 2.0)
part.set_feed(0.25)
part.go(17.4, 2.1)
part.along([(x - 0.6, BORE_ENDS[x] + 0.1) for x in sorted(BORE_ENDS)], level=2.1, e=0.5, side=INSIDE)
part.go(x=49.4)
bored(part, -0.6, 0.1)
part.go(18.0, 2.0)
part.go(x=50.0)
bored(part, 0.0, 0.0, f=0.1)
part.go(18.0, 2.0)

part = fanuc("g71-edges",
             "36 by 20 from 40, nothing left: by 1.5 (one level at 37, the rest by the pass along the shape), by 2 "
             "(the level would lie on the shape: none), by 5 (deeper than the stock: none). G1 in the first block: "
             "the tool goes to depth at feed.")
part.go(40.0, 1.0)
part.set_feed(0.25)
part.along([(37.0, -20.0)], level=1.0, e=0.3, how="feed")
for _ in range(3):
    part.cut(x=36.0)
    part.cut(z=-20.0)
    part.cut(x=40.0)
    part.go(40.0, 1.0)

part = fanuc("g71-left",
             "Work away from the chuck: from X54. Z-62. to the right, 30 to Z-40, cone to 40 at Z-30, 40 to Z-10, "
             "face; by 3 with .4 and -.1 left. The profile is written in increments, which count from the start; "
             "G70 too.")
part.go(54.0, -62.0)
part.set_feed(0.2)
part.go(54.4, -62.1)
part.along([(48.4, -10.1), (42.4, -10.1), (36.4, -34.1)], level=-62.1, e=0.5, away=-1)
part.go(x=30.4)
part.cut(z=-40.1)
part.cut(40.4, -30.1)
part.cut(z=-10.1)
part.cut(x=54.4)
part.go(54.0, -62.0)
part.go(x=30.0)
part.cut(z=-40.0, f=0.1)
part.cut(40.0, -30.0)
part.cut(z=-10.0)
part.cut(x=54.0)
part.go(54.0, -62.0)


# Two valleys in a bar turned to 44: 30 from Z-5 to Z-27, sides 14 (diameter) over 7, bottom at Z-12 to Z-20; and 36
# from Z-33 to Z-45, sides 8 over 4, bottom at Z-37 to Z-41. Face at Z-52.
def valleys(part, u):
    part.cut(z=-5.0)
    part.cut(30.0 + u, -12.0)
    part.cut(z=-20.0)
    part.cut(44.0 + u, -27.0)
    part.cut(z=-33.0)
    part.cut(36.0 + u, -37.0)
    part.cut(z=-41.0)
    part.cut(44.0 + u, -45.0)
    part.cut(z=-52.0)
    part.cut(x=54.0 + u)


def rough_valleys(part, first_bottom, second_bottom):
    """By 2 with .4 left and .5 back: two levels over all, then the first valley to its bottom, then the second."""
    part.set_feed(0.2)
    part.go(54.4, 3.0)
    for x, before in ((50.4, 54.4), (46.4, 50.4)):
        part.go(z=3.0)
        part.go(x=x)
        part.cut(z=-52.0)
        part.cut(x=before)
        part.go(x=before + 1.0)
    part.valley([(42.4, -6.0, -26.0, (44.4, -27.0), 46.4), (38.4, -8.0, -24.0, (42.4, -26.0), 42.4),
                 (34.4, -10.0, -22.0, (38.4, -24.0), 38.4)] + first_bottom, 0.5)
    part.go(x=47.4)
    part.valley([(42.4, -34.0, -44.0, (44.4, -45.0), 46.4),
                 (38.4, -36.0, -42.0, (42.4, -44.0), 42.4)] + second_bottom, 0.5)
    part.go(x=54.4)
    part.go(z=3.0)


part = fanuc("g71-pocket",
             "Type II: two valleys of 30 and 36 in 44; by 2 from 54 with .4 left. After each pass the tool follows "
             "the side up to the level before, as far as it rises, then goes back by .5 in X. Each valley is "
             "finished before the next; then the pass along all.")
part.go(54.0, 3.0)
rough_valleys(part, [], [])
part.go(x=44.4)
valleys(part, 0.4)
part.go(54.0, 3.0)

part = fanuc("g71-valleys-alone", "The same with parameter 5105.2 as 1: the levels, and no pass along the shape.",
             run="tests/motions/programs/fanuc/lathe-g71-pocket.nc",
             settings='[parameters]\n"5105.1" = 0\n"5105.2" = 1')
part.go(54.0, 3.0)
rough_valleys(part, [], [])
part.go(54.0, 3.0)

part = fanuc("g71-corners",
             "Corners in the profile are geometry: ,R3. between 20 and the face at Z-15 (from Z-12 to X26.), ,C2. "
             "at 40 (X36. to Z-17.). By 3 from 54 with .4 and .1 left; the level of 24 meets the fillet 1 under its "
             "middle, that of 36 the chamfer's foot.")
part.go(54.0, 2.0)
part.set_feed(0.2)
part.go(54.4, 2.1)
part.along([(48.4, -29.9), (42.4, -29.9), (36.4, -14.9), (30.4, -14.9), (24.4, -12.0 - leg(3.0, 1.0) + 0.1)],
           level=2.1, e=0.5)
part.go(x=20.4)
for u, w, f in ((0.4, 0.1, None), (0.0, 0.0, 0.1)):
    part.cut(z=-12.0 + w, f=f)
    part.round(26.0 + u, -15.0 + w, (26.0 + u, -12.0 + w), -1)
    part.cut(x=36.0 + u)
    part.cut(40.0 + u, -17.0 + w)
    part.cut(z=-30.0 + w)
    part.cut(x=54.0 + u)
    part.go(54.0, 2.0)
    if u:
        part.go(x=20.0)

part = fanuc("g71-round-pocket",
             "Type II: a round valley of radius 15 in 44, from Z-10 to Z-34: its middle is 9 over the surface (9, "
             "12, 15), its bottom 32. By 2 from 54 with .4 left; levels 10, 12 and 14 under the middle. The tool "
             "follows the arc up.")
part.go(54.0, 3.0)
part.set_feed(0.2)
part.go(54.4, 3.0)
MIDDLE = (62.4, -22.0)
for x, before in ((50.4, 54.4), (46.4, 50.4)):
    part.go(z=3.0)
    part.go(x=x)
    part.cut(z=-40.0)
    part.cut(x=before)
    part.go(x=before + 1.0)
REACH = {44.4: 12.0, 42.4: leg(15.0, 10.0), 38.4: 9.0, 34.4: leg(15.0, 14.0)}
for x, up, before in ((42.4, 44.4, 46.4), (38.4, 42.4, 42.4), (34.4, 38.4, 38.4)):
    part.go(z=-22.0 + REACH[x])
    part.cut(x=x)
    part.cut(z=-22.0 - REACH[x])
    part.round(up, -22.0 - REACH[up], MIDDLE, -1)
    part.go(x=before + 1.0)
part.go(x=54.4)
part.go(z=3.0)
part.go(x=44.4)
part.cut(z=-10.0)
part.round(44.4, -34.0, MIDDLE, -1)
part.cut(z=-40.0)
part.cut(x=54.4)
part.go(54.0, 3.0)

part = fanuc("g71-inside-pocket",
             "Type II in a bore of 30: a groove of 40 from Z-10 to Z-25, sides 5 over 5; by 1.5 from 26 with -.4 "
             "left.")
part.go(26.0, 3.0)
part.set_feed(0.15)
part.go(25.6, 3.0)
part.go(x=28.6)
part.cut(z=-35.0)
part.cut(x=25.6)
part.go(x=24.6)
part.valley([(31.6, -11.0, -24.0, (29.6, -25.0), 28.6), (34.6, -12.5, -22.5, (31.6, -24.0), 31.6),
             (37.6, -14.0, -21.0, (34.6, -22.5), 34.6)], 0.5, side=INSIDE)
part.go(x=25.6)
part.go(z=3.0)
part.go(x=29.6)
part.cut(z=-10.0)
part.cut(39.6, -15.0)
part.cut(z=-20.0)
part.cut(29.6, -25.0)
part.cut(z=-35.0)
part.cut(x=25.6)
part.go(26.0, 3.0)

part = fanuc("g71-slant",
             "Type II whose first move goes aslant, 14 in diameter over 8 along: the levels at 48.4 and 42.4 begin "
             "6 and 12 of these 14 down. The second follows the cone and then the face up to the first.")
part.go(54.0, 3.0)
part.set_feed(0.2)
part.go(54.4, 3.0)
part.go(z=3.0 - 8.0 * 6.0 / 14.0)
part.go(x=48.4)
part.cut(z=-26.0)
part.cut(x=54.4)
part.go(x=55.4)
part.go(z=3.0 - 8.0 * 12.0 / 14.0)
part.go(x=42.4)
part.cut(z=-22.0)
part.cut(46.4, -26.0)
part.cut(x=48.4)
part.go(x=49.4)
part.go(x=54.4)
part.go(z=3.0)
part.go(40.4, -5.0)
part.cut(z=-20.0)
part.cut(46.4, -26.0)
part.cut(x=54.4)
part.go(54.0, 3.0)

part = fanuc("g71-again",
             "One profile, roughed by 5 with 2. and .2 left, again by 4 with .4 and .1 left with another tool, then "
             "finished: 20 to Z-12, cone to 36 at Z-20, face to 50. The second cycle stands after its profile: the "
             "run goes on after the cycle. Sizes of the profile are in variables.")
part.go(50.0, 2.0)
for (u, w), f, e, passes in (((2.0, 0.2), 0.3, 1.0, [(42.0, -19.8), (32.0, -16.8)]),
                             ((0.4, 0.1), 0.2, 0.5, [(42.4, -19.9), (34.4, -18.9), (26.4, -14.9)])):
    part.set_feed(f)
    part.go(50.0 + u, 2.0 + w)
    part.along(passes, level=2.0 + w, e=e)
    part.go(x=20.0 + u)
    part.cut(z=-12.0 + w)
    part.cut(36.0 + u, -20.0 + w)
    part.cut(x=50.0 + u)
    part.go(50.0, 2.0)
    if u == 2.0:
        part.go(80.0, 30.0)
        part.go(50.0, 2.0)
part.go(x=20.0)
part.cut(z=-12.0, f=0.1)
part.cut(36.0, -20.0)
part.cut(x=50.0)
part.go(50.0, 2.0)
part.go(80.0)

part = fanuc("inch",
             "Inches: a step of .75 to Z-.5 from 1., by .1 with .02 (diameter) and .005 left; a hole of 1. in pecks "
             "of .25; a thread 13 to the inch, height .043, first .012, least .002, finish .002. P and Q count "
             ".0001.", unit=INCH)
part.go(1.05, 0.1)
part.set_feed(0.012)
part.go(1.07, 0.105)
part.along([(0.87, -0.495)], level=0.105, e=0.02)
part.go(x=0.77)
part.cut(z=-0.495)
part.cut(x=1.07)
part.go(1.05, 0.1)
part.go(0.0, 0.1)
part.face_pecks([0.0], [-0.15, -0.4, -0.65, -0.9, -1.0], 0.02, f=0.006)
part.go(z=0.2)
part.go(x=0.6)
part.screw(0.4069, -0.75, equal_chips(0.012, 0.002, 0.041) + [0.043], height=0.043, lead=0.0769, angle=60.0)

# ---------------------------------------------------------------------------------------------------------------------
# G72 and G73 on Fanuc.

# A flange on 60: face at Z-20 in to 50, cone to 40 at Z-12, 40 to Z-6, round of 6 to 28 at Z0, face to the middle.
FLANGE_ENDS = {-0.5: 28.0 + 2 * leg(6.0, 5.5), -3.0: 28.0 + 2 * leg(6.0, 3.0), -5.5: 28.0 + 2 * leg(6.0, 0.5),
               -8.0: 40.0, -10.5: 40.0, -13.0: 50.0 - 10.0 * 7.0 / 8.0,
               -15.5: 50.0 - 10.0 * 4.5 / 8.0, -18.0: 50.0 - 10.0 * 2.0 / 8.0}


def flange(part, u, w, f=None):
    part.cut(x=50.0 + u, f=f)
    part.cut(40.0 + u, -12.0 + w)
    part.cut(z=-6.0 + w)
    part.round(28.0 + u, 0.0 + w, (28.0 + u, -6.0 + w), -1)
    part.cut(x=-1.0 + u)


part = fanuc("g72-face",
             "A flange with a cone and a round of 6, faced by 2.5 from Z2. with .4 (diameter) and .2 left, then "
             "G70.")
part.go(64.0, 2.0)
part.set_feed(0.25)
part.go(64.4, 2.2)
part.across([(z + 0.2, FLANGE_ENDS[z] + 0.4) for z in sorted(FLANGE_ENDS, reverse=True)], level=64.4, e=0.4)
part.go(z=-19.8)
flange(part, 0.4, 0.2)
part.go(64.0, 2.0)
part.go(z=-20.0)
flange(part, 0.0, 0.0, f=0.1)
part.go(64.0, 2.0)

part = fanuc("g72-inside",
             "A counterbore faced outward from 20: bottom at Z-12 out to 40, cone to 44 at Z-4, 44 out of the hole; "
             "by 4 with -.4 and .1 left.")
part.go(20.0, 2.0)
part.set_feed(0.15)
part.go(19.6, 2.1)
part.across([(-1.9, 43.6), (-5.9, 40.0 + 4.0 * 6.0 / 8.0 - 0.4), (-9.9, 40.0 + 4.0 * 2.0 / 8.0 - 0.4)],
            level=19.6, e=0.5, side=INSIDE)
part.go(z=-11.9)
part.cut(x=39.6)
part.cut(43.6, -3.9)
part.cut(z=2.1)
part.go(20.0, 2.0)

part = fanuc("g72-pocket",
             "Type II: a valley in the face, 46 to 30, 6 deep, sides 4 (diameter) over 6; by 2 from Z3. with .2 "
             "left in Z. The first level runs to the end of the shape at 20, which lies deeper; the others follow "
             "the inner side up.")
part.go(54.0, 3.0)
part.set_feed(0.15)
part.go(54.0, 3.2)
part.go(z=1.2)
part.cut(x=20.0)
part.go(z=3.7)
for z, begin, end, flank, before in (
    (-0.8, 46.0 - 4.0 / 6.0, 30.0 + 4.0 / 6.0, (30.0, 0.2), 1.2),
    (-2.8, 44.0, 32.0, (30.0 + 4.0 / 6.0, -0.8), -0.8),
    (-4.8, 46.0 - 20.0 / 6.0, 30.0 + 20.0 / 6.0, (32.0, -2.8), -2.8),
):
    part.go(x=begin)
    part.cut(z=z)
    part.cut(x=end)
    part.cut(*flank)
    part.go(z=before + 0.5)
part.go(z=3.2)
part.go(x=54.0)
part.go(z=0.2)
part.cut(x=46.0)
part.cut(42.0, -5.8)
part.cut(x=34.0)
part.cut(30.0, 0.2)
part.cut(x=20.0)
part.go(54.0, 3.0)


def forged(part, u, w):
    """A pass along a forging, from X60. Z5., so far off: 20 from Z2 to Z-10, fillet of 5 to 30 at Z-15, face to 40,
    cone to 50 at Z-30."""
    part.go(60.0 + u, 5.0 + w)
    part.go(20.0 + u, 2.0 + w)
    part.cut(z=-10.0 + w)
    part.round(30.0 + u, -15.0 + w, (30.0 + u, -10.0 + w), -1)
    part.cut(x=40.0 + u)
    part.cut(50.0 + u, -30.0 + w)


part = fanuc("g73-forging",
             "Three passes over a forging with 6 (radius) and 3 of stock, .4 and .2 left: off by 12.4 and 3.2, by "
             "6.4 and 1.7, by .4 and .2. Then one pass only (R1), which leaves .4 and .2 whatever the stock is.")
part.go(60.0, 5.0)
part.set_feed(0.3)
for u, w in ((12.4, 3.2), (6.4, 1.7), (0.4, 0.2)):
    forged(part, u, w)
part.go(60.0, 5.0)
forged(part, 0.4, 0.2)
part.go(60.0, 5.0)

part = fanuc("g73-inside",
             "Two passes in a cast bore, 2 (radius) of stock to the middle and none in Z, nothing left: 40 to Z-12, "
             "cone to 30 at Z-22, out to 26. G1 in the first block: to depth at feed.")
part.go(26.0, 3.0)
part.set_feed(0.2)
for u in (-4.0, 0.0):
    part.go(26.0 + u, 3.0)
    part.cut(x=40.0 + u)
    part.cut(z=-12.0)
    part.cut(30.0 + u, -22.0)
    part.cut(x=26.0 + u)
part.go(26.0, 3.0)

# ---------------------------------------------------------------------------------------------------------------------
# G74 and G75 on Fanuc.

part = fanuc("g74-groove",
             "A face groove from 50 to 38, 8 deep, with a tool that steps 2.5 (radius): columns at 50, 45, 40 and "
             "38, pecks of 3 from Z2. back by .5; the last peck is 1, the last step 1. Relief of .2 but in the "
             "first column. Back to X50. Z2.")
part.go(50.0, 2.0)
part.face_pecks([50.0, 45.0, 40.0, 38.0], [-1.0, -4.0, -7.0, -8.0], 0.5, relief=0.2, f=0.1)
part.go(60.0, 20.0)

part = fanuc("g74-drill",
             "A hole of 25 in pecks of 8 from Z3., back by 1 each; the last peck is 4. Then a start of 5 in one go, "
             "without Q.")
part.go(0.0, 3.0)
part.face_pecks([0.0], [-5.0, -13.0, -21.0, -25.0], 1.0, f=0.15)
part.go(z=2.0)
part.face_pecks([0.0], [-5.0], 1.0, f=0.1)

part = fanuc("g75-groove",
             "A groove from 44 to 30, Z-20. to Z-28.: plunges at -20, -23.5, -27 and -28, pecks of 2 (radius) back "
             "by .3, the last 1; relief of .1 but in the first column.")
part.go(44.0, -20.0)
part.side_pecks([-20.0, -23.5, -27.0, -28.0], [40.0, 36.0, 32.0, 30.0], 0.3, relief=0.1, f=0.08)
part.go(80.0)

part = fanuc("g75-inside",
             "A groove in a bore, 30 out to 36 in pecks of 1.25 (radius), one column; then cut off from 42 to -1 in "
             "pecks of 8: 26, 10, -1.")
part.go(20.0, 5.0)
part.go(z=-10.0)
part.go(x=30.0)
part.side_pecks([-10.0], [32.5, 35.0, 36.0], 0.25, f=0.06)
part.go(z=20.0)
part.go(42.0)
part.go(z=-50.0)
part.side_pecks([-50.0], [26.0, 10.0, -1.0], 0.25, f=0.05)

part = fanuc("g75-one-block",
             "The older form in one block: the groove of before by I2. K3.5 D.1, the face groove by I2.5 K3. D.2, and the hole of 25 by "
             "K8. alone. Parameter 5139 is the way back, .3.",
             settings='[parameters]\n"0001.1" = 1\n5139 = 0.3')
part.go(44.0, -20.0)
part.side_pecks([-20.0, -23.5, -27.0, -28.0], [40.0, 36.0, 32.0, 30.0], 0.3, relief=0.1, f=0.08)
part.go(80.0)
part.go(z=2.0)
part.go(50.0)
part.face_pecks([50.0, 45.0, 40.0, 38.0], [-1.0, -4.0, -7.0, -8.0], 0.3, relief=0.2, f=0.1)
part.go(0.0, 3.0)
part.face_pecks([0.0], [-5.0, -13.0, -21.0, -25.0], 0.3, f=0.15)

# ---------------------------------------------------------------------------------------------------------------------
# Threads on Fanuc.

part = fanuc("g76-outside",
             "M20 by 2.5, height 1.5, root 17: first .4, least .1, finish .05 in two passes, 60 degrees: the tool "
             "goes .577 of its depth along.")
part.go(24.0, 5.0)
part.screw(17.0, -30.0, equal_chips(0.4, 0.1, 1.45) + [1.5, 1.5], height=1.5, lead=2.5, angle=60.0)
part.go(40.0)

part = fanuc("g76-inside",
             "M30 by 1.5 in a bore, height .92: first .3, least .08, finish .03 in one pass; the end is given by U "
             "and W.")
part.go(26.0, 4.0)
part.screw(30.0, -20.0, equal_chips(0.3, 0.08, 0.89) + [0.92], height=0.92, lead=1.5, side=INSIDE, angle=60.0)

part = fanuc("g76-taper",
             "Tapered threads, straight in and at 55 degrees: outside, 1.25 (radius) smaller at the start 40 before "
             "the end (R-1.25); inside, .8 larger there (R.8). With the flank the tool begins later on the same "
             "cone.")
part.go(34.0, 3.0)
part.screw(30.0, -37.0, equal_chips(0.5, 0.1, 1.4) + [1.479], height=1.479, lead=2.309, angle=55.0, taper=-1.25)
part.go(60.0, 3.0)
part.go(18.0)
part.screw(24.0, -21.0, equal_chips(0.45, 0.15, 1.0) + [1.0], height=1.0, lead=2.0, side=INSIDE, taper=0.8)

part = fanuc("g76-one-pass",
             "The first depth .9 is more than height less finish (.9 - .05): one pass at .85, then the finish. No "
             "angle, no chamfer.")
part.go(16.0, 3.0)
part.screw(10.2, -12.0, [0.85, 0.9], height=0.9, lead=1.5)

part = fanuc("g76-one-block",
             "The older form in one block: the M20 by 2.5, parameters 5140 .1, 5141 .05 and 5142 2. P4, a tapered bore, both flanks in turn, "
             "I.8, A55: .3, .6, .9, .95, then two at 1. P3, straight in, one flank.",
             settings='[parameters]\n"0001.1" = 1\n5130 = 0\n5140 = 0.1\n5141 = 0.05\n5142 = 2')
part.go(24.0, 5.0)
part.screw(17.0, -30.0, equal_chips(0.4, 0.1, 1.45) + [1.5, 1.5], height=1.5, lead=2.5, angle=60.0)
part.go(60.0)
part.go(z=3.0)
part.go(x=18.0)
part.screw(24.0, -21.0, [0.3, 0.6, 0.9, 0.95, 1.0, 1.0], height=1.0, lead=2.0, side=INSIDE, angle=55.0, taper=0.8, both=True)
part.go(10.0)
part.screw(24.0, -21.0, [0.3, 0.6, 0.9, 0.95, 1.0, 1.0], height=1.0, lead=2.0, side=INSIDE)

part = fanuc("g92-thread",
             "Passes at 19.2, 18.7, 18.4 from X24. Z4.; a taper of -.8 that the next pass keeps; a bore with .5; Z "
             "by W.")
part.go(24.0, 4.0)
for x in (19.2, 18.7, 18.4):
    part.threaded(x, -22.0, lead=1.5)
part.go(26.0, 5.0)
for x in (18.0, 17.6):
    part.threaded(x, -22.0, taper=-0.8, lead=2.0)
part.go(16.0, 5.0)
part.threaded(20.0, -15.0, taper=0.5, lead=1.25)
part.threaded(20.4, -15.0, taper=0.5, lead=1.25)
part.threaded(20.4, 5.0 - 18.0, taper=0.5, lead=1.25)

part = fanuc("g32-thread",
             "Straight, with a cone after it in the same turn, across the face, and with a lead that grows (G34).")
part.go(19.0, 4.0)
part.thread(z=-20.0, lead=2.0)
part.go(x=24.0)
part.go(z=4.0)
part.go(x=18.0)
part.thread(z=-20.0, lead=2.0)
part.thread(22.0, -36.0, lead=2.0)
part.thread(26.0, -40.0, lead=2.0)
part.go(60.0)
part.go(z=-1.0)
part.thread(x=20.0, lead=3.0)
part.go(z=5.0)
part.go(x=30.0)
part.thread(z=-40.0, lead=2.0)

# ---------------------------------------------------------------------------------------------------------------------
# Single cycles on Fanuc.

part = fanuc("g90-turn",
             "46 and 42 to Z-40., 38 to Z-30., 34 by U-18.; an outside taper that starts 3 (radius) smaller (R-3.), "
             "kept by the next block; a bore that starts 2 larger (R2.), then Z by W.")
part.go(52.0, 2.0)
for x, z in ((46.0, -40.0), (42.0, -40.0), (38.0, -30.0), (52.0 - 18.0, -30.0)):
    part.turned(x, z, f=0.25)
part.go(60.0, 2.0)
for x in (50.0, 46.0):
    part.turned(x, -20.0, taper=-3.0, f=0.2)
part.go(20.0, 2.0)
part.turned(24.0, -15.0, taper=2.0, f=0.1)
part.turned(28.0, 2.0 - 10.0, taper=2.0)

part = fanuc("g94-face",
             "Three faces from 52 to 20; a cone that is 2 deeper at the outside (R-2.), kept by the next block; one "
             "that is 3 less deep there (R3.).")
part.go(52.0, 2.0)
for z in (-1.0, -2.0, -3.0):
    part.faced(20.0, z, f=0.2)
part.go(54.0, 3.0)
for z in (-5.0, -6.0):
    part.faced(20.0, z, taper=-2.0, f=0.15)
part.go(54.0, 4.0)
part.faced(20.0, -9.0, taper=3.0)

# ---------------------------------------------------------------------------------------------------------------------
# Coordinates on Fanuc.

part = fanuc("offsets",
             "Tool 3 is 4 smaller in X and 12.5 farther in Z, tool 4 is set by G10; neither word moves anything. An "
             "increment does not bring the offset; a word of one axis brings it in that axis only. Then G52, G53, "
             "G50 and G28.",
             settings="[parameters]\n8136.6 = 1",
             tables='[[state]]\nstate = "offset.lathe.x"\nsubscripts = [3]\nvalue = -4.0\n'
                    '[[state]]\nstate = "offset.lathe.z"\nsubscripts = [3]\nvalue = 12.5')
part.go(80.0, 40.0)
part.go(50.0 - 4.0, 5.0 + 12.5)
part.feed_by(x=2.0, f=0.2)
part.feed_by(z=-3.0)
part.go(x=50.0)
part.go(z=5.0)
part.go(50.0 + 2.0, 5.0 - 1.5)
part.go(50.0, 5.0)
part.go(20.0 + 10.0, 0.0 - 3.0)
part.go(20.0, 0.0)
part.machine(x=250.0, z=90.0)
# The tool stands at X100. Z50. from here on.
part.shift = (250.0 - 100.0, 0.0, 90.0 - 50.0)
part.go(60.0, 10.0)
part.by(x=5.0)
part.machine(x=400.0)
part.machine(z=350.0)

part = fanuc("arcs",
             "Arcs by R and by I, K (radius) in both senses, outside and in, in increments too; feed a minute, "
             "dwells.")
part.go(20.0, 1.0)
part.cut(z=-10.0, f=0.2)
part.round(32.0, -16.0, (32.0, -10.0), -1)
part.round(40.0, -20.0, (32.0, -20.0), 1)
part.cut(z=-30.0)
part.round(60.0, -40.0, (60.0, -30.0), -1)
part.dwell(0.5)
part.go(70.0)
part.go(z=2.0)
part.go(x=30.0)
part.mode = "per_minute"
part.cut(z=-5.0, f=150.0)
part.round(24.0, -8.0, (24.0, -5.0), 1)
part.cut(z=-11.0)
part.round(16.0, -15.0, (24.0, -15.0), -1)
part.dwell(0.25)
part.go(z=2.0)

part = fanuc("drill",
             "Live drill on the face: holes at X40. C0., C90. and C180. from the plane 3 under the start (R-3.), "
             "out in rapid (G83) and at feed with a wait of .3 s (G85); system A always goes back to the start.",
             settings='axes = ["X", "Z", "C"]')
part.mode = "per_minute"
part.go(40.0, 5.0)
part.hole(40.0, None, r=2.0, bottom=-12.0, back=5.0, f=60.0)
part.hole(40.0, None, r=2.0, bottom=-12.0, back=5.0)
part.hole(40.0, None, r=2.0, bottom=-12.0, back=5.0, dwell=0.3, out="feed")
part.go(100.0)

# ---------------------------------------------------------------------------------------------------------------------
# Roughing on Haas: a last level on the bottom; a pass along the shape only with I or K.

part = haas("g71-outside",
            "The stepped shaft of the Fanuc list in one block (D2.5, no I, no K): the same levels, one more on the "
            "bottom at 20.4, and no pass along the shape. G70 at .12.", "73=0.5")
part.go(64.0, 2.0)
part.set_feed(0.3)
part.go(64.4, 2.1)
part.along([(x + 0.4, SHAFT_ENDS[x] + 0.1) for x in sorted(SHAFT_ENDS, reverse=True)] + [(20.4, -14.9)],
           level=2.1, e=0.5)
part.go(64.0, 2.0)
part.go(x=20.0)
stepped(part, 0.0, 0.0, (0.12, None))
part.go(64.0, 2.0)

part = haas("g71-allowance",
            "20 to Z-15, corner of 5 to the face at Z-20, from 50: by 4 with .4 and .1 for finishing and .3 "
            "(radius) and .1 more for roughing: levels 1. off, the last on the bottom; then the pass along the "
            "shape, .4 and .1 off. P with G1: to depth at feed.", "73=0.4")
part.go(50.0, 1.0)
part.set_feed(0.25)
part.go(51.0, 1.2)
part.along([(43.0, -19.8), (35.0, -19.8), (27.0, -15.0 - leg(5.0, 2.0) + 0.2), (21.0, -14.8)],
           level=1.2, e=0.4, how="feed")
part.cut(20.4, 1.1)
part.cut(z=-14.9)
part.round(30.4, -19.9, (30.4, -14.9), -1)
part.cut(x=50.4)
part.go(50.0, 1.0)

part = haas("g71-inside",
            "The bore of the Fanuc list in one block: D2., U-.6 W.1: the same levels and the bottom at 49.4.", "73=0.5")
part.go(18.0, 2.0)
part.set_feed(0.25)
part.go(17.4, 2.1)
part.along([(x - 0.6, BORE_ENDS[x] + 0.1) for x in sorted(BORE_ENDS)] + [(49.4, -9.9)], level=2.1, e=0.5, side=INSIDE)
part.go(18.0, 2.0)
part.go(x=50.0)
bored(part, 0.0, 0.0, f=0.1)
part.go(18.0, 2.0)

part = haas("g71-deep", "36 by 20 from 40 by 5, nothing left: one level, on the bottom.", "73=0.3")
part.go(40.0, 1.0)
part.set_feed(0.2)
part.along([(36.0, -20.0)], level=1.0, e=0.3)
part.go(40.0, 1.0)

part = haas("g71-pocket",
            "The two valleys of the Fanuc list in one block: a level on each bottom (30.4 and 36.4), no pass along "
            "the shape.", "33=fanuc 73=0.5")
part.go(54.0, 3.0)
rough_valleys(part, [(30.4, -12.0, -20.0, (34.4, -22.0), 34.4)], [(36.4, -37.0, -41.0, (38.4, -42.0), 38.4)])
part.go(54.0, 3.0)

part = haas("g71-yasnac",
            "Setting 33 is YASNAC: R1 asks for type 2 though the first block has X only. A valley of 30 from Z-5 to "
            "Z-27 in 44: levels 42.4, 38.4, 34.4 and the bottom.", "33=yasnac 73=0.5")
part.go(46.0, 3.0)
part.set_feed(0.2)
part.go(46.4, 3.0)
part.valley([(42.4, -6.0, -26.0, (44.4, -27.0), 46.4), (38.4, -8.0, -24.0, (42.4, -26.0), 42.4),
             (34.4, -10.0, -22.0, (38.4, -24.0), 38.4), (30.4, -12.0, -20.0, (34.4, -22.0), 34.4)], 0.5)
part.go(x=46.4)
part.go(z=3.0)
part.go(46.0, 3.0)

part = haas("g71-two-block",
            "The two-block form of the newer control: U2. (radius) R.6, then P Q U W: levels at 36.4 and 32.4, the "
            "bottom at 30.4.", "73=0.5")
part.go(40.0, 2.0)
part.set_feed(0.2)
part.go(40.4, 2.1)
part.along([(36.4, -24.9), (32.4, -24.9), (30.4, -24.9)], level=2.1, e=0.6)
part.go(40.0, 2.0)
part.go(x=30.0)
part.cut(z=-25.0, f=0.1)
part.cut(x=40.0)
part.go(40.0, 2.0)

part = haas("g72-face",
            "The flange of the Fanuc list in one block: D2.5 U.4 W.2: the same levels and the bottom at -19.8.",
            "73=0.4")
part.go(64.0, 2.0)
part.set_feed(0.25)
part.go(64.4, 2.2)
part.across([(z + 0.2, FLANGE_ENDS[z] + 0.4) for z in sorted(FLANGE_ENDS, reverse=True)] + [(-19.8, 50.4)],
            level=64.4, e=0.4)
part.go(64.0, 2.0)

part = haas("g72-two-block",
            "The two-block form: W3. R.5, then P Q U W: a counterbore faced outward from 20, levels at -1.9 and "
            "-4.9, the bottom at -6.9.", "73=0.2")
part.go(20.0, 1.0)
part.set_feed(0.15)
part.go(19.6, 1.1)
part.across([(-1.9, 43.6), (-4.9, 43.6), (-6.9, 43.6)], level=19.6, e=0.5, side=INSIDE)
part.go(20.0, 1.0)

part = haas("g73-forging", "The forging of the Fanuc list: I6. K3. D3 U.4 W.2, then D1.")
part.go(60.0, 5.0)
part.set_feed(0.3)
for u, w in ((12.4, 3.2), (6.4, 1.7), (0.4, 0.2)):
    forged(part, u, w)
part.go(60.0, 5.0)
forged(part, 0.4, 0.2)
part.go(60.0, 5.0)

# ---------------------------------------------------------------------------------------------------------------------
# Pecks, threads, single cycles and home on Haas.

part = haas("g74-groove",
            "The face groove of the Fanuc list: I2.5 K3. D.2, setting 22 is .5. Then a hole of 25 by K8.", "22=0.5")
part.go(50.0, 2.0)
part.face_pecks([50.0, 45.0, 40.0, 38.0], [-1.0, -4.0, -7.0, -8.0], 0.5, relief=0.2, f=0.1)
part.go(0.0, 3.0)
part.face_pecks([0.0], [-5.0, -13.0, -21.0, -25.0], 0.5, f=0.15)

part = haas("g75-groove",
            "From 44 to 30, Z-20. to Z-27. in steps of 3.5, no smaller last one; pecks of 2 (radius), the last 1; "
            "relief .1. Cut off by I3. without Z: 36, 30 and so on to 0.", "22=0.3")
part.go(44.0, -20.0)
part.side_pecks([-20.0, -23.5, -27.0], [40.0, 36.0, 32.0, 30.0], 0.3, relief=0.1, f=0.08)
part.go(42.0)
part.go(z=-50.0)
part.side_pecks([-50.0], [36.0, 30.0, 24.0, 18.0, 12.0, 6.0, 0.0], 0.3, f=0.05)

part = haas("g76-outside", "The thread of the Fanuc list: K1.5 D.4 A60, settings 86 .05 and 99 .1; one finish pass.",
            "86=0.05 95=1 96=45 99=0.1")
part.go(24.0, 5.0)
part.screw(17.0, -30.0, equal_chips(0.4, 0.1, 1.45) + [1.5], height=1.5, lead=2.5, angle=60.0)
part.go(40.0)

part = haas("g76-steps",
            "P3: steps of .4, no finish (setting 86 is 0): .4, .8, 1.2, 1.5. Straight in. Then a tapered bore, I.8, "
            "by U and W, equal chips without a least one.", "86=0 95=0 96=45 99=0")
part.go(24.0, 5.0)
part.screw(17.0, -30.0, [0.4, 0.8, 1.2, 1.5], height=1.5, lead=2.5)
part.go(60.0)
part.go(z=3.0)
part.go(x=18.0)
part.screw(24.0, -21.0, equal_chips(0.5, 0.0, 1.0), height=1.0, lead=2.0, side=INSIDE, taper=0.8)

part = haas("g76-flanks",
            "Both flanks in turn. P2: K1.5 D.4 A60, equal chips, settings 86 .05 and 99 .1, one finish pass. P4: a tapered bore, "
            "I.8, A55, steps of .3 to .95, then the finish pass at 1.",
            "86=0.05 95=0 96=45 99=0.1")
part.go(24.0, 5.0)
part.screw(17.0, -30.0, equal_chips(0.4, 0.1, 1.45) + [1.5], height=1.5, lead=2.5, angle=60.0, both=True)
part.go(60.0)
part.go(z=3.0)
part.go(x=18.0)
part.screw(24.0, -21.0, [0.3, 0.6, 0.9, 0.95, 1.0], height=1.0, lead=2.0, side=INSIDE, angle=55.0, taper=0.8, both=True)

part = haas("g90-turn", "Straight passes, U, a taper by I-3. that the next block keeps.")
part.go(52.0, 2.0)
for x, z in ((46.0, -40.0), (42.0, -40.0), (52.0 - 18.0, -30.0)):
    part.turned(x, z, f=0.25)
part.go(60.0, 2.0)
for x in (50.0, 46.0):
    part.turned(x, -20.0, taper=-3.0, f=0.2)

part = haas("g92-thread", "Three passes, then a taper by I-.8.", "95=0 96=45")
part.go(24.0, 4.0)
for x in (19.2, 18.7, 18.4):
    part.threaded(x, -22.0, lead=1.5)
part.go(26.0, 5.0)
part.threaded(18.0, -22.0, taper=-0.8, lead=2.0)

part = haas("g94-face", "Two faces, then cones by K-2. and K3.")
part.go(52.0, 2.0)
for z in (-1.0, -2.0):
    part.faced(20.0, z, f=0.2)
part.go(54.0, 3.0)
part.faced(20.0, -5.0, taper=-2.0, f=0.15)
part.go(54.0, 4.0)
part.faced(20.0, -9.0, taper=3.0)

part = haas("home", "Home by G28 without an axis, a turn, X and then Z home by G53 with G0, and G154 P5.",
            home=(0.0, 0.0, 0.0),
            offsets={1: (5.0, 0.0, -120.0), 105: (20.0, 0.0, -200.0)})
part.machine(x=0.0, z=0.0)
part.go(40.0, 2.0)
part.cut(z=-20.0, f=0.2)
part.feed_by(x=4.0)
part.feed_by(x=2.0, z=-5.0)
part.machine(x=0.0)
part.machine(z=-50.0)
part.work(105)
part.go(40.0, 2.0)
part.machine(x=-10.0)

# ---------------------------------------------------------------------------------------------------------------------
# Alarms: the tool has come to the start of the cycle, and no farther.

for name, about in [
    ("turns-back", "Type I, but X goes from 30 back to 26: alarm 329 before the first pass."),
    ("beyond-start", "The profile ends at 52, the cycle begins at 50: alarm 322."),
    ("no-block", "Q names a block that is not there: alarm 063."),
    ("no-depth", "U0. in the first block: alarm 062."),
    ("first-block", "The first block of the profile is an arc: alarm 065."),
    ("angle", "A thread of 45 degrees: alarm 315."),
]:
    part = fanuc(f"alarm-{name}", about, ends="alarm")
    part.go(50.0, 2.0)
