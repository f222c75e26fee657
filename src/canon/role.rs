//! What a word's value is, once the code beside it is known.

super::vocabulary! {
    /// The role of a word in a block. The same letter has other roles beside
    /// other codes: P is milliseconds beside a dwell and a program beside a call.
    Role {
        /// Target of the X axis.
        X = "axis.x",
        /// Target of the Y axis.
        Y = "axis.y",
        /// Target of the Z axis.
        Z = "axis.z",
        /// Target of the A axis, degrees.
        A = "axis.a",
        /// Target of the B axis, degrees.
        B = "axis.b",
        /// Target of the C axis, degrees.
        C = "axis.c",
        /// Target of the fourth linear axis where it has the letter E.
        E = "axis.e",
        /// Target of the U axis, parallel to X.
        U = "axis.u",
        /// Target of the V axis, parallel to Y.
        V = "axis.v",
        /// Target of the W axis, parallel to Z.
        W = "axis.w",
        /// How far X goes from where it is: on a lathe a difference of diameters.
        StepX = "step.x",
        /// How far Y goes from where it is.
        StepY = "step.y",
        /// How far Z goes from where it is.
        StepZ = "step.z",
        /// How far C turns from where it is, degrees.
        StepC = "step.c",
        /// Arc centre along X, from the start point.
        ArcI = "arc.i",
        /// Arc centre along Y, from the start point.
        ArcJ = "arc.j",
        /// Arc centre along Z, from the start point.
        ArcK = "arc.k",
        /// Arc radius: positive the arc up to 180 degrees, negative the longer one.
        ArcRadius = "arc.radius",
        /// Corner rounding after the block (`,R`).
        CornerRadius = "corner.radius",
        /// Corner chamfer after the block (`,C`).
        CornerChamfer = "corner.chamfer",
        /// Chamfer after a block along Z: the next one goes along X, the way of the sign (a radius).
        ChamferX = "chamfer.x",
        /// Chamfer after a block along X: the next one goes along Z, the way of the sign.
        ChamferZ = "chamfer.z",
        /// Chamfer after a block along one axis: the next one goes along the other, the way of the sign.
        ChamferNext = "chamfer.next",
        /// The same, rounded.
        RoundNext = "round.next",
        /// Angle of a straight line on a lathe, from Z counter-clockwise, degrees: one axis word gives its end.
        LineAngle = "line.angle",
        /// Feed, in units per minute or per turn as the feed mode says.
        Feed = "feed",
        /// Spindle speed, turns per minute (surface speed under constant surface speed).
        Speed = "speed",
        /// Tool number.
        Tool = "tool",
        /// Turret station and tool offset in one number: 100 times the station, plus the offset. An offset over 99 stands in
        /// 1000000 and 1000 times the station, plus the offset.
        Turret = "tool.turret",
        /// Number of the tool length offset.
        LengthOffset = "offset.length",
        /// Number of the cutter radius offset.
        RadiusOffset = "offset.radius",
        /// Work offset: 0 none, 1 to 6 the standard six, 101 and up the additional ones from 1.
        WorkOffset = "wcs.number",
        /// Retract plane of a drilling cycle; along X of a lathe a diameter.
        CycleR = "cycle.r",
        /// How far the retract plane of a hole lies from where its cycle began, with its sign: along X a radius.
        CycleRStep = "cycle.r.step",
        /// Peck or shift of a drilling cycle.
        CycleQ = "cycle.q",
        /// How many times as fast as it goes in a tap comes out.
        TapRetract = "cycle.tap.retract",
        /// Speed of the spindle while a tap comes out, turns per minute.
        TapOutSpeed = "cycle.tap.out.speed",
        /// How near an axis must be to its place before the next step of a tap begins.
        InPosition = "in.position",
        /// How near the spindle must be to its place before the next step of a tap begins.
        InPositionSpindle = "in.position.spindle",
        /// Dwell at the bottom of a drilling cycle, milliseconds.
        CycleDwell = "cycle.dwell",
        /// How often a cycle or motion block is repeated.
        Repeat = "repeat",
        /// First peck of a decreasing peck cycle.
        PeckFirst = "cycle.peck.first",
        /// How much each peck is smaller.
        PeckLess = "cycle.peck.less",
        /// The smallest peck.
        PeckLeast = "cycle.peck.least",
        /// Distance fed before each peck begins.
        PeckClear = "cycle.peck.clear",
        /// Shift in X of a fine boring cycle.
        CycleI = "cycle.i",
        /// Shift in Y of a fine boring cycle.
        CycleJ = "cycle.j",
        /// Radius of a circle of holes.
        HolesRadius = "holes.radius",
        /// Angle of the first hole of a circle, or of a line of holes, counterclockwise from the first axis of the plane.
        HolesStart = "holes.start",
        /// Angle between the holes on an arc.
        HolesStep = "holes.step",
        /// Distance from hole to hole on a line.
        HolesApart = "holes.apart",
        /// How many holes are on a circle, an arc or a line.
        HolesCount = "holes.count",
        /// Radius of the first circle of a pocket, or of the only one.
        PocketFirst = "pocket.first",
        /// Radius of the last circle of a pocket.
        PocketLast = "pocket.last",
        /// By how much each circle of a pocket is larger.
        PocketStep = "pocket.step",
        /// How often a pocket is milled, each time deeper.
        PocketCount = "pocket.count",
        /// Lead of a thread.
        Lead = "lead",
        /// Threads an inch, in place of the lead.
        ThreadsPerInch = "threads.per.inch",
        /// Angle of the spindle at which a thread begins, thousandths of a degree.
        ThreadStart = "thread.start",
        /// By how much the lead of a thread grows each turn.
        LeadGrowth = "lead.growth",
        /// Taper of a turning or threading pass: the radius at its start less that at its end.
        Taper = "taper",
        /// Taper of a facing pass: Z at its start less that at its end.
        TaperZ = "taper.z",
        /// Sequence number of the first block of a contour.
        ContourFirst = "contour.first",
        /// Sequence number of the last block of a contour.
        ContourLast = "contour.last",
        /// 1 where a contour may have valleys.
        ContourType = "contour.type",
        /// Depth of a roughing pass, as a radius or along Z.
        CutDepth = "cut.depth",
        /// How far a pass or a peck goes back from the cut.
        CutRetract = "cut.retract",
        /// What is left for finishing along X: a diameter, with its sign.
        AllowanceX = "allowance.x",
        /// What is left for finishing along Z, with its sign.
        AllowanceZ = "allowance.z",
        /// What the last roughing pass takes along X: a radius.
        RoughX = "rough.x",
        /// What the last roughing pass takes along Z.
        RoughZ = "rough.z",
        /// How far the first pass of a repeated pattern lies off along X: a radius, with its sign.
        PatternX = "pattern.x",
        /// How far the first pass of a repeated pattern lies off along Z, with its sign.
        PatternZ = "pattern.z",
        /// How many passes a pattern is repeated in.
        Passes = "passes",
        /// Peck or shift along X of a grooving cycle: a radius.
        GrooveX = "groove.x",
        /// Peck or shift along Z of a grooving cycle.
        GrooveZ = "groove.z",
        /// How far the tool leaves the wall at the bottom of a groove.
        GrooveRelief = "groove.relief",
        /// Height of a thread: a radius.
        ThreadHeight = "thread.height",
        /// Depth of the first pass of a thread: a radius.
        ThreadFirst = "thread.first",
        /// The least depth of a pass of a thread: a radius.
        ThreadLeast = "thread.least",
        /// What is left of a thread for its finishing passes: a radius.
        ThreadAllowance = "thread.allowance",
        /// Finishing passes, run-out and angle of a thread in one number: two digits each.
        ThreadForm = "thread.form",
        /// How many finishing passes a thread gets.
        ThreadFinishes = "thread.finishes",
        /// How long a thread runs out at its end, in leads.
        ThreadRunOut = "thread.run.out",
        /// Angle between the flanks of a thread, degrees.
        ThreadAngle = "thread.angle",
        /// How the passes of a thread go in: 1 one flank, constant area; 2 both flanks, constant area; 3 one flank, constant depth; 4
        /// both flanks, constant depth.
        ThreadInfeed = "thread.infeed",
        /// Radius of the cylinder that a path is wound round.
        CylinderRadius = "cylinder.radius",
        /// Dwell in milliseconds.
        DwellMs = "dwell.ms",
        /// Dwell in seconds.
        DwellS = "dwell.s",
        /// Rotation angle, degrees counter-clockwise.
        Angle = "rotation.angle",
        /// Polar angle.
        PolarAngle = "polar.angle",
        /// Polar distance.
        PolarDistance = "polar.distance",
        /// Scale factor of all axes.
        Scale = "scale",
        /// Scale factor of the X axis.
        ScaleX = "scale.x",
        /// Scale factor of the Y axis.
        ScaleY = "scale.y",
        /// Scale factor of the Z axis.
        ScaleZ = "scale.z",
        /// Program number of a call.
        Program = "call.program",
        /// Sequence number of a call or a return.
        Sequence = "call.sequence",
        /// How often a call is repeated, in all.
        CallCount = "call.count",
        /// How often a call is repeated after the first time.
        CallAgain = "call.again",
        /// Input bit that is tested.
        Input = "input.bit",
        /// Output bit that is switched.
        Output = "output.bit",
        /// Blocks that may be read ahead.
        Lookahead = "lookahead",
        /// Row of an offset table that is written.
        OffsetRow = "offset.row",
        /// Value that is written into an offset table.
        OffsetValue = "offset.value",
        /// Nose radius that is written into a tool offset of a lathe.
        OffsetNose = "offset.nose",
        /// Direction of the tip, 0 to 9, that is written into it.
        OffsetTip = "offset.tip",
        /// Which reference position a return goes to: the second, the third or the fourth.
        ReferencePoint = "reference.point",
        /// Number of a probed point.
        ProbePoint = "probe.point",
        /// Spindle-speed limit.
        SpeedLimit = "speed.limit",
        /// Ratio of cam wrapping.
        WrapRatio = "wrap.ratio",
        /// Which mode of quality a code switches, by a number that only the tables of one control and its relatives share.
        Quality = "path.quality.mode",
        /// A value that a machine builder's code takes as it is.
        Builder = "builder",
        /// The number of the name that the profile gives to a builder's code.
        Act = "act",
        /// First word that such a code takes, by the order of their names.
        Act1 = "act.1",
        /// Second word of such a code.
        Act2 = "act.2",
        /// Third word of such a code.
        Act3 = "act.3",
        /// Fourth word of such a code.
        Act4 = "act.4",
        /// Fifth word of such a code.
        Act5 = "act.5",
        /// Sixth word of such a code.
        Act6 = "act.6",
        /// Seventh word of such a code.
        Act7 = "act.7",
        /// Eighth word of such a code.
        Act8 = "act.8",
        /// Ninth word of such a code.
        Act9 = "act.9",
        /// Tenth word of such a code.
        Act10 = "act.10",
        /// Eleventh word of such a code.
        Act11 = "act.11",
        /// Twelfth word of such a code.
        Act12 = "act.12",
        /// Thirteenth word of such a code.
        Act13 = "act.13",
        /// Fourteenth word of such a code.
        Act14 = "act.14",
        /// Fifteenth word of such a code.
        Act15 = "act.15",
        /// Sixteenth word of such a code.
        Act16 = "act.16",
    }
}
