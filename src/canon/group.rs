//! What of a machine stays in force until another operation of its kind.

super::vocabulary! {
    /// A modal group: of its operations one is in force at a time.
    Group {
        /// Interpolation: how axis words move.
        Motion = "motion",
        /// Drilling cycles. An interpolation code ends the cycle in force; ending a cycle leaves the interpolation as it was.
        Cycle = "cycle",
        /// Working plane.
        Plane = "plane",
        /// Absolute or incremental.
        Distance = "distance",
        /// Feed per minute or per turn.
        FeedMode = "feed.mode",
        /// Inch or metric.
        Units = "units",
        /// Cutter radius compensation.
        RadiusComp = "radius.comp",
        /// Tool length compensation.
        LengthComp = "length.comp",
        /// Return plane of drilling cycles.
        ReturnPlane = "return.plane",
        /// Work offset.
        WorkOffset = "wcs",
        /// Exact stop, cutting, tapping mode.
        PathMode = "path.mode",
        /// Constant surface speed.
        SpeedMode = "speed.mode",
        /// Coordinate rotation.
        Rotation = "rotation",
        /// Scaling.
        Scaling = "scaling",
        /// Mirror image.
        Mirror = "mirror",
        /// Modal macro call.
        ModalCall = "modal.call",
        /// Spindle.
        Spindle = "spindle",
        /// Coolant.
        Coolant = "coolant",
        /// Acts in its own block only.
        OneShot = "one.shot",
    }
}
