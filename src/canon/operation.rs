//! What a block tells the machine to do.

super::vocabulary! {
    /// A canonical operation.
    Op {
        /// Rapid traverse.
        Rapid = "motion.rapid",
        /// Rapid traverse in this block only.
        RapidOnce = "motion.rapid.once",
        /// Straight line at feed.
        Linear = "motion.linear",
        /// Clockwise arc.
        ArcCw = "motion.arc.cw",
        /// Counter-clockwise arc.
        ArcCcw = "motion.arc.ccw",
        /// Arc with tangential entry.
        ArcTangent = "motion.arc.tangent",
        /// Move that ends when the probe touches.
        Probe = "motion.probe",
        /// Probe move of a second kind, named by the control.
        ProbeOther = "motion.probe.other",
        /// Thread cut.
        Thread = "motion.thread",
        /// Thread cut whose lead grows or shrinks.
        ThreadVariable = "motion.thread.variable",
        /// A pass of turning: to the diameter at rapid, along the part, out, and back.
        TurningPass = "pass.turning",
        /// A pass of threading: to the diameter, the thread, out, and back.
        ThreadingPass = "pass.threading",
        /// A pass of facing: to the length at rapid, across the part, off, and back.
        FacingPass = "pass.facing",
        /// Wait for a time.
        Dwell = "dwell",
        /// Exact stop at the end of this block.
        ExactStopOnce = "path.exact.once",
        /// Exact stop mode.
        ExactStop = "path.exact",
        /// Cutting mode: no exact stops.
        CuttingMode = "path.cutting",
        /// Tapping mode.
        TappingMode = "path.tapping",
        /// Acceleration ramps off.
        RampsOff = "path.ramps.off",
        /// Acceleration ramps on.
        RampsOn = "path.ramps.on",
        /// A gain of the axes: how closely they follow their path.
        AxisGain = "path.gain",
        /// A mode of how smoothly or how fast a path is followed, within the tolerance that the control is set to.
        PathQuality = "path.quality",
        /// XY plane.
        PlaneXy = "plane.xy",
        /// ZX plane.
        PlaneZx = "plane.zx",
        /// YZ plane.
        PlaneYz = "plane.yz",
        /// A plane of another axis pair, named by the control.
        PlaneOther = "plane.other",
        /// Wraps an axis round a rotary one.
        Wrap = "plane.wrap",
        /// Dimensions in inch.
        Inch = "units.inch",
        /// Dimensions in millimetres.
        Metric = "units.metric",
        /// Checks that the control is set to inch; changes nothing.
        CheckInch = "units.check.inch",
        /// Checks that the control is set to metric; changes nothing.
        CheckMetric = "units.check.metric",
        /// Ends the input of data that an earlier block began; where none is open it does nothing.
        DataInputEnd = "data.input.end",
        /// Stored stroke check on.
        StrokeCheckOn = "stroke.check.on",
        /// Stored stroke check off.
        StrokeCheckOff = "stroke.check.off",
        /// Checks the reference position.
        ReferenceCheck = "reference.check",
        /// Moves to the reference position by way of a point.
        ReferenceReturn = "reference.return",
        /// Moves back from the reference position.
        ReferenceFrom = "reference.from",
        /// Moves to a second reference position.
        Reference2 = "reference.second",
        /// Moves to the machine's tool-change position, without a point on the way.
        Home = "reference.home",
        /// Cutter compensation off.
        RadiusOff = "radius.off",
        /// Cutter to the left of the path.
        RadiusLeft = "radius.left",
        /// Cutter to the right of the path.
        RadiusRight = "radius.right",
        /// Length compensation on, added.
        LengthPlus = "length.plus",
        /// Length compensation on, subtracted.
        LengthMinus = "length.minus",
        /// Length compensation off.
        LengthOff = "length.off",
        /// Tool offset increases this move once.
        OffsetPlus = "offset.increase",
        /// Tool offset decreases this move once.
        OffsetMinus = "offset.decrease",
        /// Tool offset increases this move twice.
        OffsetPlus2 = "offset.increase.twice",
        /// Tool offset decreases this move twice.
        OffsetMinus2 = "offset.decrease.twice",
        /// This block's coordinates are machine coordinates.
        MachineOnce = "wcs.machine.once",
        /// Cancels every zero shift, until one is selected again.
        ShiftCancel = "wcs.cancel",
        /// Selects the work offset of role `wcs.number`.
        SelectWork = "wcs.select",
        /// Shifts every work offset by the axis words.
        LocalShift = "wcs.local",
        /// Makes the present place have the coordinates of the axis words.
        SetPosition = "wcs.set.position",
        /// Writes axis words into a work offset.
        WriteWork = "wcs.write",
        /// Writes a tool length offset (geometry).
        WriteLength = "offset.write.length",
        /// Writes a tool length offset (wear).
        WriteLengthWear = "offset.write.length.wear",
        /// Writes a tool radius or diameter offset (geometry).
        WriteRadius = "offset.write.radius",
        /// Writes a tool radius or diameter offset (wear).
        WriteRadiusWear = "offset.write.radius.wear",
        /// Writes a tool offset on a control with one value a tool.
        WriteOffset = "offset.write",
        /// Writes the places, the nose radius and the tip of a tool offset of a lathe.
        WriteTurret = "offset.write.turret",
        /// Reads an offset into program variables.
        ReadOffset = "offset.read",
        /// Writes program variables.
        WriteVariable = "variable.write",
        /// Sets the pole of polar words.
        Pole = "polar.pole",
        /// Polar coordinates on.
        PolarOn = "polar.on",
        /// Polar coordinates off.
        PolarOff = "polar.off",
        /// Moves on the face of a part are programmed in a plane of X and a length, and C follows.
        PolarPlane = "interpolation.polar.on",
        /// Ends that.
        PolarPlaneOff = "interpolation.polar.off",
        /// Moves on the side of a part of the radius of its word are programmed on its surface, and C follows; a radius of 0 ends that.
        Cylinder = "interpolation.cylinder",
        /// Scaling on.
        ScaleOn = "scale.on",
        /// Scaling off.
        ScaleOff = "scale.off",
        /// Mirror image on, for the axes of the block.
        MirrorOn = "mirror.on",
        /// Mirror image off.
        MirrorOff = "mirror.off",
        /// Rotates the coordinate system.
        RotateOn = "rotate.on",
        /// Ends the rotation.
        RotateOff = "rotate.off",
        /// Ends a drilling cycle.
        CycleOff = "cycle.off",
        /// Drill.
        CycleDrill = "cycle.drill",
        /// Drill with a dwell at the bottom.
        CycleDrillDwell = "cycle.drill.dwell",
        /// Peck drill, out of the hole each time.
        CyclePeck = "cycle.peck",
        /// Peck drill that only breaks the chip.
        CycleChipBreak = "cycle.chipbreak",
        /// Tap, right hand; feed and speed programmed apart.
        CycleTap = "cycle.tap",
        /// Tap, left hand.
        CycleTapLeft = "cycle.tap.left",
        /// Rigid tap.
        CycleTapRigid = "cycle.tap.rigid",
        /// Tap whose feed word is the spindle speed and whose Q is the lead.
        CycleTapByLead = "cycle.tap.by.lead",
        /// Bore, feed out.
        CycleBore = "cycle.bore",
        /// Bore, stop, rapid out.
        CycleBoreStop = "cycle.bore.stop",
        /// Back bore.
        CycleBackBore = "cycle.bore.back",
        /// Bore, dwell, manual out.
        CycleBoreManual = "cycle.bore.manual",
        /// Bore, dwell, feed out.
        CycleBoreDwell = "cycle.bore.dwell",
        /// Fine bore: orient and shift before the way out.
        CycleFineBore = "cycle.bore.fine",
        /// Runs the active cycle or modal call at the present place.
        CycleHere = "cycle.here",
        /// Sets the depth and the way back of the passes of the next roughing along Z.
        TurningSetup = "contour.turning.setup",
        /// Roughs a contour by passes along Z.
        RoughTurning = "contour.turning",
        /// Sets the depth and the way back of the passes of the next roughing along X.
        FacingSetup = "contour.facing.setup",
        /// Roughs a contour by passes along X.
        RoughFacing = "contour.facing",
        /// Sets the stock and the passes of the next repeated contour.
        PatternSetup = "contour.pattern.setup",
        /// Repeats a contour, nearer each time.
        Pattern = "contour.pattern",
        /// Finishes a contour.
        Finish = "contour.finish",
        /// Sets the way back of the pecks of the next grooving or drilling of a face.
        FaceGrooveSetup = "groove.face.setup",
        /// Grooves a face, or drills it, by pecks along Z.
        FaceGroove = "groove.face",
        /// Sets the way back of the pecks of the next grooving of a diameter.
        GrooveSetup = "groove.setup",
        /// Grooves a diameter by pecks along X.
        Groove = "groove",
        /// Sets the form, the least depth and the finish of the next thread.
        ThreadingSetup = "threading.setup",
        /// Cuts a thread in many passes.
        Threading = "threading",
        /// Drills along Z with a live tool or the part: in pecks where its block has one, with a wait where one was told.
        FaceHole = "hole.face",
        /// Drills along Z, on a control with a code for each way.
        FaceDrill = "hole.face.drill",
        /// The same with a wait at the bottom.
        FaceDrillDwell = "hole.face.drill.dwell",
        /// Drills along Z in pecks.
        FacePeck = "hole.face.peck",
        /// Taps along Z.
        FaceTap = "hole.face.tap",
        /// Taps on the centre line with the spindle that turns the part.
        FaceTapMain = "hole.face.tap.main",
        /// Taps a left-hand thread on the centre line with the spindle that turns the part.
        FaceTapMainLeft = "hole.face.tap.main.left",
        /// Taps along Z with a live tool, which the cycle turns by itself at the last speed.
        FaceTapLive = "hole.face.tap.live",
        /// Taps a left-hand thread along Z with a live tool, which the cycle turns by itself at the last speed.
        FaceTapLiveLeft = "hole.face.tap.live.left",
        /// Bores along Z, feed out.
        FaceBore = "hole.face.bore",
        /// Bores along Z: the spindle stops at the bottom, and the tool comes out by rapid.
        FaceBoreStop = "hole.face.bore.stop",
        /// Bores along Z with a wait at the bottom, feed out.
        FaceBoreDwell = "hole.face.bore.dwell",
        /// Drills along X with a live tool: in pecks where its block has one, with a wait where one was told.
        SideHole = "hole.side",
        /// Drills along X, on a control with a code for each way.
        SideDrill = "hole.side.drill",
        /// The same with a wait at the bottom.
        SideDrillDwell = "hole.side.drill.dwell",
        /// Drills along X in pecks.
        SidePeck = "hole.side.peck",
        /// Taps along X.
        SideTap = "hole.side.tap",
        /// Taps along X with a live tool, which the cycle turns by itself at the last speed.
        SideTapLive = "hole.side.tap.live",
        /// Taps a left-hand thread along X with a live tool, which the cycle turns by itself at the last speed.
        SideTapLiveLeft = "hole.side.tap.live.left",
        /// Bores along X, feed out.
        SideBore = "hole.side.bore",
        /// Bores along X: the spindle stops at the bottom, and the tool comes out by rapid.
        SideBoreStop = "hole.side.bore.stop",
        /// Bores along X with a wait at the bottom, feed out.
        SideBoreDwell = "hole.side.bore.dwell",
        /// Lets threads run out at their end, as the settings of the control say.
        ThreadRunOutOn = "thread.run.out.on",
        /// Lets threads end straight.
        ThreadRunOutOff = "thread.run.out.off",
        /// Makes the taps of the next cycle rigid: their feed follows the turns of the tool.
        RigidTaps = "tap.rigid",
        /// Gets the spindle ready for a rigid tap whose cycle is a code of its own.
        TapReady = "tap.ready",
        /// Runs the drilling cycle in force at places round the circle whose centre is where the tool stands.
        HolesCircle = "holes.circle",
        /// The same at places on an arc, by an angle between them.
        HolesArc = "holes.arc",
        /// The same at places on a line, the first of them where the tool stands.
        HolesLine = "holes.line",
        /// Mills a circle, or a pocket in growing circles, clockwise about the place where the tool stands.
        PocketCw = "pocket.circle.cw",
        /// The same counter-clockwise.
        PocketCcw = "pocket.circle.ccw",
        /// A cycle that only this family of controls has; never carried across.
        CycleOther = "cycle.other",
        /// Absolute coordinates.
        Absolute = "distance.absolute",
        /// Incremental coordinates.
        Incremental = "distance.incremental",
        /// Feed per minute.
        FeedPerMinute = "feed.per.minute",
        /// Feed per turn.
        FeedPerTurn = "feed.per.turn",
        /// Inverse-time feed.
        FeedInverse = "feed.inverse",
        /// Constant surface speed.
        SurfaceSpeed = "speed.surface",
        /// Spindle in turns per minute.
        TurnsPerMinute = "speed.turns",
        /// Limits the spindle speed.
        LimitSpeed = "speed.limit",
        /// Cycles return to the initial plane.
        ReturnInitial = "return.initial",
        /// Cycles return to the R plane.
        ReturnR = "return.r",
        /// Program stop.
        Stop = "stop",
        /// Optional stop.
        OptionalStop = "stop.optional",
        /// End of program.
        End = "end",
        /// End of program and rewind.
        EndRewind = "end.rewind",
        /// Spindle clockwise.
        SpindleCw = "spindle.cw",
        /// Spindle counter-clockwise.
        SpindleCcw = "spindle.ccw",
        /// Spindle stop.
        SpindleStop = "spindle.stop",
        /// Spindle orientation.
        SpindleOrient = "spindle.orient",
        /// Tool change.
        ToolChange = "tool.change",
        /// Turns the turret to a station and takes a tool offset.
        TurretIndex = "tool.turret.index",
        /// Mist coolant on.
        Mist = "coolant.mist",
        /// Flood coolant on.
        Flood = "coolant.flood",
        /// Coolant through the spindle on.
        ThroughSpindle = "coolant.through.on",
        /// Coolant through the spindle off.
        ThroughSpindleOff = "coolant.through.off",
        /// Coolant off.
        CoolantOff = "coolant.off",
        /// Feed and speed overrides in force.
        OverrideOn = "override.on",
        /// Feed and speed overrides out of force.
        OverrideOff = "override.off",
        /// Probe on.
        ProbeOn = "probe.on",
        /// Tool probe on.
        ToolProbeOn = "probe.tool.on",
        /// Brake of the fourth axis on: it holds the axis.
        FourthBrakeOn = "brake.fourth.on",
        /// Brake of the fourth axis off: the axis may turn.
        FourthBrakeOff = "brake.fourth.off",
        /// Brake of the fifth axis on.
        FifthBrakeOn = "brake.fifth.on",
        /// Brake of the fifth axis off.
        FifthBrakeOff = "brake.fifth.off",
        /// Switches the output of role `output.bit` on.
        OutputOn = "output.on",
        /// Switches the output of role `output.bit` off.
        OutputOff = "output.off",
        /// Limits how many blocks are read ahead.
        LimitLookahead = "lookahead.limit",
        /// Calls a program with arguments.
        CallMacro = "call.macro",
        /// Calls a program with arguments after each move.
        CallModal = "call.modal",
        /// Calls a program with arguments after each block.
        CallModalEach = "call.modal.each",
        /// Ends a modal call.
        CallModalOff = "call.modal.off",
        /// Calls a program.
        CallProgram = "call.program",
        /// Calls a part of this program.
        CallLocal = "call.local",
        /// Calls a cycle of the machine builder.
        CallCycle = "call.cycle",
        /// Jumps when an input is off.
        JumpInputOff = "jump.input.off",
        /// Jumps.
        Jump = "jump",
        /// Returns from a subprogram.
        Return = "return",
        /// Ends a subroutine inside a program.
        SubEnd = "sub.end",
        /// Ends the subroutines at the head of a program.
        SubAreaEnd = "sub.area.end",
        /// A machine builder's code, with what the machine profile says of it.
        Builder = "builder",
        /// A code of a machine's builder that the profile names: it leaves every mode as it is.
        Act = "machine.act",
        /// Something that only this kind of machine has; never carried across.
        MachineSpecific = "machine.specific",
    }
}
