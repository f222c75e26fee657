"""Short programs for the passes of legalization (src/legalize/): the same moves must come of the conversion.

Each `to` names a target and the files that put something in another's place on the way there. Numbers are such that
no word is rounded, or are rounded here to the least increment that both controls have.
"""

from decimal import ROUND_HALF_UP, Decimal
from math import exp, log

from motion import ALL, INCH, Motion, tan

FRAME = (300.0, 150.0, -100.0)


def least(value, increment="0.001"):
    return float((Decimal(repr(round(value, 9))) / Decimal(increment)).quantize(Decimal(1), ROUND_HALF_UP)
                 * Decimal(increment))


class Short(Motion):
    def __init__(self, control, name, about, *, units="metric", profile="", library=(), **more):
        run = [f"tests/motions/programs/{control}/{file}.nc" for file in (name, *library)]
        unit = INCH if units == "inch" else 1.0
        more = {"start": (10.0, 20.0, 30.0), "offsets": {1: FRAME}, **more}
        profile = (f'units = "{units}"\n' if control != "cc100" else "") + profile
        super().__init__(control, name, run, about, unit=unit, profile=profile, **more)


part = Short("fanuc", "returns", "M99 P50 goes on at N50, so X99. is passed by until the plain M99 of the third time.")
part.work(1)
part.rapid(0.0, 0.0)
for turn in range(3):
    part.rapid(y=2.0 * turn + 1.0)
    if turn == 2:
        part.rapid(99.0)
    part.rapid(10.0 + turn)
part.rapid(y=20.0)
part.to("haas", "calls/chain.rs")

part = Short("fanuc", "computed", "#103 = 7.5, #3 = 2.25 over its own 3, then #500.. are 0, 1.5, 3, 4.5. #503 is first what #106.25 is not:\n"
                                  "the number is rounded; it is written again before it is read.")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(7.5, 2.25)
part.rapid(3.0, 4.5)
part.rapid(1.5 + 1.5)
part.to("haas")

part = Short("fanuc", "carried", "Under G66 the locals are set once: #33 is 2, 2 + 3, 5 + 4 behind the moves, and M08 calls nothing.")
part.work(1)
part.rapid(0.0, 0.0)
for x, z in ((1.0, -2.0), (2.0, -5.0), (3.0, -9.0)):
    part.rapid(x)
    part.rapid(z=z)
part.rapid(4.0)

part = Short("fanuc", "functions", "FUP away from zero, MOD with the dividend's sign, EXP and LN, BIN[149] = 95 (149 is 95 in BCD) and back, angles in\n"
                                   "-180..180 (6004.0 = 1), bits.", profile="[parameters]\n\"6004.0\" = 1")
part.work(1)
part.rapid(0.0, 0.0)
for x, y in ((-3, 3), (-2, 2), (exp(1.5), log(20)), (95, 149), (30, 60), (90, 60), (-36.869897646, 126.869897646),
             (-135, tan(30)), (4, 12), (13, None)):
    part.rapid(least(x), None if y is None else least(y))
part.to("haas", "expressions/functions/exponential.rs", "expressions/functions/rounding.rs", "expressions/functions/decimal.rs", "expressions/functions/emulated.rs", "expressions/functions/modulo.rs",
        "expressions/functions/trigonometry.rs", "expressions/functions/mod.rs", "rewrite.rs")

part = Short("fanuc", "both-bits", "13 and 6 are 4, 15 and 11; with -3 they are 13, -1 and -16; 13 AND 6, 14 AND 7, 15 AND 8 are 4, 6 and 8.")
part.work(1)
part.rapid(0.0, 0.0)
one, two, minus = 13, 6, -3
part.rapid(one & two, one | two)
part.rapid(one ^ two, two)
part.rapid(one & minus, minus | two)
part.rapid(minus ^ one, minus)
for more in range(3):
    part.rapid((one + more) & (two + more))
part.to("fadal", "expressions/functions/bits.rs", "rewrite.rs")

part = Short("fanuc", "word-rounds", "1.23456 and -2.34567 round to 1.235 and -2.346, so back by 1.111; half of the first to .617, twice.")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(1.235, -2.346)
part.rapid(1.235 + 1.111, -2.346)
part.rapid(1.235 + 1.111 + 2 * 0.617, -2.346)
part.to("fadal", "moves/word_rounds.rs", "expressions/functions/rounding.rs")
part.to("cc100", "moves/word_rounds.rs", "expressions/functions/rounding.rs")

part = Short("fanuc", "taps-by-feed", "400 and 300 a minute, in and out, at 500 turns: leads of .8 and .6; back to Z20. (G98) and to the plane (G99).",
             profile='options = ["common.variables"]')
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=20.0)
part.feed(1.0, f=250.0)
part.hole(2.0, 1.0, r=2.0, bottom=-3.0, back=20.0, f=400.0, out="feed")
part.hole(4.0, 1.0, r=2.0, bottom=-3.0, back=20.0, f=400.0, out="feed")
part.hole(5.0, 1.0, r=3.0, bottom=-2.0, f=300.0, out="feed")
part.feed(6.0, f=300.0)
part.to("fadal", "cycles/tap_leads.rs", profile='[settings]\nformat = "1"')
part.to("fadal", profile='[settings]\nformat = "2"')

part = Short("fanuc", "taps-by-turn", ".8 a turn at 500 turns and .75 at 400, in and out: 400 and 300 a minute; back to Z20. (G98) and to the plane (G99).",
             profile='options = ["common.variables"]')
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=20.0)
part.feed(1.0, f=250.0)
part.hole(2.0, 1.0, r=2.0, bottom=-3.0, back=20.0, f=0.8 * 500, out="feed")
part.hole(4.0, 1.0, r=2.0, bottom=-3.0, back=20.0, f=0.8 * 500, out="feed")
part.hole(5.0, 1.0, r=3.0, bottom=-2.0, f=0.75 * 400, out="feed")
part.feed(6.0, f=300.0)
part.to("fadal", "cycles/turn_feeds.rs", "cycles/rigid_taps.rs", "cycles/tap_leads.rs", profile='[settings]\nformat = "1"')
part.to("fadal", "cycles/turn_feeds.rs", "cycles/rigid_taps.rs", profile='[settings]\nformat = "2"')
part.to("haas", "cycles/rigid_taps.rs")

part = Short("fanuc", "dwells", "G82 dwells .5 s; G83 and G73 take no P, so they do not; G82 dwells again. G04: P in ms, X in seconds.")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=20.0)
part.hole(1.0, 1.0, r=2.0, bottom=-3.0, back=20.0, f=100.0, dwell=0.5)
part.peck(2.0, 1.0, r=2.0, bottom=-8.0, steps=[5, 5], back=20.0)
part.peck(3.0, 1.0, r=2.0, bottom=-8.0, steps=[5, 5], back=20.0, chips=True)
part.hole(4.0, 1.0, r=2.0, bottom=-3.0, back=20.0, dwell=0.5)
part.dwell(0.25)
part.dwell(1.5)
part.to("haas", "cycles/cycle_words.rs", "cycles/dwell.rs")
part.to("fadal", "cycles/cycle_planes.rs")

part = Short("fanuc", "holes-as-moves", "G98 returns to 20, G99 to 2; pecks begin 1 over the last depth. Under G91 the plane is 18 below 20, and the bottom 3\n"
                                         "below that; K2 drills twice.", profile="[behaviours]\n\"cycle.peck.clearance\" = 1.0")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=20.0)
part.hole(1.0, 1.0, r=2.0, bottom=-3.0, back=20.0, f=100.0)
part.hole(2.0, r=2.0, bottom=-3.0)
part.hole(3.0, r=2.0, bottom=-4.0, out="feed")
part.peck(4.0, r=2.0, bottom=-8.0, steps=[5, 5])
part.peck(5.0, r=2.0, bottom=-7.0, steps=[4, 4, 1], back=20.0)
part.peck(6.0, r=2.0, bottom=-8.0, steps=[5, 5], back=20.0, chips=True)
part.hole(7.0, r=2.0, bottom=-1.0, back=20.0)
part.hole(8.0, r=2.0, bottom=-1.0, back=20.0)
part.feed(20.0, f=200.0)
part.to("cc100", "cycles/hole_moves/mod.rs")

part = Short("fanuc", "chosen", "GOTO 10, 20 and 30 in turn, each from N5; G53 to X-50. Y-60. of the machine, and G54 counts again.")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(10.0)
part.rapid(20.0, 5.0)
part.rapid(30.0)
part.machine(-50.0, -60.0)
part.rapid(1.0, 1.0)
part.rapid(8.0)
part.to("cc100", "calls/jump_chains.rs", "moves/machine_moves.rs", "moves/unit_checks.rs")
part.to("fadal", "calls/jump_chains.rs", "moves/unit_checks.rs", profile='[settings]\nformat = "1"')

part = Short("fanuc", "cycle-ends", "G00 and G01 end the cycle, so X7., X8. and X10. drill nothing; G99 goes back to 2.")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(z=20.0)
part.hole(5.0, 5.0, r=2.0, bottom=-3.0, f=100.0)
part.hole(6.0, r=2.0, bottom=-3.0)
part.rapid(7.0, 0.0)
part.rapid(8.0)
part.hole(9.0, r=2.0, bottom=-4.0)
part.feed(10.0, f=200.0)
part.to("fadal", "cycles/cycle_ends.rs", profile='[settings]\nformat = "1"')
part.to("cc100", "cycles/hole_moves/mod.rs")

part = Short("haas", "deep", "Six doublings of 2 with one more each are 191; (191 > 20) + (191 < 20) * 5 is 1; 123456.789 - 123450 and\n"
                             "12.3456789; the loop ends when 12.346 - 3 is below 10, with #1 at 189; M97 twice.", profile='options = ["macros"]')
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(191.0)
part.rapid(1.0)
part.rapid(y=1.0)
part.rapid(6.789)
part.rapid(y=12.346)
part.rapid(190.0)
part.rapid(189.0)
part.rapid(y=9.346)
part.rapid(289.0)
part.rapid(290.0)
part.to("fanuc", "expressions/split.rs", "expressions/cost.rs", "expressions/truth.rs", "expressions/conditions.rs", "expressions/constants.rs", "calls/outline.rs", "registers/temporaries.rs",
        profile='options = ["common.variables"]')

part = Short("haas", "vacant-write", "R with a vacant variable is not there: the table keeps 5, then gets 2.5. It holds diameters.")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(5.0)
part.rapid(2.5)
part.to("fanuc", "variables/vacant_writes.rs", "variables/state.rs")

part = Short("fanuc", "offset-numbers", "Length 2 is 3.5 and length 3 twice that, by computed numbers and by their own.")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(3.5, 7.0)
part.rapid(7.0)
part.to("haas", "variables/computed_numbers.rs", "variables/computed_numbers/shift.rs")

part = Short("fadal", "repeats", "G91 X.5 Y.25 L3 moves three times; G5 is rapid for its block, and X3. feeds on.", units="inch")
part.work(1)
part.rapid(0.0, 0.0, 1.0)
for _ in range(3):
    part.by(0.5, 0.25)
part.rapid(0.0)
part.feed(1.0, f=20.0)
part.rapid(2.0, 2.0)
part.feed(3.0)
part.feed(y=0.0)
part.to("fanuc", "calls/repeats.rs", "moves/rapid_once.rs", "moves/units.rs")
# A Haas repeats moves as well.
part.to("haas", "moves/rapid_once.rs", "moves/units.rs")

part = Short("fadal", "rows", "FX(2) is 10, so FX(3) becomes 35.4 and FY(3) 5 - 12.7; INT(35.4) is 35.", units="inch",
             offsets={2: (254.0, 127.0, 0.0), 3: (1.0, 2.0, 0.0)})
part.work(2)
part.rapid(0.0, 0.0)
part.shift = (35.4 * INCH, -7.7 * INCH, 0.0)
part.rapid(1.0, 0.0)
part.rapid(35.0)
for target in ("fanuc", "haas"):
    part.to(target, "offsets/offset_rows.rs", "registers/clear.rs", "registers/allocate.rs", "registers/pool.rs", "registers/runs.rs")

part = Short("fadal", "start", "START goes on in O26 for good, with V1 = 2.5 as it stands: X5., Y0.", units="inch", library=("started",))
part.work(1)
part.rapid(1.0, 1.0)
part.rapid(5.0)
part.rapid(y=0.0)
for target in ("fanuc", "haas"):
    part.to(target, "calls/chain.rs")

part = Short("fadal", "home", "G28 without axes takes them all home.", units="inch", home=(5.0, 6.0, 7.0))
part.work(1)
part.rapid(1.0, 1.0, 1.0)
part.machine(5.0, 6.0, 7.0)
part.rapid(2.0, 1.0)
part.to("fanuc", "moves/reference.rs")

part = Short("fadal", "functions", "SGN(-2.5) = -1 and SGN(0) = 1; INT(-2.5) = -2; six doublings of -1.5 with one less each are -159; ATN(1) = 45; AND is false, OR is true.",
             units="inch")
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(-1.0, 1.0)
part.rapid(-2.0, 2.5)
part.rapid(-1.59, 0.45)
part.rapid(0.0)
part.to("fanuc", "expressions/functions/rounding.rs", "expressions/split.rs", "expressions/conditions.rs", profile='options = ["common.variables", "atan.one"]')
part.to("haas", "expressions/functions/rounding.rs")

part = Short("fadal", "probe", "The probe touches at Z-.5 and X1.2 of the part; PZ1 and PX2 are those.", units="inch",
             scenario="probes = [{ at = [300, 150, -112.7, 0, 0, 0, 0, 0, 0, 0] }, "
                      "{ at = [330.48, 150, -74.6, 0, 0, 0, 0, 0, 0, 0] }]")
part.work(1)
part.rapid(0.0, 0.0, 1.0)
part.probe((None, None, -1.0), (300.0, 150.0, -112.7), f=10.0)
part.rapid(z=1.0)
part.probe((2.0, None, None), (330.48, 150.0, -74.6))
part.rapid(0.0)
part.rapid(z=-0.5)
part.rapid(1.2)
for target in ("fanuc", "haas"):
    part.to(target, "variables/probe_points.rs")

part = Short("cc100", "polar-square", "Five above the pole (10, 20), eight left of it, fifteen right of it, then four down from there.",
             start=(100.0, 100.0, 50.0), offsets={})
part.rapid(0.0, 0.0, 5.0)
part.rapid(10.0, 25.0)
part.feed(2.0, 20.0, f=1000.0)
part.feed(25.0, 20.0)
part.feed(25.0, 16.0)
part.feed(1.0, 2.0)
for target in ("fanuc", "haas"):
    part.to(target, "moves/polar.rs")

# Programs of the other lists.
for control, name, targets, files in (
    ("fadal", "ex-r-transfer", ("fanuc", "haas"), ("variables/vacancy.rs",)),
    ("fadal", "o600-rect-pocket", ("fanuc", "haas"), ("operator/questions.rs",)),
    ("fadal", "o10-row-column-main", ("fanuc", "haas"), ("cycles/cycle_here.rs", "moves/shift.rs")),
    ("fadal", "o1234-drill-grid", ("haas",), ("codes/substitutes.rs", "codes/machine_codes.rs", "layout/emptied.rs")),
    ("fadal", "o4-big-drill", ("fanuc", "haas"), ("calls/modal_calls.rs", "calls/outline.rs", "variables/state.rs")),
    ("fadal", "tap", ("fanuc", "haas"), ("cycles/tapping.rs", "cycles/tapping/kept.rs")),
    ("fadal", "left-tap", ("fanuc",), ("cycles/tapping.rs",)),
    ("fadal", "bores", ("haas",), ("moves/units.rs",)),
    ("fanuc", "g66-nesting-main", ("haas",), ("calls/modal_calls.rs",)),
    ("haas", "bare-numbers", ("fanuc",), ("moves/increments.rs", "cycles/dwell.rs")),
    ("haas", "branches", ("fanuc",), ("expressions/truth.rs", "calls/outline.rs")),
    ("haas", "o9000-problem3", ("fanuc",), ("codes/lookahead.rs",)),
    ("haas", "taps", ("fanuc",), ()),
    ("cc100", "example2", ("fanuc", "haas"), ("moves/shift.rs",)),
    ("cc100", "drill", ("fanuc", "haas"), ("cycles/cycle_here.rs",)),
):
    for target in targets:
        next(part for part in ALL if (part.control, part.name) == (control, name)).to(target, *files)

part = Short("fanuc", "parts", "#500 is 5, then 7 and 9: X5., X7. + 1. at Y3., X7. from within, X9.", library=("parts-one", "parts-two"))
part.work(1)
part.rapid(0.0, 0.0)
part.rapid(5.0)
part.rapid(8.0, 3.0)
part.rapid(7.0)
part.rapid(9.0)
part.to("cc100", "calls/merged.rs")
