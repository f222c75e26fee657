"""Keeps the list of moves that a person works out for a program, and writes it down.

Nothing here reads a program. A list says: from here rapid to there, feed to there. Coordinates are
those of the part in the units of the program; what is written are millimetres of the machine.
"""

import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))
INCH = 25.4
ALL = []


def number(value):
    text = f"{value:.9f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def quoted(text):
    return f'"{text}"'


def sin(degrees):
    return math.sin(math.radians(degrees))


def cos(degrees):
    return math.cos(math.radians(degrees))


def tan(degrees):
    return math.tan(math.radians(degrees))


class Motion:
    """The moves of one program.

    start is the machine position in mm at which the run begins; shift is what the work offset adds, in mm;
    length what the tool in use adds to Z, in mm.
    """

    # Where the lists of this kind of machine are written, and what more these lists say: a key a line.
    folder, says = "expected", ""

    def __init__(self, control, name, run, about, *, unit=1.0, start=(0, 0, 0), home=(0, 0, 0), offsets=None,
                 tools=None, profile="", scenario="", tables="", ends="ended",
                 turns=False):
        self.control, self.name, self.run, self.about = control, name, run, about
        self.unit, self.start, self.home = unit, start, home
        self.offsets, self.tools = offsets or {}, tools or {}
        self.profile, self.scenario, self.tables, self.ends = profile, scenario, tables, ends
        self.now = list(map(float, start))
        self.shift, self.length = (0.0, 0.0, 0.0), 0.0
        self.speed, self.mode = 0.0, "per_minute"
        # Whether the list says what the spindle does and where the program waits for the operator.
        self.turns, self.turning, self.rpm = turns, "stopped", 0.0
        self.lines = []
        # Targets, the files of src/legalize/ that act on the way there, and the lines of the target's profile.
        self.converts = []
        ALL.append(self)

    # Where coordinates count from.

    def work(self, which):
        """Coordinates count from this work offset; 0 is the machine's own zero."""
        self.shift = self.offsets.get(which, (0.0, 0.0, 0.0)) if which else (0.0, 0.0, 0.0)

    def tool(self, which):
        """The length of this tool's offset counts; 0 for none."""
        self.length = self.tools.get(which, 0.0) if which else 0.0

    def place(self, x=None, y=None, z=None):
        at = list(self.now)
        for axis, value in enumerate((x, y, z)):
            if value is not None:
                at[axis] = value * self.unit + self.shift[axis] + (self.length if axis == 2 else 0.0)
        return at

    def here(self):
        """Where the tool stands, in the part's coordinates and units."""
        shifts = (self.shift[0], self.shift[1], self.shift[2] + self.length)
        return tuple((value - shift) / self.unit for value, shift in zip(self.now, shifts))

    # The moves.

    def _write(self, kind, at, *rest):
        self.lines.append(" ".join([kind, *map(number, at), *map(str, rest)]))

    def rapid(self, x=None, y=None, z=None):
        self._rapid(self.place(x, y, z))

    def _rapid(self, at):
        if math.dist(at, self.now) > 1e-7:
            self._write("rapid", at)
        self.now = at

    def machine(self, x=None, y=None, z=None):
        """A rapid move in machine coordinates, mm."""
        self._rapid([now if value is None else value for now, value in zip(self.now, (x, y, z))])

    def by(self, x=0.0, y=0.0, z=0.0):
        """A rapid move by so much."""
        self._rapid([now + step * self.unit for now, step in zip(self.now, (x, y, z))])

    def feed(self, x=None, y=None, z=None, f=None, mode=None):
        self._feed(self.place(x, y, z), f, mode)

    def feed_by(self, x=0.0, y=0.0, z=0.0, f=None, mode=None):
        self._feed([now + step * self.unit for now, step in zip(self.now, (x, y, z))], f, mode)

    def set_feed(self, f, mode=None):
        self.speed, self.mode = f * self.unit, mode or self.mode

    def _feed(self, at, f, mode):
        if f is not None:
            self.set_feed(f, mode)
        if math.dist(at, self.now) > 1e-7:
            self._write("feed", at, number(self.speed), self.mode)
        self.now = at

    def arc(self, x, y, centre, turn, z=None, f=None, plane=(0, 1)):
        """An arc about a centre (part coordinates); turn is +1 counter-clockwise, -1 clockwise, seen as
        the first axis of the plane turns to the second."""
        if f is not None:
            self.set_feed(f)
        at = self.place(x, y, z)
        one, two = plane
        middle = list(self.now)
        place = self.place(*(dict(zip(plane, centre)).get(axis) for axis in range(3)))
        middle[one], middle[two] = place[one], place[two]
        begin = math.atan2(self.now[two] - middle[two], self.now[one] - middle[one])
        end = math.atan2(at[two] - middle[two], at[one] - middle[one])
        sweep = math.degrees(end - begin) * turn % 360.0
        if math.hypot(at[one] - self.now[one], at[two] - self.now[two]) < 1e-7:
            sweep = 360.0
        self._write("arc", at, *map(number, middle), number(turn * sweep), number(self.speed), self.mode)
        self.now = at

    def arc_of_radius(self, x, y, radius, turn, f=None):
        """The arc of less than half a turn with this radius."""
        px, py, _ = self.here()
        dx, dy = x - px, y - py
        chord = math.hypot(dx, dy)
        height = math.sqrt(max(radius * radius - chord * chord / 4.0, 0.0))
        # Left of the way for counter-clockwise arcs.
        centre = ((px + x) / 2.0 - turn * height * dy / chord, (py + y) / 2.0 + turn * height * dx / chord)
        self.arc(x, y, centre, turn, f=f)

    def dwell(self, seconds):
        self.lines.append(f"dwell {number(seconds)}")

    def probe(self, aim, to, f=None):
        """A probe move toward a place of the part; it ended at this machine position, mm."""
        if f is not None:
            self.set_feed(f)
        self._write("probe", to, *map(number, self.place(*aim)), number(self.speed))
        self.now = list(map(float, to))

    def into(self, x, y, r, bottom, f=None, dwell=0.0):
        """Over a hole, to the plane r, to the bottom, and a wait there."""
        if f is not None:
            self.set_feed(f)
        self.rapid(x, y)
        self.over(r, bottom)
        self.feed(z=bottom)
        if dwell:
            self.dwell(dwell)

    def hole(self, x=None, y=None, *, r, bottom, back=None, f=None, dwell=0.0, out="rapid"):
        """A drilled hole: over it, to the plane r, to the bottom, up to r, and to the plane back."""
        self.into(x, y, r, bottom, f, dwell)
        self.rapid(z=r) if out == "rapid" else self.feed(z=r)
        if back is not None:
            self.rapid(z=back)

    def peck(self, x=None, y=None, *, r, bottom, steps, back=None, f=None, dwell=0.0, clear=1.0, chips=False):
        """A hole in steps: out to the plane r after each (or back by the clearance only, to break the chip),
        down again to the clearance (mm) over the last depth."""
        if f is not None:
            self.set_feed(f)
        self.rapid(x, y)
        self.over(r, bottom)
        depth = r
        for step in steps:
            if depth != r:
                if not chips:
                    self.rapid(z=r)
                self.rapid(z=min(depth + clear / self.unit, r))
            depth = max(depth - step, bottom)
            self.feed(z=depth)
            if depth == bottom:
                break
        if dwell:
            self.dwell(dwell)
        self.rapid(z=r)
        if back is not None:
            self.rapid(z=back)

    # Cycles that stop, turn back or orient the spindle.

    def spindle(self, direction, rpm=None):
        self.turning, self.rpm = direction, self.rpm if rpm is None else rpm
        self.lines.append(f"spindle {number(self.rpm)} {direction}")

    def stop(self):
        self.lines.append("stop")

    def tap(self, x=None, y=None, *, r, bottom, back=None, f=None, dwell=0.0):
        """A tapped hole: out with the spindle turned back, and turned as before at the plane r."""
        before = self.turning
        self.into(x, y, r, bottom, f, dwell)
        self.spindle("clockwise" if before == "counter_clockwise" else "counter_clockwise")
        self.feed(z=r)
        self.spindle(before)
        if back is not None:
            self.rapid(z=back)

    def bore_and_stop(self, x=None, y=None, *, r, bottom, back=None):
        """A bored hole: the spindle stands on the way out, up to the plane that the cycle ends at."""
        before = self.turning
        self.into(x, y, r, bottom)
        self.spindle("stopped")
        self.rapid(z=r)
        if back is not None:
            self.rapid(z=back)
        self.spindle(before)

    def bore_by_hand(self, x=None, y=None, *, r, bottom, back=None, dwell=0.0):
        """A bored hole: the spindle stops and the operator takes the tool out; the list says where the cycle goes on."""
        before = self.turning
        self.into(x, y, r, bottom, dwell=dwell)
        self.spindle("stopped")
        self.stop()
        self.rapid(z=r)
        self.spindle(before)
        if back is not None:
            self.rapid(z=back)

    def bore_finely(self, x=None, y=None, *, r, bottom, by, back=None, dwell=0.0):
        """A bored hole: the spindle stops where the tip points off the wall, the tool goes aside by so much, out to
        the plane that the cycle ends at, and back over the hole."""
        before = self.turning
        self.into(x, y, r, bottom, dwell=dwell)
        self.spindle("oriented")
        self.by(*by)
        self.rapid(z=r)
        if back is not None:
            self.rapid(z=back)
        self.by(-by[0], -by[1])
        self.spindle(before)

    def bore_back(self, x=None, y=None, *, r, bottom, by, back, f=None, dwell=0.0):
        """A hole bored from below: aside, through to r, into the middle, up to the bottom, aside, and out."""
        before = self.turning
        if f is not None:
            self.set_feed(f)
        self.rapid(x, y)
        self.spindle("oriented")
        self.by(*by)
        self.rapid(z=r)
        self.by(-by[0], -by[1])
        self.spindle(before)
        self.over(r, bottom)
        self.feed(z=bottom)
        if dwell:
            self.dwell(dwell)
        self.spindle("oriented")
        self.by(*by)
        self.rapid(z=back)
        self.by(-by[0], -by[1])
        self.spindle(before)

    def over(self, r, bottom):
        """The tool goes down to the plane r over a hole."""
        self.rapid(z=r)
        self._write("hole", self.now, number(self.place(z=bottom)[2]))

    # Writing it down.

    def to(self, control, *files, profile=""):
        """The same moves come of the conversion for a control; these files of src/legalize/ act on the way there."""
        units = "inch" if self.unit == INCH else "metric"
        self.converts.append((control, files, f'units = "{units}"\n{profile}'))

    def text(self):
        def row(values):
            return "[" + ", ".join(map(number, (list(values) + [0.0] * 10)[:10])) + "]"

        scenario = [f"start = {row(self.start)}", f"references = [{row(self.home)}, {row(self.home)}]"]
        scenario += [self.scenario] if self.scenario else []
        if self.offsets:
            scenario.append("[work_offsets]")
            scenario += [f"{which} = {row(at)}" for which, at in sorted(self.offsets.items())]
        for which, length in sorted(self.tools.items()):
            scenario += [f"[tools.{which}]", f"length = {number(length)}"]
        scenario += [self.tables] if self.tables else []
        about = "\n".join("# " + line for line in self.about.strip().splitlines())
        run = ", ".join(f'"{path}"' for path in self.run)
        converts = "".join(
            f"\n[[converts]]\nto = \"{to}\"\nfiles = [{', '.join(map(quoted, files))}]\nprofile = '''\n{profile.strip()}\n'''\n"
            for to, files, profile in self.converts
        )
        turns = "turns = true\n" if self.turns else ""
        return (
            f"{about}\n\ncontrol = \"{self.control}\"\nrun = [{run}]\nends = \"{self.ends}\"\n{turns}{self.says}"
            f"profile = '''\ndialect = \"{self.control}\"\n{self.profile.strip()}\n'''\n"
            f"scenario = '''\n" + "\n".join(scenario) + "\n'''\n"
            "moves = '''\n" + "\n".join(self.lines) + "\n'''\n" + converts
        )

    def path(self):
        return os.path.join(HERE, self.folder, self.control, self.name + ".toml")
