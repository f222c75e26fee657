//! State of the machine that programs can read, and sometimes write.

super::vocabulary! {
    /// A quantity of the machine. In the IR it stands with its subscripts:
    /// which axis (1 to 9: X Y Z A B C U V W; 10: E), which offset, which work offset.
    Sys {
        /// End of the previous block in work coordinates: axis.
        EndPosition = "pos.end",
        /// Present position in machine coordinates: axis.
        MachinePosition = "pos.machine",
        /// Present position in work coordinates: axis.
        WorkPosition = "pos.work",
        /// Place where the probe touched, in work coordinates: axis.
        SkipPosition = "pos.skip",
        /// Touch points kept by number: axis, point.
        ProbePoint = "pos.probe",
        /// Position of an axis whose frame of reference no source settles: axis.
        AxisPosition = "pos.unsettled",
        /// Tool offset in force: axis.
        ActiveOffset = "offset.active",
        /// Shift of all work offsets: axis.
        ExternalShift = "wcs.external",
        /// Work offset: number (1 to 6, 101 and up for the additional ones), axis.
        WorkOffset = "wcs",
        /// The datum set by the axis words of the position-setting code: axis.
        SetPosition = "wcs.datum",
        /// The pole of polar words: axis.
        Pole = "polar.pole",
        /// Home offset: axis.
        HomeOffset = "reference.offset",
        /// Tool length offset, geometry: number.
        LengthGeometry = "offset.length",
        /// Tool length offset, wear: number.
        LengthWear = "offset.length.wear",
        /// Tool radius, geometry: number.
        RadiusGeometry = "offset.radius",
        /// Tool radius, wear: number.
        RadiusWear = "offset.radius.wear",
        /// Tool diameter, geometry: number.
        DiameterGeometry = "offset.diameter",
        /// Tool diameter, wear: number.
        DiameterWear = "offset.diameter.wear",
        /// Tool diameter or radius, as the control is set: number.
        DiameterOrRadius = "offset.diameter.or.radius",
        /// Wear of the tool diameter or radius, as the control is set: number.
        DiameterOrRadiusWear = "offset.diameter.or.radius.wear",
        /// The one offset value a tool has where length and radius share a table: number.
        ToolOffset = "offset.shared",
        /// Lathe tool offset along X: number.
        LatheX = "offset.lathe.x",
        /// Lathe tool offset along Z: number.
        LatheZ = "offset.lathe.z",
        /// Lathe nose radius: number.
        LatheRadius = "offset.lathe.radius",
        /// Lathe nose position: number.
        LatheTip = "offset.lathe.tip",
        /// Lathe tool offset along Y: number.
        LatheY = "offset.lathe.y",
        /// A variable that a code of the machine's builder reads or sets, by the name that profiles give it: act, word.
        Act = "machine.act",
        /// Tool in the spindle.
        ActiveTool = "tool.active",
        /// Allowed tool time, minutes: tool.
        ToolTimeLimit = "tool.time.limit",
        /// Used tool time, minutes: tool.
        ToolTimeUsed = "tool.time.used",
        /// Tool life and other tool-table cells that only one control has: cell, tool. Cells: 1 feed
        /// seconds, 2 total seconds, 3 life limit, 4 life counter, 5 largest load, 6 load limit, 7 flutes.
        ToolTable = "tool.table",
        /// The modal code of a group: group, by the common numbers of groups.
        Modal = "modal",
        /// Whether a G code is in force: 0 if it is, by its number.
        CodeTest = "modal.test",
        /// The modal code of a group in the running block: group.
        ModalNow = "modal.now",
        /// Modal G code of the motion group, plus one.
        ModalMotionPlus1 = "modal.motion.plus.one",
        /// Where the spindle is in a cycle: 0 initial plane, 1 R plane.
        CyclePlane = "modal.cycle.plane",
        /// Last value of an address: letter (1 A to 26 Z).
        Address = "address",
        /// Last value of an address in the running block: letter.
        AddressNow = "address.now",
        /// Input bit: number.
        Input = "input",
        /// Input word: number.
        InputWord = "input.word",
        /// Output bit: number.
        Output = "output",
        /// Output word: number.
        OutputWord = "output.word",
        /// Analog input: number.
        Analog = "input.analog",
        /// Input that reads 0 when on and 1 when off: number.
        InputInverted = "input.inverted",
        /// Output pulled low by 0: number.
        OutputInverted = "output.inverted",
        /// Alarm: writing it stops the machine with this number.
        Alarm = "alarm",
        /// Stop with a message: writing it stops until cycle start.
        StopMessage = "stop.message",
        /// Timer, milliseconds.
        TimerMs = "timer.ms",
        /// Timer, hours.
        TimerHours = "timer.hours",
        /// Seconds since cycle start.
        CycleSeconds = "timer.cycle",
        /// Other clocks: 1 since power-on, 2 all time in automatic mode, 3 the program now running,
        /// 4 since cycle start, 5 feeding, 6 the last part, 7 the part before it.
        Clock = "timer.other",
        /// Date, as yyyymmdd.
        Date = "date",
        /// Date, as yymmdd: the year is counted from 2000.
        ShortDate = "date.short",
        /// Time of day, as hhmmss.
        Time = "time",
        /// Single-block and auxiliary-function control.
        SingleBlock = "control.single.block",
        /// Feed-hold, override and exact-stop control.
        FeedHold = "control.feed.hold",
        /// Setting bits.
        Settings = "control.settings",
        /// Setting of the control: number.
        Setting = "control.setting",
        /// Parameter of the control: number.
        Parameter = "control.parameter",
        /// Mirror-image state.
        Mirror = "control.mirror",
        /// Program restart state.
        Restart = "control.restart",
        /// Parts made.
        PartsMade = "parts.made",
        /// Parts required.
        PartsRequired = "parts.required",
        /// Actual spindle speed.
        SpindleActual = "spindle.actual",
        /// Number of the main program.
        MainProgram = "program.main",
        /// Index of a table: 1 tools, 2 fixtures.
        TableIndex = "table.index",
        /// Vacant, always.
        Empty = "empty",
        /// The ratio of circumference to diameter.
        Pi = "pi",
        /// Euler's number.
        Euler = "e",
        /// Other state that only this control has: number.
        Other = "other",
    }
}

impl Sys {
    /// True for state that moves change, or that changes while they are made: read too early, it is what it was before.
    pub const fn is_changed_by_moves(self) -> bool {
        use Sys::*;
        matches!(
            self,
            AxisPosition
                | WorkPosition
                | MachinePosition
                | EndPosition
                | SkipPosition
                | ProbePoint
                | Act
                | Input
                | InputInverted
                | ToolTimeUsed
                | Clock
                | CyclePlane
        )
    }

    /// True for what a control that reads ahead may read before the moves before it are done: what the machine has come to, and
    /// not what its program says.
    pub const fn is_read_early(self) -> bool {
        use Sys::*;
        matches!(
            self,
            MachinePosition
                | WorkPosition
                | SkipPosition
                | Input
                | InputWord
                | Analog
                | TimerMs
                | TimerHours
                | CycleSeconds
                | SpindleActual
                | Act
                | Output
                | OutputWord
        )
    }

    /// True for a clock that runs on while moves and waits are made: set and read early, it has none of their time.
    pub const fn runs_on(self) -> bool {
        matches!(self, Sys::TimerMs | Sys::TimerHours | Sys::CycleSeconds)
    }

    /// True for a length or a position, which is read and written in the unit in force.
    pub const fn is_length(self) -> bool {
        use Sys::*;
        matches!(
            self,
            EndPosition
                | MachinePosition
                | WorkPosition
                | SkipPosition
                | ProbePoint
                | AxisPosition
                | ActiveOffset
                | ExternalShift
                | WorkOffset
                | SetPosition
                | Pole
                | HomeOffset
        ) || self.is_tool_offset() && !matches!(self, LatheTip)
    }

    /// True for a cell of the table of tools.
    pub const fn is_tool_offset(self) -> bool {
        use Sys::*;
        matches!(
            self,
            LengthGeometry
                | LengthWear
                | RadiusGeometry
                | RadiusWear
                | DiameterGeometry
                | DiameterWear
                | DiameterOrRadius
                | DiameterOrRadiusWear
                | ToolOffset
                | LatheX
                | LatheZ
                | LatheRadius
                | LatheTip
                | LatheY
        )
    }
}
