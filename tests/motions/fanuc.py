"""Programs of the Fanuc seminar (seed 001) and of the digit-chain article (seed 003).

Values that a macro computes for a word are rounded to its least increment: .001 mm, .0001 inch. X of a
lathe is the diameter, in the program and in the trace.
"""

from decimal import ROUND_HALF_UP, Decimal

from motion import INCH, Motion, cos, sin, tan

LATHE = 'machine = "lathe"\nunits = "inch"'
HOME = (200.0, 0.0, 150.0)


def least(value, increment="0.0001"):
    return float((Decimal(repr(value)) / Decimal(increment)).quantize(Decimal(1), ROUND_HALF_UP) * Decimal(increment))


class Turned(Motion):
    """A part on the lathe, inches; per_turn feeds unless told otherwise."""

    def __init__(self, name, about, *, run=None, **more):
        more = {"start": (100.0, 0.0, 50.0), "home": HOME, "profile": LATHE, **more}
        super().__init__("fanuc", name, run or [f"corpus/fanuc/{name}.nc"], about, unit=INCH, **more)
        self.mode = "per_turn"

    def go(self, x=None, z=None):
        self.rapid(x, None, z)

    def cut(self, x=None, z=None, f=None):
        self.feed(x, None, z, f)


# The frame of holes: 6 across 16 apart, 5 up 14 apart, without the first one again.
part = Motion("fanuc", "o0023-frame-main", ["corpus/fanuc/o0023-frame-main.nc", "corpus/fanuc/o8103-frame-macro.nc"],
              "18 holes round a frame of 6 by 5 from X10. Y9.5, 16 and 14 apart; the cycle keeps the planes that it was\n"
              "given under G90 while the macro moves under G91 (ambiguities.md 2). G99: the tool stays at R2.5.\n"
              "U6 V5 are 6 and 5 with calculator-type input only (errata 46).",
              offsets={1: (30.0, 40.0, -200.0)}, tools={1: 55.5}, start=(1.0, 2.0, 3.0), home=(0.0, 0.0, 10.0),
              profile='units = "metric"\ndecimal_point = "calculator"')
part.work(1)
part.rapid(0.0, 0.0)
part.tool(1)
part.rapid(z=25.0)
frame = [(16 * at, 0) for at in range(6)] + [(80, 14 * at) for at in range(1, 5)]
frame += [(80 - 16 * at, 56) for at in range(1, 6)] + [(0, 56 - 14 * at) for at in range(1, 4)]
for x, y in frame:
    part.hole(10 + x, 9.5 + y, r=2.5, bottom=-14.7, f=150.0)
part.rapid(z=25.0)
part.machine(z=10.0)

# Rounding of addresses: seed 001:1172.
part = Motion("fanuc", "round-return", ["corpus/fanuc/round-return.nc"],
              "1.2345 and 2.3456 go as 1.235 and 2.346, their sum 3.5801 as 3.580: the return ends .001 off\n"
              "(seed 001:1172).", profile='units = "metric"\ndecimal_point = "calculator"',
              tables='[variables]\n"#1" = 1.2345\n"#2" = 2.3456', start=(50.0, 0.0, 0.0))
part.by(-1.235)
part.feed_by(-2.346, f=300.0)
part.by(3.58)

part = Motion("fanuc", "o0001-g65-l2", ["corpus/fanuc/o0001-g65-l2.nc", "corpus/fanuc/o9010-g65-l2.nc"],
              "X3. twice, in steps (seed 001:1871).", profile='units = "metric"')
part.by(3.0)
part.by(3.0)

# Modal calls: (1-1) (2-1) (1-2) (3-1) (2-1) (3-2) (2-1) (1-3), seed 001:2575-2591.
nest = ["corpus/fanuc/o9100-g66-nesting.nc", "corpus/fanuc/o9200-g66-nesting.nc"]
part = Motion("fanuc", "g66-nesting-main", ["corpus/fanuc/g66-nesting-main.nc", *nest],
              "The order of seed 001:2591 with absolute coordinates: Z50. moves the first time only.",
              profile='units = "metric"')
for x, y, z in [(10, None, None), (None, None, 50), (15, None, None), (60, None, None), (None, 70, None), (-25, None, None)]:
    part.rapid(x, y, z)
part = Motion("fanuc", "g66-incremental", ["tests/motions/programs/fanuc/g66-incremental.nc", *nest],
              "The order of seed 001:2591 in steps, so that every move shows.", profile='units = "metric"')
for x, y, z in [(10, 0, 0), (0, 0, 50), (15, 0, 0), (60, 0, 0), (0, 0, 50), (0, 70, 0), (0, 0, 50), (-25, 0, 0)]:
    part.by(x, y, z)

# Grooves.
part = Turned("groove-width", "Two plunges, the second .307 + #514 along, with #514 = .005.",
              tables='[variables]\n"#514" = 0.005')
part.go(0.55, 0.3)
part.cut(0.4, f=0.003)
part.go(0.55)
part.go(z=0.312)
part.cut(0.4)
part.go(1.18)

part = Turned("family-groove", "The groove of part 2: Z.4 (table at seed 001:549).", tables='[variables]\n"#514" = 0.4')
part.go(0.55, 0.4)
part.cut(0.4, f=0.003)
part.go(1.18)

part = Turned("call-p9014", "The groove at Z.3 from the argument A.3.",
              run=["corpus/fanuc/call-p9014.nc", "corpus/fanuc/o9014-groove-macro.nc"])
part.go(0.55, 0.3)
part.cut(0.4, f=0.003)
part.go(1.18)

# Turned faces with tools that are counted.
part = Turned("o1204-tool-life", "Face with a chamfer, home in X, then a drilled face. G28U0 goes home in X from where it stands.",
              tables='[variables]\n"#505" = 100\n"#506" = 3\n"#507" = 100\n"#508" = 4')
part.go(0.55, 0.05)
part.cut(0.52, 0.015, f=0.005)
part.cut(0.49, 0.0, f=0.001)
part.cut(-0.015)
part.go(z=-0.05)
part.machine(x=HOME[0])
part.go(0.0, -0.05)
part.cut(z=0.1, f=0.002)
part.go(z=-0.05)
part.machine(x=HOME[0])

part = Turned("o1204-tool-life-change", "The same face with the second tool of the group.",
              tables='[variables]\n"#511" = 5\n"#512" = 5\n"#513" = 2')
part.go(0.55, 0.05)
part.cut(0.52, 0.015, f=0.005)
part.cut(0.49, 0.0, f=0.001)
part.cut(-0.015)
part.go(z=-0.05)
part.machine(x=HOME[0])

part = Turned("o1234-tool-life-time", "Two tools come to X1. Z0 and go home in X; M201 to M203 call macros that do not move.",
              run=[f"corpus/fanuc/{name}.nc" for name in
                   ("o1234-tool-life-time", "o9001-timer-start", "o9002-accumulate", "o9003-tool-life-alarms-12tools")],
              profile=LATHE + "\n[parameters]\n6071 = 201\n6072 = 202\n6073 = 203")
for _ in range(2):
    part.go(1.0, 0.0)
    part.machine(x=HOME[0])

part = Turned("ex-skip-move", "The probe touches at Z1.25 on its way from Z1.5 to Z1. at 4 inches a minute.",
              scenario="probes = [{ part = 0.5 }]")
part.go(z=1.5)
part.probe((None, None, 1.0), (100.0, 0.0, 1.25 * INCH), f=4.0)

# Cut-off: M910 calls O9020 with D1.0 X-.04 F.002; the tool stands above X0, so it cuts.
part = Turned("call-m910", "Home in X, to .05 over the bar of 1., off to X-.04 at .002 a turn.",
              run=["corpus/fanuc/call-m910.nc", "corpus/fanuc/o9020-auto-cutoff.nc"],
              profile=LATHE + '\ndecimal_point = "calculator"\n[parameters]\n6080 = 910\n'
                              '[[site]]\ncode = "M10"\ntext = "collet"\n[[site]]\ncode = "M60"\ntext = "catcher"')
part.machine(x=HOME[0])
part.go(1.05)
part.cut(-0.04, f=0.002)

# Pecks that shrink by a fifth from .3, not below .15, from R.1 to Z-1.
part = Turned("g383-call", "O9018: pecks of .3, .24, .192, .1536, then .15 where the fifth less would be smaller; each from\n"
                           "E.02 above the last depth and back to the start. The last one goes to Z-1. with T.5 s.\n"
                           "The first depth counts from R-E (.08).",
              run=["tests/motions/programs/fanuc/g383-call.nc", "corpus/fanuc/o9018-g383-peck.nc"],
              profile=LATHE + "\n[parameters]\n6058 = 383")
part.mode = "per_minute"
part.go(0.0, 1.0)
depth, peck = 0.08, 0.3
while depth - peck > -1:
    part.go(z=least(depth + 0.02))
    depth = least(depth - peck)
    part.cut(z=depth, f=5.0)
    part.go(z=1.0)
    peck = max(peck * 0.8, 0.15)
part.go(z=least(depth + 0.02))
part.cut(z=-1.0, f=5.0)
part.dwell(0.5)
part.go(z=1.0)
part.go(z=2.0)

# Pecks of .4 along a line at 30 degrees in Y and Z.
part = Turned("g183-call", "O9019: four whole pecks of .4 at 30 degrees from Z.5 to Z2., Y falling; each step is rounded to\n"
                           ".0001. After each the tool backs off .05 and returns to the start at R20.; then along the\n"
                           "line to Z2., one second, and back.",
              run=["tests/motions/programs/fanuc/g183-call.nc", "corpus/fanuc/o9019-g183-angled.nc"],
              profile=LATHE + '\naxes = ["X", "Z", "C", "Y"]\n[parameters]\n6059 = 183')
part.mode = "per_minute"
part.rapid(0.0, 1.0, 0.5)
escape, end = (1.0, 0.5), (1.0, 0.5)
for peck in range(int(1.5 / cos(30) / 0.4)):
    part.feed(None, *escape, f=20.0)
    part.feed(None, *end, f=4.0)
    end = (least(end[0] - least(0.4 * sin(30))), least(end[1] + least(0.4 * cos(30))))
    part.feed(None, *end)
    escape = (least(end[0] + least(0.05 * sin(30))), least(end[1] - least(0.05 * cos(30))))
    part.feed(None, *escape)
    part.feed(None, 1.0, 0.5, f=20.0)
part.feed(None, *escape, f=20.0)
part.feed(None, *end, f=4.0)
part.feed(None, least(end[0] - least((2 - end[1]) * tan(30))), 2.0)
part.dwell(1.0)
part.feed(None, 1.0, 0.5, f=20.0)
part.rapid(None, None, 0.0)

# Drilling cycles: the initial level is where the tool stood when the cycle began; under G91 R counts from there and
# Z from R. A dwell lasts for the cycles that take one. Taps come out with the spindle turned back.
MILL = dict(profile='units = "metric"', start=(1.0, 2.0, 50.0), offsets={1: (30.0, 40.0, -200.0)}, tools={1: 50.0}, turns=True)
part = Motion("fanuc", "taps", ["tests/motions/programs/fanuc/taps.nc"],
              "G74 with M04, at R3. (G99) and back to Z20. (G98); G84 twice by K2 under G91 from R20-16 to 4-14; a tap by G84.2;\n"
              "G82 dwells .7 s, G81 and G83 take no P, G89 takes the .7 of before. Q5. from R4.: -1, -6, -8.", **MILL)
part.spindle("counter_clockwise", 400.0)
part.work(1)
part.rapid(0.0, 0.0)
part.tool(1)
part.rapid(z=20.0)
part.tap(10.0, 5.0, r=3.0, bottom=-12.0, f=500.0, dwell=0.3)
part.tap(20.0, 5.0, r=3.0, bottom=-12.0, dwell=0.3, back=20.0)
part.spindle("clockwise")
for x in (30.0, 40.0):
    part.tap(x, 5.0, r=20.0 - 16.0, bottom=4.0 - 14.0, f=300.0)
part.tap(50.0, 5.0, r=4.0, bottom=-6.0, f=250.0, dwell=0.1, back=20.0)
part.hole(60.0, 5.0, r=4.0, bottom=-2.0, dwell=0.7, back=20.0)
part.hole(70.0, 5.0, r=4.0, bottom=-2.0, back=20.0)
part.hole(80.0, 5.0, r=4.0, bottom=-2.0, f=100.0, dwell=0.7, out="feed", back=20.0)
part.peck(90.0, 5.0, r=4.0, bottom=-8.0, steps=[5, 5, 5], back=20.0)
part.feed(95.0)

part = Motion("fanuc", "bores", ["tests/motions/programs/fanuc/bores.nc"],
              "Each bore back to the initial level (G98) and to R2. (G99). G76: the tool goes aside by Q at the bottom and comes back over\n"
              "the hole where the cycle ends; which way is a parameter, taken for +X, and the sign of Q does not count (B-63324EN/03\n"
              "p. 295). G86: the spindle turns again there too. G87: aside, through to R-25., up to Z-20.; G80 left the tool at R2., so\n"
              "that is its initial level. Then three by K3 and two by L2 under G91.", **MILL)
part.spindle("clockwise", 600.0)
part.work(1)
part.rapid(0.0, 0.0)
part.tool(1)
part.rapid(z=30.0)
part.set_feed(60.0)
for y, back in ((5.0, 30.0), (15.0, None)):
    part.bore_finely(10.0, y, r=2.0, bottom=-8.0, by=(0.5, 0.0), dwell=0.2, back=back)
for y, back in ((5.0, 30.0), (15.0, None)):
    part.bore_and_stop(20.0, y, r=2.0, bottom=-8.0, back=back)
for y, bottom, back in ((5.0, -8.0, 30.0), (15.0, -4.0, None)):
    part.hole(30.0, y, r=2.0, bottom=bottom, out="feed", back=back)
for y, back in ((5.0, 30.0), (15.0, None)):
    part.bore_by_hand(40.0, y, r=2.0, bottom=-4.0, dwell=0.1, back=back)
for y, back in ((5.0, 30.0), (15.0, None)):
    part.hole(50.0, y, r=2.0, bottom=-4.0, dwell=0.25, out="feed", back=back)
for y in (5.0, 15.0):
    part.bore_back(60.0, y, r=-25.0, bottom=-20.0, by=(1.0, 0.0), dwell=0.05, f=40.0, back=2.0)
part.rapid(z=30.0)
for x in (50.0, 40.0, 30.0):
    part.hole(x, 15.0, r=30.0 - 28.0, bottom=2.0 - 5.0, out="feed", back=30.0)
for x in (20.0, 10.0):
    part.hole(x, 15.0, r=2.0, bottom=2.0 - 4.0, out="feed")
part.rapid(z=60.0)
